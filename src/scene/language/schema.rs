//! The whole scene language on one page, for people; a test holds it against the types that read scenes.

use crate::mimic::{CurvatureForm, Energy, FaceWeight};
use crate::scene::defaults;
use crate::support::Datum;
use std::fmt::Write;

/// One struct or choice of the language.
pub(crate) struct Chapter {
    /// As it is written: `Round(...)`, or a plain name for a struct without one.
    pub title: &'static str,
    pub about: &'static str,
    pub fields: Vec<FieldDoc>,
}

/// One field: what it takes, what it is if left out, what it means.
pub(crate) struct FieldDoc {
    pub name: &'static str,
    pub kind: &'static str,
    /// `required` if there is no default.
    pub default: String,
    pub doc: &'static str,
}

const INTRO: &str = "\
// The scene language of pillarforest. A scene is one RON value: ( field: value, ... ), comments as in this text.
// z points up; the top of the base is z = 0. Lengths are in `units`, angles in degrees counter-clockwise from above.
// Lengths given as defaults are millimetres whatever the units.
";

fn field(
    name: &'static str,
    kind: &'static str,
    default: impl ToString,
    doc: &'static str,
) -> FieldDoc {
    FieldDoc {
        name,
        kind,
        default: default.to_string(),
        doc,
    }
}

const REQUIRED: &str = "required";

/// The language as text.
pub fn schema() -> String {
    let mut out = INTRO.to_string();
    for chapter in chapters() {
        // Writing to a String cannot fail.
        let _ = write!(out, "\n{}\n    // {}\n", chapter.title, chapter.about);
        let width = chapter
            .fields
            .iter()
            .map(|f| f.name.len() + f.kind.len())
            .max()
            .unwrap_or(0);
        for f in &chapter.fields {
            let pad = " ".repeat(width - f.name.len() - f.kind.len());
            let _ = writeln!(
                out,
                "    {}: {}{pad}  [{}]  {}",
                f.name, f.kind, f.default, f.doc
            );
        }
    }
    out
}

