//! Rules that join several values: pillars that overlap, eyes in the wrong place, forests no printer can make.

use super::defaults;
use crate::diag::Diagnostic;
use crate::scene::layout::region::{self, Room};
use crate::scene::resolved::Printer;
use crate::scene::supports::shapes;
use crate::scene::text::reader::{Reader, Span, error_at, short, warning_at};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// A pillar as the checks see it.
pub struct Standing {
    pub name: String,
    pub axis: DVec2,
    pub profile: Vec<DVec2>,
    /// Top, millimetres above the base's top.
    pub height: f64,
    /// Largest distance of the profile from the axis.
    pub reach: f64,
    pub round: bool,
    pub span: Span,
}

/// The base as the checks see it.
pub struct Slab {
    pub outline: Vec<DVec2>,
    pub thickness: f64,
    pub span: Option<Span>,
}

/// An eye as the checks see it.
pub struct Eye {
    pub view: String,
    pub stand: Stand,
    pub span: Span,
}

/// Where an eye is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stand {
    At(DVec3),
    /// At infinity, in this direction (unit).
    Towards(DVec3),
}

impl Stand {
    /// Whether two eyes are one.
    fn is_like(self, other: Self) -> bool {
        match (self, other) {
            (Self::At(a), Self::At(b)) => a.distance(b) < 1.0,
            (Self::Towards(a), Self::Towards(b)) => a.distance(b) < SAME_WAY,
            _ => false,
        }
    }
}

/// Directions that differ by less (radians) are one: a millimetre seen from a metre.
const SAME_WAY: f64 = 1e-3;

/// What of a forest is checked.
pub struct Checked<'a> {
    pub pillars: &'a [Standing],
    pub base: Option<&'a Slab>,
    /// Where more pillars are to be found.
    pub room: Option<&'a Room>,
    /// Pillars that are to be mended may still overlap and stand anywhere.
    pub mend: bool,
}

/// All of them.
pub fn all(reader: &mut Reader, checked: &Checked, eyes: &[Eye], printer: &Printer) {
    let (pillars, base) = (checked.pillars, checked.base);
    slimness(reader, pillars, printer);
    if !checked.mend {
        gaps(reader, pillars, printer);
        if let Some(slab) = base {
            footing(reader, pillars, slab);
        }
    }
    if let Some(room) = checked.room {
        slimness(reader, &room.samples, printer);
        let problem = base.and_then(|slab| region::footing(room, slab));
        reader.problems.extend(problem);
    }
    plate(reader, checked, printer);
    eye_pairs(reader, eyes);
    for eye in eyes {
        let problem = match eye.stand {
            Stand::At(at) => place(eye, at, checked, reader.unit_name),
            Stand::Towards(from) => below(eye, from, checked),
        };
        reader.problems.extend(problem);
    }
}

/// Overlapping pillars are errors, gaps that fuse on the printer warnings: the first of each pair of places in the text.
fn gaps(reader: &mut Reader, pillars: &[Standing], printer: &Printer) {
    let narrow = defaults::NARROW_GAP_NOZZLES * printer.nozzle;
    let mut worst: BTreeMap<(usize, usize, bool), Tight> = BTreeMap::new();
    let mut work = 0u64;
    for (i, j) in neighbours(pillars, narrow) {
        let (a, b) = (&pillars[i], &pillars[j]);
        let round = a.round && b.round;
        work += if round {
            1
        } else {
            (a.profile.len() * b.profile.len()) as u64
        };
        if work > defaults::MOST_CORNER_PAIRS {
            // An overlap among them is told below and enough.
            if worst.keys().all(|(.., overlap)| !overlap) {
                let text = "outlines too detailed for pillars so close together: their gaps cannot be checked";
                reader.problems.push(
                    error_at(&b.span, text)
                        .help("fewer `sides` or `points`, or pillars farther apart"),
                );
            }
            break;
        }
        let gap = if round {
            a.axis.distance(b.axis) - a.reach - b.reach
        } else {
            shapes::gap(&a.profile, &b.profile)
        };
        if gap < narrow {
            let key = (a.span.start, b.span.start, gap <= 0.0);
            let tight = worst.entry(key).or_insert(Tight {
                a: i,
                b: j,
                gap,
                pairs: 0,
            });
            tight.pairs += 1;
            if gap < tight.gap {
                (tight.a, tight.b, tight.gap) = (i, j, gap);
            }
        }
    }
    // Twenty say as much as two hundred.
    for tight in worst.values().take(20) {
        let problem = gap_problem(&pillars[tight.a], &pillars[tight.b], tight, narrow);
        reader.problems.push(problem);
    }
}

