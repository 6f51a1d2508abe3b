//! One view on its way through the stages that concern it alone.

use crate::carve::{ViewRelief, Whole};
use crate::certify::Seen;
use crate::certify::coverage::{Coverage, coverage};
use crate::contest::{Claim, Loss};
use crate::diag::Diagnostic;
use crate::diagram::section::{Section, section};
use crate::groups::{Groups, groups, without};
use crate::mesh::TriMesh;
use crate::mimic::{Depths, Energy, RowKind, SolveError, depths};
use crate::relief::{Relief, relief};
use crate::scene::Scene;
use crate::steps::{StepLine, StepSummary, torn};
use crate::surface::{Surface, surface, torn_surface};
use crate::view::View;
use crate::viewmap::{SupportField, Target, ViewMap, view_map};
use crate::whole::{Bounded, Crossings, crossings, moved, whole};

/// One view before optimisation.
pub struct Sight<'a> {
    pub view: &'a View,
    pub target: Target,
    pub map: ViewMap,
    pub groups: Groups,
    /// Cells left to other views, rising.
    pub lost: Vec<Loss>,
}

/// One view after it.
pub struct Shape {
    pub depths: Depths,
    pub relief: Relief,
    /// Where the surface was torn, if it might be.
    pub steps: Option<(Vec<StepLine>, StepSummary)>,
    /// The mesh as it is built, if it stays whole.
    pub whole: Option<TriMesh>,
    /// What crosses in the surface before it is cut, if the whole mesh was optimised.
    pub crossings: Option<Crossings>,
    /// The surface before it was cut, if it is wanted.
    pub surface: Option<Surface>,
    /// The groups cut open, if that is wanted.
    pub section: Option<Section>,
}

/// Warnings of iterations that did not converge.
pub fn unsettled(sights: &[Sight], shapes: &[Shape]) -> Vec<Diagnostic> {
    let views = sights.iter().zip(shapes);
    let warning = |(sight, shape): (&Sight, &Shape)| {
        let text = shape.depths.iterated.as_ref()?.warning()?;
        Some(
            Diagnostic::warning(format!("view \"{}\": {text}", sight.view.name)).help(
                "`iterate: 0` is the paper's own energy; iterating works for small, regular meshes",
            ),
        )
    };
    views.filter_map(warning).collect()
}

/// Projects, maps and groups one view; of meshes that stay whole so much is `bounded`.
///
/// # Errors
/// If the models do not lie before the eye, nothing of them is seen, or no support carries them.
pub fn see<'a>(
    view: &'a View,
    field: &SupportField,
    bounded: Option<Bounded>,
) -> Result<Sight<'a>, Vec<Diagnostic>> {
    let failed = |text: String| vec![Diagnostic::error(format!("view \"{}\": {text}", view.name))];
    let plane = view.plane();
    let target = Target::new(view.target(), &plane)
        .ok_or_else(|| failed("part of its models lies beside or behind the eye".into()))?
        .marked(view.marks());
    let map = view_map(plane, &target, field).map_err(|e| failed(e.to_string()))?;
    let groups = groups(&view.name, &map, &target, field)?;
    if groups.groups.is_empty() {
        return Err(failed(
            "no pillar stands behind or in its models, so nothing of them can appear".into(),
        ));
    }
    let groups = match bounded {
        Some(bounded) => whole(&view.name, &map, &target, field, groups, bounded)?,
        None => groups,
    };
    Ok(Sight {
        view,
        target,
        map,
        groups,
        lost: Vec::new(),
    })
}

impl Sight<'_> {
    /// What the view wants of the supports.
    pub fn claim(&self) -> Claim<'_> {
        Claim {
            name: &self.view.name,
            map: &self.map,
            groups: &self.groups,
        }
    }

    /// What certificates need of the view.
    pub fn seen(&self) -> Seen<'_> {
        Seen {
            view: self.view,
            target: &self.target,
            map: &self.map,
            groups: &self.groups,
            lost: &self.lost,
        }
    }

    /// What of the models a support carries, and why the rest is not. `given_up` are cells without relief in the solid.
    pub fn coverage(&self, scene: &Scene, field: &SupportField, given_up: &[u32]) -> Coverage {
        let views: Vec<&str> = scene.views.iter().map(|v| v.name.as_str()).collect();
        coverage(&self.seen(), &views, field, given_up)
    }

    /// Leaves cells to other views.
    ///
    /// # Errors
    /// If nothing is left.
    pub fn give_up(&mut self, lost: Vec<Loss>, field: &SupportField) -> Result<(), Diagnostic> {
        if lost.is_empty() {
            return Ok(());
        }
        let cells: Vec<u32> = lost.iter().map(|l| l.cell).collect();
        self.groups = without(&self.groups, &cells, &self.map, &self.target, field);
        self.lost = lost;
        if self.groups.groups.is_empty() {
            return Err(Diagnostic::error(format!(
                "view \"{}\": other views own every place where its models could appear",
                self.view.name
            ))
            .help("move pillars or models apart, or try `contested: Largest`"));
        }
        Ok(())
    }

    /// Optimises, cuts and scales back. A surface with free vertices stays in one piece: tears are found within a layer.
    pub fn shape(&self, scene: &Scene, field: &SupportField) -> Result<Shape, Vec<Diagnostic>> {
        let Self {
            target,
            map,
            groups,
            ..
        } = self;
        let explained = |e| vec![self.explain(e, field)];
        let (wanted, opened) = (scene.output.surface, scene.output.groups);
        let whole = |torn: bool| (&target.mesh, torn);
        let steps = scene.steps.as_ref().filter(|_| target.free.is_empty());
        if let (Energy::Normal(options), Some(steps)) = (scene.energy, steps) {
            let torn = torn(steps, options, target, map, field, groups);
            // Its rows belong to the cut mesh: only the kind of failure is told.
            let torn = torn.map_err(|e| explained(e.without_row()))?;
            let seen = (&torn.map, &torn.target, field);
            let relief = relief(&torn.map, &torn.target, field, &torn.groups, &torn.depths);
            return Ok(Shape {
                surface: wanted.then(|| torn_surface(self.view, &torn)),
                section: opened
                    .then(|| section(seen, &torn.groups, &torn.depths, &relief, whole(true))),
                relief,
                depths: torn.depths,
                steps: Some((torn.lines, torn.summary)),
                whole: None,
                crossings: None,
            });
        }
        let depths = depths(scene.energy, target, map, groups).map_err(explained)?;
        let relief = relief(map, target, field, groups, &depths);
        let seen = (map, target, field);
        let all_of_it = groups.whole || matches!(scene.energy, Energy::Curvature(_));
        let mesh = all_of_it.then(|| moved(target, self.view.eye, &depths));
        Ok(Shape {
            crossings: mesh.as_ref().map(|m| crossings(target, m, &depths)),
            whole: mesh.filter(|_| groups.whole),
            surface: wanted.then(|| surface(self.view, groups, &depths)),
            section: opened.then(|| section(seen, groups, &depths, &relief, whole(false))),
            relief,
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

    /// What the solids need of a view whose mesh stays whole.
    pub fn joined<'a>(&'a self, shape: &'a Shape) -> Option<Whole<'a>> {
        let mesh = shape.whole.as_ref()?;
        Some(Whole {
            name: &self.view.name,
            support: self.groups.groups[0].support,
            mesh,
        })
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
