//! The forest in pieces: do they fit the bed, each other and the forest they came from?

use super::shapes::{boxes, manifold, pillar, prism};
use glam::{DMat4, DVec2, DVec3};
use manifold_rust::linalg::Vec3;
use manifold_rust::manifold::Manifold;
use pillarforest::diagram::layout;
use pillarforest::geom::{contains, polygon_area};
use pillarforest::index::FaceId;
use pillarforest::mesh::TriMesh;
use pillarforest::split::{Lettering, Piece, PlateNumber, Split, SplitError, SplitOptions, split};
use pillarforest::support::{Datum, Support, SupportKind};

const CLEARANCE: f64 = 0.15;
const OPTIONS: SplitOptions = SplitOptions {
    nozzle: 0.4,
    bed: [100.0, 100.0, 200.0],
    clearance: CLEARANCE,
};
const THICKNESS: f64 = 5.0;
/// How deep sockets of that base are.
const DEPTH: f64 = 3.0;

fn rectangle(width: f64, depth: f64) -> Vec<DVec2> {
    let (x, y) = (width / 2.0, depth / 2.0);
    [(-x, -y), (x, -y), (x, y), (-x, y)]
        .map(DVec2::from)
        .to_vec()
}

fn base(outline: Vec<DVec2>, thickness: f64) -> Support {
    Support {
        name: "base".into(),
        mesh: prism(&outline, -thickness, 0.0),
        kind: SupportKind::Base {
            outline,
            bottom: -thickness,
            top: 0.0,
        },
        layer: None,
    }
}

/// A pillar sunk into the base by a millimetre, as scenes have them.
fn sunk(x: f64, y: f64, radius: f64, corners: usize) -> Support {
    let mut support = pillar(DVec2::new(x, y), radius, corners, Datum::Plane);
    if let SupportKind::Pillar {
        profile, bottom, ..
    } = &mut support.kind
    {
        *bottom = -1.0;
        support.mesh = prism(profile, -1.0, 40.0);
    }
    support
}

fn meshes(supports: &[Support]) -> Vec<TriMesh> {
    supports.iter().map(|s| s.mesh.clone()).collect()
}

fn divided(supports: &[Support]) -> Split {
    split(supports, &meshes(supports), &OPTIONS).unwrap()
}

/// A grove of two sizes on a base larger than the bed.
fn grove() -> Vec<Support> {
    vec![
        sunk(-40.0, 5.0, 4.0, 64),
        sunk(-10.0, -12.0, 4.0, 64),
        sunk(2.0, 14.0, 5.0, 4),
        sunk(41.0, -3.0, 4.0, 6),
        base(rectangle(150.0, 60.0), THICKNESS),
    ]
}

fn back(piece: &Piece) -> TriMesh {
    let place = DMat4::from_translation(piece.origin);
    piece.solid.mesh().transformed(place)
}

fn back_as(piece: &Piece) -> Manifold {
    manifold(&back(piece))
}

fn plates(split: &Split) -> impl Iterator<Item = &Piece> {
    split.pieces.iter().filter(|p| p.is_plate)
}

fn pillars(split: &Split) -> impl Iterator<Item = &Piece> {
    split.pieces.iter().filter(|p| !p.is_plate)
}

fn near(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() < within, "{a}, expected {b}");
}

/// Cubic millimetres of all numbers engraved in plates.
fn numbers(split: &Split) -> f64 {
    let of = |s: &pillarforest::split::Socket| {
        let label = s.label.expect("room for the number");
        0.6 * engraved_area(s.number, label.middle, label.stroke)
    };
    split.sockets.iter().map(of).sum()
}

fn engraved_area(number: usize, at: DVec2, stroke: f64) -> f64 {
    let rings = Lettering::new(number).rings(at, stroke);
    let area =
        |r: &Vec<[f64; 2]>| polygon_area(&r.iter().map(|p| DVec2::from(*p)).collect::<Vec<_>>());
    rings.iter().map(area).sum()
}

