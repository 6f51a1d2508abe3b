//! One map of a layout: region, ranges, pillars, faults, eyes.

use super::story::Story;
use crate::diagram::drawing::{Align, Drawing, Ink, Mark, Pen, TextStyle, Verb};
use crate::diagram::eyes::{arrow, eye_symbol, eyes};
use crate::diagram::lettering::Typeface;
use crate::diagram::map::{chord, fan, range};
use crate::diagram::page::{BASE, FREE, HAIR, PAPER, Page, QUIET, RED, TEXT, deep, pale};
use crate::diagram::vista::{Grain, Vista, viewpoint};
use crate::geom::polygon_area;
use crate::horizon::Run;
use crate::planner::{Frame, Pillar};
use glam::DVec2;
use std::f64::consts::TAU;

/// Smallest letters that are drawn, millimetres: smaller ones cannot be read.
const LEAST_LETTER: f64 = 1.3;
const LARGEST_LETTER: f64 = 2.8;
/// Half a cross at a fault, layout units.
const CROSS: f64 = 1.2;
/// Corners of the circle to which regions are cut.
const CORNERS: usize = 120;

/// Where a map lies.
pub(crate) struct Map<'a> {
    pub story: &'a Story<'a>,
    pub page: Page,
    /// Chords of a round pillar's outline where a range ends on it.
    pub arc: usize,
}

impl<'a> Map<'a> {
    pub(crate) fn new(story: &'a Story<'a>, room: [DVec2; 2], u: f64) -> Self {
        Self {
            story,
            page: Page::panel(story.circle, room, u),
            arc: 8,
        }
    }

    pub(crate) fn ground(&self, drawing: &mut Drawing) {
        let outline = self.page.outline(self.story.brief.region.outline());
        drawing.polygon(
            &outline,
            Some(BASE),
            Some(Pen::new(HAIR, 0.4 * self.page.u)),
        );
    }

    /// Sight regions, as far as the map shows them.
    pub(crate) fn regions(&self, drawing: &mut Drawing) {
        let page = &self.page;
        let (centre, reach) = (page.centre, page.range);
        let regions = || self.story.views.iter().zip(&self.story.planned.regions);
        for (view, region) in regions() {
            let inside = page.outline(&within(region, centre, reach));
            drawing.polygon(&inside, Some(Ink::new(view.colour).fade(0.1)), None);
        }
        for (view, region) in regions() {
            let pen = Pen::new(deep(view.colour, 0.1), 0.35 * page.u);
            let pen = pen.dashed(1.6 * page.u, 1.3 * page.u);
            // A little inside, so that neighbours' lines lie side by side.
            let turn = polygon_area(region).signum();
            for k in 0..region.len() {
                let (p, q) = (region[k], region[(k + 1) % region.len()]);
                let way = (q - p).normalize_or_zero();
                let Some((from, to)) = chord(p - centre, way, reach) else {
                    continue;
                };
                let (from, to) = (from.max(0.0), to.min(p.distance(q)));
                if from < to {
                    let at = |t: f64| page.place(p + t * way) + 0.3 * page.u * inward(way, turn);
                    drawing.polyline(&[at(from), at(to)], pen);
                }
            }
        }
    }

    /// What every eye sees up to its pillars; red where it meets none, or another's.
    pub(crate) fn ranges(&self, drawing: &mut Drawing, frame: &Frame) {
        let views = self.story.views;
        let vistas: Vec<Vista> = (0..views.len()).map(|v| self.vista(frame, v)).collect();
        for (view, vista) in views.iter().zip(&vistas) {
            for interval in &vista.intervals {
                fan(drawing, &self.page, vista, interval, view.colour);
            }
        }
        for (v, vista) in vistas.iter().enumerate() {
            for sector in vista.sectors() {
                match sector.obstacle.and_then(|i| frame.pillars.get(i)) {
                    None => self.past(drawing, vista, &sector.hits),
                    Some(p) if p.owner != Some(v) => self.foreign(drawing, vista, &sector.hits),
                    Some(_) => {}
                }
            }
        }
    }

