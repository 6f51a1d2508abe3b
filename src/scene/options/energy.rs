//! The small sections of a scene: energy, printer, output.

use crate::contest::Contested;
use crate::mimic::{
    CurvatureForm, CurvatureOptions, Energy, FaceWeight, GradientOptions, NormalOptions,
};
use crate::scene::defaults;
use crate::scene::language::raw::{
    RawContested, RawCurvature, RawCurvatureForm, RawEnergy, RawOutput, RawPrefer, RawPrinter,
    RawStepOptions, RawSteps, RawWeight,
};
use crate::scene::resolved::{Output, Printer};
use crate::scene::text::reader::Reader;
use crate::scene::text::spanned::Field;
use crate::steps::{Prefer, StepLimits, StepOptions};

/// What is minimised, and how.
pub fn energy(reader: &mut Reader, field: &Field<RawEnergy>) -> Energy {
    match reader.given(field).map(|(energy, _)| energy) {
        None => defaults::ENERGY,
        Some(RawEnergy::Normal(raw)) => {
            let weight = match reader.given(&raw.weight) {
                Some((RawWeight::Area, _)) => FaceWeight::Area,
                Some((RawWeight::SolidAngle, _)) => FaceWeight::SolidAngle,
                None => defaults::NORMAL.weight,
            };
            Energy::Normal(NormalOptions {
                weight,
                ordering: flag(reader, &raw.ordering, defaults::NORMAL.ordering),
                reweight: reader
                    .count(&raw.reweight, "reweight", defaults::REWEIGHT)
                    .map_or(defaults::NORMAL.reweight, |(v, _)| v),
            })
        }
        Some(RawEnergy::Curvature(raw)) => Energy::Curvature(curvature(reader, raw)),
        Some(RawEnergy::Linear) => Energy::Linear,
        Some(RawEnergy::Gradient(raw)) => {
            let compression = reader.within(&raw.compression, "compression", defaults::COMPRESSION);
            Energy::Gradient(GradientOptions {
                compression: compression.map_or(defaults::GRADIENT.compression, |(v, _)| v),
            })
        }
    }
}

fn curvature(reader: &mut Reader, raw: &RawCurvature) -> CurvatureOptions {
    let under = defaults::CURVATURE;
    let hidden_weight = reader.number(&raw.hidden_weight, "hidden_weight");
    if let Some((value, span)) = hidden_weight
        .as_ref()
        .filter(|(v, _)| !(1e-6..=1.0).contains(v))
    {
        reader.error(span, format!("`hidden_weight` is {value}; visible vertices count 1, hidden ones from 0.000001 to 1"));
    }
    let scale_invariant = flag(reader, &raw.scale_invariant, under.scale_invariant);
    let iterate = reader.count(&raw.iterate, "iterate", defaults::ITERATE);
    let rounds = iterate.as_ref().filter(|(rounds, _)| *rounds > 0);
    if let Some((_, span)) = rounds.filter(|_| !scale_invariant) {
        reader.error(span, "`iterate` wants normals, whatever the scale: it goes with `scale_invariant: true` only");
    }
    let form = match reader.given(&raw.form) {
        Some((RawCurvatureForm::Quadratic, _)) => CurvatureForm::Quadratic,
        Some((RawCurvatureForm::Conic, _)) => CurvatureForm::Conic,
        None => under.form,
    };
    CurvatureOptions {
        hidden_weight: hidden_weight.map_or(under.hidden_weight, |(v, _)| v),
        ordering: flag(reader, &raw.ordering, under.ordering),
        scale_invariant,
        group_scales: flag(reader, &raw.group_scales, under.group_scales),
        mean_curvature: flag(reader, &raw.mean_curvature, under.mean_curvature),
        iterate: iterate.map_or(under.iterate, |(v, _)| v),
        form,
    }
}

/// Whether the surface may tear, and how; only the normal energy can.
pub fn steps(
    reader: &mut Reader,
    field: &Field<RawEnergy>,
    pillars: usize,
    printer: &Printer,
) -> Option<StepOptions> {
    let default = StepOptions {
        narrowest_mm: printer.nozzle,
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

fn flag(reader: &mut Reader, field: &Field<bool>, default: bool) -> bool {
    reader.given(field).map_or(default, |(value, _)| *value)
}

/// Who gets surface that two views want.
pub fn contested(reader: &mut Reader, field: &Field<RawContested>) -> Contested {
    match reader.given(field) {
        Some((RawContested::First, _)) => Contested::First,
        Some((RawContested::Largest, _)) => Contested::Largest,
        Some((RawContested::Error, _)) => Contested::Error,
        None => defaults::CONTESTED,
    }
}

/// The printer the checks have in mind.
pub fn printer(reader: &mut Reader, field: &Field<RawPrinter>) -> Printer {
    let Some((raw, _)) = reader.given(field) else {
        return defaults::PRINTER;
    };
    let nozzle = reader
        .length_from(&raw.nozzle, "nozzle", 0.05)
        .map_or(defaults::PRINTER.nozzle, |(v, _)| v);
    let clearance = reader
        .length_from(&raw.clearance, "clearance", 0.0)
        .map_or(defaults::PRINTER.clearance, |(v, _)| v);
    let bed = reader.point_field(&raw.bed, "bed");
    if let Some((_, span)) = bed.as_ref().filter(|(b, _)| b.iter().any(|v| *v < 10.0)) {
        reader.error(
            span,
            "`bed` is the printer's width, depth and height: each at least 10 mm",
        );
    }
    Printer {
        nozzle,
        bed: bed.map_or(defaults::PRINTER.bed, |(b, _)| b),
        clearance,
    }
}

/// Which files are written.
pub fn output(reader: &mut Reader, field: &Field<RawOutput>) -> Output {
    let Some((raw, _)) = reader.given(field) else {
        return defaults::OUTPUT;
    };
    let under = defaults::OUTPUT;
    let picture_size = reader.count(&raw.picture_size, "picture_size", defaults::PICTURE_SIZES);
    let plan_width = reader.count(&raw.plan_width, "plan_width", defaults::PLAN_WIDTHS);
    Output {
        forest_3mf: flag(reader, &raw.forest_3mf, under.forest_3mf),
        forest_stl: flag(reader, &raw.forest_stl, under.forest_stl),
        forest_glb: flag(reader, &raw.forest_glb, under.forest_glb),
        plan: flag(reader, &raw.plan, under.plan),
        views: flag(reader, &raw.views, under.views),
        lights: flag(reader, &raw.lights, under.lights),
        camouflage: flag(reader, &raw.camouflage, under.camouflage),
        split: flag(reader, &raw.split, under.split),
        report_html: flag(reader, &raw.report_html, under.report_html),
        surface: flag(reader, &raw.surface, under.surface),
        groups: flag(reader, &raw.groups, under.groups),
        turntable: flag(reader, &raw.turntable, under.turntable),
        picture_size: picture_size.map_or(under.picture_size, |(v, _)| v),
        plan_width: plan_width.map_or(under.plan_width, |(v, _)| v),
    }
}