#[test]
fn plates_of_a_bare_base_add_up_to_it() {
    let bare = |bed| {
        let supports = [base(rectangle(150.0, 60.0), THICKNESS)];
        let options = SplitOptions { bed, ..OPTIONS };
        split(&supports, &meshes(&supports), &options).unwrap()
    };
    let whole = 150.0 * 60.0 * THICKNESS;
    let one = bare([200.0, 100.0, 100.0]);
    assert_eq!((one.pieces.len(), one.pins.len()), (1, 0));
    near(one.pieces[0].solid.volume_mm3(), whole, 1e-2);
    // Turned it fits too.
    assert_eq!(bare([70.0, 160.0, 100.0]).pieces.len(), 1);
    let two = bare([100.0, 100.0, 100.0]);
    assert_eq!((two.pieces.len(), two.pins.len()), (2, 2));
    let c = CLEARANCE;
    let gap = c * 60.0 * THICKNESS;
    let pin = 6.0 * (4.0 + c / 2.0) * (THICKNESS / 2.0 - c);
    let hole = (6.0 + 2.0 * c) * (4.0 + c / 2.0) * THICKNESS / 2.0;
    let sum: f64 = two.pieces.iter().map(|p| p.solid.volume_mm3()).sum();
    near(sum, whole - gap + 2.0 * (pin - hole), 1e-2);
    // Cut in the middle, at an even number of millimetres.
    assert_eq!(two.cuts.x, [0.0]);
    let many = bare([40.0, 40.0, 40.0]);
    assert_eq!(many.pieces.len(), 5 * 2);
    for piece in &many.pieces {
        let (lo, hi) = piece.solid.bounds();
        assert!((hi - lo).max_element() <= 40.0, "{}", piece.name);
        near(lo.z, 0.0, 1e-9);
        assert_eq!(piece.solid.parts(), 1, "{}", piece.name);
    }
}

#[test]
fn pieces_fit_the_bed_and_are_back_where_they_were() {
    let supports = grove();
    let split = divided(&supports);
    assert_eq!(plates(&split).count(), 2);
    assert_eq!(pillars(&split).count(), 4);
    let names: Vec<&str> = split.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names[..3], ["plate-1", "plate-2", "pillar-1"]);
    for piece in &split.pieces {
        let (lo, hi) = piece.solid.bounds();
        assert!((hi - lo).cmple(DVec3::from_array(OPTIONS.bed)).all());
        assert!(lo.z.abs() < 1e-6 && piece.engraved, "{}", piece.name);
        assert_eq!(piece.solid.parts(), 1);
    }
    // Above the plates every pillar is what it was.
    for (piece, support) in pillars(&split).zip(&supports) {
        let above = |m: Manifold| m.trim_by_plane(Vec3::new(0.0, 0.0, 1.0), 0.0);
        let (now, before) = (above(back_as(piece)), above(manifold(&support.mesh)));
        near(now.volume(), before.volume(), 1e-2);
        assert!(now.difference(&before).volume() < 1e-2);
        let (lo, hi) = back(piece).bounds().unwrap();
        near(lo.z, -DEPTH, 1e-6);
        near(hi.z, 40.0, 1e-5);
    }
}

#[test]
fn pegs_fit_their_sockets_with_the_clearance_and_in_one_way_only() {
    let split = divided(&grove());
    let all: Vec<Manifold> = plates(&split).map(back_as).collect();
    let base = all[0].union(&all[1]);
    for piece in pillars(&split) {
        let peg = back_as(piece);
        let hit = |m: &Manifold| base.intersection(m).volume();
        assert!(hit(&peg) < 1e-6, "{}", piece.name);
        // Sideways by a little less than the clearance it is free, off the floor; by twice as much it is not.
        for k in 0..8 {
            let way = DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_4);
            let put = |by: f64| peg.translate(Vec3::new(by * way.x, by * way.y, 1e-3));
            assert!(hit(&put(0.9 * CLEARANCE)) < 1e-6, "{} {k}", piece.name);
            assert!(hit(&put(2.5 * CLEARANCE)) > 1e-2, "{} {k}", piece.name);
        }
        // Deeper it does not go, and turned about its axis it does not go in.
        assert!(hit(&peg.translate(Vec3::new(0.0, 0.0, -0.1))) > 1.0);
        let o = piece.origin;
        let own = manifold(piece.solid.mesh());
        for turn in [20.0, 60.0, 90.0, 120.0, 180.0, 270.0] {
            let put = own
                .rotate(0.0, 0.0, turn)
                .translate(Vec3::new(o.x, o.y, o.z + 1e-3));
            assert!(hit(&put) > 0.1, "{} turned by {turn}", piece.name);
        }
    }
}

