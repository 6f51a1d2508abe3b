//! What eyes beside a view's own will see of the forest, without building it.
//!
//! Takes subjects, pillars and their survey. Gives, for every outlook, the mean angle between the normals of models and forest over
//! the rays that meet the models: what [`certify::camouflage`](crate::certify) measures on the finished solid as `mean_error_deg`.
//!
//! Every relief is taken for the model as its eye sees it, painted with its true normals on the middle plane of the layer: a torn
//! relief is just that but for its steps. Rays are followed in plan, one column at a time: into the carved front of a
//! pillar, to the painted plane, or to the bare body; past all of them to the base or into the air, which counts 90 degrees.

use super::brief::{Brief, Pillar};
use super::skyline::entry;
use super::subject::{Outlook, OutlookColumn, Subject};
use super::survey::{Offsets, Survey};
use glam::{DVec2, Vec3};

/// Where a column of rays passes a pillar.
pub struct Passage {
    /// Distance at which the rays meet the body.
    pub body: f64,
    /// Unit normal of the body there.
    pub normal: Vec3,
    height: f64,
    /// View that the pillar is carved for, the portrait's column and the distance from that eye, at the body and at the painted plane.
    pub carved: Option<Painted>,
    pub painted: Option<(f64, Painted)>,
}

#[derive(Clone, Copy)]
pub struct Painted {
    pub view: usize,
    pub column: usize,
    /// Horizontal distance of the place from the view's eye.
    pub distance: f64,
}

/// A sum of errors over the rays of one column, degrees, and their number.
pub type Tally = (f64, usize);

/// One column of an outlook.
pub fn tally(
    subjects: &[Subject],
    brief: &Brief,
    pillars: &[Pillar],
    survey: &Survey,
    outlook: &Outlook,
    column: &OutlookColumn,
) -> Tally {
    if column.rays.is_empty() {
        return (0.0, 0);
    }
    let eye = outlook.eye.truncate();
    let mut passages: Vec<Passage> = pillars
        .iter()
        .enumerate()
        .filter_map(|(i, p)| passage(subjects, brief, p, i, survey, eye, column.way))
        .collect();
    passages.sort_unstable_by(|a, b| a.body.total_cmp(&b.body));
    let mut sum = 0.0;
    for (slope, wanted) in &column.rays {
        let seen = passages
            .iter()
            .find_map(|p| p.seen(subjects, outlook.eye.z, *slope));
        let seen = seen.or_else(|| on_base(brief, outlook, column.way, *slope));
        sum += seen.map_or(90.0, |n| degrees(n.dot(*wanted)));
    }
    (sum, column.rays.len())
}

/// The angle in degrees whose cosine is given, to a hundredth of a degree (Abramowitz & Stegun 4.4.45).
pub fn degrees(cosine: f32) -> f64 {
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

/// The base is seen wherever a ray comes down inside the region.
pub fn on_base(brief: &Brief, outlook: &Outlook, way: DVec2, slope: f64) -> Option<Vec3> {
    let t = -outlook.eye.z / slope;
    let inside = || crate::geom::contains(&brief.region, outlook.eye.truncate() + t * way);
    (slope < 0.0 && outlook.eye.z > 0.0 && inside()).then_some(Vec3::Z)
}

pub fn passage(
    subjects: &[Subject],
    brief: &Brief,
    pillar: &Pillar,
    index: usize,
    survey: &Survey,
    eye: DVec2,
    way: DVec2,
) -> Option<Passage> {
    let shape = &brief.shapes[pillar.shape];
    if way.perp_dot(pillar.at - eye).abs() > shape.reach {
        return None;
    }
    let body = entry(eye, way, pillar.at, shape)?;
    let met = eye + body * way;
    let outward = (met - pillar.at).normalize_or_zero();
    let mut passage = Passage {
        body,
        normal: outward.extend(0.0).as_vec3(),
        height: shape.heights[1],
        carved: None,
        painted: None,
    };
    let Some(view) = pillar.owner else {
        return Some(passage);
    };
    let (subject, shadow) = (&subjects[view], &survey.shadows[view][index]);
    let ahead = (pillar.at - subject.o) / shadow.distance;
    let place = |p: DVec2| {
        let offset = p - subject.o;
        let bearing = shadow.middle + ahead.perp_dot(offset).atan2(ahead.dot(offset));
        let shown = survey.runs[view]
            .iter()
            .any(|r| r.pillar == Some(index) && r.from <= bearing && bearing <= r.to);
        let column = subject.portrait.column(bearing).filter(|_| shown)?;
        Some(Painted {
            view,
            column,
            distance: offset.length(),
        })
    };
    passage.carved = place(met);
    let plane = shadow.distance + Offsets::new(shape).middle;
    let towards = way.dot(ahead);
    if towards > 0.0 {
        let t = (plane - ahead.dot(eye - subject.o)) / towards;
        passage.painted = place(eye + t * way).map(|p| (t, p));
    }
    Some(passage)
}

impl Passage {
    /// Normal of what a ray of this slope meets of the pillar.
    pub fn seen(&self, subjects: &[Subject], eye_z: f64, slope: f64) -> Option<Vec3> {
        let model = |p: &Painted, t: f64| {
            let subject = &subjects[p.view];
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
            return Some(normal);
        }
        Some(self.normal)
    }
}

/// Mean error of a view's outlooks in degrees, from the tallies of all their columns.
pub fn mean(tallies: impl Iterator<Item = Tally>) -> f64 {
    let (sum, rays) = tallies.fold((0.0, 0), |(s, n), t| (s + t.0, n + t.1));
    if rays > 0 { sum / rays as f64 } else { 0.0 }
}