/// The tightest of several pairs of pillars.
struct Tight {
    a: usize,
    b: usize,
    /// Millimetres; zero or less if they overlap.
    gap: f64,
    pairs: usize,
}

fn gap_problem(a: &Standing, b: &Standing, tight: &Tight, narrow: f64) -> Diagnostic {
    let (gap, count, overlap) = (tight.gap, tight.pairs, tight.gap <= 0.0);
    let more = if count > 1 {
        format!(" (and {} more pairs)", count - 1)
    } else {
        String::new()
    };
    let apart = short(a.axis.distance(b.axis));
    if overlap {
        let size = |p: &Standing| {
            if p.round {
                p.reach
            } else {
                shapes::narrowest(&p.profile)
            }
        };
        let sizes = if (size(a) - size(b)).abs() < 1e-6 {
            short(size(a))
        } else {
            format!("{} mm and {}", short(size(a)), short(size(b)))
        };
        let radii = match (a.round, b.round) {
            (true, true) => format!("radius {sizes} mm but "),
            (false, false) => format!("{sizes} mm wide but "),
            _ => String::new(),
        };
        let label = if gap < 0.0 {
            format!("overlaps {} by {} mm", a.name, short(-gap))
        } else {
            format!("touches or overlaps {}", a.name)
        };
        let wanted = a.reach + b.reach + narrow;
        return error_at(
            &b.span,
            format!("pillars overlap: {radii}centres {apart} mm apart{more}"),
        )
        .label(label)
        .help(format!(
            "put the centres at least {} mm apart, or make the pillars thinner",
            short(wanted)
        ));
    }
    warning_at(
        &b.span,
        format!(
            "the gap between {} and {} is {} mm{more}: gaps below {narrow} mm fuse when printed",
            a.name,
            b.name,
            short(gap)
        ),
    )
    .help(format!(
        "leave at least {narrow} mm, or change `printer: (nozzle: ...)`"
    ))
}