    /// What the eye of view `v` sees at a frame.
    fn vista(&self, frame: &Frame, v: usize) -> Vista {
        let runs = frame.runs.get(v).map_or(&[][..], Vec::as_slice);
        let intervals = runs
            .chunk_by(|a, b| a.to == b.from)
            .map(|i: &[Run]| i.iter());
        let obstacle = |i: usize| {
            let pillar = frame.pillars.get(i)?;
            Some(self.story.brief.shapes[pillar.shape].obstacle(pillar.at))
        };
        let viewpoint = viewpoint(&self.story.views[v]);
        Vista::new(&viewpoint, intervals, obstacle, Grain::Chords(self.arc))
    }

    /// Where an eye looks past all pillars.
    fn past(&self, drawing: &mut Drawing, vista: &Vista, hits: &[(f64, f64)]) {
        let u = self.page.u;
        let points = range(&self.page, vista, hits);
        drawing.polygon(&points, Some(RED.fade(0.18)), None);
        if let [far, other_far, other_near, near] = points[..] {
            let middle = [(near + other_near) / 2.0, (far + other_far) / 2.0];
            drawing.polyline(&middle, Pen::new(RED, 0.3 * u).dashed(0.8 * u, 1.2 * u));
        }
    }

    /// Where an eye meets another view's pillar.
    fn foreign(&self, drawing: &mut Drawing, vista: &Vista, hits: &[(f64, f64)]) {
        let at = |(bearing, t): &(f64, f64)| self.page.place(vista.point(*bearing, *t));
        let line: Vec<DVec2> = hits.iter().map(at).collect();
        drawing.polyline(&line, Pen::new(RED, 0.9 * self.page.u));
    }

    pub(crate) fn pillars(&self, drawing: &mut Drawing, pillars: &[Pillar]) {
        for pillar in pillars {
            self.pillar(drawing, pillar, self.page.place(pillar.at));
        }
    }

    /// One pillar, its axis at a place of the page.
    pub(crate) fn pillar(&self, drawing: &mut Drawing, pillar: &Pillar, at: DVec2) {
        let owner = self.story.owner(pillar);
        let (fill, line) = owner.map_or((FREE, QUIET), |(v, _)| {
            (pale(v.colour, 0.3), deep(v.colour, 0.35))
        });
        let width = if pillar.fixed { 0.9 } else { 0.25 };
        let line = if pillar.fixed { TEXT } else { line };
        self.body(
            drawing,
            pillar,
            at,
            Some(fill),
            Pen::new(line, width * self.page.u),
        );
        let reach = self
            .page
            .scaled(self.story.brief.shapes[pillar.shape].reach);
        let size = (1.25 * reach).min(LARGEST_LETTER);
        if let Some((_, key)) = owner.filter(|_| size >= LEAST_LETTER) {
            let style = TextStyle::new(size, Typeface::Regular, TEXT, Align::Middle)
                .fitting(key, 1.5 * reach);
            drawing.text(at + DVec2::new(0.0, 0.35 * style.size), key, style);
        }
    }

    fn body(&self, drawing: &mut Drawing, pillar: &Pillar, at: DVec2, fill: Option<Ink>, pen: Pen) {
        let shape = &self.story.brief.shapes[pillar.shape];
        if shape.round {
            drawing.circle(at, self.page.scaled(shape.reach), fill, Some(pen));
            return;
        }
        let corner = |p: &DVec2| at + DVec2::new(self.page.scaled(p.x), self.page.scaled(-p.y));
        let outline: Vec<DVec2> = shape.profile.iter().map(corner).collect();
        drawing.polygon(&outline, fill, Some(pen));
    }

    /// What was done to given pillars: where they stood, and the way to where they stand; a plus at new ones.
    pub(crate) fn changes(&self, drawing: &mut Drawing) {
        let u = self.page.u;
        let pen = Pen::new(TEXT, 0.3 * u).dashed(0.8 * u, 0.9 * u);
        for change in &self.story.planned.changes {
            let given = change.given.and_then(|i| self.story.brief.given.get(i));
            match (given, change.to) {
                (Some(given), Some(to)) => {
                    let from = self.page.place(given.at);
                    self.body(drawing, given, from, None, pen);
                    drawing.polyline(&[from, self.page.place(to)], pen);
                }
                (Some(given), None) => {
                    let from = self.page.place(given.at);
                    self.body(drawing, given, from, None, pen);
                    sign(drawing, from, CROSS * u, TEXT, None);
                }
                (None, Some(to)) => {
                    let new = self.story.planned.pillars.iter().find(|p| p.at == to);
                    let reach = new.map_or(0.0, |p| self.story.brief.shapes[p.shape].reach);
                    let beside = self.page.scaled(reach) + 1.4 * u;
                    plus(
                        drawing,
                        self.page.place(to) + beside * DVec2::new(-0.7, -0.7),
                        u,
                    );
                }
                (None, None) => {}
            }
        }
    }

