//! One support with all that views make of it.

use super::boolean::{Boolean, BooleanError};
use super::brace::braces;
use super::forest::{CarveError, Repairs};
use super::operand::Operand;
use super::piece::ReliefOnSupport;
use super::sound::{CRUMB_MM3, Sound, sound};
use crate::index::{CellId, SupportId, ViewId};
use crate::ladder::Ladder;
use crate::mesh::Solid;
use crate::support::{Slab, Support};
use crate::viewmap::SupportField;
use glam::DVec3;

/// Widths that make operands overlap where they would only touch. Where they happen to touch all the same and cannot be
/// mended, the next are tried.
#[derive(Clone, Copy)]
pub(crate) struct Widths {
    /// How far a relief's edge is bedded in its support, millimetres at the support: less than a tenth of a printed line, so
    /// unseen. At 0.002 (the thinnest cells) operands always touch.
    bed: f64,
    /// How far it goes on behind a nearer support, millimetres.
    lap: f64,
}

pub(crate) const WIDTHS: [Widths; 8] = [
    Widths {
        bed: 0.012,
        lap: 0.040,
    },
    Widths {
        bed: 0.015,
        lap: 0.053,
    },
    Widths {
        bed: 0.010,
        lap: 0.033,
    },
    Widths {
        bed: 0.019,
        lap: 0.067,
    },
    Widths {
        bed: 0.008,
        lap: 0.046,
    },
    Widths {
        bed: 0.025,
        lap: 0.081,
    },
    Widths {
        bed: 0.013,
        lap: 0.060,
    },
    Widths {
        bed: 0.017,
        lap: 0.028,
    },
];
/// Supports nearer than this to a defect may have caused it, millimetres.
const SUSPECT_MM: f64 = 0.5;
/// One support with its reliefs.
pub(crate) struct Carved {
    pub whole: Solid,
    pub bare: Solid,
    pub blocks: Vec<(ViewId, Solid)>,
    /// Cells given up, by view.
    pub given_up: Vec<(ViewId, Vec<CellId>)>,
    pub repairs: Repairs,
    /// Index into [`WIDTHS`].
    pub widths: usize,
    pub ladders: Vec<Ladder>,
}

impl Carved {
    pub(crate) fn is_near(&self, place: DVec3) -> bool {
        let (lo, hi) = self.whole.bounds();
        place.cmpge(lo - SUSPECT_MM).all() && place.cmple(hi + SUSPECT_MM).all()
    }
}

/// Carves one support, at the first widths from `first` on that come out sound. Meshes have no widths.
///
/// # Errors
/// If the boolean library refuses an operand, or a solid is unsound at all of them.
pub(crate) fn carve_support(
    field: &SupportField,
    s: SupportId,
    views: &[Operand],
    first: usize,
) -> Result<Carved, CarveError> {
    let has_widths = views.iter().any(Operand::has_widths);
    let past = if has_widths { WIDTHS.len() } else { first + 1 };
    let mut last = None;
    for widths in first..past {
        match carve_at(field, s, views, widths) {
            Ok(mut carved) => {
                if has_widths {
                    let place = Some(field.supports[s].name.as_str());
                    carved.ladders.push(Ladder::new(
                        "widths of carving",
                        place,
                        widths,
                        WIDTHS.len(),
                    ));
                }
                return Ok(carved);
            }
            Err(error) => last = Some(error),
        }
    }
    Err(last.unwrap_or_else(|| unreachable!("there are widths from `first` on")))
}

fn carve_at(
    field: &SupportField,
    s: SupportId,
    views: &[Operand],
    widths: usize,
) -> Result<Carved, CarveError> {
    let support = &field.supports[s];
    let failed = |source| CarveError::Boolean {
        place: support.name.clone(),
        source,
    };
    let mut work = SupportWork {
        support,
        bare: Boolean::new(&support.mesh).map_err(failed)?,
        blocks: Vec::new(),
        given_up: Vec::new(),
        repairs: Repairs::default(),
    };
    for (v, operand) in ViewId::all(views.len()).zip(views) {
        work.take(s, v, operand, WIDTHS[widths]).map_err(failed)?;
    }
    let whole = work.united().map_err(failed)?;
    work.take_apart().map_err(failed)?;
    work.checked(&whole, widths)
}

/// What one view puts on a support.
struct OnSupport<'a> {
    view: ViewId,
    operand: &'a Operand<'a>,
    /// Of a relief.
    slab: Option<Slab>,
    solid: Boolean,
}

