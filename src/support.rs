//! What carries reliefs: pillars, and bodies of any other form (plates, stairs, grooves, waves, meshes).
//!
//! A support is a closed solid with a name and, if it may carry reliefs, a depth layer. Everything downstream
//! (visibility, groups, solids) asks only for its mesh and for its layer along a ray.

use crate::geom::narrowest;
use crate::index::FaceId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};

/// From where a layer is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datum {
    /// A plane: of a pillar the vertical one through its axis that faces the eye, the best layer for a pillar; of a body its face.
    Plane,
    /// The first hit of each ray with the support: a shell.
    Surface,
}

/// From where a layer is measured, and where it ends. Millimetres square to the datum for a plane; for the others along the rays, on
/// pillars at the axis's distance, on bodies at the distance of their farthest point, so that it is at most as much everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Up to `back` behind a [`Datum::Plane`].
    Plane { back: f64 },
    /// Up to `back` behind a [`Datum::Surface`].
    Surface { back: f64 },
    /// From a [`Datum::Surface`] through the wall behind it, up to the layer's core before rays leave that.
    Wall,
}

impl Extent {
    /// Up to `back` millimetres behind a datum.
    pub fn behind(datum: Datum, back: f64) -> Self {
        match datum {
            Datum::Plane => Self::Plane { back },
            Datum::Surface => Self::Surface { back },
        }
    }
}

/// The room a relief may fill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    pub extent: Extent,
    /// How far in front of the datum, millimetres as in [`Extent`].
    pub front: f64,
    /// Material that must be left behind the layer, millimetres.
    pub core: f64,
    /// Whether the outline of every component of the model must lie on the datum, to [`HULL_MM`] (paper Figs 12 and 17).
    pub hull: bool,
}

impl Layer {
    pub fn datum(&self) -> Datum {
        match self.extent {
            Extent::Plane { .. } => Datum::Plane,
            Extent::Surface { .. } | Extent::Wall => Datum::Surface,
        }
    }

    /// How far behind the datum it reaches, millimetres; of a wall, where it is too thin for a core and reliefs only stand on it.
    pub fn back(&self) -> f64 {
        match self.extent {
            Extent::Plane { back } | Extent::Surface { back } => back,
            Extent::Wall => SUNK_MM,
        }
    }

    pub fn goes_through(&self) -> bool {
        matches!(self.extent, Extent::Wall)
    }

    /// The same layer with lengths changed; a wall has no `back`.
    pub fn resized(self, front: f64, back: f64, core: f64) -> Self {
        let extent = match self.extent {
            Extent::Plane { .. } => Extent::Plane { back },
            Extent::Surface { .. } => Extent::Surface { back },
            Extent::Wall => Extent::Wall,
        };
        Self {
            extent,
            front,
            core,
            ..self
        }
    }
}

/// How exactly an outline lies on its datum, millimetres: what a printer cannot show, and room enough for a solver.
pub const HULL_MM: f64 = 0.05;
/// A layer that ends less than this behind its datum is not carved into its body: reliefs only stand on it. They begin a little
/// inside, or their edges would touch the body in a line.
pub const SUNK_MM: f64 = 0.05;

/// A plane with its outward side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    pub point: DVec3,
    /// Unit.
    pub normal: DVec3,
}

/// Where a ray meets a support, in units of its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hits {
    /// Where it first meets it.
    pub first: f64,
    /// Where it leaves the wall behind that, if the layer goes through it there.
    pub leaves: Option<f64>,
}

