//! What carries reliefs: pillars now; plates, stairs, grooves, waves and meshes are to come as new `SupportKind`s.
//!
//! A support is a closed solid with a name and, if it may carry reliefs, a depth layer. Everything downstream
//! (visibility, groups, solids) asks only for its mesh and for its layer along a ray.

use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};

/// From where a layer is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datum {
    /// The vertical plane through the pillar's axis that faces the eye: a flat slab, the best layer for a pillar.
    AxisPlane,
    /// The first hit of each ray with the support: a shell.
    Surface,
}

/// The room a relief may fill, in millimetres measured along the horizontal direction from the eye to the axis
/// (`AxisPlane`) or along the rays, at the axis's distance (`Surface`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    pub datum: Datum,
    /// How far in front of the datum.
    pub front: f64,
    /// How far behind it.
    pub back: f64,
    /// Material that must be left behind the layer.
    pub core: f64,
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

/// Thickness of relief kept behind the layer's back so that its deepest parts still print: two extrusions of a 0.4 mm nozzle.
const BACKING_MM: f64 = 0.8;
/// Never more than this share of what stands behind the layer, so that the backing stays inside a thin pillar.
const BACKING_SHARE: f64 = 0.45;

/// The layer of one support as one eye meets it: depths along rays, in units of each ray's direction vector.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    eye: DVec3,
    /// Unit, horizontal, from the eye to the support's axis.
    towards: DVec3,
    /// Horizontal distance from the eye to the datum plane, millimetres.
    distance: f64,
    layer: Layer,
    /// How far the support reaches in front of and behind its axis plane, millimetres.
    reach: (f64, f64),
}

impl Slab {
    /// The layer of `support` seen from `eye`; `None` if the support carries nothing or the eye stands on its axis.
    pub fn new(support: &Support, eye: DVec3) -> Option<Self> {
        let layer = support.layer?;
        let SupportKind::Pillar { axis, profile, .. } = &support.kind else {
            return None;
        };
        let offset = *axis - eye.truncate();
        let distance = offset.length();
        let towards = offset.try_normalize()?;
        let along = profile.iter().map(|p| (*p - *axis).dot(towards));
        let reach = along.fold((0.0f64, 0.0f64), |(front, back), d| {
            (front.max(-d), back.max(d))
        });
        Some(Self {
            eye,
            towards: towards.extend(0.0),
            distance,
            layer,
            reach,
        })
    }

    /// Whether the bounds depend on where a ray meets the support.
    pub fn follows_surface(&self) -> bool {
        self.layer.datum == Datum::Surface
    }

    /// Smallest and largest depth a relief may have on a ray; `surface` is the ray's first hit with the support. A shell is the
    /// surface scaled about the eye, by `front` and `back` millimetres at the axis's distance: so its layer is flat over every
    /// flat part of the surface.
    pub fn bounds(&self, direction: DVec3, surface: f64) -> (f64, f64) {
        match self.layer.datum {
            Datum::AxisPlane => (
                self.plane(direction, -self.layer.front),
                self.plane(direction, self.layer.back),
            ),
            Datum::Surface => (
                surface * (1.0 - self.layer.front / self.distance),
                surface * (1.0 + self.layer.back / self.distance),
            ),
        }
    }

    /// Depth on a ray of the plane `offset` millimetres behind the axis plane.
    pub fn plane(&self, direction: DVec3, offset: f64) -> f64 {
        (self.distance + offset) / direction.dot(self.towards)
    }

    /// How far behind the axis plane reliefs end in solid material, millimetres: behind every depth the layer allows.
    pub fn backing(&self) -> f64 {
        self.layer.back + BACKING_MM.min(BACKING_SHARE * self.behind())
    }

    /// How far behind the axis plane a relief may reach, millimetres.
    pub fn deepest(&self) -> f64 {
        self.layer.back
    }

    /// Material left behind the layer's back, millimetres; negative if the layer reaches through the support.
    pub fn behind(&self) -> f64 {
        self.reach.1 - self.layer.back
    }

    /// How far in front of the axis plane either the support or its layer reaches, millimetres.
    pub fn front(&self) -> f64 {
        match self.layer.datum {
            Datum::AxisPlane => self.reach.0.max(self.layer.front),
            Datum::Surface => self.reach.0 + self.layer.front,
        }
    }

    /// How far `p` lies behind the axis plane, millimetres.
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
