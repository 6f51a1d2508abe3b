//! Every default of the scene language, and every limit. Lengths in millimetres, angles in degrees.

use crate::contest::Contested;
use crate::kinds::Bounded;
use crate::mimic::{CurvatureOptions, Energy, FaceWeight, GradientOptions, NormalOptions};
use crate::planner::Matters;
use crate::scene::resolved::{Output, Printer};
use crate::steps::{Prefer, StepLimits, StepOptions};
use crate::support::{Extent, Layer, SUNK_MM};

/// Title of a scene that has none.
pub const TITLE: &str = "Pillar forest";

/// Pillars: height above the base's top.
pub const PILLAR_HEIGHT: f64 = 90.0;
/// Facets of a round pillar: at radius 4 mm the outline stays within 0.005 mm of the circle, far below a printer's step.
pub const ROUND_FACETS: u32 = 64;

/// Where reliefs may lie if the scene does not say: the slab that kept normals best on 8 mm pillars.
pub const LAYER: Layer = Layer {
    extent: Extent::Plane { back: 2.0 },
    front: 5.0,
    core: 1.0,
    hull: false,
};
/// Layers of supports that are no pillars: reliefs stand on them.
pub const ON_BODIES: Layer = Layer {
    extent: Extent::Plane { back: SUNK_MM },
    front: 5.0,
    core: 1.0,
    hull: false,
};
/// On thinner pillars the default `back` and `core` shrink to these shares of the room behind the datum
/// (radius or half width from the axis, width from the surface), so that such pillars work without further ado.
pub const BACK_SHARE: f64 = 0.5;
pub const CORE_SHARE: f64 = 0.25;

/// `Auto`: a forest that stands on a 150 mm base, which most printers take, if neither region nor base is given.
pub const REGION_RADIUS: f64 = 70.0;
/// What the region leaves of a base whose size is given: a pillar on the very edge would break out of it.
pub const REGION_RIM: f64 = 1.0;
/// Corners of a disc: its sides run within 0.02 mm of a circle of 70 mm.
pub const REGION_CORNERS: u32 = 128;
/// Radius of the pillars: the slimmest that carry the default layer with a sound core.
pub const PLANNED_RADIUS: f64 = 4.0;
/// Sizes between the smallest and the largest: with more of them a search takes longer and finds nothing better.
pub const SIZES: usize = 5;
/// Sizes are written with this many decimals of a millimetre: a tenth of what a printer resolves.
pub const SIZE_DECIMALS: i32 = 2;
/// Places and heights are written with this many.
pub const PLACE_DECIMALS: i32 = 3;
/// Other lengths and angles with this many, so that what was given in inches or radians stays what it was but for a rounding.
pub const LENGTH_DECIMALS: i32 = 9;
/// Room between solids: enough that 0.4 mm nozzles leave a gap and not a row of bridges.
pub const GAP: f64 = 0.5;
pub const COUNT: [u32; 2] = [1, 200];
pub const SEED: u32 = 1;
/// Candidates times views, as a candidate takes as long as there are views: some seconds; ten times as many gain a degree or two.
pub const TRIES: u32 = 320_000;

/// Candidates of a scene with so many views.
pub fn tries(views: usize) -> u64 {
    u64::from(TRIES) / views.max(1) as u64
}

/// Wall-clock seconds: only slow machines and many views ever reach it, so that plans rarely depend on the machine.
pub const SECONDS: f64 = 60.0;
/// From how far off, degrees, models are to be hidden: a step to the side in front of a forest half a metre away.
pub const HIDDEN_FROM: f64 = 10.0;
pub const MATTERS: Matters = Matters {
    camouflage: 1.0,
    tolerance: 1.0,
    pillars: 0.0,
    spread: 0.0,
};

/// Base: slab thickness, the room it leaves around the outermost pillar, facets of a disc.
pub const BASE_THICKNESS: f64 = 5.0;
pub const BASE_MARGIN: f64 = 5.0;
pub const BASE_FACETS: u32 = 128;
/// How far pillars are sunk into the base, so that the union is a real overlap; half the base's thickness if that is less.
pub const SINK: f64 = 1.0;