impl Hits {
    /// The first hit alone.
    pub fn at(first: f64) -> Self {
        Self {
            first,
            leaves: None,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum SupportKind {
    /// An upright prism. `profile` is a simple polygon in the ground plane, world coordinates, counter-clockwise.
    Pillar {
        axis: DVec2,
        profile: Vec<DVec2>,
        bottom: f64,
        top: f64,
        round: bool,
    },
    /// The slab the pillars stand on. `outline` as a pillar's profile.
    Base {
        outline: Vec<DVec2>,
        bottom: f64,
        top: f64,
    },
    /// Any other closed solid.
    Body {
        /// Seen from above: convex, counter-clockwise.
        outline: Vec<DVec2>,
        /// What a layer with [`Datum::Plane`] is measured from.
        face: Option<Face>,
        /// Parts of the surface whose reliefs have scales of their own; index: face of the mesh.
        parts: Vec<u32>,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    pub name: String,
    pub kind: SupportKind,
    /// `None`: carries nothing (the base).
    pub layer: Option<Layer>,
    /// Closed, outward oriented.
    pub mesh: TriMesh,
}

/// The least width of a pillar, millimetres; a round one is as wide as the circle that its outline stands for.
pub fn pillar_width(axis: DVec2, profile: &[DVec2], round: bool) -> f64 {
    let across = |p: &DVec2| 2.0 * p.distance(axis);
    match round {
        true => profile.iter().map(across).fold(0.0, f64::max),
        false => narrowest(profile),
    }
}

impl Support {
    /// The part of its surface that a face of its mesh belongs to.
    pub fn part(&self, face: FaceId) -> u32 {
        match &self.kind {
            SupportKind::Body { parts, .. } => parts[face],
            SupportKind::Pillar { .. } | SupportKind::Base { .. } => 0,
        }
    }

    /// Seen from above: simple, counter-clockwise.
    pub fn outline(&self) -> &[DVec2] {
        match &self.kind {
            SupportKind::Pillar { profile, .. } => profile,
            SupportKind::Base { outline, .. } | SupportKind::Body { outline, .. } => outline,
        }
    }

    /// What to call it where its own name is not enough.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            SupportKind::Pillar { .. } => "pillar",
            SupportKind::Base { .. } => "base",
            SupportKind::Body { .. } => "support",
        }
    }

    pub fn is_body(&self) -> bool {
        matches!(self.kind, SupportKind::Body { .. })
    }
}

/// Thickness of relief kept behind the layer's back so that its deepest parts still print: two extrusions of a 0.4 mm nozzle.
const BACKING_MM: f64 = 0.8;
/// Never more than this share of what stands behind the layer, so that the backing stays inside a thin pillar.
const BACKING_SHARE: f64 = 0.45;

/// What is carved out before a relief begins no nearer to the eye than this share of the way to its support leaves.
const NEAREST: f64 = 0.95;

/// Eyes that stand inside of the box around a body count as this far from it: its core then is more than it must be.
const NEAREST_EYE_MM: f64 = 10.0;

/// The layer of one support as one eye meets it: depths along rays, in units of each ray's direction vector.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    eye: DVec3,
    /// Unit, away from the eye: square to the datum plane; for a shell towards the middle of the support.
    towards: DVec3,
    /// Distance from the eye to the datum plane (of a shell: to the plane through its middle), millimetres.
    distance: f64,
    layer: Layer,
    /// How far the support reaches in front of and behind its datum plane, millimetres.
    reach: (f64, f64),
    carrier: Carrier,
}

/// What a slab belongs to. Along rays a pillar measures at its axis.
#[derive(Clone, Copy, Debug)]
enum Carrier {
    Pillar,
    Body {
        /// Distance at which a shell is as thick as its layer says, millimetres.
        measure: f64,
        /// No part of the body is nearer to the eye than this, millimetres: here a core is as thick as its layer says.
        nearest: f64,
    },
}

impl Slab {
    /// The layer of `support` seen from `eye`; `None` if the support carries nothing or turns its back to the eye.
    pub fn new(support: &Support, eye: DVec3) -> Option<Self> {
        let layer = support.layer?;
        match &support.kind {
            SupportKind::Base { .. } => None,
            SupportKind::Pillar { axis, profile, .. } => {
                let offset = *axis - eye.truncate();
                let towards = offset.try_normalize()?;
                let distance = offset.length();
                let along = profile.iter().map(|p| (*p - *axis).dot(towards));
                Some(Self {
                    eye,
                    towards: towards.extend(0.0),
                    distance,
                    layer,
                    reach: reach(along),
                    carrier: Carrier::Pillar,
                })
            }
            SupportKind::Body { face, .. } => {
                let face = face.filter(|_| layer.datum() == Datum::Plane);
                let (lo, hi) = support.mesh.bounds()?;
                let middle = (lo + hi) / 2.0;
                let (point, towards) = match face {
                    Some(face) => (face.point, -face.normal),
                    None => (middle, (middle - eye).try_normalize()?),
                };
                let distance = (point - eye).dot(towards);
                let along = support.mesh.vertices.iter();
                let slab = Self {
                    eye,
                    towards,
                    distance,
                    layer,
                    reach: reach(along.map(|v| (*v - point).dot(towards))),
                    carrier: Carrier::Body {
                        measure: farthest(&support.mesh, eye),
                        nearest: eye.distance(eye.clamp(lo, hi)).max(NEAREST_EYE_MM),
                    },
                };
                (distance > layer.front).then_some(slab)
            }
        }
    }

