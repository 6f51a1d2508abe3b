//! The small sections of a scene: energy, printer, output.

use super::defaults;
use super::raw::{RawEnergy, RawOutput, RawPrinter, RawWeight};
use super::reader::Reader;
use super::spanned::Field;
use crate::mimic::{CurvatureOptions, Energy, FaceWeight, NormalOptions};
use crate::scene::{Output, Printer};

/// What is minimised, and how.
pub fn energy(reader: &mut Reader, field: &Field<RawEnergy>) -> Energy {
    let default = match defaults::ENERGY {
        Energy::Normal(_) => Energy::Normal(defaults::NORMAL),
        Energy::Curvature(_) => Energy::Curvature(defaults::CURVATURE),
    };
    match reader.given(field).map(|(energy, _)| energy) {
        None => default,
        Some(RawEnergy::Normal(raw)) => {
            let weight = match reader.given(&raw.weight) {
                Some((RawWeight::Area, _)) => FaceWeight::Area,
                Some((RawWeight::SolidAngle, _)) => FaceWeight::SolidAngle,
                None => defaults::NORMAL.weight,
            };
            Energy::Normal(NormalOptions {
                weight,
                ordering: flag(reader, &raw.ordering, defaults::NORMAL.ordering),
            })
        }
        Some(RawEnergy::Curvature(raw)) => {
            let hidden_weight = reader.number(&raw.hidden_weight, "hidden_weight");
            if let Some((value, span)) = hidden_weight
                .as_ref()
                .filter(|(v, _)| !(1e-6..=1.0).contains(v))
            {
                reader.error(span, format!("`hidden_weight` is {value}; visible vertices count 1, hidden ones from 0.000001 to 1"));
            }
            let hidden_weight = hidden_weight.map_or(defaults::CURVATURE.hidden_weight, |(v, _)| v);
            let ordering = flag(reader, &raw.ordering, defaults::CURVATURE.ordering);
            Energy::Curvature(CurvatureOptions {
                hidden_weight,
                ordering,
            })
        }
    }
}

fn flag(reader: &mut Reader, field: &Field<bool>, default: bool) -> bool {
    reader.given(field).map_or(default, |(value, _)| *value)
}

/// The printer the checks have in mind.
pub fn printer(reader: &mut Reader, field: &Field<RawPrinter>) -> Printer {
    let Some((raw, _)) = reader.given(field) else {
        return defaults::PRINTER;
    };
    let nozzle = reader
        .length_from(&raw.nozzle, "nozzle", 0.05)
        .map_or(defaults::PRINTER.nozzle, |(v, _)| v);
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
        picture_size: picture_size.map_or(under.picture_size, |(v, _)| v),
        plan_width: plan_width.map_or(under.plan_width, |(v, _)| v),
    }
}