/// Supports that are no pillars: thickness behind the face, a step's rise and going, room between strips, spacing of a wave's grid,
/// and the largest number of its points (a solid of a million takes a minute).
pub const BODY_THICKNESS: f64 = 5.0;
pub const STEP: [f64; 2] = [17.0, 20.0];
pub const STRIP_GAP: f64 = 0.0;
pub const WAVE_PITCH: f64 = 1.0;
pub const MOST_WAVE_POINTS: f64 = 1e6;
/// Of an image of heights: a photograph has as many, and unpacked they take 300 MB.
pub const MOST_PIXELS: u64 = 25_000_000;
pub const LONGEST_FORMULA: usize = 1000;
pub const LEANS: std::ops::RangeInclusive<f64> = -80.0..=90.0;
pub const CREASES: std::ops::RangeInclusive<f64> = 0.0..=180.0;
/// Where supports look that do not say: as models do in their files.
pub const FACING: [f64; 2] = [0.0, -1.0];
pub const MOST_BODIES: usize = 1000;

/// The most vertices of a model, if a scene says so. Below 100 nothing is left of most models.
pub const DETAILS: std::ops::RangeInclusive<u32> = 100..=10_000_000;
/// Drafts: the paper's interactive sizes begin here, and its programs are solved in seconds.
pub const DRAFT_DETAIL: u32 = 10_000;
pub const DRAFT_PICTURE_SIZE: u32 = 320;
pub const FINAL_PICTURE_SIZE: u32 = 1024;

/// Model axes in the file: which way is up, which way is the side to be seen.
pub const UP: &str = "z";
pub const FRONT: &str = "-y";

/// What is minimised: the energy that keeps normals better under the same bounds (see README).
pub const NORMAL: NormalOptions = NormalOptions {
    weight: FaceWeight::Area,
    ordering: true,
    reweight: 0,
};
/// Rounds of reweighting: after ten nothing moves.
pub const REWEIGHT: std::ops::RangeInclusive<u32> = 0..=20;

/// Steps, where they are allowed. The price gives mean errors of a tenth of a degree on the reference forest; at 3 lines get
/// 5 % longer and nothing looks better, at 300 they get 10 % shorter and the error reaches a degree.
pub const STEPS: StepOptions = StepOptions {
    limits: StepLimits {
        least_mm: 0.1,
        highest_mm: None,
        tolerance_mm: None,
    },
    most: None,
    price: 30.0,
    narrowest_mm: PRINTER.nozzle,
    prefer: Prefer::Tolerance,
};
/// From this number of pillars on steps are allowed if the scene does not say: a single support is a plate or a figure that
/// is touched and seen from nearby.
pub const STEPS_FROM_PILLARS: usize = 2;
pub const CURVATURE: CurvatureOptions = CurvatureOptions::PAPER;
/// Rounds of the nonlinear problem: the box of the paper needs about ten.
pub const ITERATE: std::ops::RangeInclusive<u32> = 0..=100;
/// Attenuation of gradients: slopes of 1 become 0.69. The owl's normals are off by 16.6, 16.8, 17.5, 21.4 and 29.1 degrees at 0.5,
/// 1, 2, 5 and 20: from 2 on broad forms are lost to details.
pub const GRADIENT: GradientOptions = GradientOptions { compression: 1.0 };
pub const COMPRESSION: std::ops::RangeInclusive<f64> = 0.0..=1000.0;
pub const ENERGY: Energy = Energy::Normal(NORMAL);

/// What of whole meshes is held: more of them is a relief of a few millimetres.
pub const BOUNDED: Bounded = Bounded::Seen;

/// Who gets surface that two views want: with the order of the views the user decides.
pub const CONTESTED: Contested = Contested::First;

pub const PRINTER: Printer = Printer {
    nozzle: 0.4,
    bed: [256.0, 256.0, 256.0],
    clearance: 0.15,
};

