//! How well a forest does in every light, in numbers.

use crate::render::caster::{PAPER, SPAN, Term};
use crate::render::stage::{FLASH_LAMP, Lit, SKY_LAMP, SUNS_DEG};
use serde::{Deserialize, Serialize};

/// Variance of a shade below which it counts as the same everywhere: rounding leaves 1e-32, one facet in ten thousand pixels 1e-9.
const FLAT: f64 = 1e-18;

/// How a view looks in one light: the forest against the model. Means of the two sides for a sun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightLikeness {
    /// `sun_15`, `sun_30`, `sun_60`, `overcast` or `flash`.
    pub light: String,
    /// Of the sun above the horizon, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevation_deg: Option<f64>,
    /// Root mean square of the difference of brightness, on the scale of 0 to 255: `217 sqrt(mean (w - g)^2)`.
    pub rmse: f64,
    /// The same with `V = 1` for both: what is left of `rmse` if nothing cast a shadow, the share of the wrong normals.
    pub rmse_unshadowed: f64,
    /// By what the forest would have to be lit more than the model to look most like it: `a = sum w g / sum g^2`.
    /// 1 if the forest is black all over.
    pub gain: f64,
    /// Root mean square of what then remains: `217 sqrt(mean (w - a g)^2)`; an eye adapts to the light.
    pub rmse_fitted: f64,
    /// Pearson's, of `w` and `g`; none if either is the same everywhere.
    pub correlation: Option<f64>,
    /// Share of the pixels that the sun or the flash lights on the model, and that face it but lie in a cast shadow on the forest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub false_shadow_share: Option<f64>,
    /// Share of the pixels that face it but lie in a cast shadow on the model, and that it lights on the forest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lost_shadow_share: Option<f64>,
}

/// All figures of a view, in the order of the sheet's columns.
pub(super) fn figures(pixels: &[[Option<Lit>; 2]]) -> Vec<LightLikeness> {
    let of_lamp = |lamp: usize| {
        let pairs: Vec<LampPixel> = pixels
            .iter()
            .filter_map(|[model, forest]| Some((model.as_ref()?[lamp], forest.map(|f| f[lamp]))))
            .collect();
        Figures::of(&pairs)
    };
    let suns = SUNS_DEG.iter().enumerate().map(|(k, elevation)| {
        let [left, right] = [of_lamp(2 * k), of_lamp(2 * k + 1)];
        LightLikeness {
            elevation_deg: Some(*elevation),
            ..left.mean(&right).named(format!("sun_{elevation:.0}"))
        }
    });
    let sky = LightLikeness {
        false_shadow_share: None,
        lost_shadow_share: None,
        ..of_lamp(SKY_LAMP).named("overcast".into())
    };
    let flash = of_lamp(FLASH_LAMP).named("flash".into());
    suns.chain([sky, flash]).collect()
}

/// One lamp at one pixel: on the model, and on the forest where it is not missed.
type LampPixel = (Term, Option<Term>);

/// The figures of one lamp, as in [`LightLikeness`].
#[derive(Clone, Copy)]
struct Figures {
    rmse: f64,
    rmse_unshadowed: f64,
    gain: f64,
    rmse_fitted: f64,
    correlation: Option<f64>,
    false_shadow: f64,
    lost_shadow: f64,
}

impl Figures {
    fn of(pairs: &[LampPixel]) -> Self {
        let of_forest =
            |pick: fn(&Term) -> f64| move |p: &LampPixel| p.1.as_ref().map_or(PAPER, pick);
        let n = pairs.len().max(1) as f64;
        let rms = |difference: &dyn Fn(&LampPixel) -> f64| {
            SPAN * (pairs.iter().map(|p| difference(p).powi(2)).sum::<f64>() / n).sqrt()
        };
        let share = |of: fn(&Term, &Term) -> bool| {
            let count = pairs
                .iter()
                .filter(|(w, g)| g.as_ref().is_some_and(|g| of(w, g)))
                .count();
            count as f64 / n
        };
        let (free, shade) = (of_forest(|t| t.free), of_forest(Term::shade));
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            pairs.iter().map(|p| of(p.0.shade(), shade(p))).sum()
        };
        let squares = sum(&|_, g| g * g);
        let gain = if squares > 0.0 {
            sum(&|w, g| w * g) / squares
        } else {
            1.0
        };
        let (mean_w, mean_g) = (sum(&|w, _| w) / n, sum(&|_, g| g) / n);
        let spread_w = sum(&|w, _| (w - mean_w).powi(2));
        let spread_g = sum(&|_, g| (g - mean_g).powi(2));
        let common = sum(&|w, g| (w - mean_w) * (g - mean_g));
        Self {
            rmse: rms(&|p| p.0.shade() - shade(p)),
            rmse_unshadowed: rms(&|p| p.0.free - free(p)),
            gain,
            rmse_fitted: rms(&|p| p.0.shade() - gain * shade(p)),
            correlation: (spread_w > FLAT * n && spread_g > FLAT * n)
                .then(|| common / (spread_w * spread_g).sqrt()),
            false_shadow: share(|w, g| w.shade() > 0.0 && g.in_cast_shadow()),
            lost_shadow: share(|w, g| w.in_cast_shadow() && g.shade() > 0.0),
        }
    }

    fn mean(&self, other: &Self) -> Self {
        let mean = |a: f64, b: f64| (a + b) / 2.0;
        Self {
            rmse: mean(self.rmse, other.rmse),
            rmse_unshadowed: mean(self.rmse_unshadowed, other.rmse_unshadowed),
            gain: mean(self.gain, other.gain),
            rmse_fitted: mean(self.rmse_fitted, other.rmse_fitted),
            correlation: match (self.correlation, other.correlation) {
                (Some(a), Some(b)) => Some(mean(a, b)),
                (a, b) => a.or(b),
            },
            false_shadow: mean(self.false_shadow, other.false_shadow),
            lost_shadow: mean(self.lost_shadow, other.lost_shadow),
        }
    }

    fn named(self, light: String) -> LightLikeness {
        LightLikeness {
            light,
            elevation_deg: None,
            rmse: self.rmse,
            rmse_unshadowed: self.rmse_unshadowed,
            gain: self.gain,
            rmse_fitted: self.rmse_fitted,
            correlation: self.correlation,
            false_shadow_share: Some(self.false_shadow),
            lost_shadow_share: Some(self.lost_shadow),
        }
    }
}
