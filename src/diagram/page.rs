//! Measures, colours and type of the plan's page.
//!
//! Everything is laid out in units of a sixtieth of the forest's radius, `u`, on a page of at least 210 x 297 u:
//! the proportions of A4, whatever the size of the forest.

use crate::diagram::drawing::{Align, Ink, TextStyle};
use crate::diagram::facts::Facts;
use crate::diagram::lettering::Typeface;
use crate::support::Support;
use glam::DVec2;

pub(crate) const PAPER: Ink = Ink::new([0xFC, 0xFB, 0xF8]);
pub(crate) const TEXT: Ink = Ink::new([0x22, 0x26, 0x2B]);
pub(crate) const QUIET: Ink = Ink::new([0x6F, 0x73, 0x78]);
pub(crate) const HAIR: Ink = Ink::new([0xC9, 0xC6, 0xBE]);
pub(crate) const BASE: Ink = Ink::new([0xF1, 0xEE, 0xE6]);
/// A pillar that no eye sees within its models' angles.
pub(crate) const FREE: Ink = Ink::new([0xDA, 0xD7, 0xCF]);
pub(crate) const RED: Ink = Ink::new([0xC4, 0x12, 0x1E]);

const WIDTH: f64 = 210.0;
const LEAST_HEIGHT: f64 = 297.0;
/// The map's middle below the top edge.
const MIDDLE: f64 = 129.0;
/// Of the plan and of panels: up to the first ranges are drawn, at the second stand the eyes that are further away. Radii of the
/// forest.
const EDGES: [f64; 2] = [1.24, 1.45];
const PANEL_EDGES: [f64; 2] = [1.13, 1.31];
/// Of the plan and of panels: widest name beside an eye, as a share of their width.
const LABEL: f64 = 0.6;
const PANEL_LABEL: f64 = 0.24;
/// Top of the table of views, and the height of one of its rows.
pub(crate) const TABLE: f64 = 240.0;
pub(crate) const ROW: f64 = 6.0;
/// Room below the table: key and scale bar.
const BELOW: f64 = 33.0;

/// Where things of the forest lie on the page.
pub(crate) struct Page {
    /// Middle of the forest and radius of the circle around it, millimetres.
    pub centre: DVec2,
    pub radius: f64,
    /// Up to here ranges are drawn, and here stand the eyes that are further away, from the middle, millimetres.
    pub range: f64,
    rim: f64,
    /// Layout unit in millimetres.
    pub u: f64,
    /// Millimetres on the page for one of the scene.
    scale: f64,
    /// Where the forest's middle lies, and the corners of the room that labels keep to.
    middle: DVec2,
    pub room: [DVec2; 2],
    /// Longer names are cut.
    pub widest_label: f64,
    height: f64,
}

impl Page {
    pub(crate) fn new(facts: &Facts) -> Self {
        let outlines = facts.supports.iter().flat_map(Support::outline);
        let (centre, radius) = circle(outlines.copied());
        let rows = facts.views.len() as f64;
        let u = radius / 60.0;
        let height = LEAST_HEIGHT.max(TABLE + ROW * rows + BELOW);
        let edge = DVec2::splat(3.0 * u);
        Self {
            centre,
            radius,
            range: EDGES[0] * radius,
            rim: EDGES[1] * radius,
            u,
            scale: 1.0,
            middle: u * DVec2::new(WIDTH / 2.0, MIDDLE),
            room: [edge, u * DVec2::new(WIDTH, height) - edge],
            widest_label: LABEL * u * WIDTH,
            height,
        }
    }

    /// A map as part of a page of other measures: eyes and all within `room`, middle and radius of the forest in scene coordinates.
    pub(crate) fn panel((centre, radius): (DVec2, f64), room: [DVec2; 2], u: f64) -> Self {
        let (size, rim) = (room[1] - room[0], PANEL_EDGES[1] * radius);
        // Half an eye stands beyond the rim.
        let reach = (size.min_element() / 2.0 - 3.2 * u).max(u);
        Self {
            centre,
            radius,
            range: PANEL_EDGES[0] * radius,
            rim,
            u,
            scale: reach / rim,
            middle: (room[0] + room[1]) / 2.0,
            room,
            widest_label: PANEL_LABEL * size.x,
            height: room[1].y / u,
        }
    }

    /// Millimetres.
    pub(crate) fn size(&self) -> DVec2 {
        self.u * DVec2::new(WIDTH, self.height)
    }

    /// A place given in layout units from the top left corner.
    pub(crate) fn at(&self, x: f64, y: f64) -> DVec2 {
        self.u * DVec2::new(x, y)
    }

    /// Bottom edge in layout units.
    pub(crate) fn bottom(&self) -> f64 {
        self.height
    }

    /// The page's place of a point of the scene, true scale.
    pub(crate) fn place(&self, p: DVec2) -> DVec2 {
        let d = p - self.centre;
        self.middle + self.scale * DVec2::new(d.x, -d.y)
    }

    /// A length of the scene on the page.
    pub(crate) fn scaled(&self, mm: f64) -> f64 {
        self.scale * mm
    }

    pub(crate) fn outline(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|p| self.place(*p)).collect()
    }

    /// Where an eye is drawn (scene coordinates), and whether that is nearer than it stands.
    pub(crate) fn stand(&self, eye: DVec2) -> (DVec2, bool) {
        let d = eye - self.centre;
        if d.length() <= self.rim {
            (eye, false)
        } else {
            (self.centre + self.rim * d.normalize(), true)
        }
    }

    /// Text of a size in layout units.
    pub(crate) fn style(&self, size: f64, face: Typeface, ink: Ink, anchor: Align) -> TextStyle {
        TextStyle::new(size * self.u, face, ink, anchor)
    }
}

/// Middle and radius of a circle around all points; the unit is arbitrary if there are none.
pub(crate) fn circle(points: impl Iterator<Item = DVec2>) -> (DVec2, f64) {
    let points: Vec<DVec2> = points.filter(|p| p.is_finite()).collect();
    let lo = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let hi = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let centre = (lo + hi) / 2.0;
    let radius = points
        .iter()
        .map(|p| p.distance(centre))
        .fold(0.0, f64::max);
    if radius > 0.0 {
        (centre, radius)
    } else {
        (DVec2::ZERO, 60.0)
    }
}

/// A colour mixed with white, 0 to 1.
pub(crate) fn pale(rgb: [u8; 3], white: f64) -> Ink {
    Ink::new(rgb.map(|c| (f64::from(c) + white * (255.0 - f64::from(c))).round() as u8))
}

/// A colour mixed with black, 0 to 1.
pub(crate) fn deep(rgb: [u8; 3], black: f64) -> Ink {
    Ink::new(rgb.map(|c| (f64::from(c) * (1.0 - black)).round() as u8))
}

/// A length for people: millimetres below a metre.
pub(crate) fn length(mm: f64) -> String {
    if mm < 1000.0 {
        format!("{mm:.0} mm")
    } else {
        format!("{:.2} m", mm / 1000.0)
    }
}
