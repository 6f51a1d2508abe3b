//! The forest in pieces to be printed one by one and put together: plates with numbered sockets, and pillars with pegs.
//!
//! Takes the supports and every support as carved with its reliefs; gives checked solids and where they belong. Above the plates'
//! top nothing of a pillar changes. Reliefs that reach across to another pillar make one piece of both. A base that does not fit
//! the bed is cut into plates that do, aligned by pins. Numbers are engraved in the end of every peg and beside every socket,
//! as far as a nozzle can draw them there.
//!
//! Without a base there are no plates and no pegs, only pillars.

mod digits;
mod foot;
mod plates;

pub use digits::Lettering;
pub use foot::Foot;
pub use plates::{Cuts, Pin};

use crate::carve::boolean::{Boolean, BooleanError};
use crate::carve::{CRUMB_MM3, CarveError, sound};
use crate::geom::gap;
use crate::mesh::{DisjointSets, Solid, TriMesh};
use crate::support::{Support, SupportKind};
use glam::{DMat4, DVec2, DVec3};
use plates::{Slab, grid, is_inside};
use rayon::prelude::*;

/// Material left under a socket: this share of the base's thickness, and at least so many millimetres.
const FLOOR_SHARE: f64 = 0.4;
const FLOOR_MM: f64 = 1.0;
/// Thinnest base that can have sockets, millimetres.
const THINNEST_BASE_MM: f64 = 2.0;
/// Lengths are cut down to multiples of this, millimetres: moving by them loses no digit of an f32.
const GRAIN_MM: f64 = 1.0 / 1024.0;
/// Depth of engraved numbers, millimetres: three layers of most printers.
const ENGRAVED_MM: f64 = 0.6;
/// Width of an engraved stroke in nozzles: as wanted, and the least that is still a stroke.
const STROKE_NOZZLES: [f64; 3] = [2.0, 1.5, 1.1];
/// Distance of a number from sockets, cuts and edges, millimetres.
const NUMBER_MARGIN_MM: f64 = 0.8;
/// Directions in which a number may stand beside its socket.
const NUMBER_WAYS: usize = 24;
/// More plates than this are refused: the bed is meant for something else.
const MOST_PLATES: usize = 256;
/// A place, millimetres, where coordinates are as coarse as anywhere up to 256 mm from the origin.
const FAR: DVec3 = DVec3::new(192.0, 192.0, 0.0);
/// Pieces that do not come out sound there are tried again this little aside, millimetres: less than a step of f32.
const NUDGE: DVec3 = DVec3::new(3.1e-6, 4.7e-6, 0.0);
const NUDGES: u32 = 4;
/// Pillars have met if they share more than this, cubic millimetres.
const MET_MM3: f64 = 1e-6;

/// What is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitOptions {
    /// Width of a printed line, millimetres.
    pub nozzle: f64,
    /// Width, depth and height of the build volume, millimetres.
    pub bed: [f64; 3],
    /// Room between peg and socket, pin and hole, plate and plate, millimetres.
    pub clearance: f64,
}

/// The forest in pieces.
#[derive(Clone, Debug)]
pub struct Split {
    /// Plates first.
    pub pieces: Vec<Piece>,
    pub cuts: Cuts,
    pub pins: Vec<Pin>,
    /// One per pillar, by number.
    pub sockets: Vec<Socket>,
}

/// One solid, standing on z = 0 about the origin.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Usable as a file name: `plate-1`, `pillar-07`, `pillar-03-04`.
    pub name: String,
    /// What the forest's names are.
    pub says: String,
    /// Numbers of the pillars it is or has sockets for.
    pub numbers: Vec<usize>,
    /// Whether those numbers can be read on it.
    pub engraved: bool,
    pub is_plate: bool,
    pub solid: Solid,
    /// What puts it back in its place.
    pub origin: DVec3,
}

/// Where a pillar goes.
#[derive(Clone, Debug)]
pub struct Socket {
    /// From 1.
    pub number: usize,
    /// Index of the support.
    pub support: usize,
    /// Middle and stroke of the number on the plate, millimetres, if there is room for it.
    pub label: Option<(DVec2, f64)>,
    /// The key at the peg's end, across the pillar; none without a base.
    pub key: Option<[DVec2; 2]>,
}

/// Why there are no pieces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplitError {
    #[error("the base is {0} mm thick: sockets need at least {THINNEST_BASE_MM} mm")]
    ThinBase(f64),
    #[error("only forests of pillars are cut into pieces, and \"{0}\" is no pillar")]
    Body(String),
    #[error("the printer's bed is too small to cut the base into plates for it")]
    SmallBed,
    #[error(transparent)]
    Carve(#[from] CarveError),
}

