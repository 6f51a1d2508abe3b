//! The plan's lower part: table of views, overview to scale, key, scale bar.

use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::eyes::{eye_symbol, room_of_eye};
use crate::diagram::facts::Facts;
use crate::diagram::lettering::Typeface;
use crate::diagram::page::{
    BASE, FREE, HAIR, Page, QUIET, RED, ROW, TABLE, TEXT, deep, length, pale,
};
use crate::diagram::vista::NARROWEST;
use crate::horizon::{Horizon, Run};
use crate::support::SupportKind;
use crate::view::View;
use glam::DVec2;

/// Columns of the table, layout units.
const NAME: f64 = 19.0;
const EYE: f64 = 58.0;
/// Right edges.
const PILLARS: f64 = 106.0;
const ANGLE: f64 = 122.0;
const COVERED: f64 = 141.0;
/// The overview's box.
const BOX: (f64, f64) = (150.0, 198.0);

pub(crate) fn draw(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    drawing.polyline(
        &[page.at(12.0, TABLE - 9.0), page.at(198.0, TABLE - 9.0)],
        Pen::new(HAIR, 0.25 * page.u),
    );
    table(drawing, page, facts);
    overview(drawing, page, facts);
    key(drawing, page);
    if facts.rooms.iter().any(Option::is_some) {
        key_of_rooms(drawing, page);
    }
    scale_bar(drawing, page);
}

fn table(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    let head = page.style(2.7, Typeface::Light, QUIET, Align::Start);
    let right = |style: TextStyle| style.anchored(Align::End);
    let y = TABLE - 3.5;
    drawing.text(page.at(NAME, y), "view", head);
    drawing.text(page.at(EYE, y), "eye x, y, z in mm", head);
    drawing.text(page.at(PILLARS, y), "pillars", right(head));
    drawing.text(page.at(ANGLE, y), "width", right(head));
    drawing.text(page.at(COVERED, y), "covered", right(head));
    for (k, (view, horizon)) in facts.views.iter().zip(&facts.horizons).enumerate() {
        let y = TABLE + ROW * k as f64;
        let seen = (0..facts.supports.len())
            .filter(|s| horizon.angle_of(*s) > NARROWEST)
            .count();
        eye_symbol(drawing, page.at(14.6, y + 1.0), 2.6 * page.u, view.colour);
        let body = page.style(3.3, Typeface::Light, TEXT, Align::Start);
        let name = TextStyle {
            face: Typeface::Regular,
            ..body
        };
        drawing.text_within(page.at(NAME, y + 2.2), &view.name, 36.0 * page.u, name);
        let eye = if view.orthographic {
            let [x, y, z] = view.from().to_array().map(finer);
            format!("infinity, from {x}, {y}, {z}")
        } else {
            let [x, y, z] = view.eye.to_array().map(plain);
            format!("{x}, {y}, {z}")
        };
        drawing.text(page.at(EYE, y + 2.2), &eye, body);
        drawing.text(page.at(PILLARS, y + 2.2), &seen.to_string(), right(body));
        let (wide, covered) = shares(view, horizon);
        drawing.text(page.at(ANGLE, y + 2.2), &wide, right(body));
        drawing.text(page.at(COVERED, y + 2.2), &covered, right(body));
    }
}

/// One decimal, and none for whole numbers; never -0.
fn plain(x: f64) -> String {
    format!("{}", (10.0 * x).round() / 10.0 + 0.0).replace('-', "\u{2212}")
}

/// Two decimals at most; never -0.
fn finer(x: f64) -> String {
    format!("{}", (100.0 * x).round() / 100.0 + 0.0).replace('-', "\u{2212}")
}

/// How wide a view's models are, and how much of that pillars cover; dashes if it has no width in plan.
fn shares(view: &View, horizon: &Horizon) -> (String, String) {
    if horizon.runs().next().is_none() {
        return ("\u{2013}".to_owned(), "\u{2013}".to_owned());
    }
    // Rounded down: a gap, however thin, never reads as 100 %.
    let covered = (1000.0 * horizon.coverage() + 1e-3).floor() / 10.0;
    (width(view, horizon), format!("{covered} %"))
}

