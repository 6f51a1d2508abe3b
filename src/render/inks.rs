//! Inks of what is written under pictures.

use crate::diagram::drawing::Ink;

pub const TEXT: Ink = Ink::new([0x22, 0x26, 0x2B]);
pub const QUIET: Ink = Ink::new([0x6F, 0x73, 0x78]);
