//! The pillars as one eye sees them: their shadows, and which of them it meets first over the bearings of its models.

use super::brief::{Pillar, Shape};
use super::subject::Subject;
use crate::horizon::{Horizon, Obstacle, Run, Shadow};

/// See the module. Indices are the layout's pillars.
#[derive(Clone, Debug, PartialEq)]
pub struct Skyline {
    pub shadows: Vec<Shadow>,
    /// Whether all rays to the models pass above the pillar: it hides nothing.
    pub passed: Vec<bool>,
    /// Rising; those of one span join without gaps.
    pub runs: Vec<Run>,
    /// From which the runs are, kept to follow changes.
    horizon: Horizon,
}

impl Skyline {
    pub fn new(subject: &Subject, shapes: &[Shape], pillars: &[Pillar]) -> Self {
        let shadow = |p: &Pillar| subject.shadow(p, &shapes[p.shape]);
        let shadows: Vec<Shadow> = pillars.iter().map(shadow).collect();
        let passes = |(p, s): (&Pillar, &Shadow)| subject.passes_over(s, &shapes[p.shape]);
        let passed: Vec<bool> = pillars.iter().zip(&shadows).map(passes).collect();
        let obstacles = obstacles(shapes, pillars, &passed);
        let horizon = Horizon::new(subject.viewpoint(), &subject.spans, &obstacles);
        Self {
            shadows,
            passed,
            runs: horizon.runs().collect(),
            horizon,
        }
    }

    /// That of the same eye after some pillars have changed, of this list or of the former one.
    pub fn after(
        &self,
        subject: &Subject,
        shapes: &[Shape],
        pillars: &[Pillar],
        changed: &[usize],
    ) -> Self {
        let mut next = self.clone();
        next.shadows.resize(pillars.len(), Shadow::default());
        next.passed.resize(pillars.len(), false);
        for &i in changed.iter().filter(|i| **i < pillars.len()) {
            let (pillar, shape) = (&pillars[i], &shapes[pillars[i].shape]);
            next.shadows[i] = subject.shadow(pillar, shape);
            next.passed[i] = subject.passes_over(&next.shadows[i], shape);
        }
        let obstacles = obstacles(shapes, pillars, &next.passed);
        for i in changed {
            next.horizon.update(*i, &obstacles);
        }
        next.runs.clear();
        next.runs.extend(next.horizon.runs());
        next
    }

    /// The runs on one pillar.
    pub fn runs_on(&self, pillar: usize) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(move |r| r.obstacle == Some(pillar))
    }
}

fn obstacles<'a>(
    shapes: &'a [Shape],
    pillars: &[Pillar],
    passed: &[bool],
) -> Vec<Option<Obstacle<'a>>> {
    let obstacle =
        |(p, passed): (&Pillar, &bool)| (!passed).then(|| shapes[p.shape].obstacle(p.at));
    pillars.iter().zip(passed).map(obstacle).collect()
}
