//! Measured figures, kept in a text file between runs.

use crate::{SUBJECTS, SURFACES, SurfaceKind, THICKNESSES};
use std::fmt;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

const HEAD: &str = "scene,surface,layer_mm,view,views,mean_deg,median_deg,p90_deg";

/// Errors of the normals in degrees: mean, median, and what 90 % lie below.
type Errors = [f64; 3];

/// One view with one surface in one layer.
#[derive(Clone)]
pub(crate) struct Measured {
    pub scene: String,
    pub surface: String,
    pub mm: f64,
    pub view: String,
    pub errors: Errors,
}

impl Measured {
    fn key(&self) -> (&str, &str, f64, &str) {
        (&self.scene, &self.surface, self.mm, &self.view)
    }
}

/// A line of a Markdown table.
impl fmt::Display for Measured {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            scene,
            surface,
            mm,
            view,
            errors: [mean, median, p90],
        } = self;
        write!(
            f,
            "| {scene} | {surface} | {mm} | {view} | {mean:.2} | {median:.2} | {p90:.2} |"
        )
    }
}

/// All rows, each with the number of views its scene has; in the order of the tables.
pub(crate) struct Rows {
    path: Option<PathBuf>,
    rows: Vec<(Measured, usize)>,
}

impl Rows {
    /// Reads the rows of an earlier run, if there was one.
    pub(crate) fn open(path: Option<&Path>) -> Result<Self, String> {
        let text = match path.map(fs::read_to_string) {
            None => String::new(),
            Some(Err(e)) if e.kind() == ErrorKind::NotFound => String::new(),
            Some(read) => read.map_err(|e| format!("rows: {e}"))?,
        };
        let lines = text.lines().filter(|l| *l != HEAD);
        let parsed = lines.map(|l| parse(l).ok_or(format!("rows: this is none: {l}")));
        Ok(Self {
            path: path.map(Path::to_owned),
            rows: parsed.collect::<Result<_, _>>()?,
        })
    }

    /// Adds a row in place of an earlier one, and saves all.
    pub(crate) fn put(&mut self, row: Measured, views: usize) -> Result<(), String> {
        self.forget(&row);
        self.rows.push((row, views));
        self.rows.sort_by_key(|(r, _)| {
            let scene = SUBJECTS.iter().position(|s| s.scene == r.scene);
            let surface = SURFACES.iter().position(|s| s.name == r.surface);
            let mm = THICKNESSES.iter().position(|t| *t == r.mm);
            (scene, surface, mm, r.view.clone())
        });
        self.save()
    }

    /// Takes a row out that holds no longer, and saves the others.
    pub(crate) fn drop(&mut self, row: &Measured) -> Result<(), String> {
        self.forget(row);
        self.save()
    }

    fn forget(&mut self, row: &Measured) {
        self.rows.retain(|(r, _)| r.key() != row.key());
    }

    fn save(&self) -> Result<(), String> {
        let Some(path) = &self.path else {
            return Ok(());
        };
        let lines = self.rows.iter().map(|(r, views)| {
            let [mean, median, p90] = r.errors;
            let (scene, surface, mm, view) = r.key();
            format!("{scene},{surface},{mm},{view},{views},{mean:.4},{median:.4},{p90:.4}\n")
        });
        let text = format!("{HEAD}\n{}", lines.collect::<String>());
        fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn of(&self, scene: &str, surface: &str, mm: f64) -> Vec<&(Measured, usize)> {
        let same = |r: &Measured| r.scene == scene && r.surface == surface && r.mm == mm;
        self.rows.iter().filter(|(r, _)| same(r)).collect()
    }

    /// Whether every view is there.
    pub(crate) fn complete(&self, scene: &str, surface: &SurfaceKind, mm: f64) -> bool {
        self.average(scene, surface.name, mm).is_some()
    }

    /// The figures averaged over the views, if all are there.
    pub(crate) fn average(&self, scene: &str, surface: &str, mm: f64) -> Option<Errors> {
        let rows = self.of(scene, surface, mm);
        let count = rows.first()?.1;
        let mean = |k: usize| rows.iter().map(|r| r.0.errors[k]).sum::<f64>() / count as f64;
        (rows.len() == count).then(|| [0, 1, 2].map(mean))
    }

    /// The README's table: mean errors averaged over the views.
    pub(crate) fn summary(&self) -> String {
        let heads: String = THICKNESSES.iter().map(|t| format!(" {t} mm |")).collect();
        let mut text = format!(
            "| scene | surface |{heads}\n|---|---|{}\n",
            "---|".repeat(THICKNESSES.len())
        );
        for subject in &SUBJECTS {
            for surface in &SURFACES {
                let figure = |mm: &f64| match self.average(subject.scene, surface.name, *mm) {
                    Some([mean, ..]) => {
                        let digits = if mean < 2.0 { 2 } else { 1 };
                        format!(" {mean:.digits$} |")
                    }
                    None => " - |".to_owned(),
                };
                let figures: String = THICKNESSES.iter().map(figure).collect();
                let (scene, name, energy) = (subject.scene, surface.name, surface.energy);
                text += &format!("| {scene} | {name}: `{energy}` |{figures}\n");
            }
        }
        text
    }
}

fn parse(line: &str) -> Option<(Measured, usize)> {
    let words: Vec<&str> = line.split(',').collect();
    let [scene, surface, mm, view, views, mean, median, p90] = words[..] else {
        return None;
    };
    let row = Measured {
        scene: scene.into(),
        surface: surface.into(),
        mm: mm.parse().ok()?,
        view: view.into(),
        errors: [mean.parse().ok()?, median.parse().ok()?, p90.parse().ok()?],
    };
    Some((row, views.parse().ok()?))
}
