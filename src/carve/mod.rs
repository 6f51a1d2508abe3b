//! From reliefs to solids: supports are carved along the eyes' rays in front of the reliefs, and everything is united.
//!
//! Takes supports and, per view, the relief over its view map. Gives the whole forest, the bare part (base and pillars) and each
//! view's reliefs as checked solids. Promises: closed, oriented, 2-manifold, free of self-intersection, in f32.
//!
//! Operands never share a wall. The carving reaches deeper than any relief, to half-way inside the relief's solid backing, and
//! is a hair narrower than the relief where the support goes on beside it (so the relief's edge is bedded in the support) but
//! wider where the support ends or is hidden (so no fin of it is left standing there).

pub(crate) mod boolean;
mod brace;
pub(crate) mod hollow;
mod joined;
mod piece;

pub use joined::{Whole, joined};

use crate::groups::Groups;
use crate::mesh::{Defect, Solid, mend, without_cavities};
use crate::relief::Relief;
use crate::viewmap::{SupportField, ViewMap};
use boolean::{Boolean, BooleanError};
use glam::DVec3;
use piece::Piece;
use rayon::prelude::*;

/// Widths that make operands overlap where they would only touch. Where they happen to touch all the same and cannot be
/// mended, the next are tried.
#[derive(Clone, Copy)]
struct Widths {
    /// How far a relief's edge is bedded in its support, millimetres at the support: less than a tenth of a printed line, so
    /// unseen. At 0.002 (the thinnest cells) operands always touch.
    bed: f64,
    /// How far it goes on behind a nearer support, millimetres.
    lap: f64,
}

const WIDTHS: [Widths; 8] = [
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
/// Unions that came out unsound and were made again with other widths of one support: three are needed now and then.
const UNIONS: usize = 16;
/// Supports nearer than this to a defect may have caused it, millimetres.
const SUSPECT_MM: f64 = 0.5;
/// Loose crumbs smaller than this are dropped, cubic millimetres: a tenth of what a nozzle can lay down as a dot.
pub(crate) const CRUMB_MM3: f64 = 0.005;

/// What one view adds to the forest.
pub struct ViewRelief<'a> {
    pub name: &'a str,
    pub map: &'a ViewMap,
    pub groups: &'a Groups,
    pub relief: &'a Relief,
}

/// The forest as checked solids.
#[derive(Clone, Debug)]
pub struct Forest {
    /// Everything as one.
    pub whole: Solid,
    /// Base and pillars without reliefs.
    pub bare: Solid,
    /// The reliefs of each view, in the order of the views; `None` for a view without any.
    pub reliefs: Vec<Option<Solid>>,
    /// Cells of each view's map that had to be given up, rising.
    pub given_up: Vec<Vec<u32>>,
    /// Every support with its reliefs, in the order of the supports.
    pub standing: Vec<Solid>,
    /// What had to be changed on the way.
    pub repairs: Repairs,
}

/// What had to be changed to make the solids sound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repairs {
    /// Corners of reliefs whose depth was filled in.
    pub filled: usize,
    /// Cells of view maps given up.
    pub dropped_cells: usize,
    /// Reliefs that touched their support nowhere and were tied to it by a brace behind it.
    pub braces: usize,
    /// Volume of loose crumbs dropped, cubic millimetres.
    pub crumbs_mm3: f64,
}

impl Repairs {
    fn add(&mut self, other: &Repairs) {
        self.filled += other.filled;
        self.dropped_cells += other.dropped_cells;
        self.braces += other.braces;
        self.crumbs_mm3 += other.crumbs_mm3;
    }
}

/// Why there is no sound forest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CarveError {
    #[error("{place}: {source}")]
    Boolean { place: String, source: BooleanError },
    #[error("{place} came out with defects: {}", list(.defects))]
    Unsound { place: String, defects: Vec<Defect> },
}

impl CarveError {
    /// Where defects were found.
    fn places(&self) -> impl Iterator<Item = DVec3> {
        let defects = match self {
            Self::Boolean { .. } => &[][..],
            Self::Unsound { defects, .. } => defects,
        };
        defects.iter().filter_map(|d| d.place)
    }
}