/// Pairs of pillars whose circles come nearer than `margin`, in order: a sweep over x.
fn neighbours(pillars: &[Standing], margin: f64) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..pillars.len()).collect();
    order.sort_by(|&a, &b| {
        pillars[a]
            .axis
            .x
            .total_cmp(&pillars[b].axis.x)
            .then(a.cmp(&b))
    });
    let widest = pillars.iter().map(|p| p.reach).fold(0.0, f64::max);
    let mut pairs = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[k + 1..] {
            if pillars[j].axis.x - pillars[i].axis.x > pillars[i].reach + widest + margin {
                break;
            }
            if pillars[i].axis.distance(pillars[j].axis)
                < pillars[i].reach + pillars[j].reach + margin
            {
                pairs.push((i.min(j), i.max(j)));
            }
            // A heap of pillars in one spot would make this quadratic; what is found by then is enough.
            if pairs.len() > 200_000 {
                return pairs;
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Pillars too thin for the nozzle or too slim to stand; once per place in the text.
fn slimness(reader: &mut Reader, pillars: &[Standing], printer: &Printer) {
    let thin = defaults::THIN_WALL_NOZZLES * printer.nozzle;
    let mut seen = std::collections::BTreeSet::new();
    for pillar in pillars {
        let width = shapes::narrowest(&pillar.profile);
        if width < thin && seen.insert((pillar.span.start, 0)) {
            reader.problems.push(
                warning_at(
                    &pillar.span,
                    format!(
                        "{} is {} mm thin: walls below {} mm vanish or break with a {} mm nozzle",
                        pillar.name,
                        short(width),
                        short(thin),
                        printer.nozzle
                    ),
                )
                .help(format!(
                    "make it at least {} mm wide, or change `printer: (nozzle: ...)`",
                    short(thin)
                )),
            );
        }
        let slim = pillar.height / width;
        if slim > defaults::SLIMMEST && seen.insert((pillar.span.start, 1)) {
            reader.problems.push(
                warning_at(&pillar.span, format!("{} is {} times as high as it is wide: it will break or wobble while printed", pillar.name, short(slim.round())))
                    .help(format!("keep it below {} times: thicker or lower pillars", defaults::SLIMMEST)),
            );
        }
    }
}

/// Every pillar must stand on the base.
fn footing(reader: &mut Reader, pillars: &[Standing], slab: &Slab) {
    let mut seen = std::collections::BTreeSet::new();
    for pillar in pillars {
        let on = pillar
            .profile
            .iter()
            .filter(|p| shapes::contains(&slab.outline, **p))
            .count();
        if on == pillar.profile.len() || !seen.insert((pillar.span.start, on == 0)) {
            continue;
        }
        let where_ = format!("({}, {})", short(pillar.axis.x), short(pillar.axis.y));
        let help =
            "enlarge the base, leave its size out (it then fits all pillars), or move the pillar";
        reader.problems.push(if on == 0 {
            error_at(
                &pillar.span,
                format!("{} at {where_} stands beside the base", pillar.name),
            )
            .help(help)
        } else {
            warning_at(
                &pillar.span,
                format!(
                    "{} at {where_} hangs over the edge of the base",
                    pillar.name
                ),
            )
            .help(help)
        });
    }
}

/// Size of the whole forest against the printer's bed, number of pillars against patience.
fn plate(reader: &mut Reader, checked: &Checked, printer: &Printer) {
    let (pillars, base, room) = (checked.pillars, checked.base, checked.room);
    let points = pillars
        .iter()
        .flat_map(|p| &p.profile)
        .chain(base.iter().flat_map(|b| &b.outline))
        .chain(room.iter().flat_map(|r| &r.region));
    let bounds = points.fold(None, |b: Option<(DVec2, DVec2)>, p| {
        Some(b.map_or((*p, *p), |(l, h)| (l.min(*p), h.max(*p))))
    });
    let Some((lo, hi)) = bounds else { return };
    let standing = pillars.iter().chain(room.iter().flat_map(|r| &r.samples));
    let Some(tallest) = standing.max_by(|a, b| a.height.total_cmp(&b.height)) else {
        return;
    };
    let height = tallest.height + base.map_or(0.0, |b| b.thickness);
    let (size, [x, y, z]) = (hi - lo, printer.bed);
    let fits = (size.x <= x && size.y <= y) || (size.x <= y && size.y <= x);
    let span = base
        .and_then(|b| b.span.clone())
        .unwrap_or(tallest.span.clone());
    if !fits {
        reader.problems.push(
            warning_at(&span, format!("the forest is {} x {} mm, larger than the printer's bed of {x} x {y} mm", short(size.x), short(size.y)))
                .help("give the size of your printer: `printer: (bed: (300, 300, 300))`, or cut it into plates with `build --split`"),
        );
    }
    if height > z {
        reader.problems.push(
            warning_at(
                &tallest.span,
                format!(
                    "the forest is {} mm tall, taller than the printer's {z} mm",
                    short(height)
                ),
            )
            .help("lower the pillars, or print them in pieces"),
        );
    }
    if pillars.len() as u64 > defaults::MANY_PILLARS {
        reader.problems.push(
            warning_at(
                &span,
                format!(
                    "{} pillars: slicers take hours for more than about {}",
                    pillars.len(),
                    defaults::MANY_PILLARS
                ),
            )
            .help("fewer, thicker pillars show models as well"),
        );
    }
}

/// Two views cannot share an eye.
fn eye_pairs(reader: &mut Reader, eyes: &[Eye]) {
    for (j, b) in eyes.iter().enumerate() {
        if let Some(a) = eyes[..j].iter().find(|a| a.stand.is_like(b.stand)) {
            let place = match b.stand {
                Stand::At(_) => "place",
                Stand::Towards(_) => "direction",
            };
            reader.problems.push(
                error_at(&b.span, format!("views \"{}\" and \"{}\" look from the same {place}: one eye cannot see two pictures", a.view, b.view))
                    .label(format!("also the eye of \"{}\"", a.view))
                    .help("move one eye, or show both models in one view: `models: [\"a\", \"b\"]`"),
            );
        }
    }
}

/// An eye must look somewhere, and not straight down.
pub fn direction(view: &str, eye: DVec3, look_at: DVec3, span: &Span) -> Option<Diagnostic> {
    let gaze = look_at - eye;
    if gaze.length() < 1e-3 {
        let problem = error_at(
            span,
            format!("view \"{view}\" looks at its own eye: it has no direction"),
        );
        return Some(problem.help("`look_at` is a point in the middle of what is seen"));
    }
    if gaze.truncate().length() < 0.05 * gaze.z.abs() {
        let way = if gaze.z < 0.0 { "down" } else { "up" };
        let problem = error_at(
            span,
            format!("view \"{view}\" looks straight {way}: pillars show nothing but their ends"),
        );
        return Some(problem.help("put the eye to the side of the forest"));
    }
    None
}

/// An eye must stand in the open, at a distance, above the base.
fn place(eye: &Eye, at: DVec3, checked: &Checked, unit: &str) -> Option<Diagnostic> {
    let base = checked.base;
    let ground = at.truncate();
    let thickness = base.map_or(0.0, |b| b.thickness);
    if let Some(slab) = base {
        if at.z < -thickness {
            return Some(
                error_at(
                    &eye.span,
                    format!(
                        "the eye of view \"{}\" is below the base: it sees only the underside",
                        eye.view
                    ),
                )
                .help("z points up; the top of the base is z = 0"),
            );
        }
        if at.z <= 0.0 && shapes::contains(&slab.outline, ground) {
            return Some(error_at(
                &eye.span,
                format!("the eye of view \"{}\" is inside the base", eye.view),
            ));
        }
    }
    let (distance, nearest) = nearest(checked, ground)?;
    let tops = checked.pillars.iter().map(|p| p.height);
    let tops = tops.chain(checked.room.map(|r| r.tops)).fold(0.0, f64::max);
    if at.z > tops || distance > 20.0 {
        return None;
    }
    let where_ = if distance <= 0.0 {
        "inside".to_string()
    } else {
        format!("{} mm from", short(distance))
    };
    let mut problem = error_at(
        &eye.span,
        format!("the eye of view \"{}\" is {where_} {nearest}", eye.view),
    )
    .label("an eye stands outside the forest, some hundred mm away");
    if at.length() < 20.0 {
        problem = problem.help(format!("eyes are in {unit} like the rest of the scene: did you mean metres? Then write them times 1000"));
    }
    Some(problem)
}

/// An eye at infinity must not look from below, nor find its pillars to be found.
fn below(eye: &Eye, from: DVec3, checked: &Checked) -> Option<Diagnostic> {
    if checked.base.is_some() && from.z < 0.0 {
        let text = format!(
            "view \"{}\" looks from below the base: it sees only the underside",
            eye.view
        );
        return Some(
            error_at(&eye.span, text)
                .help("z points up: `from: (0, -1, 0.2)` is from the front and a little above"),
        );
    }
    if checked.mend || checked.room.is_some() {
        let text = format!(
            "view \"{}\" looks from infinity: pillars are found and mended only for eyes with a place",
            eye.view
        );
        return Some(error_at(&eye.span, text).help("give it an `eye: (x, y, z)` some metres away, keep the layout that is found, and include it with `pillars: File(\"layout.ron\")`"));
    }
    None
}

/// What stands nearest to a point in plan, and how far away, millimetres.
fn nearest(checked: &Checked, p: DVec2) -> Option<(f64, String)> {
    let pillars = checked.pillars.iter();
    let pillar = pillars
        .map(|s| (shapes::gap_to_point(&s.profile, p), s))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let room = checked.room.map(|r| shapes::gap_to_point(&r.region, p));
    match (pillar, room) {
        (pillar, Some(gap)) if pillar.is_none_or(|(g, _)| gap < g) => {
            Some((gap, "the region of the pillars".to_string()))
        }
        (pillar, _) => pillar.map(|(gap, s)| (gap, format!("pillar {}", s.name))),
    }
}
