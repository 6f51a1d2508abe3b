//! The scene as written: a mirror of the RON text without defaults, units or meaning.
//!
//! Every field may be missing and every value may be wrong on its own; `resolve` decides. Unknown fields are errors.
//! What the fields mean is told by `schema`, which a test compares with these types.

use crate::scene::text::spanned::{Field, List, Spanned, options, own_text};
use crate::scene::text::wanted::{Wanted, wanted};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};

/// Declares structs of optional fields and enums, all of which refuse what they do not know.
macro_rules! raw {
    ($($(#[$doc:meta])* struct $name:ident, $wanted:literal { $($field:ident: $kind:ty,)* })*) => { $(
        $(#[$doc])*
        #[derive(Debug, Default, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub(crate) struct $name { $(pub $field: Field<$kind>,)* }
        wanted! { $name => $wanted; }
    )* };
}

raw! {
    struct RawScene, "a scene `( title: ..., models: [...], views: [...], pillars: [...] )`" {
        title: String,
        units: RawUnit,
        models: List<RawModel>,
        detail: u32,
        views: List<RawView>,
        pillars: RawForest,
        supports: List<RawSupport>,
        base: RawBase,
        depth: RawDepth,
        energy: RawEnergy,
        relief: RawRelief,
        contested: RawContested,
        make: RawMake,
        printer: RawPrinter,
        seen: f64,
        output: RawOutput,
    }
    struct RawModel, "a model `(name: \"owl\", file: \"owl.ply\", place: Fit(height: 60))`" {
        name: String,
        file: String,
        units: RawUnit,
        place: RawPlace,
        regions: List<RawModelRegion>,
        detail: u32,
    }
    struct RawModelRegion, "a region `(shape: Box(from: (0, 0, 0), to: (10, 10, 10)), weight: 3)`" {
        shape: RawVolume,
        weight: f64,
        free: bool,
    }
    struct RawBox, "`Box(from: (0, 0, 0), to: (10, 10, 10))`" { from: [f64; 3], to: [f64; 3], }
    struct RawBall, "`Ball(centre: (0, 0, 0), radius: 10)`" { centre: [f64; 3], radius: f64, }
    struct RawFit, "`Fit(height: 60)`" {
        height: f64,
        width: f64,
        largest: f64,
        up: String,
        front: String,
        facing: [f64; 2],
        spin: f64,
        at: [f64; 3],
    }
    struct RawView, "a view `(name: \"front\", eye: (0, -300, 60), models: [\"owl\"])`" {
        name: String,
        eye: [f64; 3],
        from: [f64; 3],
        look_at: [f64; 3],
        models: List<String>,
        colour: String,
    }
    struct RawPillars, "pillars `(shape: Round(radius: 4), height: 90, places: At([(0, 0)]))`" {
        name: String,
        shape: RawShape,
        height: f64,
        places: RawPlaces,
        depth: RawDepth,
    }
    struct RawAuto, "`Auto(region: Disc(radius: 70))`" {
        region: RawRegion,
        shapes: List<RawShape>,
        sizes: RawRange<f64>,
        height: RawRange<f64>,
        depth: RawDepth,
        gap: f64,
        count: RawRange<u32>,
        fixed: List<RawPillars>,
        seed: u32,
        tries: u32,
        seconds: f64,
        hidden_from: f64,
        eye_tolerance: RawTolerance,
        matters: RawMatters,
        models: RawFreedom,
    }
    struct RawDiscRegion, "`Disc(radius: 70)`" { radius: f64, centre: [f64; 2], }
    struct RawRectangleRegion, "`Rectangle(width: 140, depth: 90)`" { width: f64, depth: f64, centre: [f64; 2], turn: f64, }
    struct RawPolygonRegion, "`Polygon(points: [(0, 0), (80, 0), (40, 60)])`" { points: List<[f64; 2]>, }
    struct RawMatters, "weights `(camouflage: 1, tolerance: 1)`" {
        camouflage: f64, tolerance: f64, pillars: f64, spread: f64,
    }
    struct RawFreedom, "limits `(turn: 5, scale: 1.05, shift: 2)`" { turn: f64, scale: f64, shift: f64, }
    struct RawLayout, "a layout `[pillars, ...]` or `(pillars: [...], adjust: [...])`" {
        units: RawUnit,
        pillars: List<RawPillars>,
        adjust: List<RawAdjust>,
    }
    struct RawAdjust, "an adjustment `(view: \"owl\", turn: 3, scale: 0.98, shift: (1, -2))`" {
        view: String, turn: f64, scale: f64, shift: [f64; 2],
    }
    struct RawPlate, "`Plate(width: 120, height: 90)`" {
        name: String, width: f64, height: f64, thickness: f64, at: [f64; 3], facing: [f64; 2], lean: f64, depth: RawDepth,
    }
    struct RawStrips, "`Strips(count: 5, width: 30, height: 90)`" {
        name: String, count: u32, width: f64, height: f64, thickness: f64, gap: f64, turn: f64, at: [f64; 3], facing: [f64; 2],
        depth: RawDepth,
    }
    struct RawStairs, "`Stairs(steps: 6, width: 120)`" {
        name: String, steps: u32, width: f64, rise: f64, going: f64, at: [f64; 3], facing: [f64; 2], depth: RawDepth,
    }
    struct RawGroove, "`Groove(width: 100, height: 90, opening: 80, deep: 40)`" {
        name: String, width: f64, height: f64, thickness: f64, opening: f64, deep: f64, at: [f64; 3], facing: [f64; 2], lean: f64,
        depth: RawDepth,
    }
    struct RawWave, "`Wave(width: 120, height: 90, heights: Formula(\"3 * sin(x / 8)\"))`" {
        name: String, width: f64, height: f64, thickness: f64, heights: RawHeights, pitch: f64, at: [f64; 3], facing: [f64; 2],
        lean: f64, depth: RawDepth,
    }
    struct RawImage, "`Image(file: \"sea.png\", from: 0, to: 5)`" { file: String, from: f64, to: f64, }
    struct RawBody, "`Mesh(file: \"vase.ply\")`" {
        name: String, file: String, units: RawUnit, place: RawPlace, thickness: f64, creases: f64, depth: RawDepth,
    }
    struct RawRound, "`Round(radius: 4)`" { radius: f64, facets: u32, }
    struct RawPolygon, "`Polygon(sides: 6, radius: 4)`" { sides: u32, radius: f64, turn: f64, }
    struct RawRectangle, "`Rectangle(width: 8, depth: 5)`" { width: f64, depth: f64, turn: f64, }
    struct RawProfile, "`Profile(points: [(0, 0), (8, 0), (4, 6)])`" { points: List<[f64; 2]>, turn: f64, }
    struct RawGrid, "`Grid(columns: 4, rows: 3, pitch: 15)`" {
        columns: u32, rows: u32, pitch: f64, pitch_y: f64, centre: [f64; 2], turn: f64,
    }
    struct RawRing, "`Ring(count: 12, radius: 40)`" { count: u32, radius: f64, centre: [f64; 2], turn: f64, }
    struct RawHex, "`Hex(rings: 2, pitch: 15)`" { rings: u32, pitch: f64, centre: [f64; 2], turn: f64, }
    struct RawDisc, "`Disc(radius: 72, thickness: 5)`" {
        radius: f64, thickness: f64, margin: f64, centre: [f64; 2], facets: u32,
    }
    struct RawSlab, "`Rectangle(width: 150, depth: 100, thickness: 5)`" {
        width: f64, depth: f64, thickness: f64, margin: f64, centre: [f64; 2],
    }
    struct RawDepth, "a depth layer `(front: 5, back: 2)`" {
        from: RawDatum, hits: RawRange<u32>, front: f64, back: f64, core: f64, outline: RawOutline,
    }
    struct RawNormal, "`Normal(steps: Never)`" { steps: RawSteps, weight: RawWeight, ordering: bool, reweight: u32, }
    struct RawStepOptions, "`Allowed(highest: 3)`" {
        least: f64, highest: f64, tolerance: f64, most: u32, price: f64, narrowest: f64, prefer: RawPrefer,
    }
    struct RawCurvature, "`Curvature(hidden_weight: 0.1)`" {
        hidden_weight: f64, ordering: bool, scale_invariant: bool, group_scales: bool, mean_curvature: bool, iterate: u32,
        form: RawCurvatureForm,
    }
    struct RawWhole, "`Whole(bounded: Seen)`" { bounded: RawBounded, }
    struct RawGradient, "`Gradient(compression: 1)`" { compression: f64, }
    struct RawPrinter, "a printer `(nozzle: 0.4, bed: (256, 256, 256))`" { nozzle: f64, bed: [f64; 3], clearance: f64, }
    struct RawPrinted, "`Printed(overhang: 10)`" { overhang: f64, slenderness: f64, }
    struct RawMilled, "`Milled(tool: 3)`" { tool: f64, wall: f64, slenderness: f64, }
    struct RawBuilt, "`Built(finest: 1)`" { finest: f64, slenderness: f64, }
    struct RawOutput, "output choices `(forest_glb: false, picture_size: 512)`" {
        forest_3mf: bool, forest_stl: bool, forest_glb: bool, plan: bool, views: bool, lights: bool, camouflage: bool, split: bool,
        report_html: bool, surface: bool, groups: bool, turntable: bool, picture_size: u32, plan_width: u32,
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[allow(non_camel_case_types, reason = "as written in scenes")]
pub(crate) enum RawUnit {
    mm,
    cm,
    m,
    inch,
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per model, short-lived")]
pub(crate) enum RawPlace {
    Fit(RawFit),
    Matrix(List<[f64; 4]>),
}

/// Part of a model.
#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per region, short-lived")]
pub(crate) enum RawVolume {
    Box(RawBox),
    Ball(RawBall),
    Painted(String),
}

/// The pillars of a scene: listed, to be found, or kept in a file of their own.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "one per scene")]
pub(crate) enum RawForest {
    List(Spanned<List<RawPillars>>),
    Choice(Spanned<RawForestChoice>),
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per scene")]
pub(crate) enum RawForestChoice {
    Auto(RawAuto),
    File(String),
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per scene")]
pub(crate) enum RawRegion {
    Disc(RawDiscRegion),
    Rectangle(RawRectangleRegion),
    Polygon(RawPolygonRegion),
}

/// From the smallest to the largest: one number or two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawRange<T>(pub [T; 2]);

/// One number for all views, or one for each.
#[derive(Debug)]
pub(crate) enum RawTolerance {
    All(Spanned<f64>),
    Each(Spanned<List<f64>>),
}

#[derive(Debug, Deserialize)]
pub(crate) enum RawShape {
    Round(RawRound),
    Polygon(RawPolygon),
    Rectangle(RawRectangle),
    Profile(RawProfile),
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per entry, short-lived")]
pub(crate) enum RawPlaces {
    At(List<[f64; 2]>),
    Grid(RawGrid),
    Ring(RawRing),
    Hex(RawHex),
}

#[derive(Debug, Deserialize)]
pub(crate) enum RawBase {
    Disc(RawDisc),
    Rectangle(RawSlab),
    None,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawDatum {
    Axis,
    Face,
    Surface,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawOutline {
    Free,
    OnSupport,
}

/// What carries reliefs and is no pillar.
#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "a few per scene")]
pub(crate) enum RawSupport {
    Plate(RawPlate),
    Strips(RawStrips),
    Stairs(RawStairs),
    Groove(RawGroove),
    Wave(RawWave),
    Mesh(RawBody),
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per wave")]
pub(crate) enum RawHeights {
    Formula(String),
    Image(RawImage),
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per scene")]
pub(crate) enum RawEnergy {
    Normal(RawNormal),
    Curvature(RawCurvature),
    Linear,
    Gradient(RawGradient),
}

#[derive(Debug, Deserialize)]
pub(crate) enum RawRelief {
    HeightField,
    Whole(RawWhole),
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawBounded {
    Outline,
    Seen,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawCurvatureForm {
    Quadratic,
    Conic,
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per scene")]
pub(crate) enum RawSteps {
    Never,
    Allowed(RawStepOptions),
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawPrefer {
    Tolerance,
    Camouflage,
}

#[derive(Debug, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "one per scene")]
pub(crate) enum RawMake {
    Printed(RawPrinted),
    Milled(RawMilled),
    Built(RawBuilt),
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawContested {
    First,
    Largest,
    Error,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub(crate) enum RawWeight {
    Area,
    SolidAngle,
}

impl<'de> Deserialize<'de> for RawForest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = own_text(deserializer)?;
        Ok(match text.starts_with('[') {
            true => Self::List(Spanned::of(text)),
            false => Self::Choice(Spanned::of(text)),
        })
    }
}

impl<'de> Deserialize<'de> for RawTolerance {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = own_text(deserializer)?;
        Ok(match text.starts_with('[') {
            true => Self::Each(Spanned::of(text)),
            false => Self::All(Spanned::of(text)),
        })
    }
}

impl<'de, T: DeserializeOwned + Copy> Deserialize<'de> for RawRange<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = own_text(deserializer)?;
        let range = match text.starts_with('(') {
            true => options().from_str(text),
            false => options().from_str(text).map(|one: T| [one; 2]),
        };
        range.map(Self).map_err(D::Error::custom)
    }
}

wanted! {
    RawUnit => "mm, cm, m or inch";
    RawPlace => "`Fit(...)` or `Matrix([(...), (...), (...), (...)])`";
    RawVolume => "`Box(...)`, `Ball(...)` or `Painted(\"attribute\")`";
    RawForest => "a list `[...]`, `Auto(...)` or `File(\"layout.ron\")`";
    RawForestChoice => RawForest::WANTED;
    RawRegion => "`Disc(...)`, `Rectangle(...)` or `Polygon(...)`";
    RawRange<f64> => "a number or a range `(60, 90)`";
    RawRange<u32> => "a whole number or a range `(1, 200)`";
    RawTolerance => "a number, or a list with one for each view";
    RawShape => "`Round(...)`, `Polygon(...)`, `Rectangle(...)` or `Profile(...)`";
    RawPlaces => "`At([...])`, `Grid(...)`, `Ring(...)` or `Hex(...)`";
    RawBase => "`Disc(...)`, `Rectangle(...)` or `None`";
    RawDatum => "Axis, Face or Surface";
    RawOutline => "Free or OnSupport";
    RawSupport => "`Plate(...)`, `Strips(...)`, `Stairs(...)`, `Groove(...)`, `Wave(...)` or `Mesh(...)`";
    RawHeights => "`Formula(\"3 * sin(x / 8)\")` or `Image(file: \"sea.png\", from: 0, to: 5)`";
    RawEnergy => "`Normal(...)`, `Curvature(...)`, `Linear` or `Gradient(...)`";
    RawRelief => "`HeightField` or `Whole(...)`";
    RawBounded => "Outline or Seen";
    RawCurvatureForm => "Quadratic or Conic";
    RawSteps => "`Never` or `Allowed(...)`";
    RawPrefer => "Tolerance or Camouflage";
    RawMake => "`Printed(...)`, `Milled(...)` or `Built(...)`";
    RawContested => "First, Largest or Error";
    RawWeight => "Area or SolidAngle";
}
