//! A figure of the paper, and what became of it here.

use super::findings::Findings;
use super::workshop::Workshop;

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
    pub make: fn(&mut Workshop, &mut Findings) -> Result<(), String>,
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
