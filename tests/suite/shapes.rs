//! Small bodies and forests for tests of several subjects.

use glam::{DMat4, DVec2, DVec3};
use manifold_rust::linalg::Vec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64};
use pillarforest::groups::Groups;
use pillarforest::index::VertexId;
use pillarforest::kinds;
use pillarforest::mesh::TriMesh;
use pillarforest::mimic::{Depths, Energy};
use pillarforest::relief::{Relief, relief};
use pillarforest::scene::Scene;
use pillarforest::sight::Sight;
use pillarforest::support::{Datum, Extent, Layer, Support, SupportKind};
use pillarforest::view::{PlacedModel, View};
use pillarforest::viewmap::{Image, SupportField, Target, ViewMap};
use std::f64::consts::TAU;

pub(crate) const ORANGE: [u8; 3] = [0xE6, 0x9F, 0x00];
pub(crate) const BLUE: [u8; 3] = [0x56, 0xB4, 0xE9];
pub(crate) const GREEN: [u8; 3] = [0x00, 0x9E, 0x73];

pub(crate) const EYE: DVec3 = DVec3::new(0.0, -150.0, 20.0);
pub(crate) const MIDDLE: DVec3 = DVec3::new(0.0, 0.0, 20.0);

/// Faces of a box whose corner `k` lies at the bits of `k`: x, y, z.
pub(crate) const CUBE_FACES: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

/// A ball of 20 mm around the origin and one of 16 around `second`, as parts of one model.
pub(crate) fn balls(second: DVec3) -> TriMesh {
    let mut both = ball(DVec3::ZERO, 20.0, 16);
    both.append(&ball(second, 16.0, 14));
    both
}

/// Corners of a regular polygon, counter-clockwise.
pub(crate) fn ring(centre: DVec2, radius: f64, corners: usize) -> Vec<DVec2> {
    (0..corners)
        .map(|k| centre + radius * DVec2::from_angle(TAU * k as f64 / corners as f64))
        .collect()
}

/// An upright prism over a convex counter-clockwise outline.
pub(crate) fn prism(outline: &[DVec2], bottom: f64, top: f64) -> TriMesh {
    let n = outline.len() as u32;
    let vertices = [bottom, top]
        .iter()
        .flat_map(|z| outline.iter().map(|p| p.extend(*z)))
        .collect();
    let mut faces = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        faces.extend([[i, j, n + j], [i, n + j, n + i]]);
    }
    faces.extend((1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]));
    TriMesh::new(vertices, faces)
}

/// A ball of facets.
pub(crate) fn ball(centre: DVec3, radius: f64, rows: u32) -> TriMesh {
    let (n, m) = (2 * rows, rows);
    let mut mesh = TriMesh::default();
    mesh.vertices.push(centre - radius * DVec3::Z);
    for row in 1..m {
        let tilt = std::f64::consts::PI * (f64::from(row) / f64::from(m) - 0.5);
        let ring = ring(DVec2::ZERO, radius * tilt.cos(), n as usize);
        mesh.vertices
            .extend(ring.iter().map(|p| centre + p.extend(radius * tilt.sin())));
    }
    mesh.vertices.push(centre + radius * DVec3::Z);
    let at = |row: u32, k: u32| VertexId(1 + (row - 1) * n + k % n);
    let [first, last] = [0, mesh.vertices.len() - 1].map(VertexId::new);
    for k in 0..n {
        mesh.faces.push([first, at(1, k + 1), at(1, k)]);
        mesh.faces.push([last, at(m - 1, k), at(m - 1, k + 1)]);
        for row in 1..m - 1 {
            mesh.faces
                .push([at(row, k), at(row, k + 1), at(row + 1, k + 1)]);
            mesh.faces
                .push([at(row, k), at(row + 1, k + 1), at(row + 1, k)]);
        }
    }
    mesh
}

/// As far behind a datum as a layer with it reaches.
pub(crate) fn extent(datum: Datum, back: f64) -> Extent {
    match datum {
        Datum::Plane => Extent::Plane { back },
        Datum::Surface => Extent::Surface { back },
    }
}

/// A layer about a plane.
pub(crate) fn flat_layer(front: f64, back: f64, core: f64) -> Layer {
    Layer {
        extent: Extent::Plane { back },
        front,
        core,
        hull: false,
    }
}

