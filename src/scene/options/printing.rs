//! The printer, and which files are written.

use crate::scene::defaults;
use crate::scene::language::raw::{RawOutput, RawPrinter};
use crate::scene::resolved::{Output, Printer};
use crate::scene::text::{Field, Reader};

/// The printer the checks have in mind.
pub(crate) fn printer(reader: &mut Reader, field: &Field<RawPrinter>) -> Printer {
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
pub(crate) fn output(reader: &mut Reader, field: &Field<RawOutput>) -> Output {
    let Some((raw, _)) = reader.given(field) else {
        return defaults::OUTPUT;
    };
    let under = defaults::OUTPUT;
    let picture_size = reader.count(&raw.picture_size, "picture_size", defaults::PICTURE_SIZES);
    let plan_width = reader.count(&raw.plan_width, "plan_width", defaults::PLAN_WIDTHS);
    Output {
        forest_3mf: reader.flag(&raw.forest_3mf, under.forest_3mf),
        forest_stl: reader.flag(&raw.forest_stl, under.forest_stl),
        forest_glb: reader.flag(&raw.forest_glb, under.forest_glb),
        plan: reader.flag(&raw.plan, under.plan),
        views: reader.flag(&raw.views, under.views),
        lights: reader.flag(&raw.lights, under.lights),
        camouflage: reader.flag(&raw.camouflage, under.camouflage),
        split: reader.flag(&raw.split, under.split),
        report_html: reader.flag(&raw.report_html, under.report_html),
        surface: reader.flag(&raw.surface, under.surface),
        groups: reader.flag(&raw.groups, under.groups),
        turntable: reader.flag(&raw.turntable, under.turntable),
        picture_size: picture_size.map_or(under.picture_size, |(v, _)| v),
        plan_width: plan_width.map_or(under.plan_width, |(v, _)| v),
    }
}
