//! The figures of the paper, made again: each is a scene, a picture and numbers, with what the paper says beside them.
//!
//! Takes a way to build scenes (the library touches no files), gives for every figure the cases that were built, what was measured on
//! them, claims that were checked on the measurements, and the page ([`page`]), table ([`table`]) and rows for scripts
//! ([`json`]) that show all. Figures only read what any build tells everybody:
//! its [report](crate::report), times and pictures. A case that cannot be built makes
//! its figure fail and no other.
//!
//! Statements are about Schueller, Panozzo & Sorkine-Hornung, *Appearance-Mimicking Surfaces* (SIGGRAPH Asia 2014), in our words.
//!
//! Here too, for benchmarks: what comparisons of energies measure without building anything ([`measure`]), and a ball of any size on a
//! plate ([`bumpy_ball`], [`PLATE`]) to see how time grows.

mod ball;
mod compare;
mod energies;
mod figure;
mod findings;
mod job;
mod json;
mod light;
mod made;
pub mod measure;
mod method;
mod page;
mod reliefs;
mod scaling;
mod table;
mod table_one;
mod workshop;

pub use ball::bumpy_ball;
pub use figure::{Done, Figure};
pub use findings::{Case, Conclusion, Findings, Picture};
pub use job::Job;
pub use json::json;
pub use made::Made;
pub use page::page;
pub use scaling::{PLATE, SIZES, WAYS, exponent};
pub use table::table;
pub use table_one::TIMES;
pub use workshop::{BuildJob, Workshop};

use crate::compile::OutputFile;

/// All figures in the paper's order.
pub const FIGURES: [Figure; 19] = [
    reliefs::STAIRS,
    reliefs::GROOVE,
    energies::SCALE,
    energies::BOX,
    energies::MEAN_CURVATURE,
    method::GROUPS,
    method::ORDERING,
    energies::HIDDEN,
    compare::DEPTHS,
    compare::GRADIENTS,
    reliefs::FREE,
    reliefs::WAVE,
    reliefs::FOREST,
    reliefs::STRIPS,
    reliefs::HERD,
    light::SUN_AND_CLOUD,
    light::FLASH,
    TIMES,
    energies::CONIC,
];

/// Makes one figure; where that fails, with what was found before.
pub fn make(figure: Figure, workshop: &mut Workshop) -> Done {
    workshop.begin(figure.name);
    let mut findings = Findings::default();
    let failure = (figure.make)(workshop, &mut findings).err();
    Done {
        figure,
        findings,
        failure,
    }
}

/// What is written in any case.
pub const FILES: [&str; 3] = ["index.html", "figures.md", "figures.json"];

/// Everything that is written besides what the builds wrote.
pub fn files(done: &[Done]) -> Vec<OutputFile> {
    let file = |path: &str, text: String| OutputFile::new(path, text.into_bytes());
    let mut files = vec![
        file("index.html", page(done)),
        file("figures.md", table(done)),
        file("figures.json", json(done)),
    ];
    files.extend(done.iter().flat_map(|d| d.findings.files.clone()));
    files
}
