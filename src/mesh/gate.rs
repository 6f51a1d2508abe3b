//! What is done to a model before it may be the target of a view.
//!
//! Takes a mesh as read from anybody's file; gives one whose equal vertices are joined, without repeated-index or
//! duplicate faces and stray vertices, wound consistently and outwards wherever that has a meaning. Open, touching and
//! self-intersecting surfaces stay as they are: an eye can look at them. Everything done or left is said in one
//! warning. Coordinates do not change, except that cracks narrower than [`CRACK`] are closed; vertices and faces are numbered
//! by place, so that nothing later depends on the file's order.

use crate::diag::{Diagnostic, Place, Warned};
use crate::mesh::TriMesh;
use crate::mesh::defects::{DefectKind, check};
use crate::mesh::order::numbered;
use crate::mesh::shells::shells;
use crate::mesh::topology::{Edges, HalfEdge};
use crate::mesh::weld::{
    Welded, drop_collapsed, drop_duplicates, keep_referenced, weld, weld_some,
};
use glam::DVec3;

/// Open edges are welded over gaps up to this share of the mesh's diagonal: ten times the rounding of an f32 file, and
/// far below any detail that prints.
pub const CRACK: f64 = 1e-6;
/// Faces whose height is below this share of their longest edge: angles and cotangents computed from them are noise.
pub const NEEDLE: f64 = 1e-6;
/// Below this the mesh has no size at all, millimetres.
const NOTHING: f64 = 1e-12;

/// A mesh fit to be looked at, and where the vertices of the mesh that was read went; `None`: dropped.
#[derive(Clone, Debug, PartialEq)]
pub struct Gated {
    pub mesh: TriMesh,
    pub vertex_of: Vec<Option<u32>>,
}

/// # Errors
/// As [`gate_traced`].
pub fn gate(file: &str, mesh: TriMesh) -> Result<Warned<TriMesh>, Diagnostic> {
    let Warned { value, warnings } = gate_traced(file, mesh)?;
    Ok(Warned {
        value: value.mesh,
        warnings,
    })
}

/// # Errors
/// A mesh without faces, without extent, or closed but without thickness.
pub fn gate_traced(file: &str, mesh: TriMesh) -> Result<Warned<Gated>, Diagnostic> {
    let place = || Place::File(file.to_owned());
    let mut notes = Notes::default();
    let gated = clean(mesh, &mut notes).map_err(|why| Diagnostic::error(why).at(place()))?;
    let mesh = &gated.mesh;
    let left = leftovers(mesh);
    let notes = notes.0;
    let mut warnings = Vec::new();
    if !notes.is_empty() || !left.is_empty() {
        let mut message = String::new();
        if !notes.is_empty() {
            message = format!("repaired on loading: {}", notes.join(", "));
        }
        if !left.is_empty() {
            let joint = if notes.is_empty() { "" } else { "; " };
            message = format!(
                "{message}{joint}not a sound closed surface: {}",
                left.join("; ")
            );
        }
        let mut warning = Diagnostic::warning(message).at(place());
        if !left.is_empty() {
            warning =
                warning.help("a view can show it all the same; it could not be printed as it is");
        }
        warnings.push(warning);
    }
    Ok(Warned {
        value: gated,
        warnings,
    })
}

/// What was done, in the words of a message.
#[derive(Default)]
struct Notes(Vec<String>);

impl Notes {
    fn add(&mut self, verb: &str, count: usize, [one, many]: [&str; 2]) {
        if count > 0 {
            let noun = if count == 1 { one } else { many };
            self.0.push(format!("{verb} {count} {noun}"));
        }
    }
}

/// Follows vertices through one more renumbering.
fn follow(vertex_of: &mut [Option<u32>], next: impl Fn(u32) -> Option<u32>) {
    for v in vertex_of {
        *v = v.and_then(&next);
    }
}

