//! Views: eyes, what they look at and which models they see.
//!
//! Takes the scene's `views` and its models; gives [`Draft`]s, then, once files are read, [`View`](crate::view::View)s.

mod draft;
mod eye;
mod placed;

pub(crate) use draft::{Draft, drafts};
pub(crate) use eye::{Eye, Stand};
pub(crate) use placed::view;
