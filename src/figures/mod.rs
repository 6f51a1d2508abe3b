//! The figures of the paper, made again: each is a scene, a picture and numbers, with what the paper says beside them.
//!
//! Takes a way to build scenes (the library touches no files), gives for every figure the cases that were built, what was measured on
//! them, claims that were checked on the measurements, and the page ([`page`]), table ([`table`]) and rows for scripts
//! ([`json`]) that show all. Figures only read what any build tells everybody: `report.json`, times and pictures. A case that cannot be built makes
//! its figure fail and no other.
//!
//! Statements are about Schueller, Panozzo & Sorkine-Hornung, *Appearance-Mimicking Surfaces* (SIGGRAPH Asia 2014), in our words.

mod compare;
mod energies;
mod findings;
mod json;
mod light;
mod made;
mod method;
mod page;
mod reliefs;
mod table;
mod table_one;
mod workshop;

pub use findings::{Case, Claim, Findings, Picture};
pub use json::json;
pub use made::Made;
pub use page::page;
pub use table::table;
pub use workshop::{Build, Order, Workshop};

use crate::compile::OutputFile;

/// One figure of the paper.
#[derive(Clone, Copy)]
pub struct Figure {
    /// On the command line and in file names.
    pub name: &'static str,
    /// As the paper numbers it.
    pub paper: &'static str,
    pub title: &'static str,
    /// What the paper says or shows.
    pub statement: &'static str,
    make: fn(&mut Workshop, &mut Findings) -> Result<(), String>,
}

/// A figure with what was found for it.
pub struct Done {
    pub figure: Figure,
    pub findings: Findings,
    /// Why it could not be finished.
    pub failure: Option<String>,
}

impl Done {
    /// Whether it could be made, every build kept its promises where it is meant to, and every claim holds.
    pub fn ok(&self) -> bool {
        let findings = &self.findings;
        self.failure.is_none()
            && findings.cases.iter().all(|c| c.ok)
            && findings.claims.iter().all(|c| c.holds)
    }
}

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
    table_one::TIMES,
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

/// Everything that is written besides what the builds wrote.
pub fn files(done: &[Done]) -> Vec<OutputFile> {
    let file = |path: &str, text: String| OutputFile {
        path: path.into(),
        bytes: text.into_bytes(),
    };
    let mut files = vec![
        file("index.html", page(done)),
        file("figures.md", table(done)),
        file("figures.json", json(done)),
    ];
    files.extend(done.iter().flat_map(|d| d.findings.files.clone()));
    files
}
