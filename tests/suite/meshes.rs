//! What our mesh checks find, on small meshes that each have one property.

use crate::shapes::CUBE_FACES;
use glam::{DMat4, DQuat, DVec2, DVec3};
use pillarforest::index::{ComponentId, FaceId, VertexId};
use pillarforest::mesh::gate::gate;
use pillarforest::mesh::polygon::triangulate_outline;
use pillarforest::mesh::{
    Defect, DefectKind, Solid, TriMesh, check, face_components, face_neighbours,
    self_intersections, snap_to_f32, vertex_parts, weld, without_cavities,
};
use pillarforest::words::gate::repaired;

/// A box of the given corner and size, 8 vertices, 12 faces.
pub(crate) fn cuboid(at: [f64; 3], size: [f64; 3]) -> TriMesh {
    let vertices = (0..8)
        .map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)))
        .map(|p| DVec3::from(at) + p * DVec3::from(size))
        .collect();
    TriMesh::new(vertices, CUBE_FACES)
}

fn cube() -> TriMesh {
    cuboid([0.0; 3], [20.0; 3])
}

fn both(a: TriMesh, b: &TriMesh) -> TriMesh {
    let mut mesh = a;
    mesh.append(b);
    weld(&mesh, 0.0).mesh
}

pub(crate) fn turned_inside_out(mut mesh: TriMesh) -> TriMesh {
    mesh.faces.iter_mut().for_each(|f| f.swap(1, 2));
    mesh
}

/// Kinds and counts.
fn found(mesh: &TriMesh) -> Vec<(DefectKind, usize)> {
    check(mesh).iter().map(|d| (d.kind, d.count)).collect()
}

/// A bumpy sphere as a grid of longitudes and latitudes with two poles.
fn bumpy_sphere(columns: u32, rows: u32, bump: f64) -> TriMesh {
    let mut mesh = TriMesh {
        vertices: vec![DVec3::NEG_Z * 10.0, DVec3::Z * 10.0],
        faces: Vec::new(),
    };
    let at = |c: u32, r: u32| VertexId(2 + r * columns + c % columns);
    for r in 0..rows {
        for c in 0..columns {
            let latitude = (f64::from(r + 1) / f64::from(rows + 1) - 0.5) * std::f64::consts::PI;
            let longitude = f64::from(c) / f64::from(columns) * std::f64::consts::TAU;
            let radius = 10.0 + bump * f64::from((c * 7 + r * 13) % 11);
            mesh.vertices.push(
                radius
                    * DVec3::new(
                        latitude.cos() * longitude.cos(),
                        latitude.cos() * longitude.sin(),
                        latitude.sin(),
                    ),
            );
            if r + 1 < rows {
                mesh.faces.push([at(c, r), at(c + 1, r), at(c + 1, r + 1)]);
                mesh.faces.push([at(c, r), at(c + 1, r + 1), at(c, r + 1)]);
            }
        }
    }
    for c in 0..columns {
        mesh.faces.push([VertexId(0), at(c + 1, 0), at(c, 0)]);
        mesh.faces
            .push([VertexId(1), at(c, rows - 1), at(c + 1, rows - 1)]);
    }
    mesh
}