impl From<BooleanError> for SplitError {
    fn from(source: BooleanError) -> Self {
        let place = "a piece of the forest".into();
        Self::Carve(CarveError::Boolean { place, source })
    }
}

/// Divides the forest. `standing` are the supports with their reliefs.
///
/// # Errors
/// A base too thin for sockets, a bed too small for any plate, or a piece that does not come out sound.
pub fn split(
    supports: &[Support],
    standing: &[Solid],
    options: &SplitOptions,
) -> Result<Split, SplitError> {
    let base = supports.iter().find_map(|s| match &s.kind {
        SupportKind::Base {
            outline,
            bottom,
            top,
        } => Some((outline, top - bottom)),
        SupportKind::Pillar { .. } | SupportKind::Body { .. } => None,
    });
    if let Some(body) = supports.iter().find(|s| s.is_body()) {
        return Err(SplitError::Body(body.name.clone()));
    }
    let depth = match base {
        Some((_, t)) if t < THINNEST_BASE_MM => return Err(SplitError::ThinBase(t)),
        // A multiple of a power of two: pegs keep their digits.
        Some((_, t)) => ((t - FLOOR_MM.max(FLOOR_SHARE * t)) * 16.0).floor() / 16.0,
        None => 0.0,
    };
    let numbered: Vec<usize> = (0..supports.len())
        .filter(|s| matches!(supports[*s].kind, SupportKind::Pillar { .. }))
        .collect();
    let mut split = Split {
        pieces: Vec::new(),
        cuts: Cuts::default(),
        pins: Vec::new(),
        sockets: numbered
            .iter()
            .enumerate()
            .map(|(k, s)| Socket {
                number: k + 1,
                support: *s,
                label: None,
                key: Foot::new(&supports[*s], DVec2::ZERO, depth)
                    .filter(|_| depth > 0.0)
                    .and_then(|f| f.key_line()),
            })
            .collect(),
    };
    if let Some((outline, thickness)) = base {
        plates(supports, outline, thickness, depth, options, &mut split)?;
    }
    let groups = groups(standing, &numbered)?;
    let pillars: Vec<Piece> = groups
        .par_iter()
        .map(|group| pillar(supports, standing, &numbered, group, depth, options))
        .collect::<Result<_, _>>()?;
    split.pieces.extend(pillars);
    Ok(split)
}

/// Pillars that belong together because their reliefs meet: positions in `numbered`.
fn groups(standing: &[Solid], numbered: &[usize]) -> Result<Vec<Vec<usize>>, BooleanError> {
    let boxes: Vec<(DVec3, DVec3)> = numbered.iter().map(|s| standing[*s].bounds()).collect();
    let meet = |a: usize, b: usize| {
        boxes[a].0.cmple(boxes[b].1).all() && boxes[b].0.cmple(boxes[a].1).all()
    };
    let pairs: Vec<(usize, usize)> = (0..numbered.len())
        .flat_map(|b| (0..b).map(move |a| (a, b)))
        .filter(|(a, b)| meet(*a, *b))
        .collect();
    let solid = |k: usize| Boolean::new(standing[numbered[k]].mesh());
    let met: Vec<bool> = pairs
        .par_iter()
        .map(|(a, b)| Ok(solid(*a)?.common(&solid(*b)?)?.volume() > MET_MM3))
        .collect::<Result<_, BooleanError>>()?;
    let mut sets = DisjointSets::new(numbered.len());
    for ((a, b), _) in pairs.iter().zip(met).filter(|(_, met)| *met) {
        sets.join(*a as u32, *b as u32);
    }
    let positions = |set: Vec<u32>| set.into_iter().map(|k| k as usize).collect();
    Ok(sets.members().into_iter().map(positions).collect())
}

