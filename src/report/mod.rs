//! `report.json`, and [`html`] for people: what was built and how good it is.
//!
//! Every number has its unit in its name. The same scene gives the same bytes: times are not part of it.
//! The `views` list can be read back by any program that casts rays at the forest: it names each model's file and matrix.
//! What was written can be read into the same types ([`Report::read`]).

mod certificate;
mod document;
pub mod html;
mod print;
mod solid;
mod view;

pub use certificate::{CertificateReport, ModelShare, OPTIMAL, Proof};
pub use document::{Report, Software};
pub use print::PrintReport;
pub use solid::{RepairReport, SolidCheck, SolidReport};
pub use view::{ModelReport, NormalError, ProgramReport, ViewReport};