    /// Crosses at faults, the first `numbered` of them with their number in the list below the map.
    pub(crate) fn marks(&self, drawing: &mut Drawing, marks: &[(DVec2, String)], numbered: usize) {
        let u = self.page.u;
        for (place, text) in marks {
            sign(drawing, self.page.place(*place), CROSS * u, RED, Some(text));
        }
        for (k, (place, _)) in marks.iter().enumerate().take(numbered) {
            let style = self.page.style(3.6, Typeface::Bold, RED, Align::Start);
            let beside = self.page.place(*place) + u * DVec2::new(1.9, -1.1);
            drawing.text(beside, &(k + 1).to_string(), style.lifted(PAPER));
        }
    }

    /// Eyes with their names.
    pub(crate) fn eyes(&self, drawing: &mut Drawing) {
        let numbers = if self.story.numbered {
            &self.story.keys[..]
        } else {
            &[]
        };
        eyes(drawing, &self.page, self.story.views, &[], numbers);
    }

    /// Eyes with their letters, for small maps.
    pub(crate) fn small_eyes(&self, drawing: &mut Drawing) {
        let page = &self.page;
        for (view, key) in self.story.views.iter().zip(&self.story.keys) {
            let (stand, far) = page.stand(view.eye.truncate());
            let at = page.place(stand);
            let ahead = (page.place(view.look_at.truncate()) - at).normalize_or_zero();
            arrow(drawing, page, at, ahead, far, view.colour);
            eye_symbol(drawing, at, 4.0 * page.u, view.colour);
            let style = page.style(5.0, Typeface::Bold, deep(view.colour, 0.35), Align::Middle);
            let beside = at + page.u * (7.4 * ahead.perp() + DVec2::new(0.0, 1.8));
            drawing.text(beside, key, style.lifted(PAPER));
        }
    }
}

/// A diagonal cross on a pale one. `text` is what it says in the SVG.
pub(crate) fn sign(drawing: &mut Drawing, at: DVec2, half: f64, ink: Ink, text: Option<&str>) {
    let arm = |x: f64, y: f64| at + half * DVec2::new(x, y);
    let steps = vec![
        Verb::Move(arm(-1.0, -1.0)),
        Verb::Line(arm(1.0, 1.0)),
        Verb::Move(arm(-1.0, 1.0)),
        Verb::Line(arm(1.0, -1.0)),
    ];
    for (ink, width, text) in [(PAPER, 1.25, None), (ink, 0.58, text)] {
        drawing.shapes.push(Mark {
            steps: steps.clone(),
            fill: None,
            pen: Some(Pen::new(ink, width * half)),
            text: text.map(str::to_owned),
        });
    }
}

/// The sign of what is new.
pub(crate) fn plus(drawing: &mut Drawing, at: DVec2, half: f64) {
    for way in [DVec2::X, DVec2::Y] {
        drawing.polyline(
            &[at - half * way, at + half * way],
            Pen::new(TEXT, 0.5 * half),
        );
    }
}

/// The side of an edge on which its polygon lies, on the page. `turn` is 1 for counter-clockwise outlines in the scene.
fn inward(way: DVec2, turn: f64) -> DVec2 {
    let left = turn * way.perp();
    DVec2::new(left.x, -left.y)
}

/// The part of a convex polygon within a circle (Sutherland and Hodgman's cut at every side of a polygon around it).
fn within(polygon: &[DVec2], centre: DVec2, radius: f64) -> Vec<DVec2> {
    let mut left = polygon.to_vec();
    for k in 0..CORNERS {
        let way = DVec2::from_angle(TAU * k as f64 / CORNERS as f64);
        let beyond = |p: DVec2| way.dot(p - centre) - radius;
        let mut cut = Vec::with_capacity(left.len() + 1);
        for (i, p) in left.iter().enumerate() {
            let q = left[(i + 1) % left.len()];
            let (bp, bq) = (beyond(*p), beyond(q));
            if bp <= 0.0 {
                cut.push(*p);
            }
            if (bp <= 0.0) != (bq <= 0.0) {
                cut.push(*p + (q - *p) * (bp / (bp - bq)));
            }
        }
        left = cut;
    }
    left
}
