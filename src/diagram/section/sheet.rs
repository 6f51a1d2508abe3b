//! The page of a section: bounds as they are, scaled with the surface through them, and the pieces scaled back.
//!
//! One unit of the page is a millimetre of A4 across; all three panels show the same part of the section at one scale.

use super::chains::{DepthsOfGroup, Polyline, chains, rooms, surface, tears};
use super::labels::{fitting, spread};
use super::values::{Section, Stretch};
use super::window::{EDGE, HEAD, LABELS, PANEL, WIDTH, Window};
use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::finished::Plan;
use crate::diagram::lettering::Typeface;
use crate::diagram::page::{FREE, HAIR, PAPER, QUIET, RED, TEXT, deep, pale};
use glam::DVec2;

/// Colours of groups in order of appearance: neighbours differ, colour-blind people can tell them apart.
const COLOURS: [[u8; 3]; 7] = [
    [0xD5, 0x5E, 0x00],
    [0x00, 0x72, 0xB2],
    [0xE6, 0x9F, 0x00],
    [0x00, 0x9E, 0x73],
    [0xCC, 0x79, 0xA7],
    [0x56, 0xB4, 0xE9],
    [0x8C, 0x6D, 0x31],
];

/// Below the panels: arrow to the eye, captions, key.
const ARROW: f64 = 10.0;
const CAPTION: f64 = 13.0;
const KEY: f64 = 14.0;

const SURFACE: Pen = Pen::new(TEXT, 0.35);

/// Draws the page. `name` is the view's.
pub fn groups_sheet(name: &str, section: &Section) -> Plan {
    let view = Window::new(section);
    let size = DVec2::new(WIDTH, HEAD + LABELS + view.height() + ARROW + CAPTION + KEY);
    let mut drawing = Drawing::new(size);
    drawing.rect(DVec2::ZERO, size, Some(PAPER), None);
    heading(&mut drawing, name, section);
    for k in 0..3 {
        panel(&mut drawing, section, &view.panel(k), k);
    }
    key(&mut drawing, section, &view, size.y - 6.5);
    Plan {
        title: format!("{name}: groups"),
        drawing,
    }
}

fn style(size: f64, face: Typeface, ink: Ink) -> TextStyle {
    TextStyle::new(size, face, ink, Align::Start)
}

fn heading(drawing: &mut Drawing, name: &str, section: &Section) {
    let title = format!("{name}: groups, their bounds and their scales");
    let large = style(7.0, Typeface::Regular, TEXT).fitting(&title, WIDTH - 2.0 * EDGE);
    drawing.text(DVec2::new(EDGE, 15.0), &title, large);
    let line = subtitle(section);
    let small = style(3.4, Typeface::Light, QUIET).fitting(&line, WIDTH - 2.0 * EDGE);
    drawing.text(DVec2::new(EDGE, 22.0), &line, small);
}

fn subtitle(section: &Section) -> String {
    let (_, away) = section.cut.frame();
    let which = if section.cut.upright {
        let aside = section.cut.offset.atan().to_degrees();
        let side = if aside < 0.0 { "left" } else { "right" };
        format!(
            "Upright section through the eye (up is to the right), {:.1}° {side} of its line of sight",
            aside.abs()
        )
    } else {
        let rise = away.z.asin().to_degrees();
        let way = if rise < 0.0 { "falling" } else { "rising" };
        format!(
            "Section through the eye, level from side to side, {way} by {:.1}° away from it",
            rise.abs()
        )
    };
    format!(
        "{which}, where most groups are cut: {} of {}   ·   drawn to scale",
        section.groups.len(),
        section.of
    )
}

fn colour(group: usize) -> [u8; 3] {
    COLOURS[group % COLOURS.len()]
}

