//! Pillars against each other and against what can be made.

use crate::diag::Diagnostic;
use crate::scene::defaults;
use crate::scene::resolved::Making;
use crate::scene::supports::{Standing, shapes};
use crate::scene::text::{Reader, error_at, short, warning_at};
use crate::support::pillar_width;
use std::collections::BTreeMap;

/// Overlapping pillars are errors, gaps that do not stay open warnings: the first of each pair of places in the text.
pub(crate) fn gaps(reader: &mut Reader, pillars: &[Standing], making: &Making) {
    let narrow = making.narrowest_gap();
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
    let (mut overlaps, gaps): (Vec<Tight>, Vec<Tight>) =
        worst.into_values().partition(|tight| tight.gap <= 0.0);
    overlaps.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    for mut tight in [overlaps, gaps] {
        // Three say as much as two hundred.
        let untold: usize = tight.iter().skip(TOLD).map(|t| t.pairs).sum();
        tight.truncate(TOLD);
        if let Some(last) = tight.last_mut() {
            last.pairs += untold;
        }
        let problem = |t: &Tight| gap_problem(&pillars[t.a], &pillars[t.b], t, making);
        reader.problems.extend(tight.iter().map(problem));
    }
}

/// The most overlaps, and the most gaps, that are told one by one.
const TOLD: usize = 3;

/// The tightest of several pairs of pillars.
struct Tight {
    a: usize,
    b: usize,
    /// Millimetres; zero or less if they overlap.
    gap: f64,
    pairs: usize,
}

fn gap_problem(a: &Standing, b: &Standing, tight: &Tight, making: &Making) -> Diagnostic {
    let narrow = short(making.narrowest_gap());
    let more = match tight.pairs {
        1 => String::new(),
        pairs => format!(" (and {} more pairs)", pairs - 1),
    };
    if tight.gap <= 0.0 {
        return overlap(a, b, tight.gap, &more, making.narrowest_gap());
    }
    warning_at(
        &b.span,
        format!(
            "the gap between {} and {} is {} mm{more}: gaps below {narrow} mm {}",
            a.name,
            b.name,
            short(tight.gap),
            making.way.closes()
        ),
    )
    .help(format!(
        "leave at least {narrow} mm, or change {}",
        making.way.finest()
    ))
}

fn overlap(a: &Standing, b: &Standing, gap: f64, more: &str, narrow: f64) -> Diagnostic {
    let apart = short(a.axis.distance(b.axis));
    let size = |p: &Standing| match p.round {
        true => p.reach,
        false => shapes::narrowest(&p.profile),
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
    error_at(
        &b.span,
        format!("pillars overlap: {radii}centres {apart} mm apart{more}"),
    )
    .label(label)
    .help(format!(
        "put the centres at least {} mm apart, or make the pillars thinner",
        short(wanted)
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

/// Pillars too thin to be made or too slim to stand; once per place in the text.
pub(crate) fn slimness(reader: &mut Reader, pillars: &[Standing], making: &Making) {
    let thin = making.limits.wall.map_or(0.0, |w| w.wanted);
    let mut seen = std::collections::BTreeSet::new();
    for pillar in pillars {
        let width = pillar_width(pillar.axis, &pillar.profile, pillar.round);
        if width < thin && seen.insert((pillar.span.start, 0)) {
            reader.problems.push(
                warning_at(
                    &pillar.span,
                    format!(
                        "{} is {} mm thin: walls below {} mm vanish or break with a {} mm {}",
                        pillar.name,
                        short(width),
                        short(thin),
                        short(making.line),
                        making.way.tool()
                    ),
                )
                .help(format!(
                    "make it at least {} mm wide, or change {}",
                    short(thin),
                    making.way.finest()
                )),
            );
        }
        let slim = pillar.height / width;
        let slimmest = making.limits.slimmest.unwrap_or(f64::INFINITY);
        if slim > slimmest && seen.insert((pillar.span.start, 1)) {
            reader.problems.push(
                warning_at(
                    &pillar.span,
                    format!(
                        "{} is {} times as high as it is wide: it will break or wobble",
                        pillar.name,
                        short(slim.round())
                    ),
                )
                .help(format!(
                    "keep it below {} times: thicker or lower pillars",
                    short(slimmest)
                )),
            );
        }
    }
}