/// All chapters in reading order.
pub(crate) fn chapters() -> Vec<Chapter> {
    [
        scene_chapters(),
        pillar_chapters(),
        body_chapters(),
        place_chapters(),
        planning_chapters(),
        other_chapters(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn chapter(title: &'static str, about: &'static str, fields: Vec<FieldDoc>) -> Chapter {
    Chapter {
        title,
        about,
        fields,
    }
}

#[rustfmt::skip] // a table
fn scene_chapters() -> Vec<Chapter> {
    vec![
        chapter("scene", "The whole file.", vec![
            field("title", "text", format!("{:?}", defaults::TITLE), "for people: report, 3MF, plan"),
            field("units", "mm | cm | m | inch", "mm", "of every length in this file"),
            field("models", "[model, ...]", REQUIRED, "what is to be seen"),
            field("detail", "count", "as the files", "the most vertices that any model may have: larger ones are simplified on loading, for quick looks"),
            field("views", "[view, ...]", REQUIRED, "from where"),
            field("pillars", "[pillars, ...] | Auto(...) | File(text)", "required without `supports`", "what carries it: listed, to be found, or a layout file in the scene's folder or below"),
            field("supports", "[Plate(...) | Strips(...) | Stairs(...) | Groove(...) | Wave(...) | Mesh(...), ...]", "[]", "what else carries it"),
            field("base", "Disc(...) | Rectangle(...) | None", "Disc(); None without pillars", "what the pillars stand on"),
            field("depth", "depth", "see depth", "where reliefs may lie, for all pillars"),
            field("energy", "Normal(...) | Curvature(...) | Linear | Gradient(...)", energy(), "what is optimised; Linear: nothing, depth is compressed linearly into the layer"),
            field("relief", "HeightField | Whole(...)", "HeightField", "what is built: what the eye sees, or whole closed models, on other supports than pillars"),
            field("contested", "First | Largest | Error", "First", "who gets surface that two views want, or that would hide the other's: the earlier view, the one to which it is larger, or nobody"),
            field("make", "Printed(...) | Milled(...) | Built(...)", "Printed()", "how it is made: which checks and limits apply"),
            field("printer", "printer", "see printer", "what the checks of printing have in mind"),
            field("seen", "arc-minutes", defaults::SEEN, "gaps nowhere wider than this go unseen: told in the report, but no failure"),
            field("output", "output", "see output", "which files are written"),
        ]),
        chapter("model", "A mesh file and where it stands.", vec![
            field("name", "text", REQUIRED, "what views call it"),
            field("file", "text", REQUIRED, "OBJ, STL, PLY, OFF or 3MF in the scene's folder or below, or by name in --models DIR"),
            field("units", "mm | cm | m | inch", "mm", "of the file's coordinates, when fitted without a size"),
            field("place", "Fit(...) | Matrix(...)", "Fit()", "Matrix([(a, b, c, d), (..), (..), (..)]): 4 x 4 by rows, from file coordinates to mm"),
            field("regions", "[region, ...]", "[]", "vertices that count more or less, or are free of the layer"),
            field("detail", "count", "the scene's", "the most vertices it may have, if that is less than the scene's"),
        ]),
        chapter("region", "Vertices of a model; where regions overlap their weights are multiplied.", vec![
            field("shape", "Box(...) | Ball(...) | Painted(text)", REQUIRED, "Painted: by an attribute of the file, a PLY vertex property or red, green, blue of its colours: its values (0 to 1000) are weights, or more than 0.5 is inside if `free`"),
            field("weight", "number", "1", "factor on the weight of its vertices, 0.001 to 1000; counts squared"),
            field("free", "true | false", "false", "its vertices have no depth bounds (with relief: Whole they only stay inside the support's far side); a view with such vertices has no steps"),
        ]),
        chapter("Box(...)", "In the coordinates and the unit of the model's file, before it is placed.", vec![
            field("from", "(x, y, z)", REQUIRED, "a corner"),
            field("to", "(x, y, z)", REQUIRED, "the opposite corner"),
        ]),
        chapter("Ball(...)", "In the coordinates and the unit of the model's file, before it is placed.", vec![
            field("centre", "(x, y, z)", REQUIRED, "middle"),
            field("radius", "number", REQUIRED, "in the unit of the file"),
        ]),
        chapter("Fit(...)", "Upright, turned to the eye, at one size: give height, width or largest, or none.", vec![
            field("height", "length", "as the file", "scaled to this height"),
            field("width", "length", "as the file", "scaled to this width, left to right as the eye sees it"),
            field("largest", "length", "as the file", "scaled until the longest side is this long"),
            field("up", "text", format!("{:?}", defaults::UP), "axis of the file that points up: \"x\", \"-x\", \"y\", \"-y\", \"z\", \"-z\""),
            field("front", "text", format!("{:?}", defaults::FRONT), "axis of the file that looks out of the side to be seen"),
            field("facing", "(x, y)", "to the eye", "where the front looks, as a direction in the ground plane"),
            field("spin", "degrees", "0", "turned on by this much about the vertical"),
            field("at", "(x, y, z)", "(0, 0, 0)", "where the middle of the model's underside goes"),
        ]),
        chapter("view", "One eye and what it sees.", vec![
            field("name", "text", REQUIRED, "also the name of its picture: letters, digits, - and _"),
            field("eye", "(x, y, z)", "see from", "where the eye is: either this or `from`"),
            field("from", "(x, y, z)", "see eye", "the direction from which an eye at infinity looks, all of whose rays are parallel"),
            field("look_at", "(x, y, z)", "middle of its models", "centre of the view"),
            field("models", "[text, ...]", REQUIRED, "names of the models it sees"),
            field("colour", "text", "a colour-blind-safe palette", "\"#rrggbb\" for its reliefs, plan and legend"),
        ]),
    ]
}

#[rustfmt::skip] // a table
fn pillar_chapters() -> Vec<Chapter> {
    let facets = defaults::ROUND_FACETS;
    vec![
        chapter("pillars", "Pillars of one shape; a scene may have several such entries.", vec![
            field("name", "text", "\"p\"", "pillars are numbered p1, p2, ... or name-1, name-2, ..."),
            field("shape", "Round(...) | Polygon(...) | Rectangle(...) | Profile(...)", REQUIRED, "cross-section"),
            field("height", "length", format!("{} mm", defaults::PILLAR_HEIGHT), "above the base"),
            field("places", "At([(x, y), ...]) | Grid(...) | Ring(...) | Hex(...)", REQUIRED, "where their axes stand"),
            field("depth", "depth", "the scene's", "fields given here replace the scene's"),
        ]),
        chapter("Round(...)", "A circle, printed as a regular polygon inside it.", vec![
            field("radius", "length", REQUIRED, "of the circle"),
            field("facets", "count", facets, "8 to 512"),
        ]),
        chapter("Polygon(...)", "A regular polygon.", vec![
            field("sides", "count", REQUIRED, "3 to 512"),
            field("radius", "length", REQUIRED, "from the axis to a corner"),
            field("turn", "degrees", "0", "direction of the first corner"),
        ]),
        chapter("Rectangle(...) as a pillar", "A rectangle around the axis.", vec![
            field("width", "length", REQUIRED, "along x before the turn"),
            field("depth", "length", REQUIRED, "along y before the turn"),
            field("turn", "degrees", "0", "about the axis"),
        ]),
        chapter("Profile(...)", "Any simple polygon.", vec![
            field("points", "[(x, y), ...]", REQUIRED, "corners in order, relative to the axis"),
            field("turn", "degrees", "0", "about the axis"),
        ]),
        chapter("depth", "The room of the reliefs.", vec![
            field("from", "Axis | Face | Surface", format!("{}; Face on plates and strips, Surface on other supports", datum()), "measured from the upright plane through a pillar's axis that faces the eye, square to a plate's face, or along the rays from the surface"),
            field("hits", "(1, 1) | (1, 2)", "(1, 1)", "where rays meet the support: around the first hit, or from there through the wall, up to `core` before rays leave it (not on pillars; `back` plays no part)"),
            field("front", "length", format!("{} mm", defaults::LAYER.front), "towards the eye"),
            field("back", "length", format!("{} mm, at most {} of the room behind; {} mm where there are no pillars", defaults::LAYER.back(), defaults::BACK_SHARE, defaults::ON_BODIES.back()), "away from the eye: reliefs are carved in"),
            field("core", "length", format!("{} mm, at most {} of the room behind", defaults::LAYER.core, defaults::CORE_SHARE), "what must be left of the support behind it"),
            field("outline", "Free | OnSupport", "Free", "whether the outline of every object must lie on the datum, to 0.05 mm"),
        ]),
    ]
}

#[rustfmt::skip] // a table
fn body_chapters() -> Vec<Chapter> {
    let thick = format!("{} mm", defaults::BODY_THICKNESS);
    let name = |usual: &str| field("name", "text", format!("{usual:?}"), "numbered where several have it");
    let at = || field("at", "(x, y, z)", "(0, 0, 0)", "middle of the lower edge of its face");
    let facing = || field("facing", "(x, y)", "(0, -1)", "where the face looks, along the ground");
    let lean = || field("lean", "degrees", "0", "backwards: at 90 it lies on its back");
    let depth = || field("depth", "depth", "the scene's", "fields given here replace the scene's");
    vec![
        chapter("Plate(...)", "A box with a flat face: the layer is square to it.", vec![
            name("plate"),
            field("width", "length", REQUIRED, "of the face"),
            field("height", "length", REQUIRED, "of the face"),
            field("thickness", "length", &thick, "behind the face"),
            at(), facing(), lean(), depth(),
        ]),
        chapter("Strips(...)", "Upright plates side by side.", vec![
            name("strip"),
            field("count", "count", REQUIRED, "of plates, up to 100"),
            field("width", "length", REQUIRED, "of one"),
            field("height", "length", REQUIRED, "of all"),
            field("thickness", "length", &thick, "behind the faces"),
            field("gap", "length", format!("{} mm", defaults::STRIP_GAP), "between neighbours"),
            field("turn", "degrees", "0", "of each against its left neighbour: more than 0 folds the row back at its ends"),
            at(), facing(), depth(),
        ]),
        chapter("Stairs(...)", "Steps that go up away from the viewer; every riser and tread carries pieces of its own.", vec![
            name("stairs"),
            field("steps", "count", REQUIRED, "up to 200"),
            field("width", "length", REQUIRED, "of the steps"),
            field("rise", "length", format!("{} mm", defaults::STEP[0]), "height of one"),
            field("going", "length", format!("{} mm", defaults::STEP[1]), "depth of one"),
            at(), facing(), depth(),
        ]),
        chapter("Groove(...)", "A block with a V-shaped groove from bottom to top.", vec![
            name("groove"),
            field("width", "length", REQUIRED, "of the block"),
            field("height", "length", REQUIRED, "of the block"),
            field("thickness", "length", format!("`deep` + {} mm", defaults::BODY_THICKNESS), "of the block"),
            field("opening", "length", REQUIRED, "width of the groove at the face"),
            field("deep", "length", REQUIRED, "depth of the groove in the middle"),
            at(), facing(), lean(), depth(),
        ]),
        chapter("Wave(...)", "A block whose face is any height field.", vec![
            name("wave"),
            field("width", "length", REQUIRED, "of the face"),
            field("height", "length", REQUIRED, "of the face"),
            field("thickness", "length", format!("{} mm", 2.0 * defaults::BODY_THICKNESS), "behind height 0"),
            field("heights", "Formula(text) | Image(...)", REQUIRED, "in mm out of the face: of x (0 in the middle) and y (0 below) in mm, as Formula(\"3 * sin(x / 8)\")"),
            field("pitch", "length", format!("{} mm", defaults::WAVE_PITCH), "largest distance of its points"),
            at(), facing(), lean(), depth(),
        ]),
        chapter("Image(...)", "Heights from a PNG (8 or 16 bits) stretched over the face.", vec![
            field("file", "text", REQUIRED, "in the scene's folder or below"),
            field("from", "length", "0 mm", "height of black"),
            field("to", "length", REQUIRED, "height of white"),
        ]),
        chapter("Mesh(...)", "Any mesh: closed, or with a border and a thickness.", vec![
            name("mesh"),
            field("file", "text", REQUIRED, "as a model's"),
            field("units", "mm | cm | m | inch", "mm", "of the file's coordinates, when fitted without a size"),
            field("place", "Fit(...) | Matrix(...)", "Fit()", "as a model's, but it looks along -y unless `facing` says otherwise"),
            field("thickness", "length", "for meshes with a border", "goes on behind them, square to their mean direction"),
            field("creases", "degrees", "none", "sharper edges part the surface: each part carries pieces of its own"),
            depth(),
        ]),
    ]
}

#[rustfmt::skip] // a table
fn place_chapters() -> Vec<Chapter> {
    let centre = || field("centre", "(x, y)", "(0, 0)", "middle of the arrangement");
    vec![
        chapter("Grid(...)", "Rows and columns.", vec![
            field("columns", "count", REQUIRED, "along x"),
            field("rows", "count", REQUIRED, "along y"),
            field("pitch", "length", REQUIRED, "between axes"),
            field("pitch_y", "length", "pitch", "between rows, if different"),
            centre(),
            field("turn", "degrees", "0", "about the centre"),
        ]),
        chapter("Ring(...)", "Evenly on a circle.", vec![
            field("count", "count", REQUIRED, "number of pillars"),
            field("radius", "length", REQUIRED, "of the circle through the axes"),
            centre(),
            field("turn", "degrees", "0", "direction of the first pillar"),
        ]),
        chapter("Hex(...)", "A honeycomb: one in the middle, hexagons around it.", vec![
            field("rings", "count", REQUIRED, "0 for one pillar, 1 for 7, 2 for 19, ..."),
            field("pitch", "length", REQUIRED, "between neighbours"),
            centre(),
            field("turn", "degrees", "0", "about the centre"),
        ]),
        chapter("Disc(...)", "A round base; its top is z = 0.", vec![
            field("radius", "length", "fits all pillars", "of the disc"),
            field("thickness", "length", format!("{} mm", defaults::BASE_THICKNESS), "downwards from z = 0"),
            field("margin", "length", format!("{} mm", defaults::BASE_MARGIN), "beyond the pillars, if no radius is given"),
            field("centre", "(x, y)", "middle of the pillars", "of the disc"),
            field("facets", "count", defaults::BASE_FACETS, "8 to 512"),
        ]),
        chapter("Rectangle(...) as base", "A rectangular base; its top is z = 0.", vec![
            field("width", "length", "fits all pillars", "along x"),
            field("depth", "length", "fits all pillars", "along y"),
            field("thickness", "length", format!("{} mm", defaults::BASE_THICKNESS), "downwards from z = 0"),
            field("margin", "length", format!("{} mm", defaults::BASE_MARGIN), "beyond the pillars, where no size is given"),
            field("centre", "(x, y)", "middle of the pillars", "of the rectangle"),
        ]),
    ]
}

#[rustfmt::skip] // a table
fn planning_chapters() -> Vec<Chapter> {
    let ([fewest, most], matters) = (defaults::COUNT, defaults::MATTERS);
    vec![
        chapter("Auto(...)", "Pillars that `plan` and `build` find for the views: all models covered, nothing in the way.", vec![
            field("region", "Disc(...) | Rectangle(...) | Polygon(...)", format!("the base less {} mm, if its size is given; else Disc(radius: {} mm)", defaults::REGION_RIM, defaults::REGION_RADIUS), "where they may stand, with their whole width"),
            field("shapes", "[Round(...) | Polygon(...) | ..., ...]", format!("[Round(radius: {} mm)]", defaults::PLANNED_RADIUS), "what they may be, as in pillars"),
            field("sizes", "factor | (factor, factor)", "1", "on the lengths of every shape, from the smallest to the largest in even steps"),
            field("height", "length | (length, length)", format!("{} mm", defaults::PILLAR_HEIGHT), "above the base, from the lowest to the highest"),
            field("depth", "depth", "the scene's", "fields given here replace the scene's"),
            field("gap", "length", format!("{} mm", defaults::GAP), "room between any two solids"),
            field("count", "count | (count, count)", format!("({fewest}, {most})"), "fewest and most pillars, fixed ones included"),
            field("fixed", "[pillars, ...]", "[]", "pillars that stay; the others are found around them"),
            field("seed", "count", defaults::SEED, "of the search: the same seed gives the same layout"),
            field("tries", "count", format!("{} / views", defaults::TRIES), "candidate layouts, 1 to 10000000"),
            field("seconds", "number", defaults::SECONDS, "wall-clock time after which the search ends with what it has"),
            field("hidden_from", "degrees", defaults::HIDDEN_FROM, "how far off its eye a model is to be hidden, 1 to 90"),
            field("eye_tolerance", "length | [length, ...]", "0", "how far every eye, or each, must be able to move sideways"),
            field("matters", "matters", "see matters", "what the search looks for"),
            field("models", "models", "see models", "how far a plan may change the models of each view"),
        ]),
        chapter("Disc(...) as region", "A disc.", vec![
            field("radius", "length", REQUIRED, "of the disc"),
            field("centre", "(x, y)", "(0, 0)", "of the disc"),
        ]),
        chapter("Rectangle(...) as region", "A rectangle.", vec![
            field("width", "length", REQUIRED, "along x before the turn"),
            field("depth", "length", REQUIRED, "along y before the turn"),
            field("centre", "(x, y)", "(0, 0)", "middle of the rectangle"),
            field("turn", "degrees", "0", "about the centre"),
        ]),
        chapter("Polygon(...) as region", "Any simple polygon.", vec![
            field("points", "[(x, y), ...]", REQUIRED, "corners in order"),
        ]),
        chapter("matters", "Weights: 0 does not matter, 2 matters twice as much as 1.", vec![
            field("camouflage", "number", matters.camouflage, "models are hard to recognise from elsewhere"),
            field("tolerance", "number", matters.tolerance, "eyes may move"),
            field("pillars", "number", matters.pillars, "few pillars"),
            field("spread", "number", matters.spread, "pillars are spread evenly"),
        ]),
        chapter("models", "Limits, to either side, within which a plan may change the models of a view together.", vec![
            field("turn", "degrees", "0", "about the vertical"),
            field("scale", "factor", "1", "larger by this, or smaller by its inverse; 1 to 2"),
            field("shift", "length", "0", "along the ground"),
        ]),
        chapter("layout file", "What `plan` writes and File(\"layout.ron\") reads: [pillars, ...], or a struct.", vec![
            field("units", "mm | cm | m | inch", "mm", "of every length in that file"),
            field("pillars", "[pillars, ...]", REQUIRED, "as if they stood in the scene"),
            field("adjust", "[adjustment, ...]", "[]", "changes to the models of views"),
        ]),
        chapter("adjustment", "The models of a view together, about the middle of their underside, after they are placed.", vec![
            field("view", "text", REQUIRED, "name of the view"),
            field("turn", "degrees", "0", "about the vertical"),
            field("scale", "factor", "1", "on their size"),
            field("shift", "(x, y)", "(0, 0)", "along the ground"),
        ]),
    ]
}

#[rustfmt::skip] // a table
fn other_chapters() -> Vec<Chapter> {
    let (printer, output, steps) = (defaults::PRINTER, defaults::OUTPUT, defaults::STEPS);
    vec![
        chapter("Normal(...)", "Keeps the normals the eye sees.", vec![
            field("steps", "Never | Allowed(...)", "Allowed() with two pillars or more", "whether the surface may be torn along the eye's rays, where it does not see it"),
            field("weight", "Area | SolidAngle", weight(), "how much a face counts: its area, or what the eye sees of it"),
            field("ordering", "true | false", defaults::NORMAL.ordering, "what lies in front stays in front"),
            field("reweight", "count", defaults::NORMAL.reweight, "rounds that gather what error is left in few faces, 0 to 20"),
        ]),
        chapter("Allowed(...)", "Steps: the surface may fall into pieces at different depths. In the report: `steps`.", vec![
            field("least", "length", format!("{} mm", steps.limits.least_mm), "lowest step; where pieces are nearer they stay joined"),
            field("highest", "length", "no limit", "highest step"),
            field("tolerance", "length", "no limit", "how far the eye may move sideways before a step opens by two arc-minutes"),
            field("most", "count", "no limit", "largest number of step lines of a view"),
            field("price", "number", steps.price, "of a millimetre of line, in square millimetres tilted by one degree: more gives fewer steps"),
            field("narrowest", "length", "the printer's nozzle; without pillars the thinnest wall that prints", "narrower strips between steps are given to a neighbour"),
            field("prefer", "Tolerance | Camouflage", "Tolerance", "where pieces are free: small steps, or large ones that confuse from elsewhere"),
        ]),
        chapter("Curvature(...)", "Keeps the curvature of the whole model (Schueller et al. 2014).", vec![
            field("hidden_weight", "number", defaults::CURVATURE.hidden_weight, "what hidden vertices count; visible ones count 1"),
            field("ordering", "true | false", defaults::CURVATURE.ordering, "what lies in front stays in front"),
            field("scale_invariant", "true | false", defaults::CURVATURE.scale_invariant, "parts may change their scale; false: the paper's Eq 7 without its last factor"),
            field("group_scales", "true | false", defaults::CURVATURE.group_scales, "pieces on different supports may be scaled on their own (Eq 11); false: bounds are absolute (Eq 10)"),
            field("mean_curvature", "true | false", defaults::CURVATURE.mean_curvature, "keep the division by the mean curvature (Eq 7), so that flat parts count as much as curved ones"),
            field("iterate", "count", defaults::CURVATURE.iterate, "most rounds with the Laplacian of the deformed surface (Eq 6), 0 to 100, best with hidden_weight: 1; in the report: `iterated`"),
            field("form", "Quadratic | Conic", form(), "of the program: Conic is the paper's appendix; same optimum"),
        ]),
        chapter("Whole(...)", "Whole closed models are deformed along the eye's rays, front, back and what is hidden; their outline lies on the support, free regions are held by nothing. Energy: Normal or Curvature.", vec![
            field("bounded", "Outline | Seen", "Seen", "what else is held: nothing, or all that is seen within `front` of the support"),
        ]),
        chapter("Gradient(...)", "Compresses the slopes of depth, then depth itself (Weyrich et al. 2007): a baseline, not an optimum.", vec![
            field("compression", "number", defaults::GRADIENT.compression, "alpha of log(1 + alpha g) / alpha, 0 to 1000: more evens out steep and gentle slopes; 0 is Linear without silhouettes"),
        ]),
        chapter("Printed(...)", "By a printer: walls and gaps by its nozzle. What misses the next two, or the printer's bed, is a warning.", vec![
            field("overhang", "length", format!("{} mm", defaults::OVERHANG), "how far reliefs may stand out over nothing: what one tower of a slicer's supports holds"),
            field("slenderness", "number", defaults::SLIMMEST, "how many times as high as wide a pillar may be"),
        ]),
        chapter("Milled(...)", "By a cutter, from a block: nothing is asked of overhangs and of a bed.", vec![
            field("tool", "length", format!("{} mm", defaults::TOOL), "width of the cutter: gaps beside carvings are as wide, narrower ones between pillars a failure"),
            field("wall", "length", format!("{} mm", defaults::MILLED_WALL), "thinner walls break"),
            field("slenderness", "number", defaults::SLIMMEST, "how many times as high as wide a pillar may be"),
        ]),
        chapter("Built(...)", "By other means, at any size: only what is seen is judged, and that it hangs together.", vec![
            field("finest", "length", format!("{} mm", defaults::FINEST_BUILT), "the finest that can be made: gaps beside carvings are as wide"),
            field("slenderness", "number", "no limit", "how many times as high as wide a pillar may be"),
        ]),
        chapter("printer", "Used by warnings, print checks and `build --split`.", vec![
            field("nozzle", "length", format!("{} mm", printer.nozzle), "width of a printed line"),
            field("bed", "(x, y, z)", format!("{:?} mm", printer.bed), "largest print"),
            field("clearance", "length", format!("{} mm", printer.clearance), "room between peg and socket, pin and hole, plate and plate"),
        ]),
        chapter("output", "What `build` writes besides report.json.", vec![
            field("forest_3mf", "true | false", output.forest_3mf, "for slicers: named and coloured objects"),
            field("forest_stl", "true | false", output.forest_stl, "one closed solid"),
            field("forest_glb", "true | false", output.forest_glb, "for viewers, with the eyes as cameras"),
            field("plan", "true | false", output.plan, "plan.svg and plan.png"),
            field("views", "true | false", output.views, "views/<view>.png"),
            field("lights", "true | false", output.lights, "each view under suns, an overcast sky and a flash beside the model: views/<view>-lights.png, and figures in report.json"),
            field("camouflage", "true | false", output.camouflage, "how like its model the forest is from elsewhere: camouflage.png and .svg, and figures in report.json"),
            field("split", "true | false", output.split, "plates, pillars one by one and layout.svg, as `build --split`"),
            field("report_html", "true | false", output.report_html, "report.html, the report with all pictures as one page for people"),
            field("surface", "true | false", output.surface, "surface-<view>.ply and .obj: the optimised surface before it is cut and scaled back"),
            field("groups", "true | false", output.groups, "groups-<view>.svg and .png: a section through the eye with the groups' bounds, the scales mu, the surface and its pieces"),
            field("turntable", "true | false", output.turntable, "turntable.png: the finished solid from seven sides, -90 to 90 degrees from the first view's eye"),
            field("picture_size", "count", output.picture_size, "pixels of one panel of a view's picture, and height of the turntable's, 64 to 4096"),
            field("plan_width", "count", output.plan_width, "pixels of plan.png and groups-<view>.png, 400 to 8000"),
        ]),
    ]
}

fn energy() -> &'static str {
    match defaults::ENERGY {
        Energy::Normal(_) => "Normal()",
        Energy::Curvature(_) => "Curvature()",
        Energy::Linear => "Linear",
        Energy::Gradient(_) => "Gradient()",
    }
}

fn form() -> &'static str {
    match defaults::CURVATURE.form {
        CurvatureForm::Quadratic => "Quadratic",
        CurvatureForm::Conic => "Conic",
    }
}

fn datum() -> &'static str {
    match defaults::LAYER.datum() {
        Datum::Plane => "Axis",
        Datum::Surface => "Surface",
    }
}