#[test]
fn each_defect_is_found_and_nothing_else() {
    use DefectKind::*;
    assert_eq!(found(&cube()), []);
    assert_eq!(found(&TriMesh::default()), [(NoFaces, 1)]);
    let with = |change: fn(&mut TriMesh)| {
        let mut mesh = cube();
        change(&mut mesh);
        found(&mesh)
    };
    assert_eq!(with(|m| m.vertices[0].x = f64::NAN), [(NonFinite, 1)]);
    assert_eq!(with(|m| m.faces[3][1] = VertexId(8)), [(BadIndex, 1)]);
    assert_eq!(
        with(|m| m.vertices.push(DVec3::ZERO)),
        [(UnreferencedVertex, 1)]
    );
    assert_eq!(
        with(|m| {
            m.faces.pop();
        }),
        [(OpenEdge, 3)]
    );
    assert_eq!(with(|m| m.faces[0].swap(0, 1)), [(MixedWinding, 3)]);
    assert_eq!(
        with(|m| m.faces.push([0, 0, 1].map(VertexId))),
        [(RepeatedIndex, 1), (CrowdedEdge, 1)]
    );
    assert_eq!(
        with(|m| m.faces.push([0, 2, 3].map(VertexId))),
        [(DuplicateFace, 1), (CrowdedEdge, 3)]
    );
    assert_eq!(found(&turned_inside_out(cube())), [(InsideOut, 1)]);
    let beside = |at: [f64; 3]| found(&both(cube(), &cuboid(at, [20.0; 3])));
    assert_eq!(beside([30.0, 0.0, 0.0]), []);
    assert_eq!(beside([20.0, 20.0, 0.0]), [(CrowdedEdge, 1)]);
    assert_eq!(beside([20.0, 20.0, 20.0]), [(BowtieVertex, 1)]);
    assert!(
        beside([20.0, 5.0, 5.0])
            .iter()
            .all(|(kind, _)| *kind == SelfIntersection)
    );
    assert!(!beside([20.0, 5.0, 5.0]).is_empty());
}

#[test]
fn shells_are_sound_by_how_they_lie() {
    let inner = cuboid([5.0; 3], [10.0; 3]);
    let core = cuboid([8.0; 3], [2.0; 3]);
    assert_eq!(
        found(&both(cube(), &inner)),
        [(DefectKind::MisplacedShell, 1)]
    );
    let hollow = both(cube(), &turned_inside_out(inner));
    assert_eq!(found(&hollow), []);
    let solid = Solid::new(hollow.clone()).unwrap();
    assert_eq!(
        (solid.parts(), solid.cavities(), solid.volume_mm3().round()),
        (1, 1, 7000.0)
    );
    let rattle = Solid::new(both(hollow, &core)).unwrap();
    assert_eq!(
        (
            rattle.parts(),
            rattle.cavities(),
            rattle.volume_mm3().round()
        ),
        (2, 1, 7008.0)
    );
    // Inside out beside a larger sound one: the sum of volumes hides it.
    let beside = both(cube(), &turned_inside_out(cuboid([30.0; 3], [2.0; 3])));
    assert_eq!(found(&beside), [(DefectKind::MisplacedShell, 1)]);
}