fn list(defects: &[Defect]) -> String {
    defects
        .iter()
        .map(|d| d.to_string())
        .collect::<Vec<_>>()
        .join("; ")
}

/// Carves and unites everything.
///
/// # Errors
/// If the boolean library refuses an operand or a solid stays unsound at all widths tried, with the support.
pub fn carve(field: &SupportField, views: &[ViewRelief]) -> Result<Forest, CarveError> {
    let mut carved: Vec<Carved> = (0..field.supports.len())
        .into_par_iter()
        .map(|s| carve_support(field, s, views, 0))
        .collect::<Result<_, _>>()?;
    let names: Vec<&str> = views.iter().map(|v| v.name).collect();
    for _ in 1..UNIONS {
        let error = match unite(&carved, &names) {
            Ok(forest) => return Ok(forest),
            Err(error) => error,
        };
        // Of the supports at the defect the one tried least often is carved anew.
        let near = |s: &usize| error.places().any(|p| carved[*s].is_near(p));
        let suspects = (0..carved.len()).filter(|s| carved[*s].widths + 1 < WIDTHS.len());
        let Some(s) = suspects.filter(near).min_by_key(|s| carved[*s].widths) else {
            return Err(error);
        };
        carved[s] = carve_support(field, s, views, carved[s].widths + 1)?;
    }
    unite(&carved, &names)
}

/// The forest of carved supports; `views` are the views' names.
fn unite(carved: &[Carved], views: &[&str]) -> Result<Forest, CarveError> {
    let mut repairs = Repairs::default();
    carved.iter().for_each(|c| repairs.add(&c.repairs));
    let of_view = |v: usize| {
        carved
            .iter()
            .flat_map(move |c| c.blocks.iter().filter(move |b| b.0 == v).map(|b| &b.1))
            .collect::<Vec<_>>()
    };
    let (whole, (bare, reliefs)) = rayon::join(
        || united(carved.iter().map(|c| &c.whole).collect(), "the forest"),
        || {
            rayon::join(
                || united(carved.iter().map(|c| &c.bare).collect(), "the bare pillars"),
                || {
                    (0..views.len())
                        .into_par_iter()
                        .map(|v| united(of_view(v), views[v]))
                        .collect::<Result<Vec<_>, _>>()
                },
            )
        },
    );
    let whole = whole?.unwrap_or_else(|| unreachable!("a scene has supports"));
    let bare = bare?.unwrap_or_else(|| unreachable!("a scene has supports"));
    let mut given_up = vec![Vec::new(); views.len()];
    for (v, cells) in carved.iter().flat_map(|c| &c.given_up) {
        given_up[*v].extend(cells);
    }
    given_up.iter_mut().for_each(|cells| cells.sort_unstable());
    Ok(Forest {
        whole,
        bare,
        reliefs: reliefs?,
        given_up,
        standing: carved.iter().map(|c| c.whole.clone()).collect(),
        repairs,
    })
}

/// The union of solids, sound again; `None` of nothing.
fn united(parts: Vec<&Solid>, place: &str) -> Result<Option<Solid>, CarveError> {
    if parts.is_empty() {
        return Ok(None);
    }
    let operands = parts
        .iter()
        .map(|s| Boolean::new(s.mesh()))
        .collect::<Result<Vec<_>, _>>();
    let whole = operands
        .and_then(Boolean::union)
        .map_err(|source| CarveError::Boolean {
            place: place.into(),
            source,
        })?;
    sound(&whole, place).map(Some)
}

/// The result of booleans as a checked solid, mended: with slivers simplified away, which is fast but may cross long faces, as
/// it is, or more simplified.
pub(crate) fn sound(solid: &Boolean, place: &str) -> Result<Solid, CarveError> {
    let mut defects = Vec::new();
    for tolerance in [1e-4, 0.0, 5e-4] {
        let mesh = solid.simplified(tolerance);
        // Vertices that move by the tolerance sweep no more than this: now and then simplifying loses whole pieces.
        let swept = tolerance * mesh.area();
        if tolerance > 0.0 && (mesh.volume() - solid.volume()).abs() > swept {
            continue;
        }
        match Solid::new(without_cavities(mend(&mesh))) {
            Ok(solid) => return Ok(solid),
            Err(d) => defects = d,
        }
    }
    Err(CarveError::Unsound {
        place: place.into(),
        defects,
    })
}