pub const OUTPUT: Output = Output {
    forest_3mf: true,
    forest_stl: true,
    forest_glb: true,
    plan: true,
    views: true,
    lights: true,
    camouflage: true,
    split: false,
    report_html: true,
    surface: false,
    groups: false,
    turntable: false,
    picture_size: 640,
    plan_width: 2000,
};

/// View colours in order of appearance: Okabe & Ito's palette, which colour-blind people can tell apart
/// (its black and yellow left out: they vanish on plans).
pub const PALETTE: [[u8; 3]; 6] = [
    [0xd5, 0x5e, 0x00],
    [0x00, 0x72, 0xb2],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
];

/// Largest coordinate or length: ten metres. Beyond it something is in the wrong unit.
pub const LARGEST: f64 = 10_000.0;
/// Scene text, bytes.
pub const LONGEST_TEXT: usize = 8 << 20;
/// Title and names, characters.
pub const LONGEST_TITLE: usize = 200;
pub const LONGEST_NAME: usize = 64;
pub const MOST_VIEWS: usize = 32;
pub const MOST_MODELS: usize = 256;
/// Regions of one model.
pub const MOST_REGIONS: usize = 64;
/// Factors on the weight of vertices; they count squared, so that beyond these a program loses its digits.
pub const VERTEX_WEIGHTS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;
/// More pillars than this are refused before anything is allocated, more than the second take slicers very long.
pub const MOST_PILLARS: u64 = 20_000;
pub const MANY_PILLARS: u64 = 1_500;
pub const MOST_POINTS: usize = 2_000;
/// Corners of all pillars' outlines together: a solid takes some hundred bytes for each. 20,000 round pillars have 1.3 million.
pub const MOST_CORNERS: u64 = 2_000_000;
/// Sum of the squares of each outline's corners, for what is quadratic in them (widths, triangles): a second or two.
pub const MOST_CORNER_PAIRS: u64 = 1_000_000_000;
/// Shapes that planned pillars may have, before their sizes.
pub const MOST_SHAPES: usize = 8;
/// Factors on the size of a shape: beyond them it is another shape.
pub const SIZE_FACTORS: std::ops::RangeInclusive<f64> = 0.1..=10.0;
pub const TRIES_ALLOWED: std::ops::RangeInclusive<u32> = 1..=10_000_000;
/// Up to a day.
pub const SECONDS_ALLOWED: std::ops::RangeInclusive<f64> = 0.01..=86_400.0;
pub const HIDDEN_ALLOWED: std::ops::RangeInclusive<f64> = 1.0..=90.0;
pub const WEIGHTS: std::ops::RangeInclusive<f64> = 0.0..=1000.0;
/// How far a layout may change the models of a view: degrees, and factors down to the inverse.
pub const MOST_TURN: f64 = 180.0;
pub const MOST_SCALE: f64 = 2.0;
pub const FACETS: std::ops::RangeInclusive<u32> = 8..=512;
pub const PICTURE_SIZES: std::ops::RangeInclusive<u32> = 64..=4096;
pub const PLAN_WIDTHS: std::ops::RangeInclusive<u32> = 400..=8000;

/// Slimmer pillars than this height to width break on the printer, and under a cutter.
pub const SLIMMEST: f64 = 30.0;
pub const SLENDERNESS_ALLOWED: std::ops::RangeInclusive<f64> = 1.0..=1000.0;
/// Farther than this a ledge is not held by one tower of a slicer's supports, which are 10 mm wide or less. A choice: the layers of
/// reliefs on pillars (7 mm) stay below it, a table top does not.
pub const OVERHANG: f64 = 10.0;
/// A cutter for wood or foam, and the wall it leaves standing.
pub const TOOL: f64 = 3.0;
pub const MILLED_WALL: f64 = 1.0;
/// What is built by hand.
pub const FINEST_BUILT: f64 = 1.0;
/// What a good eye resolves, arc-minutes: gaps nowhere wider go unseen.
pub const SEEN: f64 = 1.0;
pub const SEEN_ALLOWED: std::ops::RangeInclusive<f64> = 0.0..=60.0;