#[test]
fn touching_by_less_than_nothing_counts_and_a_gap_does_not() {
    let pairs = |height: f64| {
        let spike = TriMesh::new(
            vec![
                DVec3::new(3.0, 4.0, height),
                DVec3::new(3.0, 5.0, 30.0),
                DVec3::new(4.0, 4.0, 30.0),
                DVec3::new(2.0, 3.0, 30.0),
            ],
            [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        );
        self_intersections(&both(cube(), &spike), usize::MAX).len()
    };
    assert_eq!(pairs(20.0_f64.next_up()), 0);
    assert_eq!(pairs(20.0), 3);
    assert!(pairs(20.0_f64.next_down()) >= 3);
}

#[test]
fn coplanar_faces_intersect_if_they_overlap() {
    let fan = |apex: [f64; 2]| {
        let at = |x: f64, y: f64| DVec3::new(x, y, 1.0 + x / 3.0 + y / 7.0);
        let vertices = vec![
            at(0.0, 0.0),
            at(4.0, 0.0),
            at(2.0, 3.0),
            at(apex[0], apex[1]),
        ];
        let sheet = TriMesh::new(vertices, [[0, 1, 2], [1, 0, 3]]);
        // Rounded to f32 the plane is lost; level it exactly.
        let flat = sheet.vertices.iter().map(|v| v.with_z(0.0)).collect();
        self_intersections(
            &TriMesh {
                vertices: flat,
                faces: sheet.faces,
            },
            10,
        )
        .len()
    };
    assert_eq!(fan([2.0, -3.0]), 0);
    assert_eq!(fan([2.0, 1.0]), 1);
    assert_eq!(fan([9.0, 0.5]), 1);
}

#[test]
fn intersections_do_not_depend_on_place_order_or_limit() {
    let a = bumpy_sphere(40, 20, 0.05);
    assert_eq!(found(&a), []);
    let turn =
        DMat4::from_rotation_translation(DQuat::from_rotation_x(0.4), DVec3::new(9.0, 1.0, 2.0));
    let pair = both(a.clone(), &a.transformed(turn));
    let all = self_intersections(&pair, usize::MAX);
    assert!(all.len() > 50 && all.is_sorted() && all.iter().all(|[p, q]| p < q));
    let mut reversed = pair.clone();
    reversed.faces.reverse();
    let turned = |f: FaceId| FaceId::new(pair.faces.len() - 1 - f.at());
    let mut mirrored: Vec<[FaceId; 2]> = self_intersections(&reversed, usize::MAX)
        .iter()
        .map(|[p, q]| [turned(*q), turned(*p)])
        .collect();
    mirrored.sort_unstable();
    assert_eq!(mirrored, all);
    assert!(self_intersections(&pair, 10).len() >= 10);
    let Err(defects) = Solid::new(pair) else {
        panic!("overlapping spheres are no solid")
    };
    assert_eq!(defects[0].kind, DefectKind::SelfIntersection);
}

#[test]
fn faces_at_one_vertex_are_found_however_they_are_crumpled() {
    // Each vertex is moved along its own direction, so that some of its faces fold over each other and others do not.
    let crumpled = |by: f64| {
        let mut mesh = bumpy_sphere(24, 12, 0.05);
        for (k, v) in mesh.vertices.iter_mut().enumerate() {
            let k = k as f64;
            *v += by * DVec3::new((7.0 * k).sin(), (11.0 * k).sin(), (13.0 * k).sin());
        }
        mesh
    };
    let mut met = Vec::new();
    for by in [0.0, 1.0, 3.0] {
        let mesh = crumpled(by);
        let neighbours = |pair: &[FaceId; 2]| {
            let [a, b] = pair.map(|f| mesh.faces[f]);
            a.iter().any(|v| b.contains(v))
        };
        let faces = || FaceId::all(mesh.faces.len());
        let meet = |pair: &[FaceId; 2]| {
            let alone = TriMesh {
                vertices: mesh.vertices.clone(),
                faces: pair.iter().map(|f| mesh.faces[*f]).collect(),
            };
            !self_intersections(&alone, 1).is_empty()
        };
        let one_by_one: Vec<[FaceId; 2]> = faces()
            .flat_map(|a| faces().filter(move |b| a < *b).map(move |b| [a, b]))
            .filter(|pair| neighbours(pair) && meet(pair))
            .collect();
        let mut together = self_intersections(&mesh, usize::MAX);
        together.retain(|pair| neighbours(pair));
        assert_eq!(together, one_by_one, "moved by {by}");
        met.push(together.len());
    }
    assert!(met[0] == 0 && met[1] > 0 && met[2] > met[1], "{met:?}");
}

#[test]
fn a_solid_survives_being_written_as_f32() {
    let turn =
        DMat4::from_rotation_translation(DQuat::from_rotation_y(0.3), DVec3::splat(1.0 / 3.0));
    let mesh = bumpy_sphere(30, 15, 0.1).transformed(turn);
    let solid = Solid::new(mesh.clone()).unwrap();
    assert!(
        solid
            .mesh()
            .vertices
            .iter()
            .all(|v| v.as_vec3().as_dvec3() == *v)
    );
    assert_eq!(Solid::new(solid.mesh().clone()).unwrap(), solid);
    assert!((solid.volume_mm3() / mesh.volume() - 1.0).abs() < 1e-6);
    assert!((solid.area_mm2() / mesh.area() - 1.0).abs() < 1e-6);
    assert_eq!((solid.parts(), solid.cavities()), (1, 0));
    // Triangle soup, as STL has it, is the same body; an open one is none.
    let soup = TriMesh::new(
        FaceId::all(mesh.faces.len())
            .flat_map(|f| mesh.corners(f))
            .collect(),
        (0..mesh.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]),
    );
    assert_eq!(Solid::new(soup).unwrap().volume_mm3(), solid.volume_mm3());
    let mut open = mesh;
    open.faces.pop();
    let said: Vec<Defect> = Solid::new(open).unwrap_err();
    assert_eq!((said[0].kind, said[0].count), (DefectKind::OpenEdge, 3));
}