fn panel(drawing: &mut Drawing, section: &Section, view: &Window, k: usize) {
    let scaled = |g: usize| if k == 1 { section.groups[g].mu } else { 1.0 };
    let rooms = rooms(section, scaled);
    let corners = [
        view.place(DVec2::new(view.lo.x, view.hi.y)),
        view.place(DVec2::new(view.hi.x, view.lo.y)),
    ];
    drawing.rect(corners[0], corners[1], Some(Ink::new([255; 3])), None);
    if k != 1 {
        supports(drawing, section, view);
    }
    rays(drawing, view, &rooms);
    for room in &rooms {
        let rgb = colour(room.of.unwrap_or_default());
        let pen = Pen::new(Ink::new(rgb).fade(0.8), 0.12);
        let fill = Ink::new(rgb).fade(if k == 2 { 0.16 } else { 0.32 });
        drawing.polygon(&view.places(&room.points), Some(fill), Some(pen));
    }
    match k {
        0 => model(drawing, section, view),
        1 => optimised(drawing, section, view),
        _ => pieces(drawing, section, view),
    }
    match k {
        0 if named(section) => names(drawing, section, view, &rooms, |g| {
            section.groups[g].support.clone()
        }),
        1 if !section.torn => names(drawing, section, view, &rooms, |g| {
            format!("{:.3}", section.groups[g].mu)
        }),
        _ => {}
    }
    to_eye(drawing, view);
    caption(drawing, section, view, k);
}

/// Whether supports have to be told apart.
fn named(section: &Section) -> bool {
    section
        .groups
        .windows(2)
        .any(|g| g[0].support != g[1].support)
}

fn supports(drawing: &mut Drawing, section: &Section, view: &Window) {
    for (outline, carries) in &section.supports {
        let (fill, line) = if *carries {
            (FREE, QUIET)
        } else {
            (pale(FREE.rgb, 0.6), HAIR)
        };
        if outline.closed {
            let shown = view.places(&view.clipped_polygon(&outline.points));
            drawing.polygon(&shown, Some(fill), None);
        }
        let again = outline.closed.then_some(outline.points.first()).flatten();
        let points: Vec<DVec2> = outline.points.iter().chain(again).copied().collect();
        line_within(drawing, view, &points, Pen::new(line, 0.18));
    }
}

/// A line where it is shown.
fn line_within(drawing: &mut Drawing, view: &Window, points: &[DVec2], pen: Pen) {
    let mut run: Vec<DVec2> = Vec::new();
    for pair in points.windows(2) {
        let Some([a, b]) = view.clipped(pair[0], pair[1]) else {
            continue;
        };
        if run.last().is_some_and(|end| end.distance(a) > 1e-9) {
            drawing.polyline(&view.places(&std::mem::take(&mut run)), pen);
        }
        if run.is_empty() {
            run.push(a);
        }
        run.push(b);
    }
    drawing.polyline(&view.places(&run), pen);
}

/// The eye's rays at both ends of every room, as far as its far end.
fn rays(drawing: &mut Drawing, view: &Window, rooms: &[Polyline]) {
    let mut ends: Vec<DVec2> = rooms
        .iter()
        .flat_map(|r| {
            let far = r.points.len() / 2;
            [r.points[0], r.points[far - 1]]
        })
        .collect();
    ends.sort_by(|a, b| (a.x / a.y).total_cmp(&(b.x / b.y)));
    // Of rays nearer to each other than they are wide the longer one.
    let near = 0.3 / view.scale;
    ends.dedup_by(|b, a| {
        let same = (b.x / b.y - a.x / a.y).abs() * a.y < near;
        if same && b.y > a.y {
            *a = *b;
        }
        same
    });
    for end in ends {
        if let Some(shown) = view.clipped(DVec2::ZERO, end) {
            drawing.polyline(&view.places(&shown), Pen::new(Ink::new([0x9A; 3]), 0.1));
        }
    }
}

fn model(drawing: &mut Drawing, section: &Section, view: &Window) {
    outlines(drawing, section, view);
    for chain in chains(section, |s| Some((None, s.model))) {
        drawing.polyline(&view.places(&chain.points), SURFACE);
    }
}

/// The whole of the model, thin.
fn outlines(drawing: &mut Drawing, section: &Section, view: &Window) {
    for outline in &section.model {
        let again = outline.closed.then_some(outline.points.first()).flatten();
        let points: Vec<DVec2> = outline.points.iter().chain(again).copied().collect();
        line_within(drawing, view, &points, Pen::new(QUIET.fade(0.8), 0.13));
    }
}

/// The surface, in its groups' colours where they carry it.
fn optimised(drawing: &mut Drawing, section: &Section, view: &Window) {
    for [a, b] in tears(section) {
        let pen = Pen::new(RED, 0.2).dashed(0.5, 0.7);
        drawing.polyline(&view.places(&[a, b]), pen);
    }
    for chain in chains(section, |s| Some(surface(s))) {
        drawing.polyline(&view.places(&chain.points), SURFACE);
    }
    let carried = |s: &Stretch| s.laid.map(|l| (Some(l.group), s.surface));
    coloured(drawing, section, view, carried);
}