pub(crate) fn pillar(axis: DVec2, radius: f64, corners: usize, datum: Datum) -> Support {
    let profile = ring(axis, radius, corners);
    Support {
        name: format!("pillar at {axis}"),
        mesh: prism(&profile, 0.0, 40.0),
        kind: SupportKind::Pillar {
            axis,
            profile,
            bottom: 0.0,
            top: 40.0,
            round: corners > 12,
        },
        layer: Some(Layer {
            extent: extent(datum, 1.0),
            ..flat_layer(2.0, 1.0, 0.5)
        }),
    }
}

pub(crate) fn base(outline: Vec<DVec2>) -> Support {
    Support {
        name: "base".into(),
        mesh: prism(&outline, -3.0, 0.0),
        kind: SupportKind::Base {
            outline,
            bottom: -3.0,
            top: 0.0,
        },
        layer: None,
    }
}

pub(crate) fn view(name: &str, eye: DVec3, model: TriMesh, colour: [u8; 3]) -> View {
    let (lo, hi) = model.bounds().unwrap();
    let model = PlacedModel {
        name: name.into(),
        file: format!("{name}.obj"),
        matrix: DMat4::IDENTITY,
        mesh: model,
        original: None,
        marks: Default::default(),
    };
    View {
        name: name.into(),
        eye,
        look_at: (lo + hi) / 2.0,
        orthographic: false,
        models: vec![model],
        colour,
    }
}

/// Three eyes, one of them far away, and pillars of all kinds.
pub(crate) fn grove() -> (Vec<View>, Vec<Support>) {
    let views = vec![
        view(
            "owl",
            DVec3::new(150.0, 10.0, 20.0),
            ball(DVec3::new(12.0, 2.0, 20.0), 9.0, 12),
            ORANGE,
        ),
        view(
            "hare",
            DVec3::new(-35.0, 30.0, 20.0),
            ball(DVec3::new(-10.0, 8.0, 20.0), 7.0, 12),
            BLUE,
        ),
        view(
            "a \"fish\" & <more>",
            DVec3::new(-5.0, -44.0, 20.0),
            ball(DVec3::new(0.0, -10.0, 20.0), 8.0, 12),
            GREEN,
        ),
    ];
    let places = [
        (14.0, 9.0),
        (8.0, 4.5),
        (16.0, -1.0),
        (9.0, -5.0),
        (-9.0, 13.0),
        (-6.0, 7.0),
        (-12.0, 3.0),
        (-6.0, -12.0),
        (0.5, -9.0),
        (6.0, -13.0),
        (22.0, 18.0),
    ];
    let kinds = [(48, Datum::Plane), (4, Datum::Plane), (6, Datum::Surface)];
    let mut supports: Vec<Support> = places
        .iter()
        .enumerate()
        .map(|(k, &(x, y))| pillar(DVec2::new(x, y), 3.2, kinds[k % 3].0, kinds[k % 3].1))
        .collect();
    supports.push(base(ring(DVec2::ZERO, 32.0, 96)));
    (views, supports)
}

/// What one eye is to see on which pillars.
pub(crate) struct Setting {
    pub eye: DVec3,
    pub look_at: DVec3,
    pub model: TriMesh,
    pub supports: Vec<Support>,
}

impl Setting {
    pub(crate) fn new(model: TriMesh, supports: Vec<Support>) -> Self {
        Self {
            eye: EYE,
            look_at: MIDDLE,
            model,
            supports,
        }
    }

    /// A bumpy ball on three pillars at different depths, in a layer much thinner than it.
    pub(crate) fn tight() -> Self {
        let places = [(-8.5, 4.0), (0.0, -6.0), (8.5, 10.0)];
        let supports = places.map(|(x, y)| pillar(DVec2::new(x, y), 4.6, 48, Datum::Plane));
        Self::new(bumpy(12.0), supports.to_vec())
    }

    /// The same ball inside one huge pillar whose layer takes all of it at any scale from a third to four thirds.
    pub(crate) fn roomy() -> Self {
        let mut support = pillar(DVec2::ZERO, 60.0, 96, Datum::Plane);
        support.layer = Some(flat_layer(110.0, 55.0, 1.0));
        Self::new(bumpy(12.0), vec![support])
    }

    pub(crate) fn view(&self) -> View {
        View {
            look_at: self.look_at,
            ..view("test", self.eye, self.model.clone(), ORANGE)
        }
    }

