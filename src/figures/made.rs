//! What a build tells of itself.

use super::workshop::Order;
use serde_json::Value;

/// A built scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    pub order: Order,
    /// Path of the scene, for people.
    pub scene: String,
    /// `report.json`.
    pub report: Value,
    pub seconds: f64,
    /// Stages in order with their seconds.
    pub stages: Vec<(String, f64)>,
    /// Largest memory of the build, where the system tells.
    pub peak_mb: Option<f64>,
    /// Files it wrote, from its own folder.
    pub files: Vec<String>,
}

impl Made {
    /// A number of the report by its JSON pointer.
    ///
    /// # Errors
    /// There is none.
    pub fn number(&self, pointer: &str) -> Result<f64, String> {
        let found = self.report.pointer(pointer).and_then(Value::as_f64);
        found.ok_or_else(|| format!("report.json of {} has no number {pointer}", self.scene))
    }

    /// A number of every view.
    ///
    /// # Errors
    /// A view has none.
    pub fn of_views(&self, pointer: &str) -> Result<Vec<f64>, String> {
        let count = self.report["views"].as_array().map_or(0, Vec::len);
        (0..count)
            .map(|v| self.number(&format!("/views/{v}{pointer}")))
            .collect()
    }

    /// Mean over the views.
    ///
    /// # Errors
    /// As [`Made::of_views`].
    pub fn mean(&self, pointer: &str) -> Result<f64, String> {
        let all = self.of_views(pointer)?;
        Ok(all.iter().sum::<f64>() / all.len().max(1) as f64)
    }

    /// Sum over the views.
    ///
    /// # Errors
    /// As [`Made::of_views`].
    pub fn sum(&self, pointer: &str) -> Result<f64, String> {
        Ok(self.of_views(pointer)?.iter().sum())
    }

    /// Largest of the views.
    ///
    /// # Errors
    /// As [`Made::of_views`].
    pub fn most(&self, pointer: &str) -> Result<f64, String> {
        Ok(self.of_views(pointer)?.into_iter().fold(0.0, f64::max))
    }

    /// Mean angle between the normals of model and solid, degrees.
    ///
    /// # Errors
    /// There is none.
    pub fn error_deg(&self) -> Result<f64, String> {
        self.mean("/normal_error_deg/mean")
    }

    /// A figure of a light of the first view.
    ///
    /// # Errors
    /// The scene does not measure that light.
    pub fn in_light(&self, light: &str, figure: &str) -> Result<f64, String> {
        let lights = self.report.pointer("/views/0/lights");
        let lights = lights.and_then(Value::as_array).into_iter().flatten();
        lights
            .filter(|l| l["light"] == light)
            .find_map(|l| l[figure].as_f64())
            .ok_or_else(|| format!("{} measures no {figure} in the light {light}", self.scene))
    }

    /// Whether all holds that a build promises.
    pub fn keeps_promises(&self) -> bool {
        self.report["ok"] == true
    }

    /// How far reliefs leave their layers or had to be moved into them, millimetres.
    ///
    /// # Errors
    /// There is no certificate.
    pub fn outside_mm(&self) -> Result<f64, String> {
        let violation = self.most("/certificate/bound_violation_mm")?;
        Ok(violation.max(self.most("/certificate/clamp_mm")?))
    }

    /// Seconds of a stage; 0 if it did not run.
    pub fn stage_seconds(&self, stage: &str) -> f64 {
        let stage = self.stages.iter().find(|s| s.0 == stage);
        stage.map_or(0.0, |s| s.1)
    }

    /// Path of a file from the figures' folder.
    fn path(&self, file: &str) -> String {
        format!("{}/{file}", self.order.folder)
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
