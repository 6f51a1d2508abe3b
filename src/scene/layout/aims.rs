//! The numbers of an `Auto(...)`: ranges, limits and weights.

use crate::planner::{Freedom, Matters};
use crate::scene::defaults;
use crate::scene::language::raw::{RawFreedom, RawMatters, RawRange, RawTolerance};
use crate::scene::resolved::Making;
use crate::scene::text::{Field, Reader, Span, Spanned, error_at, short, warning_at};

/// A range the right way round.
pub(crate) fn range(
    reader: &mut Reader,
    field: &Field<RawRange<f64>>,
    name: &str,
) -> Option<([f64; 2], Span)> {
    let (&RawRange([least, most]), span) = reader.given(field)?;
    reader.finite(least, name, &span)?;
    reader.finite(most, name, &span)?;
    ordered(reader, [least, most], name, &span)?;
    Some(([least, most], span))
}

fn ordered<T: PartialOrd + std::fmt::Display>(
    reader: &mut Reader,
    [least, most]: [T; 2],
    name: &str,
    span: &Span,
) -> Option<()> {
    if least <= most {
        return Some(());
    }
    let problem = error_at(
        span,
        format!("`{name}` runs from {least} to {most}: the smaller number comes first"),
    );
    reader
        .problems
        .push(problem.help(format!("write ({most}, {least})")));
    None
}

pub(crate) fn count(
    reader: &mut Reader,
    field: &Field<RawRange<u32>>,
    standing: usize,
) -> [usize; 2] {
    let [fewest, most] = defaults::COUNT.map(|n| n as usize);
    let default = [fewest, most.max(standing)];
    let Some((&RawRange(range), span)) = reader.given(field) else {
        return default;
    };
    if ordered(reader, range, "count", &span).is_none() {
        return default;
    }
    let [fewest, most] = range.map(|n| n as usize);
    let limit = defaults::MANY_PILLARS as usize;
    if most == 0 || most > limit {
        reader.error(
            &span,
            format!("`count` ends at {most}; a planned forest has from 1 to {limit} pillars"),
        );
    } else if standing > most {
        reader.error(
            &span,
            format!("{standing} pillars are `fixed`, but the `count` ends at {most}"),
        );
    }
    [fewest, most]
}

/// Warns of a gap that does not stay open.
pub(crate) fn narrow(reader: &mut Reader, gap: f64, span: &Span, making: &Making) {
    let least = making.narrowest_gap();
    if gap < least {
        let text = format!(
            "`gap` is {} mm: gaps below {} mm {}",
            short(gap),
            short(least),
            making.way.closes()
        );
        let help = format!("leave more room, or change {}", making.way.finest());
        reader.problems.push(warning_at(span, text).help(help));
    }
}

/// One number for every view.
pub(crate) fn tolerance(
    reader: &mut Reader,
    field: &Field<RawTolerance>,
    views: usize,
) -> Vec<f64> {
    let name = "eye_tolerance";
    let of = |reader: &mut Reader, number: &Spanned<f64>| {
        let span = reader.span(number);
        let value = *reader.value(number)?;
        reader.measured(value, name, 0.0, &span)
    };
    match reader.given(field) {
        None => vec![0.0; views],
        Some((RawTolerance::All(one), _)) => vec![of(reader, one).unwrap_or(0.0); views],
        Some((RawTolerance::Each(list), span)) => {
            let Some(list) = reader.value(list) else {
                return vec![0.0; views];
            };
            if list.len() != views {
                let text = format!(
                    "`{name}` has {} numbers, and the scene {views} views",
                    list.len()
                );
                let help = "one number for all views, or a list with one for each, in order";
                reader.problems.push(error_at(&span, text).help(help));
            }
            let numbers = list.iter().take(views);
            let mut found: Vec<f64> = numbers.map(|n| of(reader, n).unwrap_or(0.0)).collect();
            found.resize(views, 0.0);
            found
        }
    }
}

pub(crate) fn matters(reader: &mut Reader, field: &Field<RawMatters>) -> Matters {
    let Some((raw, _)) = reader.given(field) else {
        return defaults::MATTERS;
    };
    let mut weight = |field: &Field<f64>, name: &str, default: f64| {
        let found = reader.within(field, name, defaults::WEIGHTS);
        found.map_or(default, |(v, _)| v)
    };
    let default = defaults::MATTERS;
    Matters {
        camouflage: weight(&raw.camouflage, "camouflage", default.camouflage),
        tolerance: weight(&raw.tolerance, "tolerance", default.tolerance),
        pillars: weight(&raw.pillars, "pillars", default.pillars),
        spread: weight(&raw.spread, "spread", default.spread),
    }
}

pub(crate) fn freedom(reader: &mut Reader, field: &Field<RawFreedom>) -> Freedom {
    let Some((raw, _)) = reader.given(field) else {
        return Freedom::NONE;
    };
    let turn = reader.within(&raw.turn, "turn", 0.0..=defaults::MOST_TURN);
    let scale = reader.within(&raw.scale, "scale", 1.0..=defaults::MOST_SCALE);
    let shift = reader.length_from(&raw.shift, "shift", 0.0);
    Freedom {
        turn: turn.map_or(0.0, |(v, _)| v.to_radians()),
        scale: scale.map_or(1.0, |(v, _)| v),
        shift: shift.map_or(0.0, |(v, _)| v),
    }
}