    /// Angle between a ray and the way to the support (square to the datum plane, if there is one), radians.
    pub fn angle_to(&self, direction: DVec3) -> f64 {
        direction.angle_between(self.towards)
    }

    /// Whether the bounds depend on where a ray meets the support.
    pub fn follows_surface(&self) -> bool {
        self.layer.datum() == Datum::Surface
    }

    /// Whether the layer reaches through the wall behind a ray's first hit.
    pub fn goes_through(&self) -> bool {
        self.layer.goes_through()
    }

    /// Distance at which a shell is as thick as its layer says, millimetres.
    fn measure(&self) -> f64 {
        match self.carrier {
            Carrier::Pillar => self.distance,
            Carrier::Body { measure, .. } => measure,
        }
    }

    /// Distance at which a core is as thick as its layer says, millimetres.
    fn nearest(&self) -> f64 {
        match self.carrier {
            Carrier::Pillar => self.distance,
            Carrier::Body { nearest, .. } => nearest,
        }
    }

    fn is_on_body(&self) -> bool {
        matches!(self.carrier, Carrier::Body { .. })
    }

    /// Whether a wall has room for its core and something to carve before it.
    pub fn has_room(&self, first: f64, leaves: f64) -> bool {
        self.before_core(leaves) >= first * (1.0 + SUNK_MM / self.measure())
    }

    /// Depth at which the core of a wall begins that the ray leaves at `leaves`.
    fn before_core(&self, leaves: f64) -> f64 {
        leaves * (1.0 - self.layer.core / self.nearest())
    }

    /// Smallest and largest depth a relief may have on a ray that meets the support there. A shell is the
    /// surface scaled about the eye, by `front` and `back` millimetres at the axis's distance: so its layer is flat over every
    /// flat part of the surface. One that goes through walls ends `core` before rays leave them, measured at its nearest point; where
    /// they are too thin for that reliefs only stand on them.
    pub fn bounds(&self, direction: DVec3, hits: Hits) -> (f64, f64) {
        match self.layer.datum() {
            Datum::Plane => (
                self.plane(direction, -self.layer.front),
                self.plane(direction, self.layer.back()),
            ),
            Datum::Surface => (
                hits.first * (1.0 - self.layer.front / self.measure()),
                self.back_of_shell(hits),
            ),
        }
    }

    /// How far a point at this depth lies behind the datum as the layer measures it, millimetres; negative in front.
    pub fn behind_datum(&self, direction: DVec3, surface: f64, depth: f64) -> f64 {
        match self.layer.datum() {
            Datum::Plane => depth * direction.dot(self.towards) - self.distance,
            Datum::Surface => (depth / surface - 1.0) * self.measure(),
        }
    }

    fn back_of_shell(&self, hits: Hits) -> f64 {
        let behind = |mm: f64| hits.first * (1.0 + mm / self.measure());
        match hits.leaves {
            Some(leaves) => self.before_core(leaves),
            None => behind(self.layer.back()),
        }
    }

    /// Factor from the farthest depth that the layer allows on a ray to `before` millimetres before the datum.
    pub fn before_datum(&self, before: f64) -> f64 {
        let from = match self.layer.datum() {
            Datum::Plane => self.distance,
            Datum::Surface => self.measure(),
        };
        (from - before) / (from + self.layer.back())
    }

    /// Material that must be left of the support, millimetres.
    pub fn core(&self) -> f64 {
        self.layer.core
    }

