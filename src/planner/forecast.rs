//! What eyes beside a view's own will see of the forest, without building it.
//!
//! Takes subjects, pillars and their survey. Gives, for every outlook, the mean angle between the normals of models and forest over
//! the rays that meet the models: what [`certify::camouflage`](crate::certify) measures on the finished solid as `mean_error_deg`.
//!
//! Every relief is taken for the model as its eye sees it, painted with its true normals on the middle plane of the layer: a torn
//! relief is just that, but for the walls of its steps, which count by a share. Rays are followed in plan, one column at a time:
//! into the carved front of a pillar, to the painted plane, or to the bare body; past all of them to the base or into the air, which
//! counts 90 degrees.

use super::brief::{Brief, Pillar};
use super::subject::{Outlook, OutlookColumn, Subject};
use super::survey::{Offsets, Survey};
use crate::horizon::Ray;
use glam::{DVec2, DVec3, Vec3};
use std::iter::Sum;

/// Walls of steps that an eye off to the side sees, as a share of the relief's area over the tangent of the angle: length times height
/// of the steps, by area. The reference forest's four reliefs have 0.2 to 0.6.
const WALLS: f64 = 0.35;
/// Walls stand along the rays of their own eye: how far their normals are off those of a model that faces it, on average, degrees.
const WALL_DEG: f64 = 80.0;

/// Where a column of rays passes a pillar.
struct Passage {
    /// Distance at which the rays meet the body.
    body: f64,
    /// Unit normal of the body there.
    normal: Vec3,
    height: f64,
    /// View that the pillar is carved for, the portrait's column and the distance from that eye, at the body and at the painted plane.
    carved: Option<Painted>,
    painted: Option<(f64, Painted)>,
    /// Share of the painted plane that is walls of steps.
    walls: f64,
}

#[derive(Clone, Copy)]
struct Painted {
    view: usize,
    column: usize,
    /// Horizontal distance of the place from the view's eye.
    distance: f64,
}

/// Sums over rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    /// Angles between the normals, degrees.
    pub error_deg: f64,
    /// `max(0, 1 - angle / 90 degrees)`; nothing where the forest is missed.
    pub agreement: f64,
    pub rays: usize,
}

impl Tally {
    const MISSED: Self = Self {
        error_deg: 90.0,
        agreement: 0.0,
        rays: 1,
    };

    /// A ray that meets a surface, or, with the probability `walls`, the wall of a step in it.
    fn of(error_deg: f64, walls: f64) -> Self {
        let agreement = |deg: f64| (1.0 - deg / 90.0).max(0.0);
        let mixed = |surface: f64, wall: f64| (1.0 - walls) * surface + walls * wall;
        Self {
            error_deg: mixed(error_deg, WALL_DEG),
            agreement: mixed(agreement(error_deg), agreement(WALL_DEG)),
            rays: 1,
        }
    }

    pub(crate) fn mean_error_deg(&self) -> f64 {
        self.error_deg / self.rays.max(1) as f64
    }

    pub(crate) fn mean_agreement(&self) -> f64 {
        self.agreement / self.rays.max(1) as f64
    }
}

impl Sum for Tally {
    fn sum<I: Iterator<Item = Self>>(tallies: I) -> Self {
        tallies.fold(Self::default(), |a, b| Self {
            error_deg: a.error_deg + b.error_deg,
            agreement: a.agreement + b.agreement,
            rays: a.rays + b.rays,
        })
    }
}

/// What a layout is seen with.
#[derive(Clone, Copy)]
pub(crate) struct Forecast<'a> {
    pub subjects: &'a [&'a Subject],
    pub brief: &'a Brief,
    pub pillars: &'a [Pillar],
    pub survey: &'a Survey,
}