    /// The view map with its target.
    pub(crate) fn seen(&self) -> Image<'static> {
        Image::new(kept(self.view()), field(&self.supports)).expect("a map")
    }

    pub(crate) fn sight(&self) -> Sight<'static> {
        sighted(self.view(), field(&self.supports))
    }

    /// The first view of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let view = &scene.views[0];
        Self {
            eye: view.eye,
            look_at: view.look_at,
            model: view.target(),
            supports: scene.supports.clone(),
        }
    }

    /// All stages up to the relief.
    pub(crate) fn solved(&self, energy: Energy) -> Outcome {
        solved(self.sight(), energy)
    }
}

/// A value for the rest of the run, so that sights can be handed about: tests are few and end soon.
fn kept<T>(value: T) -> &'static T {
    Box::leak(Box::new(value))
}

/// Supports as a target for rays, for the rest of the run.
pub(crate) fn field(supports: &[Support]) -> &'static SupportField<'static> {
    kept(SupportField::new(kept(supports.to_vec())))
}

/// What an eye sees on supports.
pub(crate) fn sighted(view: View, field: &'static SupportField<'static>) -> Sight<'static> {
    let sight = Sight::new(kept(view), field);
    sight.unwrap_or_else(|e| panic!("nothing to see: {e:?}"))
}

/// What the stages from a sight to the relief make of it, the surface in one piece.
pub(crate) fn solved(sight: Sight<'static>, energy: Energy) -> Outcome {
    let depths = kinds::height_field_depths(energy, &sight).expect("depths");
    Outcome {
        relief: relief(&sight, &depths),
        sight,
        depths,
    }
}

/// The text of an OBJ file.
pub(crate) fn obj(mesh: &TriMesh) -> Vec<u8> {
    let vertices = mesh.vertices.iter();
    let vertices = vertices.map(|v| format!("v {:?} {:?} {:?}\n", v.x, v.y, v.z));
    let face = |f: &[VertexId; 3]| format!("f {} {} {}\n", f[0].0 + 1, f[1].0 + 1, f[2].0 + 1);
    let text: String = vertices.chain(mesh.faces.iter().map(face)).collect();
    text.into_bytes()
}

/// All that the stages up to the relief make of a setting.
pub(crate) struct Outcome {
    pub sight: Sight<'static>,
    pub depths: Depths,
    pub relief: Relief,
}

impl Outcome {
    pub(crate) fn target(&self) -> &Target {
        &self.sight.image.target
    }

    pub(crate) fn map(&self) -> &ViewMap {
        &self.sight.image.map
    }

    pub(crate) fn groups(&self) -> &Groups {
        &self.sight.groups
    }
}

/// A closed ball with waves on it, finer than the pillars and coarser than its faces.
pub(crate) fn bumpy(radius: f64) -> TriMesh {
    wavy(radius, 0.06)
}

/// A closed ball with waves of a share of its radius.
pub(crate) fn wavy(radius: f64, share: f64) -> TriMesh {
    let mut mesh = ball(MIDDLE, radius, 16);
    for v in &mut mesh.vertices {
        let d = *v - MIDDLE;
        let wave = (0.5 * d.x + 0.3).sin() * (0.6 * d.z).cos() * (0.4 * d.y + 1.0).sin();
        *v = MIDDLE + d * (1.0 + share * wave);
    }
    mesh
}

/// What the boolean library makes of boxes given by two corners: their union.
pub(crate) fn boxes(corners: &[(DVec3, DVec3)]) -> TriMesh {
    let cube = |(lo, hi): &(DVec3, DVec3)| {
        let vec = |v: DVec3| Vec3::new(v.x, v.y, v.z);
        Manifold::cube(vec(*hi - *lo), false).translate(vec(*lo))
    };
    let all = corners.iter().map(cube).reduce(|a, b| a.union(&b)).unwrap();
    let mesh = all.get_mesh_gl64(-1);
    TriMesh::new(
        (0..mesh.num_vert())
            .map(|v| DVec3::from_array(mesh.get_vert_pos(v)))
            .collect(),
        (0..mesh.num_tri()).map(|t| mesh.get_tri_verts(t).map(|v| v as u32)),
    )
}

/// A mesh for the boolean library.
pub(crate) fn manifold(mesh: &TriMesh) -> Manifold {
    let solid = Manifold::from_mesh_gl64(&MeshGL64 {
        num_prop: 3,
        vert_properties: mesh.vertices.iter().flat_map(DVec3::to_array).collect(),
        tri_verts: mesh
            .faces
            .iter()
            .flatten()
            .map(|v| u64::from(v.0))
            .collect(),
        ..MeshGL64::default()
    });
    assert_eq!(solid.status(), Error::NoError);
    solid
}
