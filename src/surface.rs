//! The optimised surface as a mesh of its own: before it is cut and scaled back, for whoever wants to work with it.
//!
//! Takes a view with the depths and groups found for it, on its target or on the target cut along tears. Gives every vertex of
//! the input at `o + s (v - o)`, with what the files and the optimisation say of it. Promises for a surface in one piece:
//! vertices and faces are those of the models' files one after the other, in their order, hidden and unused ones included
//! (polygons as triangles). A torn surface has a vertex for every bundle of face corners that stayed together, and only faces
//! that lie on a support as the eye sees it, one for every group they are seen on. Nothing here is checked for printing.
//!
//! Symbols: eye `o`; `lambda0 = |v - o|`, `lambda = s lambda0`; the relief on a support is `o + (p - o) / mu_g`.

use crate::groups::Groups;
use crate::index::{FaceId, GroupId, VertexId};
use crate::mesh::{Attributes, NO_UV, Original, TriMesh, Uvs, VertexScalar, picked};
use crate::mimic::Depths;
use crate::sight::Sight;
use crate::steps::Torn;
use crate::view::{PlacedModel, View};
use glam::DVec3;
use std::borrow::Cow;

/// The largest bound of a vertex that has none, millimetres: as large as tools that keep numbers in 32 bits can hold. Infinite
/// or undefined numbers spoil their histograms and colour scales, and some refuse to read them.
pub const UNBOUNDED: f64 = f32::MAX as f64;

/// What the optimisation says of a vertex; lengths in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexReach {
    /// Distance from the eye in the optimised surface and in the model.
    pub lambda: f64,
    pub lambda0: f64,
    /// The tightest bounds of `lambda` at the vertex itself, those of its group's layer times `mu`; 0 and [`UNBOUNDED`] for
    /// vertices that have none: free, hidden, off the supports, or on them only with a part of their faces.
    pub lambda_min: f64,
    pub lambda_max: f64,
    /// The group that the vertex is bounded in (the first if there are several), -1: none.
    pub group: i32,
    /// Scale of that group; 1 without.
    pub mu: f64,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Surface {
    pub mesh: TriMesh,
    /// Of `mesh`. A model without colours is white, one without some scalar has 0.
    pub attributes: Attributes,
    /// Index: vertex.
    pub reach: Vec<VertexReach>,
    /// The vertex of the input, counted from 0 through the files of all models. Index: vertex.
    pub input_vertex: Vec<VertexId>,
    /// What a reader of the file must know, one line each.
    pub notes: Vec<String>,
}

/// The optimised surface of a view.
pub fn surface(sight: &Sight, depths: &Depths) -> Surface {
    assembled(sight, depths, None)
}

/// The same of a view whose surface was torn.
pub fn torn_surface(torn: &Torn) -> Surface {
    assembled(&torn.sight, &torn.depths, Some(torn))
}

fn assembled(sight: &Sight, depths: &Depths, torn: Option<&Torn>) -> Surface {
    let view = sight.image.view;
    let input = Input::new(view);
    let bounds = vertex_bounds(&sight.groups, depths, depths.s.len());
    let at = |point: DVec3, solved: Option<VertexId>| {
        let s = solved.map_or(1.0, |v| depths.s[v]);
        let bound = solved.and_then(|v| bounds[v]);
        let lambda0 = point.distance(view.eye);
        let (least, most) = bound.map_or((0.0, f64::INFINITY), |b| (b.least, b.most));
        let reach = VertexReach {
            lambda: s * lambda0,
            lambda0,
            lambda_min: least * lambda0,
            lambda_max: (most * lambda0).min(UNBOUNDED),
            group: bound.map_or(-1, |b| b.group.0.cast_signed()),
            mu: bound.map_or(1.0, |b| depths.mu[b.group]),
        };
        (view.eye + s * (point - view.eye), reach)
    };
    let (faces, attributes, input_vertex, solved) = match torn {
        None => input.in_one_piece(),
        Some(torn) => input.torn(view, torn),
    };
    let (vertices, reach) = input_vertex
        .iter()
        .zip(solved)
        .map(|(i, solved)| at(input.points[*i], solved))
        .unzip();
    Surface {
        mesh: TriMesh { vertices, faces },
        attributes,
        reach,
        input_vertex,
        notes: notes(view, &input, torn.is_some()),
    }
}

/// The tightest bounds of `s` at a vertex.
#[derive(Clone, Copy)]
struct VertexBound {
    group: GroupId,
    least: f64,
    most: f64,
}

fn vertex_bounds(groups: &Groups, depths: &Depths, count: usize) -> Vec<Option<VertexBound>> {
    let mut bounds: Vec<Option<VertexBound>> = vec![None; count];
    for bound in &groups.bounds {
        let mut terms = bound.anchor.terms();
        let (Some((vertex, _)), None) = (terms.next(), terms.next()) else {
            continue;
        };
        let mu = depths.mu[bound.group];
        let slot = bounds[vertex].get_or_insert(VertexBound {
            group: bound.group,
            least: 0.0,
            most: f64::INFINITY,
        });
        slot.group = slot.group.min(bound.group);
        slot.least = slot.least.max(bound.lower * mu);
        slot.most = slot.most.min(bound.upper * mu);
    }
    bounds
}