#[test]
fn sockets_and_numbers_take_out_what_they_should() {
    let supports = [
        sunk(10.0, 5.0, 5.0, 4),
        base(rectangle(60.0, 50.0), THICKNESS),
    ];
    let split = divided(&supports);
    let plate = plates(&split).next().unwrap();
    assert_eq!(plate.numbers, [1]);
    // The socket is a square with a corner cut off, less and less towards the top: the triangle beyond a line `h` from the
    // corner of a square has the area h squared.
    let c = CLEARANCE;
    let (reach, corner): (f64, f64) = (5.0, 5.0 + c * 2f64.sqrt());
    let top = reach + 0.05;
    let end = (0.6 * reach).max(top - 0.9 * DEPTH);
    let lean = (top - end) / DEPTH;
    let out = c * lean.hypot(1.0);
    // The line leaves the square a little below the top.
    let h = corner - end - out;
    assert!(h / lean < DEPTH);
    let cut = h.powi(3) / (3.0 * lean);
    let socket = 2.0 * corner * corner * DEPTH - cut;
    let expected = 60.0 * 50.0 * THICKNESS - socket - numbers(&split);
    near(plate.solid.volume_mm3(), expected, 2e-2);
    // The number in the peg's end is there as well: 1 is a bar of five cells.
    let peg = pillars(&split).next().unwrap();
    let (mesh, z) = (peg.solid.mesh(), 0.6);
    let ceiling: f64 = FaceId::all(mesh.faces.len())
        .filter(|f| mesh.corners(*f).iter().all(|p| (p.z - z).abs() < 1e-4))
        .map(|f| mesh.area_vector(f).length() / 2.0)
        .sum();
    near(ceiling, 5.0 * 0.8 * 0.8, 1e-3);
}

#[test]
fn a_number_is_engraved_on_free_ground() {
    let supports = grove();
    let split = divided(&supports);
    for socket in &split.sockets {
        let PlateNumber {
            middle: at, stroke, ..
        } = socket.label.unwrap();
        let half = Lettering::new(socket.number).size() * stroke / 2.0;
        for corner in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let p = at + half * DVec2::from(corner);
            for support in &supports {
                match &support.kind {
                    SupportKind::Pillar { profile, .. } => assert!(!contains(profile, p)),
                    SupportKind::Base { outline, .. } => assert!(contains(outline, p)),
                    SupportKind::Body { .. } => panic!("{} is no pillar", support.name),
                }
            }
            let cut = split.cuts.x[0];
            assert_eq!(p.x > cut, at.x > cut, "number {}", socket.number);
        }
    }
}

#[test]
fn numbers_are_made_of_cells_and_tell_up_from_down() {
    let cells = |n: usize| engraved_area(n, DVec2::new(3.0, -2.0), 1.0).round() as usize;
    let segments = [12, 5, 11, 11, 9, 11, 12, 7, 13, 12];
    for (digit, count) in segments.into_iter().enumerate() {
        // 6 and 9 are underlined by three cells.
        let bar = if matches!(digit, 6 | 9) { 3 } else { 0 };
        assert_eq!(cells(digit), count + bar, "{digit}");
    }
    assert_eq!(cells(47), 9 + 7);
    assert_eq!(cells(16), 5 + 12 + 7);
    assert_eq!(Lettering::new(8).size(), DVec2::new(3.0, 5.0));
    assert_eq!(Lettering::new(61).size(), DVec2::new(7.0, 7.0));
    // Rings: outer ones turn left, holes right.
    let rings = Lettering::new(8).rings(DVec2::ZERO, 2.0);
    let area =
        |r: &Vec<[f64; 2]>| polygon_area(&r.iter().map(|p| DVec2::from(*p)).collect::<Vec<_>>());
    let mut areas: Vec<f64> = rings.iter().map(area).collect();
    areas.sort_by(f64::total_cmp);
    assert_eq!(areas, [-4.0, -4.0, 60.0]);
    let mirrored = Lettering::new(7).mirrored().rings(DVec2::ZERO, 1.0);
    assert!(mirrored[0].contains(&[-1.5, -2.5]), "{mirrored:?}");
}

