//! The printer, how the forest is made, and which files are written.

use crate::certify::printability::{Apart, PrintLimits};
use crate::scene::defaults;
use crate::scene::language::raw::{RawMake, RawOutput, RawPrinter};
use crate::scene::resolved::{Making, MakingWay, Output, Printer};
use crate::scene::text::{Field, Reader};
use crate::support::{Support, SupportKind};

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

/// How the forest is made: what is asked of it.
pub(crate) fn making(reader: &mut Reader, field: &Field<RawMake>, printer: &Printer) -> Making {
    let slimness = |reader: &mut Reader, field: &Field<f64>| {
        let most = reader.within(field, "slenderness", defaults::SLENDERNESS_ALLOWED);
        most.map(|(v, _)| v)
    };
    match reader.given(field) {
        Some((RawMake::Milled(raw), _)) => {
            let mut length = |field: &Field<f64>, name: &str, default: f64| {
                let given = reader.length_from(field, name, 0.05);
                given.map_or(default, |(v, _)| v)
            };
            let tool = length(&raw.tool, "tool", defaults::TOOL);
            let wall = length(&raw.wall, "wall", defaults::MILLED_WALL);
            let slimmest = slimness(reader, &raw.slenderness).unwrap_or(defaults::SLIMMEST);
            Making {
                way: MakingWay::Milled,
                line: tool,
                limits: PrintLimits::milled(tool, wall, slimmest),
            }
        }
        Some((RawMake::Built(raw), _)) => {
            let finest = reader.length_from(&raw.finest, "finest", 0.05);
            Making {
                way: MakingWay::Built,
                line: finest.map_or(defaults::FINEST_BUILT, |(v, _)| v),
                limits: PrintLimits {
                    slimmest: slimness(reader, &raw.slenderness),
                    ..PrintLimits::NONE
                },
            }
        }
        printed => {
            let (mut overhang, mut slimmest) = (defaults::OVERHANG, defaults::SLIMMEST);
            if let Some((RawMake::Printed(raw), _)) = printed {
                let given = reader.length_from(&raw.overhang, "overhang", 0.0);
                overhang = given.map_or(overhang, |(v, _)| v);
                slimmest = slimness(reader, &raw.slenderness).unwrap_or(slimmest);
            }
            Making {
                way: MakingWay::Printed,
                line: printer.nozzle,
                limits: PrintLimits::printed(printer.nozzle, printer.bed, overhang, slimmest),
            }
        }
    }
}

impl Making {
    /// The same for these supports: without a base each of them stands for itself.
    pub(crate) fn of(mut self, supports: &[Support]) -> Self {
        let has_base = |s: &Support| matches!(s.kind, SupportKind::Base { .. });
        if !supports.iter().any(has_base) {
            let feet = supports.iter().filter_map(|s| s.mesh.bounds());
            self.limits.apart = Some(Apart {
                parts: supports.len(),
                foot: feet.map(|(lo, _)| lo.z).fold(f64::NEG_INFINITY, f64::max),
            });
        }
        self
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
