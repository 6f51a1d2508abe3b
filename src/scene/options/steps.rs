//! Whether the surface may fall into pieces, and how.

use crate::scene::defaults;
use crate::scene::language::raw::{RawEnergy, RawPrefer, RawStepOptions, RawSteps};
use crate::scene::resolved::Making;
use crate::scene::text::{Field, Reader};
use crate::steps::{Prefer, StepLimits, StepOptions};

/// Whether the surface may tear, and how; only the normal energy can.
pub(crate) fn steps(
    reader: &mut Reader,
    field: &Field<RawEnergy>,
    pillars: usize,
    making: &Making,
) -> Option<StepOptions> {
    let default = StepOptions {
        narrowest_mm: narrowest(pillars, making),
        ..defaults::STEPS
    };
    let by_default = (pillars >= defaults::STEPS_FROM_PILLARS).then_some(default);
    // What the energy itself lacks is told by `energy`.
    let Field::Given(energy) = field else {
        return by_default;
    };
    let Ok(RawEnergy::Normal(raw)) = &energy.value else {
        return None;
    };
    match reader.given(&raw.steps) {
        None => by_default,
        Some((RawSteps::Never, _)) => None,
        Some((RawSteps::Allowed(raw), _)) => Some(step_options(reader, raw, default)),
    }
}

/// Narrower strips are lost, millimetres. Between pillars the pieces are small, and one line is enough: asking for more makes the error of
/// the reference forest's armadillo 1.7 degrees instead of 1.4 and loses no fewer walls. On other supports strips are as long as the
/// model, and stand free of the support on both sides: what is not printed of them is missed.
fn narrowest(pillars: usize, making: &Making) -> f64 {
    match making.limits.wall {
        Some(wall) if pillars == 0 => wall.limit,
        _ => making.line,
    }
}

fn step_options(reader: &mut Reader, raw: &RawStepOptions, default: StepOptions) -> StepOptions {
    let mut length = |field: &Field<f64>, name: &str, least: f64| {
        reader.length_from(field, name, least).map(|(v, _)| v)
    };
    let limits = StepLimits {
        least_mm: length(&raw.least, "least", 0.01).unwrap_or(default.limits.least_mm),
        highest_mm: length(&raw.highest, "highest", 0.0),
        tolerance_mm: length(&raw.tolerance, "tolerance", 0.01),
    };
    let narrowest_mm = length(&raw.narrowest, "narrowest", 0.0).unwrap_or(default.narrowest_mm);
    let given = limits.highest_mm.zip(reader.given(&raw.highest));
    if let Some((h, (_, span))) = given.filter(|(h, _)| *h < 2.0 * limits.least_mm) {
        reader.error(&span, format!("`highest` is {h} mm, but the least step is {} mm: no step could be printed between them", limits.least_mm));
    }
    let price = reader.number(&raw.price, "price");
    if let Some((value, span)) = price.as_ref().filter(|(v, _)| !(0.01..=1e6).contains(v)) {
        reader.error(
            span,
            format!("`price` is {value}; it may be 0.01 (many steps) to 1000000 (hardly any)"),
        );
    }
    let most = reader.count(&raw.most, "most", 0..=1_000_000);
    let prefer = match reader.given(&raw.prefer) {
        Some((RawPrefer::Tolerance, _)) => Prefer::Tolerance,
        Some((RawPrefer::Camouflage, _)) => Prefer::Camouflage,
        None => default.prefer,
    };
    StepOptions {
        limits,
        most: most.map(|(v, _)| v),
        price: price.map_or(default.price, |(v, _)| v),
        narrowest_mm,
        prefer,
    }
}