    /// Whether outlines of the model are to lie on the datum.
    pub fn draws(&self) -> bool {
        self.layer.hull
    }

    /// Smallest and largest depth at which an outline lies on the datum, if it is to lie there.
    pub fn on_datum(&self, direction: DVec3, hits: Hits) -> Option<(f64, f64)> {
        let (near, far) = self.bounds(direction, hits);
        let at = |offset: f64| match self.layer.datum() {
            Datum::Plane => self.plane(direction, offset),
            Datum::Surface => hits.first * (1.0 + offset / self.measure()),
        };
        self.layer
            .hull
            .then(|| (at(-HULL_MM).max(near), at(HULL_MM).min(far)))
    }

    /// Whether reliefs are carved into the support or only stand on it.
    pub fn is_carved(&self) -> bool {
        !self.is_on_body() || self.layer.back() > SUNK_MM || self.goes_through()
    }

    /// Whether reliefs follow a body of any form: then nothing about them is flat but within a facet.
    pub fn is_shell(&self) -> bool {
        self.is_on_body() && self.follows_surface()
    }

    /// Depth on a ray at which a shell's reliefs end in solid material (`share` 1) or part of the way from the layer's back to there.
    pub fn shell_backing(&self, hits: Hits, share: f64) -> f64 {
        let backing = BACKING_MM.min(BACKING_SHARE * self.layer.core);
        self.back_of_shell(hits) * (1.0 + share * backing / self.measure())
    }

    /// Depth on a ray of the plane `offset` millimetres behind the datum plane.
    pub fn plane(&self, direction: DVec3, offset: f64) -> f64 {
        (self.distance + offset) / direction.dot(self.towards)
    }

    /// How far behind the datum plane reliefs end in solid material, millimetres: behind every depth the layer allows.
    pub fn backing(&self) -> f64 {
        self.layer.back() + BACKING_MM.min(BACKING_SHARE * self.behind())
    }

    /// How far behind the datum plane a relief may reach, millimetres.
    pub fn deepest(&self) -> f64 {
        self.layer.back()
    }

    /// Material left behind the layer's back, millimetres; negative if the layer reaches through the support.
    pub fn behind(&self) -> f64 {
        self.reach.1 - self.layer.back()
    }

    /// How far in front of the datum plane either the support or its layer reaches, millimetres.
    pub fn front(&self) -> f64 {
        match self.layer.datum() {
            Datum::Plane => self.reach.0.max(self.layer.front),
            Datum::Surface => (self.reach.0 + self.layer.front).min(NEAREST * self.distance),
        }
    }

    /// How far behind the datum plane neither the support nor its layer reaches, millimetres.
    pub fn beyond(&self) -> f64 {
        self.reach.1 + self.layer.back()
    }

    /// How far `p` lies behind the datum plane, millimetres.
    pub fn offset(&self, p: DVec3) -> f64 {
        (p - self.eye).dot(self.towards) - self.distance
    }

    /// `p` moved `by` millimetres away from the eye, horizontally.
    pub fn moved(&self, p: DVec3, by: f64) -> DVec3 {
        p + by * self.towards
    }

    /// `p` moved sideways to the vertical plane through eye and axis.
    pub fn onto_axis(&self, p: DVec3) -> DVec3 {
        let sideways = self.towards.cross(DVec3::Z);
        p - (p - self.eye).dot(sideways) * sideways
    }
}

/// How far depths along a direction go in front of 0 and behind it.
fn reach(along: impl Iterator<Item = f64>) -> (f64, f64) {
    along.fold((0.0f64, 0.0f64), |(front, back), d| {
        (front.max(-d), back.max(d))
    })
}

/// Distance of the farthest point that an eye may see of a closed mesh, millimetres.
fn farthest(mesh: &TriMesh, eye: DVec3) -> f64 {
    let seen = |f: &FaceId| mesh.area_vector(*f).dot(eye - mesh.corners(*f)[0]) > 0.0;
    let corners = FaceId::all(mesh.faces.len())
        .filter(seen)
        .flat_map(|f| mesh.corners(f));
    corners.map(|p| p.distance(eye)).fold(0.0, f64::max)
}
