//! How well a forest shows its target, in numbers.

use glam::DVec3;
use serde::Serialize;

/// How well the forest shows its target, over the pixels whose ray meets the target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Likeness {
    /// Share of them whose ray meets the forest at all.
    pub hit: f64,
    /// Angle between the normals of target and forest in degrees; 90 where the forest is missed.
    pub mean_deg: f64,
    pub median_deg: f64,
    pub p90_deg: f64,
    pub pixels: usize,
}

impl Likeness {
    /// The mean of the rays that meet the forest: what of the target is missing is told as that.
    pub fn mean_of_hits_deg(&self) -> f64 {
        (self.mean_deg - MISSED_DEG * (1.0 - self.hit)) / self.hit.max(1e-9)
    }
}

/// What a ray counts that misses the forest.
pub(super) const MISSED_DEG: f64 = 90.0;

/// Of the errors in degrees of all pixels whose ray meets the target, `hits` of which meet the forest too.
pub(super) fn likeness(errors: &[f64], hits: usize) -> Likeness {
    let mut sorted = errors.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = sorted.len().max(1) as f64;
    Likeness {
        hit: hits as f64 / n,
        mean_deg: sorted.iter().sum::<f64>() / n,
        median_deg: percentile(&sorted, 0.5),
        p90_deg: percentile(&sorted, 0.9),
        pixels: sorted.len(),
    }
}

/// Linear between neighbouring ranks; 0 of nothing.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return 0.0;
    };
    let rank = share * last as f64;
    let (low, part) = (rank.floor() as usize, rank.fract());
    sorted[low] + part * (sorted[(low + 1).min(last)] - sorted[low])
}

/// Exact for small angles, unlike the arc cosine; 90 if either is no direction.
pub fn angle_deg(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO {
        90.0
    } else {
        a.cross(b).length().atan2(a.dot(b)).to_degrees()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missed_does_not_count_as_turned() {
        let found = likeness(&[90.0, 2.0, 90.0, 4.0], 2);
        assert_eq!(found.mean_deg, 46.5);
        assert_eq!(found.mean_of_hits_deg(), 3.0);
        assert_eq!(likeness(&[90.0], 0).mean_of_hits_deg(), 0.0);
    }
}