fn pieces(drawing: &mut Drawing, section: &Section, view: &Window) {
    coloured(drawing, section, view, |s| {
        s.laid.map(|l| (Some(l.group), l.relief))
    });
}

fn coloured(
    drawing: &mut Drawing,
    section: &Section,
    view: &Window,
    value: impl Fn(&Stretch) -> DepthsOfGroup,
) {
    for chain in chains(section, value) {
        let ink = deep(colour(chain.of.unwrap_or_default()), 0.15);
        drawing.polyline(&view.places(&chain.points), Pen::new(ink, 0.65));
    }
}

/// A label for every group above the panel, with a leader along the ray that it stands on.
fn names(
    drawing: &mut Drawing,
    section: &Section,
    view: &Window,
    rooms: &[Polyline],
    text: impl Fn(usize) -> String,
) {
    let width = |c: &Polyline| c.points[0].distance(c.points[c.points.len() / 2 - 1]);
    let widest = |g: usize| {
        let own = rooms.iter().filter(|r| r.of == Some(g));
        own.max_by(|a, b| width(a).total_cmp(&width(b)))
    };
    let mut labels: Vec<(f64, DVec2, usize)> = (0..section.groups.len())
        .filter_map(|g| {
            let far = &widest(g)?.points;
            let far = &far[..far.len() / 2];
            let slope = far.iter().map(|p| p.x / p.y).sum::<f64>() / far.len() as f64;
            let from = far.iter().min_by(|a, b| {
                (a.x / a.y - slope)
                    .abs()
                    .total_cmp(&(b.x / b.y - slope).abs())
            })?;
            Some((from.x / from.y, *from, g))
        })
        .collect();
    labels.sort_by(|a, b| a.0.total_cmp(&b.0));
    let texts: Vec<String> = labels.iter().map(|l| text(l.2)).collect();
    let importance: Vec<f64> = labels.iter().map(|l| section.groups[l.2].width).collect();
    let (size, kept) = fitting(&texts, &importance, PANEL);
    let ends: Vec<DVec2> = kept
        .iter()
        .map(|k| view.place(DVec2::new(labels[*k].0, 1.0) * view.hi.y))
        .collect();
    let shown: Vec<&str> = kept.iter().map(|k| texts[*k].as_str()).collect();
    let wanted: Vec<f64> = ends.iter().map(|e| e.x).collect();
    let at = spread(&wanted, &shown, size, (view.left, view.left + PANEL));
    for (k, text) in kept
        .iter()
        .zip(&shown)
        .enumerate()
        .map(|(i, (k, t))| ((i, *k), *t))
    {
        let (i, k) = k;
        let (_, from, group) = labels[k];
        let base = DVec2::new(at[i], Window::top() - 6.5);
        let ink = deep(colour(group), 0.3);
        let leader = [view.place(from), ends[i], base + DVec2::new(0.0, 1.2)];
        drawing.polyline(&leader, Pen::new(ink.fade(0.7), 0.12));
        drawing.text(
            base,
            text,
            style(size, Typeface::Regular, ink).anchored(Align::Middle),
        );
    }
    if kept.len() < texts.len() {
        let note = format!("the widest {} of {}", kept.len(), texts.len());
        drawing.text(
            DVec2::new(view.left, Window::top() - 10.5),
            &note,
            style(2.2, Typeface::Light, QUIET),
        );
    }
}

/// Where the eye is, below the panel.
fn to_eye(drawing: &mut Drawing, view: &Window) {
    let from = DVec2::new(0f64.clamp(view.lo.x, view.hi.x), view.lo.y);
    let way = view.place(DVec2::ZERO) - view.place(from);
    let Some(way) = way.try_normalize() else {
        return;
    };
    let start = view.place(from) + DVec2::new(0.0, 0.8);
    let tip = start + 6.0 * way;
    let pen = Pen::new(QUIET, 0.3);
    drawing.polyline(&[start, tip], pen);
    let barb = |turn: f64| tip - 1.8 * DVec2::from_angle(turn).rotate(way);
    drawing.polyline(&[barb(0.45), tip, barb(-0.45)], pen);
    let text = format!("eye, {:.0} mm from here", from.length());
    let right = start.x < view.left + 0.6 * PANEL;
    let (dx, anchor) = if right {
        (2.5, Align::Start)
    } else {
        (-2.5, Align::End)
    };
    let at = DVec2::new(
        start.x.max(tip.x * f64::from(u8::from(right))) + dx,
        start.y + 4.5,
    );
    drawing.text(
        at,
        &text,
        style(2.6, Typeface::Light, QUIET).anchored(anchor),
    );
}

