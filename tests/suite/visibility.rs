//! Rays: none may slip between faces, and answers are those of a search through all faces.

use crate::shapes::{ball, prism, ring};
use glam::{DVec2, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::index::FaceId;
use pillarforest::mesh::TriMesh;

/// Rays from the middle of a ball through every vertex and through points of every edge and face.
#[test]
fn no_ray_leaks_through_vertices_edges_or_faces() {
    let centre = DVec3::new(31.7, -12.9, 55.3);
    let mesh = ball(centre, 20.0, 40);
    let bvh = Bvh::new(&mesh);
    let mut rays: Vec<DVec3> = mesh.vertices.clone();
    for f in FaceId::all(mesh.faces.len()) {
        let [a, b, c] = mesh.corners(f);
        rays.extend([
            (a + b) / 2.0,
            a.lerp(b, 0.3),
            a.lerp(b, 1e-9),
            (a + b + c) / 3.0,
        ]);
    }
    assert!(rays.len() > 10_000);
    for p in rays {
        let hit = bvh
            .first_hit(centre, p - centre)
            .expect("a ray leaves a closed ball through a face");
        assert!(
            (hit.t - 1.0).abs() < 1e-9,
            "{} instead of 1 through {p}",
            hit.t
        );
    }
}

#[test]
fn hits_are_those_of_a_search_through_all_faces() {
    let mut mesh = ball(DVec3::new(0.0, 0.0, 40.0), 12.0, 12);
    mesh.append(&prism(&ring(DVec2::new(3.0, 30.0), 4.0, 32), -1.0, 90.0));
    let bvh = Bvh::new(&mesh);
    let eye = DVec3::new(7.0, -250.0, 48.0);
    let mut met = 0;
    for i in 0..40 {
        for j in 0..40 {
            let target = DVec3::new(-20.0 + f64::from(i) * 1.03, 0.0, 20.0 + f64::from(j) * 1.01);
            let direction = target - eye;
            let all = bvh.all_hits(eye, direction);
            assert!(all.is_sorted_by(|a, b| a.t <= b.t));
            assert_eq!(
                bvh.first_hit(eye, direction).map(|h| h.t),
                all.first().map(|h| h.t)
            );
            let mut wanted = by_search(&mesh, eye, direction);
            wanted.sort_by(f64::total_cmp);
            assert_eq!(all.len(), wanted.len(), "towards {target}");
            for (found, wanted) in all.iter().zip(&wanted) {
                assert!((found.t - wanted).abs() < 1e-9 * wanted);
            }
            met += all.len();
        }
    }
    assert!(met > 1000, "{met} hits test little");
}

/// Parameters at which the ray meets faces, by solving for the point in each face's plane (Möller & Trumbore 1997).
fn by_search(mesh: &TriMesh, origin: DVec3, direction: DVec3) -> Vec<f64> {
    let hit = |f: FaceId| {
        let [a, b, c] = mesh.corners(f);
        let (e1, e2) = (b - a, c - a);
        let p = direction.cross(e2);
        let det = e1.dot(p);
        let s = (origin - a) / det;
        let u = s.dot(p);
        let q = s.cross(e1);
        let v = direction.dot(q);
        (det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| e2.dot(q))
    };
    FaceId::all(mesh.faces.len())
        .filter_map(hit)
        .filter(|t| *t > 0.0)
        .collect()
}
