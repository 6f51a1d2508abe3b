//! What a figure found: cases with measurements, claims, pictures.

use super::made::Made;
use crate::compile::OutputFile;

/// A number by its name, which tells its unit.
pub(crate) type Number = (&'static str, f64);

/// Everything found for a figure.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    pub cases: Vec<Case>,
    pub claims: Vec<Conclusion>,
    pub pictures: Vec<Picture>,
    /// Made by the figure itself.
    pub files: Vec<OutputFile>,
    /// What a reader should know.
    pub notes: Vec<String>,
}

/// One build, or one way to look at it.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    pub name: String,
    /// Path of the scene, for people.
    pub scene: String,
    pub sets: Vec<String>,
    pub measured: Vec<Number>,
    /// Whether the build kept its promises; true where a case is there to show what happens without.
    pub ok: bool,
}

/// A sentence with its numbers, and whether they bear it out.
#[derive(Clone, Debug, PartialEq)]
pub struct Conclusion {
    pub text: String,
    pub holds: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub caption: String,
    /// From the figures' folder.
    pub path: String,
}

impl Findings {
    /// Adds a build that is to keep all promises, its likeness and `more` numbers, and what its eyes see.
    ///
    /// # Errors
    /// The report lacks a number.
    pub fn case(&mut self, name: &str, made: &Made, more: &[Number]) -> Result<(), String> {
        self.add(name, made, more, made.keeps_promises())
    }

    /// The same of a build that shows what happens without some promise.
    ///
    /// # Errors
    /// The report lacks a number.
    pub fn counter_case(&mut self, name: &str, made: &Made, more: &[Number]) -> Result<(), String> {
        self.add(name, made, more, true)
    }

    fn add(&mut self, name: &str, made: &Made, more: &[Number], ok: bool) -> Result<(), String> {
        let errors = made.normal_errors()?;
        let mut measured = vec![
            ("error_mean_deg", errors.mean),
            ("error_median_deg", errors.median),
            ("error_p90_deg", errors.p90),
        ];
        measured.extend_from_slice(more);
        self.row(name, made, &measured, ok);
        for path in made.view_pictures() {
            self.picture(name, path);
        }
        Ok(())
    }

    /// Adds a row of numbers without pictures.
    pub fn row(&mut self, name: &str, made: &Made, measured: &[Number], ok: bool) {
        let mut measured = measured.to_vec();
        measured.push(("seconds", made.seconds));
        measured.extend(made.peak_mb.map(|mb| ("peak_memory_mb", mb)));
        self.cases.push(Case {
            name: name.to_owned(),
            scene: made.scene.clone(),
            sets: made.job.sets.clone(),
            measured,
            ok,
        });
    }

    pub fn picture(&mut self, caption: &str, path: String) {
        self.pictures.push(Picture {
            caption: caption.to_owned(),
            path,
        });
    }

    pub fn claim(&mut self, holds: bool, text: impl Into<String>) {
        let text = text.into();
        self.claims.push(Conclusion { text, holds });
    }

    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }
}