/// How wide the models are: an angle, or a length as parallel rays have it.
fn width(view: &View, horizon: &Horizon) -> String {
    let width: f64 = horizon.runs().map(|r| Run::width(&r)).sum();
    if view.orthographic {
        let distance = view.eye.truncate().distance(view.look_at.truncate());
        return format!("{:.0} mm", width * distance);
    }
    format!("{:.1}°", width.to_degrees())
}

/// Where the eyes really are; only if the map could not show it. Those at infinity are nowhere.
fn overview(drawing: &mut Drawing, page: &Page, facts: &Facts) {
    let near = |v: &&View| !v.orthographic;
    if !facts
        .views
        .iter()
        .filter(near)
        .any(|v| page.stand(v.eye.truncate()).1)
    {
        return;
    }
    let (lo, hi) = (page.at(BOX.0, TABLE - 4.0), page.at(BOX.1, TABLE + 44.0));
    let eyes = || facts.views.iter().filter(near).map(|v| v.eye.truncate());
    let least = eyes().fold(page.centre - page.radius, DVec2::min);
    let most = eyes().fold(page.centre + page.radius, DVec2::max);
    let scale = 0.86 * ((hi - lo) / (most - least)).min_element();
    let (middle, centre) = ((lo + hi) / 2.0, (least + most) / 2.0);
    let place = |p: DVec2| middle + scale * DVec2::new(p.x - centre.x, centre.y - p.y);
    for support in facts
        .supports
        .iter()
        .filter(|s| matches!(s.kind, SupportKind::Base { .. }))
    {
        let points: Vec<DVec2> = support.outline().iter().map(|p| place(*p)).collect();
        drawing.polygon(&points, Some(BASE), Some(Pen::new(HAIR, 0.2 * page.u)));
    }
    let vistas = facts.vistas.iter().zip(facts.views);
    for (vista, view) in vistas.filter(|(_, v)| near(v)) {
        for sectors in &vista.intervals {
            let hits = sectors.iter().flat_map(|r| r.hits.iter());
            let free = vista.eye.distance(page.centre) + page.radius;
            let mut points: Vec<DVec2> = hits
                .map(|&(a, t)| place(vista.point(a, t.min(free))))
                .collect();
            points.push(place(vista.eye));
            drawing.polygon(&points, Some(Ink::new(view.colour).fade(0.3)), None);
        }
    }
    for (support, owner) in facts.supports.iter().zip(&facts.owners) {
        if let SupportKind::Pillar { profile, .. } = &support.kind {
            let ink = owner.map_or(QUIET, |v| deep(facts.views[v].colour, 0.15));
            let points: Vec<DVec2> = profile.iter().map(|p| place(*p)).collect();
            drawing.polygon(&points, Some(ink), None);
        }
    }
    facts
        .views
        .iter()
        .filter(near)
        .for_each(|v| eye_symbol(drawing, place(v.eye.truncate()), 2.3 * page.u, v.colour));
    let text = format!("overview, 1 : {:.1}", 1.0 / scale);
    drawing.text(
        DVec2::new(middle.x, hi.y + 4.0 * page.u),
        &text,
        page.style(2.7, Typeface::Light, QUIET, Align::Middle),
    );
}