#[test]
fn snapping_collapses_what_f32_cannot_hold() {
    // Off the origin, near which f32 holds any step.
    let mut mesh =
        bumpy_sphere(30, 15, 0.0).transformed(DMat4::from_translation(DVec3::splat(100.0 / 3.0)));
    // Splits an edge so close to its end that f32 cannot tell.
    let [a, b, c] = mesh.faces[0];
    let neighbour = face_neighbours(&mesh)[0][0].unwrap();
    let d = *mesh.faces[neighbour]
        .iter()
        .find(|v| ![a, b].contains(v))
        .unwrap();
    let (p, q) = (mesh.vertices[a], mesh.vertices[b]);
    let m = VertexId::new(mesh.vertices.len());
    mesh.vertices.push(p.lerp(q, 1e-12));
    mesh.faces[0] = [a, m, c];
    mesh.faces[neighbour] = [m, a, d];
    mesh.faces.extend([[m, b, c], [b, m, d]]);
    assert!(Solid::new(mesh.clone()).is_err());
    let snapped = snap_to_f32(&mesh);
    assert_eq!((snapped.collapsed, snapped.folded), (2, 0));
    assert_eq!(
        Solid::new(snapped.mesh).unwrap().mesh().faces.len(),
        mesh.faces.len() - 2
    );
}

#[test]
fn topology_tells_what_hangs_together() {
    let two = both(cube(), &cuboid([20.0, 20.0, 20.0], [1.0; 3]));
    assert_eq!(vertex_parts(&two).0, 1);
    let components = face_components(&two);
    assert_eq!(
        (components[0], components[12], components.iter().max()),
        (ComponentId(0), ComponentId(1), Some(&ComponentId(1)))
    );
    let neighbours = face_neighbours(&cube());
    for (face, around) in FaceId::all(neighbours.len()).zip(&neighbours) {
        for next in around.map(|n| n.unwrap()) {
            assert!(neighbours[next].contains(&Some(face)));
        }
    }
    let mut stray = cube();
    stray.vertices.insert(0, DVec3::ONE);
    stray
        .faces
        .iter_mut()
        .for_each(|f| *f = f.map(|v| VertexId(v.0 + 1)));
    let (parts, part_of) = vertex_parts(&stray);
    assert_eq!((parts, part_of[0], part_of[1]), (1, None, Some(0)));
}

#[test]
fn welding_keeps_to_its_tolerance() {
    let row: Vec<DVec3> = (0..10)
        .map(|k| DVec3::new(f64::from(k) * 0.6, 0.0, 0.0))
        .collect();
    let mesh = TriMesh::new(row, [[0, 1, 9]]);
    let welded = weld(&mesh, 1.0);
    assert_eq!(
        welded.vertex_of,
        [0, 0, 1, 1, 2, 2, 3, 3, 4, 4].map(VertexId)
    );
    assert_eq!(
        (welded.merged, welded.mesh.faces[0]),
        (5, [0, 0, 4].map(VertexId))
    );
    let zeros = TriMesh {
        vertices: vec![DVec3::ZERO, -DVec3::ZERO],
        faces: Vec::new(),
    };
    assert_eq!(weld(&zeros, 0.0).merged, 1);
}

