//! Figures of a plan as people read them.

use crate::planner::{Brief, Ended, Fault, FaultKind};

/// A length: two digits that matter, none behind the point from 10 mm on. Endless is "any".
pub(crate) fn millimetres(mm: f64) -> String {
    if !mm.is_finite() {
        return "any".into();
    }
    let digits = match mm.abs() {
        x if x < 0.995 => 2,
        x if x < 9.95 => 1,
        _ => 0,
    };
    format!("{mm:.digits$} mm")
}

pub(crate) fn degrees(deg: f64) -> String {
    if deg.is_finite() {
        format!("{deg:.1}°")
    } else {
        "none".into()
    }
}

/// A count with its thousands set apart.
pub(crate) fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (k, c) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(c);
    }
    text
}

/// `1 pillar`, `1,200 pillars`.
pub(crate) fn plural(n: u64, what: &str) -> String {
    let tail = match (n, what) {
        (1, "try") => "try",
        (_, "try") => "tries",
        _ => what,
    };
    let s = if n == 1 || what == "try" { "" } else { "s" };
    format!("{} {tail}{s}", count(n))
}

/// The angle off at which errors are forecast: `10°`.
pub(crate) fn angle(brief: &Brief) -> String {
    let deg = (10.0 * brief.hidden_from_deg).round() / 10.0;
    format!("{deg}°")
}

/// Every kind of fault that there is, worst first.
pub(crate) fn faults(faults: &[Fault]) -> Option<String> {
    let kinds = [
        (FaultKind::Uncovered, "uncovered"),
        (FaultKind::Foreign, "on other views' pillars"),
        (FaultKind::Loose, "overlap missing at cuts"),
        (FaultKind::Narrow, "missing of narrow strips"),
        (FaultKind::Fin, "of thin rests of pillars"),
        (FaultKind::Ends, "above or below pillars"),
        (FaultKind::Sight, "in other views' sight"),
        (FaultKind::Tight, "of gaps missing"),
        (FaultKind::Outside, "outside the region"),
        (FaultKind::Open, "of cuts open too fast"),
    ];
    let sum = |kind: FaultKind| wrong(faults.iter().filter(|f| f.kind == kind));
    let mut kinds: Vec<(f64, &str)> = kinds.map(|(kind, what)| (sum(kind), what)).to_vec();
    kinds.retain(|k| k.0 > 0.0);
    kinds.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut list: Vec<String> = kinds
        .iter()
        .map(|(mm, what)| format!("{} {what}", millimetres(*mm)))
        .collect();
    let missing = sum(FaultKind::Count);
    if missing > 0.0 {
        let n = plural(missing as u64, "pillar");
        list.push(format!("{n} too many or too few"));
    }
    (!list.is_empty()).then(|| list.join(", "))
}

/// Of all faults together, millimetres.
pub(crate) fn wrong<'a>(faults: impl IntoIterator<Item = &'a Fault>) -> f64 {
    // Nothing at all sums to -0.
    faults.into_iter().map(|f| f.mm).sum::<f64>() + 0.0
}

pub(crate) fn ended(ended: Ended) -> &'static str {
    match ended {
        Ended::Tries => "all tries made",
        Ended::Converged => "ended as nothing better was found for long",
        Ended::Stopped => "stopped before its end",
    }
}