fn weight() -> &'static str {
    match defaults::NORMAL.weight {
        FaceWeight::Area => "Area",
        FaceWeight::SolidAngle => "SolidAngle",
    }
}

#[cfg(test)]
mod tests {
    use super::chapters;
    use crate::scene::language::raw;
    use ron::error::Error;
    use serde::de::DeserializeOwned;

    /// The field names a type takes, as serde tells them to whoever asks for an unknown one.
    fn fields_of<T: DeserializeOwned>() -> Vec<&'static str> {
        let error = crate::scene::text::spanned::options()
            .from_str::<T>("(no_such_field: 0)")
            .err();
        match error.map(|e| e.code) {
            Some(Error::NoSuchStructField { expected, .. }) => expected.to_vec(),
            other => panic!("not a struct that denies unknown fields: {other:?}"),
        }
    }

    #[test]
    fn every_field_is_documented_and_nothing_else() {
        let types = [
            ("scene", fields_of::<raw::RawScene>()),
            ("model", fields_of::<raw::RawModel>()),
            ("region", fields_of::<raw::RawModelRegion>()),
            ("Box(...)", fields_of::<raw::RawBox>()),
            ("Ball(...)", fields_of::<raw::RawBall>()),
            ("Fit(...)", fields_of::<raw::RawFit>()),
            ("view", fields_of::<raw::RawView>()),
            ("pillars", fields_of::<raw::RawPillars>()),
            ("Plate(...)", fields_of::<raw::RawPlate>()),
            ("Strips(...)", fields_of::<raw::RawStrips>()),
            ("Stairs(...)", fields_of::<raw::RawStairs>()),
            ("Groove(...)", fields_of::<raw::RawGroove>()),
            ("Wave(...)", fields_of::<raw::RawWave>()),
            ("Image(...)", fields_of::<raw::RawImage>()),
            ("Mesh(...)", fields_of::<raw::RawBody>()),
            ("Round(...)", fields_of::<raw::RawRound>()),
            ("Polygon(...)", fields_of::<raw::RawPolygon>()),
            (
                "Rectangle(...) as a pillar",
                fields_of::<raw::RawRectangle>(),
            ),
            ("Profile(...)", fields_of::<raw::RawProfile>()),
            ("depth", fields_of::<raw::RawDepth>()),
            ("Grid(...)", fields_of::<raw::RawGrid>()),
            ("Ring(...)", fields_of::<raw::RawRing>()),
            ("Hex(...)", fields_of::<raw::RawHex>()),
            ("Auto(...)", fields_of::<raw::RawAuto>()),
            ("Disc(...) as region", fields_of::<raw::RawDiscRegion>()),
            (
                "Rectangle(...) as region",
                fields_of::<raw::RawRectangleRegion>(),
            ),
            (
                "Polygon(...) as region",
                fields_of::<raw::RawPolygonRegion>(),
            ),
            ("matters", fields_of::<raw::RawMatters>()),
            ("models", fields_of::<raw::RawFreedom>()),
            ("layout file", fields_of::<raw::RawLayout>()),
            ("adjustment", fields_of::<raw::RawAdjust>()),
            ("Disc(...)", fields_of::<raw::RawDisc>()),
            ("Rectangle(...) as base", fields_of::<raw::RawSlab>()),
            ("Normal(...)", fields_of::<raw::RawNormal>()),
            ("Allowed(...)", fields_of::<raw::RawStepOptions>()),
            ("Curvature(...)", fields_of::<raw::RawCurvature>()),
            ("Whole(...)", fields_of::<raw::RawWhole>()),
            ("Gradient(...)", fields_of::<raw::RawGradient>()),
            ("Printed(...)", fields_of::<raw::RawPrinted>()),
            ("Milled(...)", fields_of::<raw::RawMilled>()),
            ("Built(...)", fields_of::<raw::RawBuilt>()),
            ("printer", fields_of::<raw::RawPrinter>()),
            ("output", fields_of::<raw::RawOutput>()),
        ];
        let documented: Vec<(&str, Vec<&str>)> = chapters()
            .iter()
            .map(|s| (s.title, s.fields.iter().map(|f| f.name).collect()))
            .collect();
        assert_eq!(documented.len(), types.len());
        for (title, fields) in types {
            let found = documented.iter().find(|(t, _)| *t == title).expect(title);
            assert_eq!(found.1, fields, "fields of {title}");
        }
    }
}