#[test]
fn pillars_whose_reliefs_meet_are_one_piece() {
    let supports = vec![
        sunk(-10.0, 0.0, 4.0, 64),
        sunk(10.0, 0.0, 4.0, 64),
        sunk(30.0, 0.0, 4.0, 64),
        base(rectangle(90.0, 40.0), THICKNESS),
    ];
    let mut standing = meshes(&supports);
    for (k, x) in [(0, -10.0), (1, -2.0)] {
        let pillar = manifold(&supports[k].mesh);
        let arm = manifold(&boxes(&[(
            DVec3::new(x, -1.0, 20.0),
            DVec3::new(x + 12.0, 1.0, 25.0),
        )]));
        let mesh = pillar.union(&arm).get_mesh_gl64(-1);
        let mesh = TriMesh::new(
            (0..mesh.num_vert())
                .map(|v| DVec3::from_array(mesh.get_vert_pos(v)))
                .collect(),
            (0..mesh.num_tri()).map(|t| mesh.get_tri_verts(t).map(|v| v as u32)),
        );
        standing[k] = mesh;
    }
    let split = split(&supports, &standing, &OPTIONS).unwrap();
    let names: Vec<&str> = pillars(&split).map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["pillar-1-2", "pillar-3"]);
    let pair = pillars(&split).next().unwrap();
    assert_eq!(
        (pair.numbers.as_slice(), pair.solid.parts()),
        (&[1, 2][..], 1)
    );
    assert!(
        back_as(pair)
            .intersection(&back_as(plates(&split).next().unwrap()))
            .volume()
            < 1e-6
    );
}

#[test]
fn without_a_base_there_are_pillars_only_and_a_thin_one_is_refused() {
    let supports = [sunk(0.0, 0.0, 4.0, 64), sunk(20.0, 0.0, 4.0, 64)];
    let split_up = divided(&supports);
    assert_eq!(split_up.pieces.len(), 2);
    assert!(split_up.pieces.iter().all(|p| !p.is_plate && p.engraved));
    let refused = |thickness: f64, bed: f64| {
        let supports = [
            sunk(0.0, 0.0, 4.0, 64),
            base(rectangle(90.0, 40.0), thickness),
        ];
        let options = SplitOptions {
            bed: [bed; 3],
            ..OPTIONS
        };
        split(&supports, &meshes(&supports), &options).unwrap_err()
    };
    assert_eq!(refused(1.5, 100.0), SplitError::ThinBase(1.5));
    assert_eq!(refused(5.0, 12.0), SplitError::SmallBed);
}

#[test]
fn a_peg_too_thin_for_its_number_says_so() {
    let supports = [
        sunk(0.0, 0.0, 1.2, 32),
        base(rectangle(40.0, 40.0), THICKNESS),
    ];
    let split = divided(&supports);
    assert!(plates(&split).all(|p| p.engraved));
    assert!(pillars(&split).all(|p| !p.engraved));
}

#[test]
fn the_layout_is_at_true_size_and_names_every_pillar() {
    let supports = grove();
    let split = divided(&supports);
    let svg = layout("A <grove>", &[], &supports, &split).svg();
    // 150 x 60 mm of base, 24 mm around it, 16 and 5 mm for bar and title.
    assert!(svg.contains("width=\"198mm\" height=\"129mm\" viewBox=\"0 0 198 129\""));
    for number in 1..=4 {
        assert!(
            svg.contains(&format!("aria-label=\"{number}\"")),
            "{number}"
        );
    }
    assert!(svg.contains("50 mm"));
    // The first pillar's key: a chord at 0.6 of its radius.
    let [a, b] = split.sockets[0].key.unwrap();
    near(a.x, -40.0 + 0.6 * 4.0, 1e-6);
    near(a.distance(b), 2.0 * 0.8 * 4.0, 0.02);
    // The cut, 3 mm beyond the base on both sides.
    let x = split.cuts.x[0] + 75.0 + 24.0;
    assert!(svg.contains(&format!("M{x} 92L{x} 26")), "{svg}");
}

#[test]
fn the_same_forest_gives_the_same_pieces_on_any_number_of_threads() {
    let supports = grove();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| divided(&supports))
    };
    let (one, four) = (run(1), run(4));
    assert_eq!(one.pieces.len(), four.pieces.len());
    for (a, b) in one.pieces.iter().zip(&four.pieces) {
        assert_eq!((&a.name, &a.solid), (&b.name, &b.solid));
    }
}