fn clean(mut mesh: TriMesh, notes: &mut Notes) -> Result<Gated, String> {
    let mut vertex_of = keep_referenced(&mut mesh);
    let stray = vertex_of.iter().filter(|v| v.is_none()).count();
    let size = extent(&mesh)?;
    let closed_as_read = Edges::new(&mesh).iter().all(|e| e.len() > 1);
    let welded = weld(&mesh, 0.0);
    let (ordered, number) = numbered(&welded.mesh);
    follow(&mut vertex_of, |v| {
        Some(number[welded.vertex_of[v as usize] as usize])
    });
    let (mut mesh, joined) = match seal_cracks(&ordered, CRACK * size.length()) {
        Some(sealed) => {
            follow(&mut vertex_of, |v| Some(sealed.vertex_of[v as usize]));
            (sealed.mesh, sealed.merged)
        }
        None => (ordered, 0),
    };
    let repeated = drop_collapsed(&mut mesh);
    let duplicates = drop_duplicates(&mut mesh);
    // A flat sheet can be looked at; a body pressed flat is a mistake. What is left of one is folded onto itself.
    let flat = size.min_element() <= NOTHING * size.max_element();
    if flat && (closed_as_read || repeated + duplicates > 0) {
        let DVec3 { x, y, z } = size;
        return Err(format!("the model has no thickness: {x} x {y} x {z} mm"));
    }
    if mesh.faces.is_empty() {
        return Err("all faces of the model are degenerate".to_owned());
    }
    let turned = orient(&mut mesh);
    let outwards = turn_outwards(&mut mesh);
    let kept = keep_referenced(&mut mesh);
    follow(&mut vertex_of, |v| kept[v as usize]);
    let unused = ["vertex that no face uses", "vertices that no face uses"];
    notes.add("dropped", stray, unused);
    let cracks = ["vertex across a crack", "vertices across cracks"];
    notes.add("joined", joined, cracks);
    let repeats = ["face that repeats a vertex", "faces that repeat a vertex"];
    notes.add("dropped", repeated, repeats);
    notes.add("dropped", duplicates, ["duplicate face", "duplicate faces"]);
    let matched = [
        "face to match its neighbours",
        "faces to match their neighbours",
    ];
    notes.add("turned", turned, matched);
    let surfaces = ["closed surface outwards", "closed surfaces outwards"];
    notes.add("turned", outwards, surfaces);
    Ok(Gated { mesh, vertex_of })
}

fn extent(mesh: &TriMesh) -> Result<DVec3, String> {
    if mesh.faces.is_empty() {
        return Err("the model has no faces".to_owned());
    }
    if mesh.vertices.iter().any(|v| !v.is_finite()) {
        return Err("the model has a coordinate that is not a finite number".to_owned());
    }
    let (lo, hi) = mesh.bounds().unwrap_or_default();
    if (hi - lo).max_element() < NOTHING {
        return Err("the model has no extent: all its points are in one place".to_owned());
    }
    Ok(hi - lo)
}

/// The mesh with vertices of open edges joined that are nearly at the same place, if that closes any.
fn seal_cracks(mesh: &TriMesh, tolerance: f64) -> Option<Welded> {
    let mut on_border = vec![false; mesh.vertices.len()];
    let open_edges = |mesh: &TriMesh| Edges::new(mesh).iter().filter(|e| e.len() == 1).count();
    for edge in Edges::new(mesh).iter().filter(|e| e.len() == 1) {
        on_border[edge[0].low as usize] = true;
        on_border[edge[0].high as usize] = true;
    }
    let sealed = weld_some(mesh, tolerance, &on_border);
    (sealed.merged > 0 && open_edges(&sealed.mesh) < open_edges(mesh)).then_some(sealed)
}

