//! What is in anybody's mesh file and whether it can be printed.
//!
//! Nothing is repaired here: the mesh is only rounded to the f32 coordinates of printable files and its equal
//! vertices are joined, as every slicer does.

use crate::diag::{Diagnostic, Warned, escaped};
use crate::formats::{MeshFormat, NamedMesh, read_bodies};
use crate::mesh::defects::{Defect, check};
use crate::mesh::size::size_doubt;
use crate::mesh::topology::{Edges, vertex_parts};
use crate::mesh::weld::{drop_unreferenced, rounded_to_f32, weld};
use crate::mesh::{Attributes, TriMesh};
use crate::words::gate::doubted;
use serde::Serialize;
use std::fmt;

/// A file's bodies and all of them together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inspection {
    pub file: String,
    pub format: &'static str,
    printable: bool,
    /// One for STL, OBJ and PLY, each placed object for 3MF.
    pub bodies: Vec<BodyReport>,
    /// All bodies as one surface; absent if there is one body only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub together: Option<BodyReport>,
}

impl Inspection {
    /// Whether each body by itself can be printed. (Bodies of one file may share walls on purpose: colours.)
    pub fn printable(&self) -> bool {
        self.printable
    }
}

/// Figures of one surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyReport {
    pub name: String,
    pub triangles: usize,
    /// After equal ones are joined.
    pub vertices: usize,
    /// Pieces that share no vertex.
    pub parts: usize,
    pub min_mm: [f64; 3],
    pub max_mm: [f64; 3],
    pub size_mm: [f64; 3],
    /// Absent for open surfaces, which have none.
    pub volume_mm3: Option<f64>,
    pub area_mm2: f64,
    pub printable: bool,
    pub defects: Vec<DefectReport>,
}

/// A [`Defect`] for programs and people.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DefectReport {
    pub kind: &'static str,
    pub count: usize,
    /// Whether there may be more than `count`.
    pub at_least: bool,
    pub example_mm: Option<[f64; 3]>,
    pub text: String,
    pub blocks_printing: bool,
}

/// Reads a mesh file and checks what is in it.
///
/// # Errors
/// Files that cannot be read as a mesh; a mesh with defects is no error.
pub fn inspect(file_name: &str, bytes: &[u8]) -> Result<Warned<Inspection>, Diagnostic> {
    let Warned {
        value: bodies,
        mut warnings,
    } = read_bodies(file_name, bytes)?;
    let mut all = TriMesh::default();
    for body in &bodies {
        all.append(&body.mesh);
    }
    warnings.extend(size_doubt(&with_faces(&all)).map(|doubt| doubted(file_name, doubt)));
    let reports: Vec<BodyReport> = bodies.into_iter().map(body_report).collect();
    let together = (reports.len() > 1).then(|| {
        body_report(NamedMesh {
            name: "all together".to_owned(),
            mesh: all,
            attributes: Attributes::default(),
        })
    });
    let inspection = Inspection {
        file: file_name.to_owned(),
        format: MeshFormat::of(file_name).map_or("", MeshFormat::name),
        printable: reports.iter().all(|r| r.printable),
        bodies: reports,
        together,
    };
    Ok(Warned {
        value: inspection,
        warnings,
    })
}

fn body_report(body: NamedMesh) -> BodyReport {
    let mesh = weld(&rounded_to_f32(&body.mesh), 0.0).mesh;
    let defects: Vec<DefectReport> = check(&mesh).iter().map(defect_report).collect();
    let closed = Edges::new(&mesh).iter().all(|e| e.len() % 2 == 0);
    let (lo, hi) = with_faces(&mesh).bounds().unwrap_or_default();
    BodyReport {
        name: body.name,
        triangles: mesh.faces.len(),
        vertices: mesh.vertices.len(),
        parts: vertex_parts(&mesh).0,
        min_mm: lo.to_array(),
        max_mm: hi.to_array(),
        size_mm: (hi - lo).to_array(),
        volume_mm3: closed.then(|| mesh.volume()),
        area_mm2: mesh.area(),
        printable: !defects.iter().any(|d| d.blocks_printing),
        defects,
    }
}

/// The mesh without vertices that no face uses: how large it is they do not say.
fn with_faces(mesh: &TriMesh) -> TriMesh {
    let mut used = mesh.clone();
    drop_unreferenced(&mut used);
    used
}

fn defect_report(defect: &Defect) -> DefectReport {
    DefectReport {
        kind: defect.kind.name(),
        count: defect.count,
        at_least: defect.at_least,
        example_mm: defect.place.map(|p| p.to_array()),
        text: defect.to_string(),
        blocks_printing: defect.blocks_printing(),
    }
}

impl fmt::Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.printable {
            "printable"
        } else {
            "not printable"
        };
        let count = self.bodies.len();
        let bodies = if count == 1 {
            String::new()
        } else {
            format!(", {count} bodies")
        };
        let file = escaped(&self.file);
        writeln!(f, "{file}: {}{bodies}, {verdict}", self.format)?;
        for body in &self.bodies {
            write!(f, "{body}")?;
        }
        let Some(together) = &self.together else {
            return Ok(());
        };
        together.figures(f)?;
        match (together.defects.is_empty(), self.printable) {
            (false, true) => writeln!(f, "    bodies share walls or overlap, as coloured parts do"),
            _ => together.verdict(f),
        }
    }
}

impl fmt::Display for BodyReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.figures(f)?;
        self.verdict(f)
    }
}

impl BodyReport {
    fn figures(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.name.is_empty() {
            writeln!(f, "  {}", escaped(&self.name))?;
        }
        let [x, y, z] = self.size_mm;
        let parts = if self.parts == 1 { "part" } else { "parts" };
        writeln!(f, "    {x:.2} x {y:.2} x {z:.2} mm, {} {parts}", self.parts)?;
        writeln!(
            f,
            "    {} triangles, {} vertices",
            self.triangles, self.vertices
        )?;
        match self.volume_mm3 {
            Some(volume) => writeln!(
                f,
                "    volume {:.3} cm3, area {:.2} cm2",
                volume / 1e3,
                self.area_mm2 / 1e2
            ),
            None => writeln!(
                f,
                "    open, so without a volume; area {:.2} cm2",
                self.area_mm2 / 1e2
            ),
        }
    }

    fn verdict(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for defect in &self.defects {
            writeln!(f, "    defect: {}", defect.text)?;
        }
        if self.defects.is_empty() {
            writeln!(f, "    closed, oriented, 2-manifold, no self-intersection")?;
        }
        Ok(())
    }
}
