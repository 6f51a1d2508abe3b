//! The report as a whole.

use super::print::PrintReport;
use super::solid::SolidReport;
use super::view::ViewReport;
use crate::certify::camouflage::Camouflage;
use crate::diag::Diagnostic;
use crate::ladder::Ladder;
use serde::{Deserialize, Serialize};

/// The whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    pub program: Software,
    /// Title of the scene.
    pub scene: String,
    /// Whether all holds that a build promises; else what does not.
    pub ok: bool,
    pub failures: Vec<String>,
    pub views: Vec<ViewReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid: Option<SolidReport>,
    /// What eyes elsewhere recognise, one for each view.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub camouflage: Vec<Camouflage>,
    /// Whether it can be printed; empty if nothing was built.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub print: Vec<PrintReport>,
    /// Where a stage has several ways to go about its work: which of them held.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ladders: Vec<Ladder>,
    pub warnings: Vec<String>,
}

/// What wrote a report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Software {
    pub name: String,
    pub version: String,
}

impl Default for Software {
    /// This one.
    fn default() -> Self {
        Self {
            name: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

impl Report {
    /// Adds what does not hold, and what is worth a warning.
    pub fn judge(&mut self, failures: &[Diagnostic], warnings: &[Diagnostic]) {
        let texts = |list: &[Diagnostic]| list.iter().map(|d| d.message.clone()).collect();
        self.ok = failures.is_empty();
        self.failures = texts(failures);
        self.warnings = texts(warnings);
    }

    /// What [`Report::json`] wrote.
    ///
    /// # Errors
    /// What is not as a report has it, and where. Among them are numbers that were not finite.
    pub fn read(json: &[u8]) -> Result<Self, serde_json::Error> {
        serde_json::from_slice(json)
    }

    /// The file's text, with a line break at its end.
    ///
    /// # Panics
    /// Never: all keys are texts. Numbers that are not finite become `null`.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report of plain values") + "\n"
    }
}
