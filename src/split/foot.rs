//! Where a pillar meets its plate: peg, socket, key.
//!
//! The peg is the pillar itself, gone on into the base: it prints standing on its flat end without anything hanging over. One side
//! of it, the key, leans inwards towards the end, so that it goes in one way round only; the socket has the same ramp. Sockets are
//! wider than pegs by the clearance all round, and as deep: the peg stands on the socket's floor.

use crate::carve::boolean::{Boolean, BooleanError};
use crate::geom::rings::{Rings, widened};
use crate::geom::{Circle, inscribed};
use crate::support::{Support, SupportKind};
use glam::DVec2;

/// How much slimmer the peg is than the pillar, and the pillar below the plate's top than above, millimetres: walls of operands
/// must not coincide. Far below a printed line.
const SLIM_MM: f64 = 0.05;
/// Reach of the key at the peg's end, as a share of the pillar's: less weakens the peg, more lets it turn in its socket.
const KEY_SHARE: f64 = 0.6;
/// Steepest lean of the key, as run over rise: what prints without supports.
const KEY_LEAN: f64 = 0.9;
/// The key starts this far outside of the pillar at the plate's top, millimetres.
const KEY_START_MM: f64 = 0.05;
/// How far a peg reaches up into a pillar that does not reach down to it, millimetres.
const JOINT_MM: f64 = 0.5;
/// More than any pillar's height or width, millimetres.
const FAR_MM: f64 = 1e4;

/// The foot of one pillar. Coordinates are those of the forest minus an origin.
#[derive(Clone, Debug)]
pub struct Foot {
    pub profile: Vec<DVec2>,
    /// Depth of the socket below the plate's top (z = 0), millimetres.
    pub depth: f64,
    /// How far the pillar itself reaches below it.
    sunk: f64,
    /// Unit, towards the key, and the key's distance from the axis at the end and at the top.
    way: DVec2,
    axis: DVec2,
    key: (f64, f64),
}

impl Foot {
    /// The foot of a pillar; `None` for what is none.
    pub fn new(support: &Support, origin: DVec2, depth: f64) -> Option<Self> {
        let SupportKind::Pillar {
            axis,
            profile,
            bottom,
            ..
        } = &support.kind
        else {
            return None;
        };
        let far = profile.iter().copied().reduce(|a, b| {
            if b.distance(*axis) > a.distance(*axis) + 1e-9 {
                b
            } else {
                a
            }
        })?;
        let reach = far.distance(*axis);
        let top = reach + KEY_START_MM;
        Some(Self {
            profile: profile.iter().map(|p| *p - origin).collect(),
            depth,
            sunk: -bottom,
            way: (far - *axis).normalize_or(DVec2::X),
            axis: *axis - origin,
            key: ((KEY_SHARE * reach).max(top - KEY_LEAN * depth), top),
        })
    }

    fn ring(&self) -> Rings {
        vec![self.profile.iter().map(DVec2::to_array).collect()]
    }

    /// The pillar's outline widened by `by` (or narrowed), millimetres.
    pub fn outline(&self, by: f64) -> Rings {
        widened(&self.ring(), by)
    }

    /// A carved pillar with what lies below the plate's top replaced by the peg.
    ///
    /// # Errors
    /// If the boolean library refuses an operand.
    pub fn pegged(&self, carved: &Boolean) -> Result<Boolean, BooleanError> {
        let sunk = self.sunk / 2.0;
        let stays = Boolean::upright(&self.outline(-SLIM_MM), -sunk, 1.0)?;
        let below = Boolean::cuboid(
            DVec2::splat(-FAR_MM).extend(-FAR_MM),
            DVec2::splat(FAR_MM).extend(0.0),
        )?;
        // A pillar that ends at the plate's top is held from inside.
        let joint = if sunk > 0.0 { -sunk / 2.0 } else { JOINT_MM };
        let peg = Boolean::upright(&self.outline(-2.0 * SLIM_MM), -self.depth, joint)?;
        carved
            .minus(&below.minus(&stays)?)?
            .plus(&peg)?
            .minus(&self.beyond_key(0.0)?)
    }

    /// What is taken out of a plate.
    ///
    /// # Errors
    /// If the boolean library refuses an operand.
    pub fn socket(&self, clearance: f64) -> Result<Boolean, BooleanError> {
        Boolean::upright(&self.outline(clearance), -self.depth, 1.0)?
            .minus(&self.beyond_key(clearance)?)
    }

    /// The wedge beyond the key moved outwards by `clearance`.
    fn beyond_key(&self, clearance: f64) -> Result<Boolean, BooleanError> {
        let (end, top) = self.key;
        let lean = (top - end) / self.depth;
        let out = clearance * lean.hypot(1.0);
        // Below the end, at the plate's top.
        let levels = [(-self.depth - 1.0, end - lean), (0.0, top)];
        let points = levels.iter().flat_map(|(z, at)| {
            let side = FAR_MM / 10.0;
            [
                (*at + out, -side),
                (*at + out, side),
                (side, -side),
                (side, side),
            ]
            .map(|(along, across)| {
                (self.axis + along * self.way + across * self.way.perp()).extend(*z)
            })
        });
        Boolean::hull(&points.collect::<Vec<_>>())
    }

    /// Where the key crosses the pillar's outline at the peg's end.
    pub fn key_line(&self) -> Option<[DVec2; 2]> {
        let ring = self.ring();
        let sides = self.clipped(&ring[0]);
        let on = |p: &DVec2| (self.beyond(*p)).abs() < 1e-9;
        sides.into_iter().find(|s| s.iter().all(on))
    }

    /// How far a point lies beyond the key at the peg's end, millimetres.
    fn beyond(&self, p: DVec2) -> f64 {
        (p - self.axis).dot(self.way) - self.key.0
    }

    /// The largest circle in the peg's end.
    pub fn end(&self) -> Option<Circle> {
        let rings = self.outline(-2.0 * SLIM_MM);
        let sides: Vec<[DVec2; 2]> = rings.iter().flat_map(|r| self.clipped(r)).collect();
        inscribed(&sides, 0.01, f64::INFINITY)
    }

    /// The sides of a ring on this side of the key's end.
    fn clipped(&self, ring: &[[f64; 2]]) -> Vec<[DVec2; 2]> {
        let mut points = Vec::new();
        for (k, a) in ring.iter().enumerate() {
            let (a, b) = (DVec2::from(*a), DVec2::from(ring[(k + 1) % ring.len()]));
            let (da, db) = (self.beyond(a), self.beyond(b));
            if da <= 0.0 {
                points.push(a);
            }
            if (da <= 0.0) != (db <= 0.0) {
                points.push(a.lerp(b, da / (da - db)));
            }
        }
        let n = points.len();
        (0..n).map(|k| [points[k], points[(k + 1) % n]]).collect()
    }
}