/// Turns faces until neighbours over two-faced edges agree, in each patch the fewer ones; gives how many. On one-sided
/// surfaces (Moebius) some edges must stay mixed.
fn orient(mesh: &mut TriMesh) -> usize {
    let edges = Edges::new(mesh);
    let mut neighbours: Vec<[Option<(u32, bool)>; 3]> = vec![[None; 3]; mesh.faces.len()];
    for edge in edges.iter() {
        if let [a, b] = edge {
            let differs = a.forward == b.forward;
            let mut link = |from: &HalfEdge, to: &HalfEdge| {
                neighbours[from.face as usize][from.corner as usize] = Some((to.face, differs));
            };
            link(a, b);
            link(b, a);
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.faces.len()];
    let mut total = 0;
    for seed in 0..mesh.faces.len() {
        if turned[seed].is_some() {
            continue;
        }
        turned[seed] = Some(false);
        let mut patch = vec![seed];
        let mut done = 0;
        while let Some(&face) = patch.get(done) {
            done += 1;
            for (next, differs) in neighbours[face].iter().flatten() {
                if turned[*next as usize].is_none() {
                    turned[*next as usize] = turned[face].map(|t| t != *differs);
                    patch.push(*next as usize);
                }
            }
        }
        let count = patch.iter().filter(|f| turned[**f] == Some(true)).count();
        let fewer = 2 * count <= patch.len();
        for face in &patch {
            if (turned[*face] == Some(true)) == fewer {
                mesh.faces[*face].swap(1, 2);
            }
        }
        total += count.min(patch.len() - count);
    }
    total
}

/// Turns closed shells that enclose a negative volume, except cavities; gives how many. Leaves meshes alone that are
/// open or mixed anywhere: outwards has no meaning there.
fn turn_outwards(mesh: &mut TriMesh) -> usize {
    let sound = Edges::new(mesh)
        .iter()
        .all(|e| e.len() % 2 == 0 && 2 * e.iter().filter(|h| h.forward).count() == e.len());
    if !sound {
        return 0;
    }
    let component = crate::mesh::topology::face_components(mesh);
    let flip_all = mesh.volume() < 0.0;
    if flip_all {
        mesh.faces.iter_mut().for_each(|f| f.swap(1, 2));
    }
    let shells = shells(mesh);
    let wrong: Vec<bool> = shells
        .iter()
        .map(|s| s.volume < 0.0 && s.winding < 1)
        .collect();
    for (face, c) in mesh.faces.iter_mut().zip(&component) {
        if wrong[*c as usize] {
            face.swap(1, 2);
        }
    }
    // A shell turned twice has not been turned.
    wrong.iter().filter(|w| **w != flip_all).count()
}

/// What is still wrong, in words.
fn leftovers(mesh: &TriMesh) -> Vec<String> {
    let mut left: Vec<String> = check(mesh)
        .iter()
        .filter(|d| d.kind != DefectKind::UnreferencedVertex)
        .map(ToString::to_string)
        .collect();
    let needles = (0..mesh.faces.len())
        .filter(|f| is_needle(mesh, *f))
        .count();
    if needles > 0 {
        let noun = if needles == 1 { "face" } else { "faces" };
        left.push(format!("{needles} needle-thin {noun}"));
    }
    left
}

/// Thinner than [`NEEDLE`], though not without area (that is a defect of its own).
fn is_needle(mesh: &TriMesh, face: usize) -> bool {
    let [a, b, c] = mesh.corners(face);
    let longest = (b - a)
        .length_squared()
        .max((c - b).length_squared())
        .max((a - c).length_squared());
    let height = mesh.area_vector(face).length() / longest;
    height > 0.0 && height < NEEDLE
}

/// Longest side of a model, millimetres: up to which it is dust below the steps of printable files, up to which people
/// usually saved in metres (a hand is 0.2 of them), up to which in inches, and from which nothing prints it.
const DUST: f64 = 0.002;
const METRES: f64 = 0.5;
const INCHES: f64 = 2.0;
const HUGE: f64 = 1e5;
/// Files with f32 coordinates keep 1e-7 of them: this many lengths from the origin a thousandth of the model is lost.
const FAR: f64 = 1e4;

/// A warning if the size of a model, taken as millimetres, suggests another unit, or if it lies so far from the origin
/// that f32 files cannot hold it. For models used at the size they are saved in.
pub fn unit_suspicion(file: &str, mesh: &TriMesh) -> Option<Diagnostic> {
    let (lo, hi) = mesh.bounds()?;
    let longest = (hi - lo).max_element();
    let far = lo.abs().max(hi.abs()).max_element();
    let place = Place::File(file.to_owned());
    let side = tidy(longest);
    let message = match longest {
        l if l < DUST => format!(
            "the model is {side} mm long, less than a printable file can hold: in which unit was it saved?"
        ),
        l if l < METRES => format!(
            "the model is {side} mm long: saved in metres? That would be {} mm",
            tidy(l * 1000.0)
        ),
        l if l < INCHES => format!(
            "the model is {side} mm long: saved in inches? That would be {} mm",
            tidy(l * 25.4)
        ),
        l if l > HUGE => {
            format!("the model is {side} mm long: in which unit was it saved?")
        }
        l if far > FAR * l => format!(
            "the model is {side} mm long but lies {} mm from the origin: files with 32-bit numbers keep steps of {} mm there",
            tidy(far),
            tidy(far * f64::from(f32::EPSILON))
        ),
        _ => return None,
    };
    Some(Diagnostic::warning(message).at(place))
}

/// Three significant digits or so, without an exponent where people would not write one.
fn tidy(x: f64) -> String {
    if (1e-3..1e7).contains(&x.abs()) {
        let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 6) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.1e}")
    }
}
