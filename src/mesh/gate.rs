//! What is done to a model before it may be the target of a view.
//!
//! Takes a mesh as read from anybody's file; gives one whose equal vertices are joined, without repeated-index or
//! duplicate faces and stray vertices, wound consistently and outwards wherever that has a meaning. Open, touching and
//! self-intersecting surfaces stay as they are: an eye can look at them. What was done is counted, what is left is
//! listed. Coordinates do not change, except that cracks narrower than [`CRACK`] are closed; vertices and faces are numbered
//! by place, so that nothing later depends on the file's order.

use crate::index::{FaceId, VertexId};
use crate::mesh::defects::{Defect, DefectKind, check_soon};
use crate::mesh::order::numbered;
use crate::mesh::shells::shells;
use crate::mesh::topology::{Edges, HalfEdge};
use crate::mesh::tri_mesh::TriMesh;
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

/// A mesh fit to be looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Gated {
    pub mesh: TriMesh,
    /// Where the vertices of the mesh that was read went; `None`: dropped.
    pub vertex_of: Vec<Option<VertexId>>,
    pub corrections: Corrections,
    /// What keeps the mesh from being a sound closed surface.
    pub defects: Vec<Defect>,
    /// Faces thinner than [`NEEDLE`], though not without area (that is a defect).
    pub needles: usize,
}

/// How often what was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Corrections {
    /// Vertices dropped that no face uses.
    pub stray: usize,
    /// Vertices joined across cracks.
    pub cracks: usize,
    /// Faces dropped that repeat a vertex.
    pub repeated: usize,
    /// Faces dropped that are there twice.
    pub duplicates: usize,
    /// Faces turned to match their neighbours.
    pub turned: usize,
    /// Closed surfaces turned outwards.
    pub outwards: usize,
}

/// Why a mesh cannot be looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    NoFaces,
    NotFinite,
    /// All points are in one place.
    NoExtent,
    /// A body pressed flat, of this size in millimetres.
    NoThickness(DVec3),
    AllDegenerate,
}

/// Follows vertices through one more renumbering.
fn follow(vertex_of: &mut [Option<VertexId>], next: impl Fn(VertexId) -> Option<VertexId>) {
    for v in vertex_of {
        *v = v.and_then(&next);
    }
}

/// # Errors
/// A mesh without faces, without extent, or closed but without thickness.
pub fn gate(mut mesh: TriMesh) -> Result<Gated, Refusal> {
    let mut vertex_of = keep_referenced(&mut mesh);
    let stray = vertex_of.iter().filter(|v| v.is_none()).count();
    let size = extent(&mesh)?;
    let closed_as_read = Edges::new(&mesh).iter().all(|e| e.len() > 1);
    let welded = weld(&mesh, 0.0);
    let (ordered, number) = numbered(&welded.mesh);
    follow(&mut vertex_of, |v| Some(number[welded.vertex_of[v]]));
    let (mut mesh, joined) = match seal_cracks(&ordered, CRACK * size.length()) {
        Some(sealed) => {
            follow(&mut vertex_of, |v| Some(sealed.vertex_of[v]));
            (sealed.mesh, sealed.merged)
        }
        None => (ordered, 0),
    };
    let repeated = drop_collapsed(&mut mesh);
    let duplicates = drop_duplicates(&mut mesh);
    // A flat sheet can be looked at; a body pressed flat is a mistake. What is left of one is folded onto itself.
    let flat = size.min_element() <= NOTHING * size.max_element();
    if flat && (closed_as_read || repeated + duplicates > 0) {
        return Err(Refusal::NoThickness(size));
    }
    if mesh.faces.is_empty() {
        return Err(Refusal::AllDegenerate);
    }
    let turned = orient(&mut mesh);
    let outwards = turn_outwards(&mut mesh);
    let kept = keep_referenced(&mut mesh);
    follow(&mut vertex_of, |v| kept[v]);
    let mut defects = check_soon(&mesh);
    defects.retain(|d| d.kind != DefectKind::UnreferencedVertex);
    let faces = FaceId::all(mesh.faces.len());
    let needles = faces.filter(|f| is_needle(&mesh, *f)).count();
    Ok(Gated {
        mesh,
        vertex_of,
        corrections: Corrections {
            stray,
            cracks: joined,
            repeated,
            duplicates,
            turned,
            outwards,
        },
        defects,
        needles,
    })
}

fn extent(mesh: &TriMesh) -> Result<DVec3, Refusal> {
    if mesh.faces.is_empty() {
        return Err(Refusal::NoFaces);
    }
    if mesh.vertices.iter().any(|v| !v.is_finite()) {
        return Err(Refusal::NotFinite);
    }
    let (lo, hi) = mesh.bounds().unwrap_or_default();
    if (hi - lo).max_element() < NOTHING {
        return Err(Refusal::NoExtent);
    }
    Ok(hi - lo)
}

/// The mesh with vertices of open edges joined that are nearly at the same place, if that closes any.
fn seal_cracks(mesh: &TriMesh, tolerance: f64) -> Option<Welded> {
    let mut on_border = vec![false; mesh.vertices.len()];
    let open_edges = |mesh: &TriMesh| Edges::new(mesh).iter().filter(|e| e.len() == 1).count();
    for edge in Edges::new(mesh).iter().filter(|e| e.len() == 1) {
        on_border[edge[0].low] = true;
        on_border[edge[0].high] = true;
    }
    let sealed = weld_some(mesh, tolerance, &on_border);
    (sealed.merged > 0 && open_edges(&sealed.mesh) < open_edges(mesh)).then_some(sealed)
}

/// Turns faces until neighbours over two-faced edges agree, in each patch the fewer ones; gives how many. On one-sided
/// surfaces (Moebius) some edges must stay mixed.
fn orient(mesh: &mut TriMesh) -> usize {
    let edges = Edges::new(mesh);
    let mut neighbours: Vec<[Option<(FaceId, bool)>; 3]> = vec![[None; 3]; mesh.faces.len()];
    for edge in edges.iter() {
        if let [a, b] = edge {
            let differs = a.forward == b.forward;
            let mut link = |from: &HalfEdge, to: &HalfEdge| {
                neighbours[from.face][usize::from(from.corner)] = Some((to.face, differs));
            };
            link(a, b);
            link(b, a);
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.faces.len()];
    let mut total = 0;
    for seed in FaceId::all(mesh.faces.len()) {
        if turned[seed].is_some() {
            continue;
        }
        turned[seed] = Some(false);
        let mut patch = vec![seed];
        let mut done = 0;
        while let Some(&face) = patch.get(done) {
            done += 1;
            for (next, differs) in neighbours[face].iter().flatten() {
                if turned[*next].is_none() {
                    turned[*next] = turned[face].map(|t| t != *differs);
                    patch.push(*next);
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
        if wrong[*c] {
            face.swap(1, 2);
        }
    }
    // A shell turned twice has not been turned.
    wrong.iter().filter(|w| **w != flip_all).count()
}

/// Thinner than [`NEEDLE`], though not without area (that is a defect of its own).
fn is_needle(mesh: &TriMesh, face: FaceId) -> bool {
    let [a, b, c] = mesh.corners(face);
    let longest = (b - a)
        .length_squared()
        .max((c - b).length_squared())
        .max((a - c).length_squared());
    let height = mesh.area_vector(face).length() / longest;
    height > 0.0 && height < NEEDLE
}