impl Forecast<'_> {
    /// One outlook.
    pub(crate) fn seen(&self, outlook: &Outlook) -> Tally {
        outlook
            .columns
            .iter()
            .map(|c| self.column(outlook.eye, c))
            .sum()
    }

    /// One column of an outlook from `eye`.
    pub(crate) fn column(&self, eye: DVec3, column: &OutlookColumn) -> Tally {
        if column.rays.is_empty() {
            return Tally::default();
        }
        let numbered = self.pillars.iter().enumerate();
        let mut passages: Vec<Passage> = numbered
            .filter_map(|(i, p)| self.passage(p, i, eye.truncate(), column.way))
            .collect();
        passages.sort_unstable_by(|a, b| a.body.total_cmp(&b.body));
        let of_ray = |(slope, wanted): &(f64, Vec3)| {
            let seen = passages
                .iter()
                .find_map(|p| p.seen(self.subjects, eye.z, *slope));
            let seen = seen.or_else(|| self.on_base(eye, column.way, *slope).map(|n| (n, 0.0)));
            seen.map_or(Tally::MISSED, |(normal, walls)| {
                Tally::of(degrees(normal.dot(*wanted)), walls)
            })
        };
        column.rays.iter().map(of_ray).sum()
    }

    /// The base is seen wherever a ray comes down inside the region.
    fn on_base(&self, eye: DVec3, way: DVec2, slope: f64) -> Option<Vec3> {
        let inside = || {
            self.brief
                .region
                .contains(eye.truncate() - eye.z / slope * way)
        };
        (slope < 0.0 && eye.z > 0.0 && inside()).then_some(Vec3::Z)
    }

    fn passage(&self, pillar: &Pillar, index: usize, eye: DVec2, way: DVec2) -> Option<Passage> {
        let shape = &self.brief.shapes[pillar.shape];
        if way.perp_dot(pillar.at - eye).abs() > shape.reach {
            return None;
        }
        let ray = Ray::new(eye, way);
        let entry = shape.obstacle(pillar.at).entry(&ray)?;
        let mut passage = Passage {
            body: entry.distance,
            normal: entry.normal.extend(0.0).as_vec3(),
            height: shape.heights[1],
            carved: None,
            painted: None,
            walls: 0.0,
        };
        let Some(view) = pillar.owner else {
            return Some(passage);
        };
        let (subject, skyline) = (self.subjects[view], &self.survey.skylines[view]);
        let shadow = &skyline.shadows[index];
        let ahead = (pillar.at - subject.o) / shadow.distance;
        let place = |p: DVec2| {
            let offset = p - subject.o;
            let bearing = shadow.middle + ahead.perp_dot(offset).atan2(ahead.dot(offset));
            let shown = skyline
                .runs_on(index)
                .any(|r| r.from <= bearing && bearing <= r.to);
            let column = subject.portrait.column(bearing).filter(|_| shown)?;
            Some(Painted {
                view,
                column,
                distance: offset.length(),
            })
        };
        passage.carved = place(ray.at(entry.distance));
        let plane = shadow.distance + Offsets::new(shape).middle;
        let towards = way.dot(ahead);
        if towards > 0.0 {
            let t = (plane - ahead.dot(eye - subject.o)) / towards;
            passage.walls = (WALLS * way.perp_dot(ahead).abs() / towards).min(1.0);
            passage.painted = place(ray.at(t)).map(|p| (t, p));
        }
        Some(passage)
    }
}

/// The angle in degrees whose cosine is given, to a hundredth of a degree (Abramowitz & Stegun 4.4.45).
fn degrees(cosine: f32) -> f64 {
    let x = cosine.abs().min(1.0);
    let root = (1.0 - x).sqrt();
    let acute = root * (1.570_728_8 + x * (-0.212_114_4 + x * (0.074_261 - 0.018_729_3 * x)));
    let angle = if cosine < 0.0 {
        std::f32::consts::PI - acute
    } else {
        acute
    };
    f64::from(angle.to_degrees())
}

impl Passage {
    /// Normal of what a ray of this slope meets of the pillar, and the probability that it meets a step's wall instead.
    fn seen(&self, subjects: &[&Subject], eye_z: f64, slope: f64) -> Option<(Vec3, f64)> {
        let model = |p: &Painted, t: f64| {
            let subject = subjects[p.view];
            let z = eye_z + slope * t;
            subject
                .portrait
                .normal(p.column, (z - subject.eye.z) / p.distance)
        };
        let z = eye_z + slope * self.body;
        if z < 0.0 || z > self.height {
            return None;
        }
        if self.carved.is_some_and(|p| model(&p, self.body).is_some())
            && let Some(normal) = self.painted.and_then(|(t, p)| model(&p, t))
        {
            return Some((normal, self.walls));
        }
        Some((self.normal, 0.0))
    }
}
