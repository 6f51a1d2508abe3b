//! One view on its way through the stages that concern it alone.

use crate::carve::ViewRelief;
use crate::diag::Diagnostic;
use crate::geom::ImagePlane;
use crate::groups::{Groups, groups};
use crate::mimic::{Depths, Energy, RowKind, SolveError, depths};
use crate::relief::{Relief, relief};
use crate::scene::Scene;
use crate::steps::{StepLine, StepSummary, torn};
use crate::view::View;
use crate::viewmap::{SupportField, Target, ViewMap, view_map};

/// Gaps below this share of a model are rounding at its outline.
const GAP_SHARE: f64 = 1e-6;

/// One view before optimisation.
pub struct Sight<'a> {
    pub view: &'a View,
    pub target: Target,
    pub map: ViewMap,
    pub groups: Groups,
}

/// One view after it.
pub struct Shape {
    pub depths: Depths,
    pub relief: Relief,
    /// Where the surface was torn, if it might be.
    pub steps: Option<(Vec<StepLine>, StepSummary)>,
}

/// Projects, maps and groups one view.
///
/// # Errors
/// If the models do not lie before the eye, nothing of them is seen, or no support carries them.
pub fn see<'a>(view: &'a View, field: &SupportField) -> Result<Sight<'a>, Vec<Diagnostic>> {
    let failed = |text: String| vec![Diagnostic::error(format!("view \"{}\": {text}", view.name))];
    let plane = ImagePlane::looking_at(view.eye, view.look_at);
    let target = Target::new(view.target(), &plane)
        .ok_or_else(|| failed("part of its models lies beside or behind the eye".into()))?;
    let map = view_map(plane, &target, field).map_err(|e| failed(e.to_string()))?;
    let groups = groups(&view.name, &map, &target, field)?;
    if groups.groups.is_empty() {
        return Err(failed(
            "no pillar stands behind or in its models, so nothing of them can appear".into(),
        ));
    }
    Ok(Sight {
        view,
        target,
        map,
        groups,
    })
}

impl Sight<'_> {
    /// Solid angles in steradians of the models, and of what of them a support carries.
    pub fn solid_angles(&self) -> (f64, f64) {
        let of = |c: &usize| self.map.solid_angle(*c);
        let seen: Vec<usize> = (0..self.map.cells.len())
            .filter(|c| self.map.cells[*c].face.is_some())
            .collect();
        (
            seen.iter().map(of).sum(),
            seen.iter()
                .filter(|c| self.groups.of_cell[**c].is_some())
                .map(of)
                .sum(),
        )
    }

    /// Share of the models' solid angle that a support carries.
    pub fn coverage(&self) -> f64 {
        let (whole, carried) = self.solid_angles();
        carried / whole
    }

    /// What of the models no support carries, if it is worth telling.
    pub fn warning(&self, field: &SupportField) -> Option<Diagnostic> {
        let gap = 1.0 - self.coverage();
        let largest = (0..self.map.cells.len())
            .filter(|c| self.map.cells[*c].face.is_some() && self.groups.of_cell[*c].is_none())
            .max_by(|a, b| {
                self.map
                    .solid_angle(*a)
                    .total_cmp(&self.map.solid_angle(*b))
            })?;
        let behind = match self.map.cells[largest].support {
            Some(s) => format!(
                "it meets {}, which carries nothing",
                field.supports[s as usize].name
            ),
            None => "no pillar stands there, or it is too short".into(),
        };
        let side = self.map.points_mean(self.map.cells[largest].corners);
        let (across, above) = (side.x.atan().to_degrees(), side.y.atan().to_degrees());
        (gap > GAP_SHARE).then(|| {
            Diagnostic::warning(format!(
                "view \"{}\" misses {:.2} % of its models, mostly {:.1} degrees {} and {:.1} degrees {} its line of sight: {behind}",
                self.view.name,
                100.0 * gap,
                across.abs(),
                if across < 0.0 { "left of" } else { "right of" },
                above.abs(),
                if above < 0.0 { "below" } else { "above" },
            ))
            .help("add or raise a pillar there, or move the models")
        })
    }

    /// Optimises, cuts and scales back.
    pub fn shape(&self, scene: &Scene, field: &SupportField) -> Result<Shape, Vec<Diagnostic>> {
        let Self {
            target,
            map,
            groups,
            ..
        } = self;
        let explained = |e| vec![self.explain(e, field)];
        if let (Energy::Normal(options), Some(steps)) = (scene.energy, &scene.steps) {
            let torn = torn(steps, options, target, map, field, groups);
            // Its rows belong to the cut mesh: only the kind of failure is told.
            let torn = torn.map_err(|e| explained(e.without_row()))?;
            return Ok(Shape {
                relief: relief(&torn.map, &torn.target, field, &torn.groups, &torn.depths),
                depths: torn.depths,
                steps: Some((torn.lines, torn.summary)),
            });
        }
        let depths = depths(scene.energy, target, map, field, groups).map_err(explained)?;
        Ok(Shape {
            relief: relief(map, target, field, groups, &depths),
            depths,
            steps: None,
        })
    }

    /// A solver's failure in terms of the scene: the pillar and the bounds in conflict.
    fn explain(&self, error: SolveError, field: &SupportField) -> Diagnostic {
        let view = &self.view.name;
        let SolveError::Infeasible(Some(kind)) = error else {
            return Diagnostic::error(format!("view \"{view}\": {error}"))
                .help("thicker layers (`front`, `back`) make it easier; `check` tells whether the models are sound");
        };
        let (bound, limit) = match kind {
            RowKind::Near(b) => (self.groups.bounds.get(b as usize), "nearest"),
            RowKind::Far(b) => (self.groups.bounds.get(b as usize), "farthest"),
            RowKind::Order(_) | RowKind::Step(_) => (None, ""),
        };
        let Some(bound) = bound else {
            return Diagnostic::error(format!(
                "view \"{view}\": {error} and keep the depth order of the model's parts"
            ))
            .help("try `ordering: false` in `energy`, or thicker layers (`front`, `back`)");
        };
        let support =
            &field.supports[self.groups.groups[bound.group as usize].support as usize].name;
        Diagnostic::error(format!(
            "view \"{view}\": {error}; the {limit} depth on {support} contradicts its neighbours (allowed there: {:.5} to {:.5} of the model's depth)",
            bound.lower, bound.upper
        ))
        .help(format!("give {support} a thicker layer (`front`, `back`)"))
    }

    /// What the solids need of this view.
    pub fn relief<'a>(&'a self, relief: &'a Relief) -> ViewRelief<'a> {
        ViewRelief {
            name: &self.view.name,
            map: &self.map,
            groups: &self.groups,
            relief,
        }
    }
}