/// Faces, attributes, and for every vertex the input's and the solved one.
type Parts = (
    Vec<[VertexId; 3]>,
    Attributes,
    Vec<VertexId>,
    Vec<Option<VertexId>>,
);

/// The files of all models, in place, one after the other.
struct Input<'a> {
    originals: Vec<Cow<'a, Original>>,
    points: Vec<DVec3>,
    faces: Vec<[VertexId; 3]>,
    attributes: Attributes,
    /// The target's vertex of every input vertex.
    target: Vec<Option<VertexId>>,
}

impl<'a> Input<'a> {
    fn new(view: &'a View) -> Self {
        let mut input = Self {
            originals: view.models.iter().map(original).collect(),
            points: Vec::new(),
            faces: Vec::new(),
            attributes: Attributes::default(),
            target: Vec::new(),
        };
        let mut first_target = 0;
        let originals = input.originals.clone();
        for (model, original) in view.models.iter().zip(&originals) {
            let first = input.points.len();
            let mirrored = model.matrix.determinant() < 0.0;
            input.join_attributes(original, mirrored);
            for (point, vertex) in original.mesh.vertices.iter().zip(&original.vertex_of) {
                input.points.push(match *vertex {
                    Some(v) => model.mesh.vertices[v],
                    None => model.matrix.transform_point3(*point),
                });
                input.target.push(vertex.map(|v| v.plus(first_target)));
            }
            let faces = original.mesh.faces.iter().map(|f| turned(f, mirrored));
            let moved = |v: VertexId| v.plus(first);
            input.faces.extend(faces.map(|f| f.map(moved)));
            first_target += model.mesh.vertices.len();
        }
        input
    }

    /// Appends what a file says; what the models before it have and it lacks, and the other way round, is filled in.
    fn join_attributes(&mut self, next: &Original, mirrored: bool) {
        let (before, faces_before) = (self.points.len(), self.faces.len());
        let count = next.mesh.vertices.len();
        let own = &next.attributes;
        let all = &mut self.attributes;
        if !(all.colours.is_empty() && own.colours.is_empty()) {
            all.colours.resize(before, [1.0; 4]);
            all.colours.extend_from_slice(&own.colours);
            all.colours.resize(before + count, [1.0; 4]);
        }
        for scalar in &own.scalars {
            if all.scalars.iter().all(|s| s.name != scalar.name) {
                all.scalars.push(VertexScalar {
                    name: scalar.name.clone(),
                    values: vec![0.0; before],
                });
            }
        }
        for scalar in &mut all.scalars {
            if let Some(own) = own.scalars.iter().find(|s| s.name == scalar.name) {
                scalar.values.extend_from_slice(&own.values);
            }
            scalar.values.resize(before + count, 0.0);
        }
        if all.uvs.is_none() && own.uvs.is_none() {
            return;
        }
        let uvs = all.uvs.get_or_insert_with(Uvs::default);
        uvs.corners.resize(faces_before, [NO_UV; 3]);
        let first = uvs.points.len() as u32;
        let moved = |uv: u32| if uv == NO_UV { NO_UV } else { uv + first };
        if let Some(own) = &own.uvs {
            uvs.points.extend_from_slice(&own.points);
            let corners = own.corners.iter().map(|c| turned(c, mirrored));
            uvs.corners.extend(corners.map(|c| c.map(moved)));
        }
        uvs.corners
            .resize(faces_before + next.mesh.faces.len(), [NO_UV; 3]);
    }

    /// The input as it is.
    fn in_one_piece(&self) -> Parts {
        let vertices = VertexId::all(self.points.len()).collect();
        (
            self.faces.clone(),
            self.attributes.clone(),
            vertices,
            self.target.clone(),
        )
    }

