//! Inks of what is written under pictures.

use crate::diagram::drawing::Ink;

pub(super) const TEXT: Ink = Ink::new([0x22, 0x26, 0x2B]);
pub(super) const QUIET: Ink = Ink::new([0x6F, 0x73, 0x78]);
