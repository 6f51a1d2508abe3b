//! What a build tells of itself.

use super::job::Job;
use crate::render::LightLikeness;
use crate::report::{
    CertificateReport, NormalError, ProgramReport, Report, SolidReport, ViewReport,
};

/// A built scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    pub job: Job,
    /// Path of the scene, for people.
    pub scene: String,
    pub report: Report,
    pub seconds: f64,
    /// Stages in order with their seconds.
    pub stages: Vec<(String, f64)>,
    /// Largest memory of the build, where the system tells.
    pub peak_mb: Option<f64>,
    /// Files it wrote, from its own folder.
    pub files: Vec<String>,
}

impl Made {
    /// What the report may leave out, of every view.
    fn of_views<T>(
        &self,
        what: &str,
        get: impl Fn(&ViewReport) -> Option<T>,
    ) -> Result<Vec<T>, String> {
        let found: Option<Vec<T>> = self.report.views.iter().map(get).collect();
        found.ok_or_else(|| self.lacks(what))
    }

    fn lacks(&self, what: &str) -> String {
        format!("report.json of {} has no {what}", self.scene)
    }

    /// A figure of every view's certificate.
    fn certified(&self, get: impl Fn(&CertificateReport) -> f64) -> Result<Vec<f64>, String> {
        self.of_views("certificate", |v| v.certificate.as_ref().map(&get))
    }

    /// Mean over the views' certificates.
    ///
    /// # Errors
    /// A view has none.
    pub fn mean(&self, get: impl Fn(&CertificateReport) -> f64) -> Result<f64, String> {
        self.certified(get).map(|all| mean(&all))
    }

    /// Sum over the views' certificates.
    ///
    /// # Errors
    /// A view has none.
    pub fn sum(&self, get: impl Fn(&CertificateReport) -> f64) -> Result<f64, String> {
        Ok(self.certified(get)?.iter().sum())
    }

    /// Largest of the views' certificates.
    ///
    /// # Errors
    /// A view has none.
    pub fn most(&self, get: impl Fn(&CertificateReport) -> f64) -> Result<f64, String> {
        Ok(self.certified(get)?.into_iter().fold(0.0, f64::max))
    }

    /// Pairs of faces of the optimised surfaces that go through each other.
    ///
    /// # Errors
    /// A view's surface was not looked at.
    pub fn self_intersections(&self) -> Result<f64, String> {
        let crossings = |v: &ViewReport| v.certificate.as_ref()?.crossings;
        let all = self.of_views("crossings", crossings)?;
        Ok(all.iter().map(|c| c.self_intersections).sum::<usize>() as f64)
    }

    /// Depth groups of all views.
    ///
    /// # Errors
    /// A view does not tell.
    pub fn groups(&self) -> Result<f64, String> {
        let all = self.of_views("number of groups", |v| v.groups)?;
        Ok(all.iter().sum::<usize>() as f64)
    }

    /// Vertices and faces of all views' models.
    pub fn sizes(&self) -> (f64, f64) {
        let views = self.report.views.iter();
        let sizes = views.map(|v| (v.vertices, v.faces));
        let (vertices, faces): (Vec<usize>, Vec<usize>) = sizes.unzip();
        let sum = |list: Vec<usize>| list.iter().sum::<usize>() as f64;
        (sum(vertices), sum(faces))
    }

    /// Angles between the normals of model and solid: means over the views.
    ///
    /// # Errors
    /// A view was not measured.
    pub fn normal_errors(&self) -> Result<NormalError, String> {
        let all = self.of_views("error of the normals", |v| v.normal_error_deg)?;
        let of = |get: fn(&NormalError) -> f64| mean(&all.iter().map(get).collect::<Vec<_>>());
        Ok(NormalError {
            mean: of(|e| e.mean),
            median: of(|e| e.median),
            p90: of(|e| e.p90),
        })
    }

    /// Mean angle between the normals of model and solid, degrees.
    ///
    /// # Errors
    /// A view was not measured.
    pub fn error_deg(&self) -> Result<f64, String> {
        Ok(self.normal_errors()?.mean)
    }

    /// The first view.
    ///
    /// # Errors
    /// There is none.
    pub fn first_view(&self) -> Result<&ViewReport, String> {
        self.report.views.first().ok_or_else(|| self.lacks("view"))
    }

    /// The program of the first view.
    ///
    /// # Errors
    /// There is none.
    pub fn program(&self) -> Result<&ProgramReport, String> {
        let program = self.first_view()?.program.as_ref();
        program.ok_or_else(|| self.lacks("program"))
    }

    /// The solid.
    ///
    /// # Errors
    /// There is none.
    pub fn solid(&self) -> Result<&SolidReport, String> {
        self.report
            .solid
            .as_ref()
            .ok_or_else(|| self.lacks("solid"))
    }

    /// A figure of a light of the first view.
    ///
    /// # Errors
    /// The scene does not measure it.
    pub fn in_light(
        &self,
        light: &str,
        get: impl Fn(&LightLikeness) -> Option<f64>,
    ) -> Result<f64, String> {
        let lights = self.first_view()?.lights.iter().flatten();
        let mut of_light = lights.filter(|l| l.light == light);
        of_light
            .find_map(get)
            .ok_or_else(|| format!("{} lacks a figure of the light {light}", self.scene))
    }

    /// Whether all holds that a build promises.
    pub fn keeps_promises(&self) -> bool {
        self.report.ok
    }

    /// How far reliefs leave their layers or had to be moved into them, millimetres.
    ///
    /// # Errors
    /// There is no certificate.
    pub fn outside_mm(&self) -> Result<f64, String> {
        self.most(|c| c.bound_violation_mm.max(c.clamp_mm))
    }

    /// Seconds of a stage; 0 if it did not run.
    pub fn stage_seconds(&self, stage: &str) -> f64 {
        let stage = self.stages.iter().find(|s| s.0 == stage);
        stage.map_or(0.0, |s| s.1)
    }

    /// Path of a file from the figures' folder.
    fn path(&self, file: &str) -> String {
        format!("{}/{file}", self.job.folder)
    }

    /// Path of the file whose name `is` the one, from the figures' folder.
    ///
    /// # Errors
    /// The build wrote none.
    pub fn file(&self, what: &str, is: impl Fn(&str) -> bool) -> Result<String, String> {
        let file = self.files.iter().find(|f| is(f));
        let file = file.ok_or_else(|| format!("{} writes no {what}", self.scene))?;
        Ok(self.path(file))
    }

    /// The pictures of what every eye sees, from the figures' folder.
    pub fn view_pictures(&self) -> Vec<String> {
        let is_picture = |f: &&String| {
            f.starts_with("views/") && f.ends_with(".png") && !f.ends_with("-lights.png")
        };
        let all = self.files.iter().filter(is_picture);
        all.map(|f| self.path(f)).collect()
    }
}

fn mean(all: &[f64]) -> f64 {
    all.iter().sum::<f64>() / all.len().max(1) as f64
}