#[test]
fn the_gate_repairs_and_says_so() {
    let told = |mesh: TriMesh, words: &str| {
        let gated = gate(mesh).unwrap();
        let said = repaired("m.obj", &gated).map(|w| w.message);
        assert!(
            said.as_ref().is_some_and(|s| s.contains(words)),
            "`{words}` wanted in {said:?}"
        );
        gated.mesh
    };
    assert_eq!(repaired("m.obj", &gate(cube()).unwrap()), None);
    assert_eq!(
        told(
            turned_inside_out(cube()),
            "turned 1 closed surface outwards"
        )
        .volume(),
        8000.0
    );
    let mut mixed = cube();
    mixed.faces[4].swap(0, 1);
    mixed.faces[7].swap(0, 1);
    assert_eq!(found(&told(mixed, "turned 2 faces to match")), []);
    let hollow = both(cube(), &turned_inside_out(cuboid([5.0; 3], [10.0; 3])));
    assert_eq!(
        told(
            turned_inside_out(hollow.clone()),
            "turned 2 closed surfaces"
        )
        .volume(),
        7000.0
    );
    assert_eq!(gate(hollow.clone()).unwrap().mesh.volume(), 7000.0);
    let beside = both(cube(), &turned_inside_out(cuboid([30.0; 3], [2.0; 3])));
    assert_eq!(
        told(beside, "turned 1 closed surface outwards").volume(),
        8008.0
    );
    let far = cuboid([1e7; 3], [20.0; 3]);
    assert_eq!(gate(far.clone()).unwrap().mesh.volume(), far.volume());
    let mut cracked = TriMesh::default();
    for face in FaceId::all(12) {
        let shift = DVec3::splat(1e-6 * f64::from(face.0 % 3));
        let [a, b, c] = cube().corners(face).map(|p| p + shift);
        cracked.append(&TriMesh::new(vec![a, b, c], [[0, 1, 2]]));
    }
    assert_eq!(found(&told(cracked, "across cracks")), []);
    let mut open = cube();
    open.faces.pop();
    assert_eq!(told(open, "3 open edges").faces.len(), 11);
}

#[test]
fn hollows_are_filled_and_parts_are_kept() {
    let mut mesh = cuboid([0.0; 3], [1.0; 3]);
    mesh.append(&turned_inside_out(cuboid([0.25; 3], [0.5; 3])));
    mesh.append(&cuboid([3.0; 3], [1.0; 3]));
    assert_eq!(Solid::new(mesh.clone()).unwrap().cavities(), 1);
    // A crumb loose in the hollow goes with it.
    mesh.append(&cuboid([0.4; 3], [0.1; 3]));
    let filled = Solid::new(without_cavities(mesh)).unwrap();
    assert_eq!((filled.cavities(), filled.parts()), (0, 2));
    assert!((filled.volume_mm3() - 2.0).abs() < 1e-6);
}

#[test]
fn what_only_touches_a_body_is_not_taken_for_a_part_of_it() {
    // Two boxes that share a side, as two shells: each has corners on the other.
    let mut mesh = cuboid([0.0; 3], [1.0; 3]);
    mesh.append(&cuboid([1.0, 0.25, 0.25], [1.0, 0.5, 0.5]));
    let kept = without_cavities(mesh.clone());
    assert_eq!(kept.faces.len(), mesh.faces.len());
    assert!((kept.volume() - 1.25).abs() < 1e-12);
}

/// Printed files hold the caps of prisms: which ear comes next shows in their bytes.
#[test]
fn outlines_are_cut_at_their_lowest_ear() {
    let pentagon = crate::shapes::ring(DVec2::ZERO, 1.0, 5);
    let fan = [[4, 0, 1], [4, 1, 2], [2, 3, 4]];
    assert_eq!(triangulate_outline(&pentagon), fan);
    // A step with a flat corner: corner 0 is an ear, then only those that leave the notch alone.
    let step = [[0, 0], [2, 0], [4, 0], [4, 1], [2, 1], [2, 3], [0, 3]];
    let step = step.map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
    let triangles = triangulate_outline(&step);
    let area = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|k| step[k]);
        (b - a).perp_dot(c - a) / 2.0
    };
    assert!(triangles.iter().all(|t| area(t) > 0.0), "{triangles:?}");
    assert_eq!(triangles.iter().map(area).sum::<f64>(), 8.0);
    assert_eq!(triangles[0], [6, 0, 1]);
}