/// One pillar, or several whose reliefs meet, with pegs.
fn pillar(
    supports: &[Support],
    standing: &[Solid],
    numbered: &[usize],
    group: &[usize],
    depth: f64,
    options: &SplitOptions,
) -> Result<Piece, SplitError> {
    let members = || group.iter().map(|k| numbered[*k]);
    let axis = members().find_map(|s| match supports[s].kind {
        SupportKind::Pillar { axis, .. } => Some(axis),
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    });
    let lowest = members()
        .map(|s| standing[s].bounds().0.z)
        .fold(f64::INFINITY, f64::min);
    let bottom = if depth > 0.0 { -depth } else { grained(lowest) };
    let origin = axis.unwrap_or_default().map(grained).extend(bottom);
    let flat = origin.truncate();
    let mut parts = Vec::new();
    let mut feet = Vec::new();
    for s in members() {
        let carved = Boolean::new(&moved(standing[s].mesh(), -flat.extend(0.0)))?;
        let foot = Foot::new(&supports[s], flat, depth);
        parts.push(match &foot {
            Some(foot) if depth > 0.0 => foot.pegged(&carved)?,
            _ => carved,
        });
        feet.push(foot);
    }
    let mut whole = Boolean::union(parts)?;
    let mut engraved = true;
    for (k, foot) in group.iter().zip(&feet) {
        let tool = foot.as_ref().and_then(|f| under(f, k + 1, bottom, options));
        engraved &= tool.is_some();
        if let Some(tool) = tool {
            whole = whole.minus(&tool?)?;
        }
    }
    let numbers: Vec<usize> = group.iter().map(|k| k + 1).collect();
    let digits = numbered.len().to_string().len();
    let tags: Vec<String> = numbers.iter().map(|n| format!("{n:0digits$}")).collect();
    let names: Vec<&str> = members().map(|s| supports[s].name.as_str()).collect();
    let name = format!("pillar-{}", tags.join("-"));
    Ok(Piece {
        solid: standing_on_zero(&whole, -bottom, &name)?,
        name,
        says: format!("pillar {} ({})", tags.join(" and "), names.join(", ")),
        numbers,
        engraved,
        is_plate: false,
        origin,
    })
}

/// What engraves a number in the end of a peg, to be read from below; `None` if there is no room for it.
fn under(
    foot: &Foot,
    number: usize,
    bottom: f64,
    options: &SplitOptions,
) -> Option<Result<Boolean, BooleanError>> {
    let circle = foot.end()?;
    let letters = Lettering::new(number).mirrored();
    let room = (circle.radius - options.nozzle) / (letters.size().length() / 2.0);
    let [most, .., least] = STROKE_NOZZLES.map(|n| n * options.nozzle);
    (room >= least).then(|| {
        let rings = letters.rings(circle.centre, room.min(most));
        Boolean::upright(&rings, bottom - 1.0, bottom + ENGRAVED_MM)
    })
}

/// The base as plates, with sockets and numbers.
fn plates(
    supports: &[Support],
    outline: &[DVec2],
    thickness: f64,
    depth: f64,
    options: &SplitOptions,
    split: &mut Split,
) -> Result<(), SplitError> {
    let feet: Vec<Foot> = split
        .sockets
        .iter()
        .filter_map(|s| Foot::new(&supports[s.support], DVec2::ZERO, depth))
        .collect();
    let holes: Vec<Vec<DVec2>> = feet
        .iter()
        .map(|f| {
            let rings = f.outline(options.clearance);
            let first = rings.first().map(|r| r.iter().map(|p| DVec2::from(*p)));
            first.map_or_else(|| f.profile.clone(), Iterator::collect)
        })
        .collect();
    let slab = Slab {
        outline,
        thickness,
        sockets: &holes,
        clearance: options.clearance,
    };
    split.cuts = slab.cuts(options.bed).ok_or(SplitError::SmallBed)?;
    let cells = grid(&split.cuts);
    if cells.len() > MOST_PLATES {
        return Err(SplitError::SmallBed);
    }
    split.pins = slab.pins(&split.cuts);
    label(outline, &holes, options, split);
    let made: Vec<Option<(Boolean, Vec<usize>)>> = cells
        .par_iter()
        .map(|cell| {
            let Some(mut plate) = slab.plate(&split.cuts, &split.pins, *cell)? else {
                return Ok(None);
            };
            let (mut numbers, full) = (Vec::new(), plate.volume());
            for (foot, socket) in feet.iter().zip(&split.sockets) {
                let cut = plate.minus(&foot.socket(options.clearance)?)?;
                if cut.volume() < full - MET_MM3 && cut.volume() < plate.volume() - MET_MM3 {
                    plate = cut;
                    numbers.push(socket.number);
                }
            }
            for socket in &split.sockets {
                let Some((at, stroke)) = socket.label else {
                    continue;
                };
                let rings = Lettering::new(socket.number).rings(at, stroke);
                let deep = ENGRAVED_MM.min(thickness / 4.0);
                plate = plate.minus(&Boolean::upright(&rings, -deep, 1.0)?)?;
            }
            Ok(Some((plate, numbers)))
        })
        .collect::<Result<_, BooleanError>>()?;
    let found: Vec<(Boolean, Vec<usize>)> = made.into_iter().flatten().collect();
    let digits = found.len().to_string().len();
    let pieces = found.par_iter().enumerate().map(|(k, (plate, numbers))| {
        let name = format!("plate-{:0digits$}", k + 1);
        let (lo, hi) = plate.simplified(0.0).bounds().unwrap_or_default();
        let middle = ((lo + hi) / 2.0).truncate().map(grained);
        let labelled = |n: &usize| split.sockets[n - 1].label.is_some();
        let at = plate.moved(-middle.extend(0.0))?;
        Ok(Piece {
            solid: standing_on_zero(&at, thickness, &name)?,
            says: format!("plate {} of {}", k + 1, found.len()),
            name,
            engraved: numbers.iter().all(labelled),
            numbers: numbers.clone(),
            is_plate: true,
            origin: middle.extend(-thickness),
        })
    });
    let pieces: Vec<Piece> = pieces.collect::<Result<_, SplitError>>()?;
    split.pieces.extend(pieces);
    Ok(())
}