/// One support with its reliefs.
struct Carved {
    whole: Solid,
    bare: Solid,
    blocks: Vec<(usize, Solid)>,
    /// Cells given up, by view.
    given_up: Vec<(usize, Vec<u32>)>,
    repairs: Repairs,
    /// Index into [`WIDTHS`].
    widths: usize,
}

impl Carved {
    fn is_near(&self, place: DVec3) -> bool {
        let (lo, hi) = self.whole.bounds();
        place.cmpge(lo - SUSPECT_MM).all() && place.cmple(hi + SUSPECT_MM).all()
    }
}

/// Carves one support, at the first widths from `first` on that come out sound.
fn carve_support(
    field: &SupportField,
    s: usize,
    views: &[ViewRelief],
    first: usize,
) -> Result<Carved, CarveError> {
    let mut last = None;
    for widths in first..WIDTHS.len() {
        match carve_at(field, s as u32, views, widths) {
            Ok(carved) => return Ok(carved),
            Err(error) => last = Some(error),
        }
    }
    Err(last.unwrap_or_else(|| unreachable!("there are widths from `first` on")))
}

fn carve_at(
    field: &SupportField,
    s: u32,
    views: &[ViewRelief],
    widths: usize,
) -> Result<Carved, CarveError> {
    let support = &field.supports[s as usize];
    let Widths { bed, lap } = WIDTHS[widths];
    let failed = |source| CarveError::Boolean {
        place: support.name.clone(),
        source,
    };
    let mut repairs = Repairs::default();
    let mut bare = Boolean::new(&support.mesh).map_err(failed)?;
    let mut blocks = Vec::new();
    let mut given_up = Vec::new();
    for (v, view) in views.iter().enumerate() {
        let cells = cells_on(view, s);
        let Some(slab) = view.groups.slabs[s as usize].filter(|_| !cells.is_empty()) else {
            continue;
        };
        let piece = Piece {
            field,
            support: s,
            slab: &slab,
            view,
        };
        let made = piece.relief(&cells, lap, &mut repairs).map_err(failed)?;
        given_up.push((v, made.dropped));
        if slab.is_carved() {
            let hollow = piece.hollow(&cells, bed).map_err(failed)?;
            bare = bare.minus(&hollow).map_err(failed)?;
        }
        blocks.push((v, slab, made.solid));
    }
    let mut whole = bare.clone();
    for (_, slab, block) in &mut blocks {
        let joined = whole.plus(block).map_err(failed)?;
        let braces = if support.is_body() {
            Vec::new()
        } else {
            brace::braces(&joined, slab, CRUMB_MM3).map_err(failed)?
        };
        repairs.braces += braces.len();
        for brace in &braces {
            *block = block.plus(brace).map_err(failed)?;
        }
        whole = if braces.is_empty() {
            joined
        } else {
            whole.plus(block).map_err(failed)?
        };
        let (kept, crumbs) = whole.without_crumbs(CRUMB_MM3);
        whole = kept;
        repairs.crumbs_mm3 += crumbs;
    }
    for (_, _, block) in &mut blocks {
        bare = bare
            .minus(block)
            .map_err(failed)?
            .without_crumbs(CRUMB_MM3)
            .0;
        *block = block.without_crumbs(CRUMB_MM3).0;
    }
    let name = |what: &str| format!("{} ({what})", support.name);
    let blocks = blocks
        .iter()
        .filter(|b| !b.2.is_empty())
        .map(|(v, _, b)| Ok((*v, sound(b, &name(views[*v].name))?)));
    Ok(Carved {
        blocks: blocks.collect::<Result<_, _>>()?,
        whole: sound(&whole, &name("with reliefs"))?,
        bare: sound(&bare, &name("carved"))?,
        given_up,
        repairs,
        widths,
    })
}

fn cells_on(view: &ViewRelief, support: u32) -> Vec<u32> {
    let on =
        |c: &usize| view.map.cells[*c].support == Some(support) && view.relief.depth[*c].is_some();
    (0..view.map.cells.len())
        .filter(on)
        .map(|c| c as u32)
        .collect()
}
