//! Pictures: what an eye sees, found by casting rays at the finished solid. In even light ([`view_pictures()`]), in real light
//! ([`lights`]), from all sides ([`turntable`](mod@turntable), [`six_sides()`]) and at a glance ([`thumbnail()`]).
//!
//! Takes views and finished meshes ready for rays; gives PNGs and the figures under them. Rows run in parallel; no result depends on
//! the thread count.

mod camera;
mod captions;
pub mod caster;
pub mod flash;
mod heat;
mod inks;
mod light_figures;
mod light_sheet;
pub mod lights;
mod likeness;
mod shading;
mod six_sides;
pub mod stage;
mod step_lines;
mod thumbnail;
pub mod turntable;
mod view_pictures;

pub use camera::{camera, framing};
pub use heat::{HEAT, SCALE_END_DEG};
pub use light_figures::LightLikeness;
pub use lights::light_pictures;
pub use likeness::{Likeness, angle_deg};
pub use six_sides::six_sides;
pub use thumbnail::thumbnail;
pub use turntable::turntable;
pub use view_pictures::{ViewPictures, view_pictures};
