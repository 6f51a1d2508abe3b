//! Where scenes are built for figures: every case once, however many figures look at it.

use super::job::Job;
use super::made::Made;
use std::rc::Rc;

/// Builds a scene and writes its files, even where they are not all that a build promises.
pub type BuildJob<'a> = &'a mut dyn FnMut(&Job) -> Result<Made, String>;

/// See the module.
pub struct Workshop<'a> {
    build: BuildJob<'a>,
    figure: &'static str,
    made: Vec<Rc<Made>>,
}

impl<'a> Workshop<'a> {
    pub fn new(build: BuildJob<'a>) -> Self {
        Self {
            build,
            figure: "",
            made: Vec::new(),
        }
    }

    /// What is built from now on belongs to this figure.
    pub fn begin(&mut self, figure: &'static str) {
        self.figure = figure;
    }

    /// The scene with these changes, built now or before.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub fn build(&mut self, case: &str, scene: &str, sets: &[&str]) -> Result<Rc<Made>, String> {
        let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
        let same = |m: &&Rc<Made>| m.job.scene == scene && m.job.sets == sets;
        if let Some(made) = self.made.iter().find(same) {
            return Ok(made.clone());
        }
        let job = Job {
            scene: scene.to_owned(),
            sets,
            folder: format!("{}/{}", self.figure, slug(case)),
        };
        let made = (self.build)(&job).map_err(|why| format!("{case}: {why}"))?;
        self.made.push(Rc::new(made));
        Ok(self.made[self.made.len() - 1].clone())
    }
}

/// A name as a folder's: small letters, digits and hyphens.
fn slug(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        match c {
            c if c.is_ascii_alphanumeric() => out.push(c.to_ascii_lowercase()),
            _ if out.ends_with('-') || out.is_empty() => {}
            _ => out.push('-'),
        }
    }
    out.trim_end_matches('-').to_owned()
}

/// Outputs that comparisons do without.
pub(crate) const LEAN: [&str; 6] = [
    "output.lights=false",
    "output.camouflage=false",
    "output.report_html=false",
    "output.forest_glb=false",
    "output.forest_3mf=false",
    "output.plan=false",
];

/// Both lists as one.
pub(crate) fn with<'s>(sets: &[&'s str], more: &[&'s str]) -> Vec<&'s str> {
    [sets, more].concat()
}
