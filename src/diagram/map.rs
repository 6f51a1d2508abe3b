//! The plan's main part: base, visible ranges, pillars, constrained segments, eyes.

use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::eyes::eyes;
use crate::diagram::facts::Facts;
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::page::{BASE, FREE, HAIR, PAPER, Page, QUIET, RED, TEXT, deep, pale};
use crate::diagram::vista::{Sector, Vista};
use crate::support::{Support, SupportKind};
use glam::DVec2;

pub(crate) fn draw(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    drawing.rect(DVec2::ZERO, page.size(), Some(PAPER), None);
    heading(drawing, page, facts);
    base(drawing, page, facts);
    for (vista, view) in facts.vistas.iter().zip(facts.views) {
        vista
            .intervals
            .iter()
            .for_each(|sectors| fan(drawing, page, vista, sectors, view.colour));
    }
    pillars(drawing, page, facts);
    for vista in &facts.vistas {
        vista
            .sectors()
            .for_each(|sector| constrained(drawing, page, facts, vista, sector));
    }
    numbers(drawing, page, facts);
    eyes(drawing, page, facts.views, facts.rooms, &[]);
}

fn heading(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    let full = page.style(9.0, Typeface::Regular, TEXT, Align::Start);
    drawing.text(
        page.at(12.0, 19.0),
        facts.title,
        full.fitting(facts.title, 186.0 * page.u),
    );
    let plural = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let line = format!(
        "Who sees what, from above   ·   {}   ·   {}",
        plural(facts.views.len(), "view"),
        plural(facts.pillars(), "pillar")
    );
    drawing.text(
        page.at(12.0, 26.0),
        &line,
        page.style(3.6, Typeface::Light, QUIET, Align::Start),
    );
}

fn base(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    for support in facts
        .supports
        .iter()
        .filter(|s| matches!(s.kind, SupportKind::Base { .. }))
    {
        drawing.polygon(
            &page.outline(support.outline()),
            Some(BASE),
            Some(Pen::new(HAIR, 0.35 * page.u)),
        );
    }
}

/// The range of one interval: from the eye, or from the range's end if the eye is drawn nearer than it is, to what it meets.
pub(crate) fn fan(
    drawing: &mut Drawing,
    page: &Page,
    vista: &Vista,
    sectors: &[Sector],
    colour: [u8; 3],
) {
    let hits: Vec<(f64, f64)> = sectors
        .iter()
        .flat_map(|r| r.hits.iter().copied())
        .collect();
    let broken = page.stand(vista.eye).1;
    let points = range(page, vista, &hits);
    drawing.polygon(&points, Some(Ink::new(colour).fade(0.26)), None);
    for side in [hits.first(), hits.last()].into_iter().flatten() {
        let Some((near, far)) = stretch(page, vista, *side) else {
            continue;
        };
        drawing.polyline(
            &[near, far],
            Pen::new(deep(colour, 0.1).fade(0.8), 0.22 * page.u),
        );
        // A far eye's sight lines go on a little beyond the rim.
        let outward = (near - far).normalize_or_zero() * 3.2 * page.u;
        if broken {
            drawing.polyline(
                &[near, near + outward],
                Pen::new(deep(colour, 0.1).fade(0.8), 0.22 * page.u)
                    .dashed(0.6 * page.u, 0.8 * page.u),
            );
        }
    }
}

/// What lies before some hits of an eye, as a polygon on the page: what they hit first, then back along the eye's side.
pub(crate) fn range(page: &Page, vista: &Vista, hits: &[(f64, f64)]) -> Vec<DVec2> {
    let ends = |hit: &(f64, f64)| stretch(page, vista, *hit);
    let far = hits.iter().filter_map(ends).map(|s| s.1);
    let near = hits.iter().rev().filter_map(ends).map(|s| s.0);
    far.chain(near).collect()
}

/// Where a ray begins on the page, and where it meets something or leaves the range.
fn stretch(page: &Page, vista: &Vista, (angle, t): (f64, f64)) -> Option<(DVec2, DVec2)> {
    let (entry, exit) = chord(vista.eye - page.centre, vista.direction(angle), page.range)?;
    let broken = page.stand(vista.eye).1;
    let start = if broken { entry.max(0.0) } else { 0.0 };
    let at = |t: f64| page.place(vista.point(angle, t));
    Some((at(start), at(t.min(exit))))
}