fn caption(drawing: &mut Drawing, section: &Section, view: &Window, k: usize) {
    let torn = section.torn;
    let (title, text) = match (k, torn) {
        (0, _) => (
            "Bounds",
            "nearest and farthest depth \u{3bb} of every group; the model",
        ),
        (1, false) => (
            "Bounds times \u{3bc}, and the surface",
            "one surface runs through all; the figures are the scales \u{3bc}",
        ),
        (1, true) => (
            "The torn surface",
            "torn along the eye's rays (red), it lies in the bounds as they are: \u{3bc} = 1",
        ),
        (_, false) => (
            "Scaled back by 1/\u{3bc}",
            "every piece lies on its own support, within its bounds",
        ),
        (_, true) => (
            "The pieces",
            "every piece lies on its own support, within its bounds",
        ),
    };
    let y = view.bottom() + ARROW;
    let head = style(4.0, Typeface::Regular, TEXT).fitting(title, PANEL);
    drawing.text(DVec2::new(view.left, y + 4.0), title, head);
    let body = style(2.8, Typeface::Light, QUIET).fitting(text, PANEL);
    drawing.text(DVec2::new(view.left, y + 9.0), text, body);
}

/// What lines and areas mean, and a scale bar.
fn key(drawing: &mut Drawing, section: &Section, view: &Window, y: f64) {
    let rgb = colour(0);
    let ink = style(2.8, Typeface::Light, TEXT);
    let mut x = EDGE;
    let mut put = |drawing: &mut Drawing, fill: Option<Ink>, pen: Pen, text: &str| {
        let (lo, hi) = (DVec2::new(x, y - 2.2), DVec2::new(x + 5.0, y));
        match fill {
            Some(_) => drawing.rect(lo, hi, fill, Some(pen)),
            None => drawing.polyline(&[lo.with_y(y - 1.0), hi.with_y(y - 1.0)], pen),
        }
        drawing.text(DVec2::new(x + 6.5, y), text, ink);
        x += 6.5 + crate::diagram::lettering::width(text, 2.8, Typeface::Light) + 6.0;
    };
    put(drawing, Some(FREE), Pen::new(QUIET, 0.18), "support");
    put(
        drawing,
        Some(Ink::new(rgb).fade(0.32)),
        Pen::new(Ink::new(rgb).fade(0.8), 0.12),
        "bounds of a group",
    );
    let whole = Pen::new(QUIET.fade(0.8), 0.13);
    put(drawing, None, whole, "model");
    put(drawing, None, SURFACE, "what is seen of it; the surface");
    put(
        drawing,
        None,
        Pen::new(deep(rgb, 0.15), 0.65),
        "piece of a group",
    );
    put(
        drawing,
        None,
        Pen::new(Ink::new([0x9A; 3]), 0.1),
        "ray of the eye",
    );
    if section.torn {
        put(drawing, None, Pen::new(RED, 0.2).dashed(0.5, 0.7), "tear");
    }
    let mm = round_length(0.3 * PANEL / view.scale);
    let (a, b) = (
        DVec2::new(WIDTH - EDGE - view.scale * mm, y),
        DVec2::new(WIDTH - EDGE, y),
    );
    let tick = DVec2::new(0.0, 1.2);
    drawing.polyline(&[a - tick, a, b, b - tick], Pen::new(TEXT, 0.25));
    drawing.text(
        (a + b) / 2.0 - DVec2::new(0.0, 1.2),
        &format!("{mm} mm"),
        ink.anchored(Align::Middle),
    );
}

/// The largest of 1, 2, 5 times a power of ten up to a length.
fn round_length(most: f64) -> f64 {
    let ten = 10f64.powf(most.log10().floor());
    let steps = [5.0, 2.0, 1.0].map(|f| f * ten);
    steps.into_iter().find(|s| *s <= most).unwrap_or(ten)
}