fn key(drawing: &mut Drawing, page: &Page) {
    let y = page.bottom() - 25.0;
    let style = page.style(3.0, Typeface::Light, TEXT, Align::Start);
    let grey = [0x8A, 0x8F, 0x94];
    let swatch = |x: f64| (page.at(x, y - 3.0), page.at(x + 6.0, y + 0.6));
    let (lo, hi) = swatch(12.0);
    drawing.rect(
        lo,
        hi,
        Some(Ink::new(grey).fade(0.3)),
        Some(Pen::new(Ink::new(grey).fade(0.8), 0.2 * page.u)),
    );
    drawing.text(page.at(20.0, y), "visible range", style);
    drawing.circle(
        page.at(46.0, y - 1.2),
        2.0 * page.u,
        Some(pale(grey, 0.3)),
        Some(Pen::new(deep(grey, 0.35), 0.25 * page.u)),
    );
    drawing.text(page.at(49.6, y), "pillar in its view's colour", style);
    drawing.circle(
        page.at(90.0, y - 1.2),
        2.0 * page.u,
        Some(FREE),
        Some(Pen::new(QUIET, 0.25 * page.u)),
    );
    drawing.text(page.at(93.6, y), "unseen", style);
    let (lo, hi) = swatch(107.0);
    drawing.rect(
        lo,
        hi,
        Some(RED.fade(0.16)),
        Some(Pen::new(RED.fade(0.7), 0.12 * page.u)),
    );
    let middle = (lo.y * 0.35) + hi.y * 0.65;
    drawing.polyline(
        &[DVec2::new(lo.x, middle), DVec2::new(hi.x, middle)],
        Pen::new(RED, 0.55 * page.u),
    );
    drawing.text(page.at(115.0, y), "relief, front to back", style);
}

/// What the discs at the eyes are.
fn key_of_rooms(drawing: &mut Drawing, page: &Page) {
    let y = page.bottom() - 19.0;
    room_of_eye(
        drawing,
        page,
        page.at(15.0, y - 1.1),
        2.0 * page.u,
        [0x8A, 0x8F, 0x94],
    );
    let style = page.style(3.0, Typeface::Light, TEXT, Align::Start);
    let text = "disc at an eye: as far as it may move with its picture still one (cuts open by 10 arc-minutes)";
    drawing.text(page.at(20.0, y), text, style);
}

/// A bar of a round length near half the forest's radius, with its tenths or fifths.
fn scale_bar(drawing: &mut Drawing, page: &Page) {
    let y = page.bottom() - 13.0;
    let rough = 0.7 * page.radius;
    let power = 10f64.powf(rough.log10().floor());
    let (step, parts) = [(5.0, 5), (2.0, 4), (1.0, 5)]
        .into_iter()
        .find(|(s, _)| s * power <= rough)
        .unwrap_or((1.0, 5));
    let total = step * power;
    let start = page.at(12.0, y);
    let pen = Pen::new(TEXT, 0.2 * page.u);
    for k in 0..parts {
        let lo = start + DVec2::new(total * f64::from(k) / f64::from(parts), 0.0);
        let hi = lo + DVec2::new(total / f64::from(parts), 1.3 * page.u);
        drawing.rect(
            lo,
            hi,
            Some(if k % 2 == 0 { TEXT } else { Ink::new([255; 3]) }),
            Some(pen),
        );
    }
    let style = page.style(2.7, Typeface::Light, QUIET, Align::Middle);
    drawing.text(start + DVec2::new(0.0, 4.6 * page.u), "0", style);
    drawing.text(
        start + DVec2::new(total, 4.6 * page.u),
        &length(total),
        style,
    );
    let note = page.style(2.7, Typeface::Light, QUIET, Align::Start);
    drawing.text(
        start + DVec2::new(total + 4.0 * page.u, 1.3 * page.u),
        "1 : 1 in the SVG; pillars count as endlessly high here",
        note,
    );
    axes(drawing, page);
}

/// Which way x and y point, in the map's lower left corner.
fn axes(drawing: &mut Drawing, page: &Page) {
    let u = page.u;
    let origin = page.at(15.0, TABLE - 14.0);
    let style = page.style(2.7, Typeface::Light, QUIET, Align::Middle);
    for (way, name, at) in [
        (DVec2::X, "x", DVec2::new(9.6, 0.8)),
        (DVec2::NEG_Y, "y", DVec2::new(0.0, -9.0)),
    ] {
        let tip = origin + 7.6 * u * way;
        drawing.polyline(&[origin, tip - u * way], Pen::new(QUIET, 0.22 * u));
        drawing.polygon(
            &[
                tip,
                tip - 1.6 * u * way + 0.6 * u * way.perp(),
                tip - 1.6 * u * way - 0.6 * u * way.perp(),
            ],
            Some(QUIET),
            None,
        );
        drawing.text(origin + u * at, name, style);
    }
}