/// Distances at which a ray from `from` (relative to a circle's centre) enters and leaves the circle.
pub(crate) fn chord(from: DVec2, direction: DVec2, radius: f64) -> Option<(f64, f64)> {
    let along = from.dot(direction);
    let root = (along * along - from.length_squared() + radius * radius).sqrt();
    (root.is_finite() && root - along > 0.0).then_some((-along - root, -along + root))
}

fn pillars(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    for (support, owner) in facts.supports.iter().zip(&facts.owners) {
        if matches!(support.kind, SupportKind::Base { .. }) {
            continue;
        }
        let (fill, line) = match owner {
            Some(view) => (
                pale(facts.views[*view].colour, 0.3),
                deep(facts.views[*view].colour, 0.35),
            ),
            None => (FREE, QUIET),
        };
        drawing.polygon(
            &page.outline(support.outline()),
            Some(fill),
            Some(Pen::new(line, 0.25 * page.u)),
        );
    }
}

fn constrained(drawing: &mut Drawing, page: &Page, facts: &Facts, vista: &Vista, sector: &Sector) {
    let Some((room, line)) = vista.constrained(sector, facts.supports) else {
        return;
    };
    drawing.polygon(
        &page.outline(&room),
        Some(RED.fade(0.16)),
        Some(Pen::new(RED.fade(0.7), 0.12 * page.u)),
    );
    drawing.polyline(&page.outline(&line), Pen::new(RED, 0.55 * page.u));
}

/// A pillar's name as messages have it, short: `p7` is 7, `owl-7` is 7 too (its colour tells the rest), any other its count.
fn short_name(k: usize, name: &str) -> String {
    let number = name.rsplit(['p', '-']).next().unwrap_or_default();
    if !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()) {
        number.to_owned()
    } else {
        (k + 1).to_string()
    }
}

/// Numbers stand behind their pillar as the owner sees it, in its shadow; on the pillar where there is no room around it.
fn numbers(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    let mut discs: Vec<(DVec2, f64)> = facts.supports.iter().filter_map(disc).collect();
    for (k, support) in facts.supports.iter().enumerate() {
        let Some((axis, reach)) = disc(support) else {
            continue;
        };
        let text = short_name(k, &support.name);
        let size = (0.9 * reach).min(3.0 * page.u);
        // Smaller ones could not be read on A4.
        if size < 0.9 * page.u {
            continue;
        }
        let half = DVec2::new(width(&text, size, Typeface::Regular), 0.7 * size) / 2.0;
        let room = half.length() + 0.1 * size;
        let away = facts.owners[k].and_then(|v| (axis - facts.vistas[v].eye).try_normalize());
        let around = away.into_iter().flat_map(|away| {
            [0.0, 0.5, -0.5, 1.0, -1.0].map(|turn| DVec2::from_angle(turn).rotate(away))
        });
        let mut places = around.map(|way| axis + (reach + 0.25 * size + half.dot(way.abs())) * way);
        let free = places.find(|p| {
            !discs
                .iter()
                .any(|(other, r)| *other != axis && other.distance(*p) < r + room)
        });
        let ink = facts.owners[k]
            .filter(|_| free.is_some())
            .map_or(TEXT, |v| deep(facts.views[v].colour, 0.45));
        let halo = free.is_none().then_some(PAPER.fade(0.7));
        let style = TextStyle {
            size,
            ink,
            face: Typeface::Regular,
            anchor: Align::Middle,
            halo,
        };
        drawing.text(
            page.place(free.unwrap_or(axis)) + DVec2::new(0.0, 0.35 * size),
            &text,
            style,
        );
        discs.extend(free.map(|place| (place, half.length())));
    }
}

/// A pillar's axis and the radius of the circle around it.
fn disc(support: &Support) -> Option<(DVec2, f64)> {
    let SupportKind::Pillar { axis, profile, .. } = &support.kind else {
        return None;
    };
    Some((
        *axis,
        profile
            .iter()
            .map(|p| p.distance(*axis))
            .fold(0.0, f64::max),
    ))
}