/// A support on its way to solids.
struct SupportWork<'a> {
    support: &'a Support,
    bare: Boolean,
    blocks: Vec<OnSupport<'a>>,
    given_up: Vec<(ViewId, Vec<CellId>)>,
    repairs: Repairs,
}

impl<'a> SupportWork<'a> {
    /// Adds what a view puts on support `s`, and carves out what stands before it.
    fn take(
        &mut self,
        s: SupportId,
        view: ViewId,
        operand: &'a Operand<'a>,
        Widths { bed, lap }: Widths,
    ) -> Result<(), BooleanError> {
        let (slab, solid) = match operand {
            Operand::Relief { sight, relief } => {
                let Some(piece) = ReliefOnSupport::new(sight, relief, s) else {
                    return Ok(());
                };
                let made = piece.relief(lap, &mut self.repairs)?;
                self.given_up.push((view, made.dropped));
                if piece.slab.is_carved() {
                    self.bare = self.bare.minus(&piece.hollow(bed)?)?;
                }
                (Some(piece.slab), made.solid)
            }
            Operand::Mesh { support, .. } if *support != s => return Ok(()),
            Operand::Mesh { mesh, .. } => (None, Boolean::new(mesh)?),
        };
        self.blocks.push(OnSupport {
            view,
            operand,
            slab,
            solid,
        });
        Ok(())
    }

    /// The support with all its blocks, of which those that float are tied to it.
    fn united(&mut self) -> Result<Boolean, BooleanError> {
        let mut whole = self.bare.clone();
        for block in &mut self.blocks {
            whole = match block.operand {
                Operand::Relief { .. } => {
                    let joined = whole.plus(&block.solid)?;
                    let braces = match &block.slab {
                        Some(slab) if !self.support.is_body() => braces(&joined, slab, CRUMB_MM3)?,
                        _ => Vec::new(),
                    };
                    self.repairs.braces += braces.len();
                    for brace in &braces {
                        block.solid = block.solid.plus(brace)?;
                    }
                    if braces.is_empty() {
                        joined
                    } else {
                        whole.plus(&block.solid)?
                    }
                }
                Operand::Mesh { .. } => whole.plus_any(&block.solid)?,
            };
            let (kept, crumbs) = whole.without_crumbs(CRUMB_MM3);
            whole = kept;
            self.repairs.crumbs_mm3 += crumbs;
        }
        Ok(whole)
    }

    /// Takes the blocks out of the bare support, so that nothing is in both.
    fn take_apart(&mut self) -> Result<(), BooleanError> {
        for block in &mut self.blocks {
            let bare = match block.operand {
                Operand::Relief { .. } => {
                    let bare = self.bare.minus(&block.solid)?;
                    block.solid = block.solid.without_crumbs(CRUMB_MM3).0;
                    bare
                }
                Operand::Mesh { .. } => self.bare.minus_any(&block.solid)?,
            };
            self.bare = bare.without_crumbs(CRUMB_MM3).0;
        }
        Ok(())
    }

    /// What of `whole` is no bare support.
    fn resolved(&self, whole: &Boolean) -> Result<Boolean, CarveError> {
        let rest = whole.minus(&self.bare);
        rest.map_err(|source| CarveError::Boolean {
            place: self.support.name.clone(),
            source,
        })
    }

    fn checked(self, whole: &Boolean, widths: usize) -> Result<Carved, CarveError> {
        let place = |what: &str| format!("{} ({what})", self.support.name);
        let (mut ladders, mut resolved) = (Vec::new(), Vec::new());
        let mut told = |sound: Sound| {
            ladders.extend(sound.ladders);
            sound.solid
        };
        let mut blocks = Vec::new();
        for block in self.blocks.iter().filter(|b| !b.solid.is_empty()) {
            let place = place(block.operand.name());
            let solid = match (block.operand, sound(&block.solid, &place)) {
                (Operand::Relief { .. }, solid) => solid?,
                (Operand::Mesh { .. }, solid) => {
                    let rung = usize::from(solid.is_err());
                    resolved.push(Ladder::new(
                        "mesh as it is, or resolved",
                        Some(&place),
                        rung,
                        2,
                    ));
                    // What lies inside of any part of a mesh that crosses itself is solid.
                    solid.or_else(|_| sound(&self.resolved(whole)?, &place))?
                }
            };
            blocks.push((block.view, told(solid)));
        }
        let whole = told(sound(whole, &place("with reliefs"))?);
        let bare = told(sound(&self.bare, &place("carved"))?);
        ladders.extend(resolved);
        Ok(Carved {
            blocks,
            whole,
            bare,
            given_up: self.given_up,
            repairs: self.repairs,
            widths,
            ladders,
        })
    }
}