    /// What a torn mesh has of the input. A vertex that was several in the file takes the attributes of the one its first face
    /// had; texture points stay those of each face's own corners.
    fn torn(&self, view: &View, torn: &Torn) -> Parts {
        let faces = &torn.sight.image.target.mesh.faces;
        let face_of = self.faces_of_target(view);
        let mut any_input = vec![None; torn.vertices.iter().max().map_or(0, |v| v.at() + 1)];
        for (i, target) in VertexId::all(self.target.len()).zip(&self.target).rev() {
            if let Some(slot) = target.and_then(|t| any_input.get_mut(t.at())) {
                *slot = Some(i);
            }
        }
        let mut input_vertex: Vec<Option<VertexId>> = vec![None; torn.vertices.len()];
        let mut corners = Vec::with_capacity(faces.len());
        let own_uvs = self.attributes.uvs.as_ref();
        for (face, target_face) in faces.iter().zip(&torn.faces) {
            let input_face = face_of[*target_face];
            corners.push(face.map(|v| {
                let target = Some(torn.vertices[v]);
                let is_same = |i: &VertexId| self.target[*i] == target;
                let found = input_face.and_then(|f| {
                    let corner = self.faces[f].iter().position(is_same)?;
                    Some((f, corner))
                });
                let vertex = found.map(|(f, corner)| self.faces[f][corner]);
                let slot = &mut input_vertex[v];
                *slot = slot.or(vertex);
                let uv = |(f, corner): (FaceId, usize)| Some(own_uvs?.corners[f][corner]);
                found.and_then(uv).unwrap_or(NO_UV)
            }));
        }
        let vertices: Vec<VertexId> = input_vertex
            .iter()
            .zip(&torn.vertices)
            .map(|(found, target)| found.or(any_input[*target]).unwrap_or(VertexId(0)))
            .collect();
        let attributes = Attributes {
            colours: picked(&self.attributes.colours, &vertices),
            uvs: own_uvs.map(|uvs| Uvs {
                points: uvs.points.clone(),
                corners,
            }),
            scalars: self
                .attributes
                .scalars
                .iter()
                .map(|s| VertexScalar {
                    name: s.name.clone(),
                    values: picked(&s.values, &vertices),
                })
                .collect(),
        };
        let solved = VertexId::all(vertices.len()).map(Some).collect();
        (faces.clone(), attributes, vertices, solved)
    }

    /// The input's face of every face of the target.
    fn faces_of_target(&self, view: &View) -> Vec<Option<FaceId>> {
        let mut all = Vec::new();
        let mut first = 0;
        for (model, original) in view.models.iter().zip(&self.originals) {
            let faces = original.faces_of(&model.mesh).into_iter();
            all.extend(faces.map(|f| f.map(|f| f.plus(first))));
            first += original.mesh.faces.len();
        }
        all
    }
}

/// The corners of a face, turned round where a model is mirrored: inside out again.
fn turned<T: Copy>([a, b, c]: &[T; 3], mirrored: bool) -> [T; 3] {
    if mirrored { [*a, *c, *b] } else { [*a, *b, *c] }
}

/// What a model's file has; a model that comes from none is its own.
fn original(model: &PlacedModel) -> Cow<'_, Original> {
    match &model.original {
        Some(original) => Cow::Borrowed(original),
        None => Cow::Owned(Original {
            mesh: model.mesh.clone(),
            attributes: Attributes::default(),
            vertex_of: VertexId::all(model.mesh.vertices.len()).map(Some).collect(),
            lowered_from: None,
        }),
    }
}

fn notes(view: &View, input: &Input, torn: bool) -> Vec<String> {
    let DVec3 { x, y, z } = view.eye;
    let mut notes = vec![
        format!(
            "pillarforest {}: optimised surface of view {} before it is cut and scaled back; millimetres, z up",
            env!("CARGO_PKG_VERSION"),
            view.name
        ),
        if view.orthographic {
            let DVec3 { x: a, y: b, z: c } = view.from();
            format!(
                "eye {x} {y} {z}, which stands for one at infinity in direction {a} {b} {c}: rays are parallel, lambda0 - lambda is the displacement along them towards the eye"
            )
        } else {
            format!("eye {x} {y} {z}")
        },
        "relief on a support: eye + (vertex - eye) / mu, where group is not -1".to_owned(),
        format!(
            "lambda distance from the eye, lambda0 in the model; lambda_min and lambda_max bounds of lambda, 0 and {UNBOUNDED:e} where there are none"
        ),
    ];
    let (mut vertex, mut face) = (0, 0);
    for (model, original) in view.models.iter().zip(&input.originals) {
        let next = [
            vertex + original.mesh.vertices.len(),
            face + original.mesh.faces.len(),
        ];
        let lowered = original
            .lowered_from
            .as_ref()
            .map_or(String::new(), |from| {
                let (v, f) = (from.vertices, from.faces);
                format!(", simplified from {v} vertices and {f} faces by `detail`")
            });
        notes.push(format!(
            "model {} of file {}: input vertices from {vertex} to {}, faces from {face} to {}{lowered}",
            model.name,
            model.file,
            next[0].saturating_sub(1),
            next[1].saturating_sub(1)
        ));
        [vertex, face] = next;
    }
    notes.push(if torn {
        "cut along tears and outlines of supports: input_vertex tells where each vertex comes from, faces that are not seen on a support are left out".to_owned()
    } else if input.originals.iter().any(|o| o.lowered_from.is_some()) {
        "vertices and faces are those of the models as simplified; vertices that took no part stay where they are in the model".to_owned()
    } else {
        "vertices and faces are those of the files in their order; vertices that took no part stay where they are in the model".to_owned()
    });
    notes
}
