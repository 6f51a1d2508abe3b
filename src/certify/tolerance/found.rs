//! The certificate: how far an eye may move, where that ends, and from where two eyes see one object.

use super::rift::Rift;
use crate::geom::{ImagePlane, READING_MM};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Movements of an eye, millimetres to either side; none if no cut would ever open. Of an eye at infinity those of one at the reading
/// distance that turns as far, by 60 degrees at most, and none along the line of sight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Movement {
    /// Along the image's right, which is level.
    pub side: Option<f64>,
    /// Along the image's up.
    pub up: Option<f64>,
    /// Along the line of sight.
    pub fore: Option<f64>,
}

/// By how much an eye at infinity may turn about what it sees, degrees to either side; none if no cut would ever open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rotation {
    pub side: Option<f64>,
    pub up: Option<f64>,
}

impl Rotation {
    /// That of an eye at the reading distance that moves so.
    pub fn of(moved: &Movement) -> Self {
        let turned = |mm: f64| (mm / READING_MM).atan().to_degrees();
        Self {
            side: moved.side.map(turned),
            up: moved.up.map(turned),
        }
    }
}

/// In which direction an eye moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    Side,
    Up,
    Fore,
}

impl Way {
    pub const ALL: [Self; 3] = [Self::Side, Self::Up, Self::Fore];

    /// Unit vector in space.
    pub fn axis(self, plane: &ImagePlane) -> DVec3 {
        match self {
            Self::Side => plane.right,
            Self::Up => plane.up,
            Self::Fore => plane.forward,
        }
    }
}

/// An angle, worked out and measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Confirmed {
    pub predicted_arcmin: f64,
    pub measured_arcmin: f64,
}

/// Where the allowed movement ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorstCut {
    pub movement: Way,
    /// The opening allowed.
    pub angle_arcmin: f64,
    /// How far the eye moved.
    pub moved_mm: f64,
    /// On the nearer piece.
    pub place_mm: [f64; 3],
    /// Of both pieces; the same twice at a tear.
    pub supports: [String; 2],
    /// In the middle of the side, by the closed form and by rays at the finished forest: what opens if the eye moves one way,
    /// and what is hidden if it moves the other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<Confirmed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overlap: Option<Confirmed>,
    #[serde(skip)]
    pub cut: Rift,
}

/// The certificate of one view.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tolerance {
    /// Until the worst cut opens by two arc-minutes.
    pub eye_tolerance_mm: Movement,
    /// Until it opens by ten.
    pub one_picture_mm: Movement,
    /// The same as angles, of an eye at infinity only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye_tolerance_deg: Option<Rotation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_picture_deg: Option<Rotation>,
    /// From the object, from where on an eye sees one picture that was made for an eye at infinity; none if anywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_picture_from_mm: Option<f64>,
    /// From the object, from where two eyes see it as one; none of an eye at infinity.
    pub stereo_distance_mm: Option<f64>,
    pub worst_cuts: Vec<WorstCut>,
}

/// Arc-minutes.
pub(crate) fn arcmin(radians: f64) -> f64 {
    60.0 * radians.to_degrees()
}
