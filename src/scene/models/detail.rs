//! `detail`: models with fewer vertices for quick looks, with all that is said of their vertices.

use crate::index::VertexId;
use crate::mesh::{
    Attributes, LoweredFrom, NO_UV, Original, TriMesh, Uvs, VertexScalar, picked, simplified,
};
use crate::scene::defaults;
use crate::scene::text::{Field, Reader};
use crate::view::Marks;
use glam::DVec2;

/// The most vertices that a scene or one of its models asks for.
pub(crate) fn detail(reader: &mut Reader, field: &Field<u32>) -> Option<usize> {
    let (most, _) = reader.count(field, "detail", defaults::DETAILS)?;
    Some(most as usize)
}

/// A model made smaller.
pub(crate) struct Lowered {
    pub mesh: TriMesh,
    /// As if the file had held this mesh.
    pub original: Original,
    pub marks: Marks,
    /// Whether the file has texture points that the mesh could not keep: their seams part vertices, which collapses go across.
    pub lost_seams: bool,
}

/// A model with at most `most` vertices, as far as that goes; `None` if it has no more anyway or cannot be simplified.
pub(crate) fn lowered(
    mesh: &TriMesh,
    original: &Original,
    marks: &Marks,
    most: usize,
) -> Option<Lowered> {
    if mesh.vertices.len() <= most {
        return None;
    }
    let small = simplified(mesh, most)?;
    let kept = &small.vertices;
    let uvs = original.attributes.uvs.as_ref();
    let points = uvs.and_then(|uvs| texture_points(mesh, original, uvs));
    let attributes = Attributes {
        colours: colours(original, mesh.vertices.len(), kept),
        uvs: points.as_ref().map(|points| Uvs {
            points: picked(points, kept),
            corners: small.mesh.faces.iter().map(|f| f.map(|v| v.0)).collect(),
        }),
        scalars: scalars(original, mesh.vertices.len(), kept),
    };
    let own = &original.mesh;
    Some(Lowered {
        original: Original {
            mesh: small.mesh.clone(),
            attributes,
            vertex_of: VertexId::all(kept.len()).map(Some).collect(),
            lowered_from: Some(LoweredFrom {
                vertices: own.vertices.len(),
                faces: own.faces.len(),
                mesh: mesh.clone(),
            }),
        },
        marks: Marks {
            weights: picked(&marks.weights, kept),
            free: picked(&marks.free, kept),
        },
        lost_seams: uvs.is_some() && points.is_none(),
        mesh: small.mesh,
    })
}

/// The texture point of every vertex of the model, if each has only one.
fn texture_points(mesh: &TriMesh, original: &Original, uvs: &Uvs) -> Option<Vec<DVec2>> {
    let became = |face: &[VertexId; 3]| {
        let [a, b, c] = face.map(|v| original.vertex_of[v]);
        Some([a?, b?, c?])
    };
    let faces = original.mesh.faces.iter().zip(&uvs.corners);
    let (faces, corners) = faces
        .filter(|(_, corners)| !corners.contains(&NO_UV))
        .filter_map(|(face, corners)| Some((became(face)?, *corners)))
        .unzip();
    let welded = TriMesh {
        vertices: mesh.vertices.clone(),
        faces,
    };
    let points = uvs.points.clone();
    Uvs { points, corners }.per_vertex(&welded)
}

fn colours(original: &Original, count: usize, kept: &[VertexId]) -> Vec<[f64; 4]> {
    let channels = ["red", "green", "blue", "alpha"].map(|name| original.values(name, count));
    let [Some(r), Some(g), Some(b), Some(a)] = channels else {
        return Vec::new();
    };
    let colour = |v: &VertexId| [&r, &g, &b, &a].map(|channel| channel[*v]);
    match original.attributes.colours.is_empty() {
        true => Vec::new(),
        false => kept.iter().map(colour).collect(),
    }
}

fn scalars(original: &Original, count: usize, kept: &[VertexId]) -> Vec<VertexScalar> {
    let scalar = |s: &VertexScalar| {
        Some(VertexScalar {
            name: s.name.clone(),
            values: picked(&original.values(&s.name, count)?, kept),
        })
    };
    let all = original.attributes.scalars.iter();
    all.filter_map(scalar).collect()
}