/// Finds a place for every number beside its socket.
fn label(outline: &[DVec2], holes: &[Vec<DVec2>], options: &SplitOptions, split: &mut Split) {
    let mut taken: Vec<[DVec2; 4]> = Vec::new();
    let cuts = split.cuts.clone();
    for (socket, hole) in split.sockets.iter_mut().zip(holes) {
        let centre = hole.iter().sum::<DVec2>() / hole.len() as f64;
        let size = Lettering::new(socket.number).size();
        let free = |at: DVec2, stroke: f64| {
            let half = size * stroke / 2.0 + NUMBER_MARGIN_MM;
            let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|c| at + half * DVec2::from(c));
            let cut = |list: &[f64], at: f64, half: f64| list.iter().any(|c| (c - at).abs() < half);
            let stands = is_inside(outline, &ring, 0.0)
                && !cut(&cuts.x, at.x, half.x)
                && !cut(&cuts.y, at.y, half.y)
                && holes.iter().all(|h| gap(h, &ring) > 0.0)
                && taken.iter().all(|t| gap(t, &ring) > 0.0);
            stands.then_some(ring)
        };
        let places = STROKE_NOZZLES.iter().flat_map(|nozzles| {
            let stroke = nozzles * options.nozzle;
            (0..NUMBER_WAYS).map(move |k| {
                // First below the socket, then to both sides in turn.
                let turn = k.div_ceil(2) as f64 * if k % 2 == 0 { 1.0 } else { -1.0 };
                let way = DVec2::from_angle(
                    -std::f64::consts::FRAC_PI_2
                        + turn * std::f64::consts::TAU / NUMBER_WAYS as f64,
                );
                (way, stroke)
            })
        });
        let found = places
            .map(|(way, stroke)| {
                let reach = hole
                    .iter()
                    .map(|p| (*p - centre).dot(way))
                    .fold(0.0, f64::max);
                let half = size * stroke / 2.0 + NUMBER_MARGIN_MM;
                // As near as the box comes to a round socket in this direction.
                let by = reach + half.dot(way.abs()) + 0.1;
                (centre + by * way, stroke)
            })
            .find_map(|(at, stroke)| Some((at, stroke, free(at, stroke)?)));
        if let Some((at, stroke, ring)) = found {
            taken.push(ring);
            socket.label = Some((at, stroke));
        }
    }
}

/// Raises a body by `up` and checks it. It is rounded as it would be at [`FAR`], so that it can be moved about there exactly: a
/// sliver that is sound near the origin may turn over where f32 is coarser.
fn standing_on_zero(body: &Boolean, up: f64, name: &str) -> Result<Solid, CarveError> {
    let body = body.without_crumbs(CRUMB_MM3).0;
    let at = |by: DVec3| {
        let put = body.moved(by + up * DVec3::Z);
        put.map_err(|source| CarveError::Boolean {
            place: name.into(),
            source,
        })
    };
    for k in 0..NUDGES {
        let far = sound(&at(FAR + f64::from(k) * NUDGE)?, name);
        let back = far.map(|s| Solid::new(moved(s.solid.mesh(), -FAR)));
        if let Ok(Ok(solid)) = back {
            return Ok(solid);
        }
    }
    Ok(sound(&at(DVec3::ZERO)?, name)?.solid)
}

fn moved(mesh: &TriMesh, by: DVec3) -> TriMesh {
    mesh.transformed(DMat4::from_translation(by))
}

fn grained(x: f64) -> f64 {
    (x / GRAIN_MM).floor() * GRAIN_MM
}
