//! One support with all that views make of it.

use super::boolean::{Boolean, BooleanError};
use super::brace::braces;
use super::forest::{CarveError, Repairs};
use super::hollow::CarvingEdge;
use super::operand::Operand;
use super::piece::ReliefOnSupport;
use super::sound::{CRUMB_MM3, spared};
use crate::index::{CellId, SupportId, ViewId};
use crate::mesh::{TriMesh, resolved};
use crate::support::{Slab, Support, SupportKind};
use crate::viewmap::SupportField;

/// How far a relief's edge is bedded in its support, millimetres at the support: less than a tenth of a printed line, so unseen. At
/// 0.002 (the thinnest cells) operands touch.
const BED_MM: f64 = 0.012;
/// How far a relief goes on behind a nearer support, millimetres.
const LAP_MM: f64 = 0.040;

/// One support with its reliefs, in f64 and without spare corners: it is rounded when all supports are united.
pub(crate) struct Carved {
    pub whole: TriMesh,
    pub bare: TriMesh,
    pub blocks: Vec<(ViewId, TriMesh)>,
    /// Cells given up, by view.
    pub given_up: Vec<(ViewId, Vec<CellId>)>,
    pub repairs: Repairs,
}

/// Carves one support; `line` is the width of a printed line, millimetres.
///
/// # Errors
/// If the boolean library refuses an operand, or the result does not become a solid.
pub(crate) fn carve_support(
    field: &SupportField,
    s: SupportId,
    views: &[Operand],
    line: f64,
) -> Result<Carved, CarveError> {
    let support = &field.supports[s];
    let failed = |source| CarveError::Boolean {
        place: support.name.clone(),
        source,
    };
    let mut work = SupportWork {
        support,
        edge: CarvingEdge { bed: BED_MM, line },
        foot: foot(field, support),
        bare: Boolean::new(&support.mesh).map_err(failed)?,
        blocks: Vec::new(),
        given_up: Vec::new(),
        repairs: Repairs::default(),
    };
    for (v, operand) in ViewId::all(views.len()).zip(views) {
        match operand {
            Operand::Relief { sight, relief } => {
                let piece = ReliefOnSupport::new(sight, relief, s);
                piece
                    .map_or(Ok(()), |p| work.take_relief(v, p))
                    .map_err(failed)?;
            }
            Operand::Mesh { support, .. } if *support != s => {}
            Operand::Mesh { mesh, name, .. } => work.take_mesh(v, mesh, name)?,
        }
    }
    let whole = work.united().map_err(failed)?;
    work.take_apart().map_err(failed)?;
    Ok(work.carved(&whole))
}

/// Height of a pillar's lower end, if it stands in a base.
fn foot(field: &SupportField, support: &Support) -> Option<f64> {
    field.base_top()?;
    match support.kind {
        SupportKind::Pillar { bottom, .. } => Some(bottom),
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    }
}

/// What one view puts on a support.
struct OnSupport {
    view: ViewId,
    /// Of a relief.
    slab: Option<Slab>,
    solid: Boolean,
    /// Whether it may have spare corners.
    is_rough: bool,
}

/// A support on its way to solids.
struct SupportWork<'a> {
    support: &'a Support,
    edge: CarvingEdge,
    /// Where it ends in a base, if it does: height of its lower end.
    foot: Option<f64>,
    bare: Boolean,
    blocks: Vec<OnSupport>,
    given_up: Vec<(ViewId, Vec<CellId>)>,
    repairs: Repairs,
}

impl SupportWork<'_> {
    /// Adds a view's relief, and carves out what stands before it.
    fn take_relief(&mut self, view: ViewId, piece: ReliefOnSupport) -> Result<(), BooleanError> {
        let made = piece.relief(LAP_MM, &mut self.repairs)?;
        self.given_up.push((view, made.dropped));
        if piece.slab.is_carved() {
            // Rows of corners along the carving's edge would leave fans of needles, which meet half of the relief.
            self.bare = Boolean::new(&spared(&self.bare.minus(&piece.hollow(self.edge)?)?))?;
        }
        self.blocks.push(OnSupport {
            view,
            slab: Some(piece.slab),
            solid: made.solid,
            is_rough: false,
        });
        Ok(())
    }

    /// Adds a mesh. What lies inside of any part of one that crosses itself is solid.
    fn take_mesh(&mut self, view: ViewId, mesh: &TriMesh, name: &str) -> Result<(), CarveError> {
        let place = || format!("{} ({name})", self.support.name);
        let made = resolved(mesh).map_err(|source| CarveError::Tangled {
            place: place(),
            source,
        })?;
        self.repairs.resolving.add(&made.took);
        let solid = Boolean::new(&made.without_cavities());
        self.blocks.push(OnSupport {
            view,
            slab: None,
            solid: solid.map_err(|source| CarveError::Boolean {
                place: place(),
                source,
            })?,
            is_rough: true,
        });
        Ok(())
    }

    /// The support with all its blocks, of which those that float are tied to it.
    fn united(&mut self) -> Result<Boolean, BooleanError> {
        let mut whole = self.bare.clone();
        for block in &mut self.blocks {
            let joined = whole.plus(&block.solid)?;
            let braces = match &block.slab {
                Some(slab) if !self.support.is_body() => {
                    braces(&joined, slab, self.foot, CRUMB_MM3)?
                }
                _ => Vec::new(),
            };
            self.repairs.braces += braces.len();
            for brace in &braces {
                block.solid = block.solid.plus(brace)?;
                block.is_rough = true;
            }
            whole = if braces.is_empty() {
                joined
            } else {
                whole.plus(&block.solid)?
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
            self.bare = self.bare.minus(&block.solid)?.without_crumbs(CRUMB_MM3).0;
            block.solid = block.solid.without_crumbs(CRUMB_MM3).0;
        }
        Ok(())
    }

    fn carved(self, whole: &Boolean) -> Carved {
        let blocks = self.blocks.iter().filter(|b| !b.solid.is_empty());
        let of_block = |b: &OnSupport| match b.is_rough {
            true => spared(&b.solid),
            false => b.solid.mesh(),
        };
        Carved {
            whole: spared(whole),
            bare: spared(&self.bare),
            blocks: blocks.map(|b| (b.view, of_block(b))).collect(),
            given_up: self.given_up,
            repairs: self.repairs,
        }
    }
}
