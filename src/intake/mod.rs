//! Models coming in: the meshes of people's files made fit to be looked at, or judged as they are.
//!
//! Takes a file's name and bytes. Gives a model for a view, in the order of its places, with all that its file says besides; or what
//! is in the file and whether it can be printed. All that was repaired or looks wrong is warned of.

mod inspect;
mod load;

pub use inspect::{Inspection, inspect};
pub use load::{Admitted, load_model, load_original};
