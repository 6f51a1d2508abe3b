//! Light and shadow, by what physics says of planes, walls and skies.

use crate::scene::CUBE;
use crate::shapes::{ORANGE, ball, view};
use glam::{DMat4, DVec3};
use pillarforest::bvh::Bvh;
use pillarforest::compile::build;
use pillarforest::diag::Diagnostic;
use pillarforest::geom::ImagePlane;
use pillarforest::index::FaceId;
use pillarforest::mesh::TriMesh;
use pillarforest::render::caster::{Caster, Meet, sky, sun};
use pillarforest::render::flash::Flash;
use pillarforest::render::stage::{SKY, SUNS_DEG};
use pillarforest::render::{LightLikeness, light_pictures};
use pillarforest::scene;
use pillarforest::view::View;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A rectangle about `middle` with half sides `a` and `b`; its normal is that of `a x b`.
fn rectangle(middle: DVec3, a: DVec3, b: DVec3) -> TriMesh {
    TriMesh::new(
        vec![
            middle - a - b,
            middle + a - b,
            middle + a + b,
            middle - a + b,
        ],
        [[0, 1, 2], [0, 2, 3]],
    )
}

/// A level floor at z = 0.
fn floor() -> TriMesh {
    rectangle(DVec3::ZERO, 500.0 * DVec3::X, 500.0 * DVec3::Y)
}

/// An upright wall over a line on the floor, square to `across`, through `foot`.
fn wall(foot: DVec3, across: DVec3, half_length: f64, height: f64) -> TriMesh {
    let along = half_length * DVec3::Z.cross(across);
    let up = height / 2.0 * DVec3::Z;
    rectangle(foot + up, along, up)
}

fn both(a: &TriMesh, b: &TriMesh) -> TriMesh {
    let mut all = a.clone();
    all.append(b);
    all
}

/// The floor's place below a point.
fn below(mesh: &TriMesh, bvh: &Bvh, at: DVec3) -> Meet {
    let meet = Caster::new(mesh, bvh).meet(at.with_z(1e-2), -DVec3::Z);
    meet.expect("a floor")
}

fn overcast(mesh: &TriMesh, meet: &Meet) -> f64 {
    let bvh = Bvh::new(mesh);
    let body = Caster::new(mesh, &bvh);
    body.skylight(meet, &sky(SKY)).shade()
}

#[test]
fn suns_stand_at_their_height_beside_the_eye() {
    let plane = ImagePlane::looking_at(DVec3::new(120.0, -80.0, 60.0), DVec3::new(1.0, 2.0, 30.0));
    let to_eye = -plane.forward.with_z(0.0).normalize();
    for elevation in SUNS_DEG {
        for (left, side) in [(true, -1.0), (false, 1.0)] {
            let l = sun(&plane, elevation, left);
            let (sin, cos) = elevation.to_radians().sin_cos();
            assert!((l.length() - 1.0).abs() < 1e-12 && (l.z - sin).abs() < 1e-12);
            assert!((l.dot(to_eye) - cos * FRAC_1_SQRT_2).abs() < 1e-12);
            assert!((l.dot(plane.right) - side * cos * FRAC_1_SQRT_2).abs() < 1e-12);
        }
    }
}

#[test]
fn a_plane_is_lit_by_the_cosine_of_its_angle_to_the_sun() {
    let l = DVec3::new(0.4, -0.7, 0.6).normalize();
    let aside = l.any_orthonormal_vector();
    for degrees in [0.0f64, 10.0, 45.0, 80.0, 89.9, 90.1, 135.0, 180.0] {
        let normal = DMat4::from_axis_angle(aside, degrees.to_radians()).transform_vector3(l);
        let (a, b) = normal.any_orthonormal_pair();
        let plate = rectangle(DVec3::new(3.0, 5.0, 7.0), 20.0 * a, 20.0 * b);
        let bvh = Bvh::new(&plate);
        let body = Caster::new(&plate, &bvh);
        let eye = DVec3::new(3.0, 5.0, 7.0) + 9.0 * normal;
        let meet = body.meet(eye, -normal).expect("a plate");
        let wanted = degrees.to_radians().cos().max(0.0);
        assert!(
            (body.sunlight(&meet, l).shade() - wanted).abs() < 1e-12,
            "{degrees}"
        );
    }
}

#[test]
fn a_wall_throws_a_shadow_as_long_as_its_height_over_the_tangent() {
    const HEIGHT: f64 = 10.0;
    let plane = ImagePlane::looking_at(DVec3::new(90.0, 30.0, 40.0), DVec3::ZERO);
    for elevation in SUNS_DEG {
        for left in [true, false] {
            let l = sun(&plane, elevation, left);
            let level = l.with_z(0.0).normalize();
            let mesh = both(&floor(), &wall(DVec3::ZERO, level, 50.0, HEIGHT));
            let bvh = Bvh::new(&mesh);
            let lit = |distance: f64| {
                let meet = below(&mesh, &bvh, -distance * level);
                Caster::new(&mesh, &bvh).sunlight(&meet, l).shade()
            };
            let length = HEIGHT / elevation.to_radians().tan();
            for share in [0.01, 0.5, 0.999] {
                assert_eq!(lit(share * length), 0.0, "{elevation} {share}");
            }
            for distance in [1.001 * length, 2.0 * length, -0.01 * length] {
                let wanted = elevation.to_radians().sin();
                assert!(
                    (lit(distance) - wanted).abs() < 1e-12,
                    "{elevation} {distance}"
                );
            }
        }
    }
}

#[test]
fn shadows_keep_to_the_wall_to_within_a_hair() {
    let l = DVec3::new(1.0, 0.0, 1.0).normalize();
    for high in [1e-4, 0.1] {
        let mesh = both(&floor(), &wall(DVec3::ZERO, DVec3::X, 50.0, high));
        let bvh = Bvh::new(&mesh);
        let meet = below(&mesh, &bvh, DVec3::new(-high / 2.0, 0.0, 0.0));
        let open = Caster::new(&mesh, &bvh).sunlight(&meet, l).open;
        assert_eq!(open == 0.0, high > 0.01, "{high}");
    }
}

#[test]
fn a_free_floor_gets_all_of_the_sky_and_a_free_wall_half() {
    let lone = |mesh: TriMesh| {
        let meet = Meet {
            face: FaceId(0),
            place: (mesh.vertices[0] + mesh.vertices[2]) / 2.0,
            normal: mesh.normal(FaceId(0)),
        };
        overcast(&mesh, &meet)
    };
    assert!((lone(floor()) - 1.0).abs() < 1e-12);
    for k in 0..12 {
        let (sin, cos) = (PI * f64::from(k) / 6.0).sin_cos();
        let across = DVec3::new(cos, sin, 0.0);
        assert!((lone(wall(DVec3::ZERO, across, 5.0, 5.0)) - 0.5).abs() < 1e-12);
        let quadrature = |normal: DVec3| -> f64 {
            let facing = |w: &DVec3| normal.dot(*w).max(0.0);
            2.0 / SKY as f64 * sky(SKY).iter().map(facing).sum::<f64>()
        };
        assert!((quadrature(across) - 0.5).abs() < 0.02, "{k}");
        assert!((quadrature(DVec3::Z) - 1.0).abs() < 1e-12);
    }
    let ceiling = rectangle(DVec3::ZERO, DVec3::X, -DVec3::Y);
    assert_eq!(lone(ceiling), 0.0);
}

#[test]
fn a_long_wall_takes_its_part_of_the_sky_from_the_floor() {
    // A floor before an endless wall whose top stands at the angle t sees (1 + cos t) / 2 of the sky; each of the
    // 48 directions is up to 0.04 of it.
    for degrees in [20.0f64, 45.0, 70.0, 89.9] {
        let wanted = (1.0 + degrees.to_radians().cos()) / 2.0;
        let mut sum = 0.0;
        for k in 0..12 {
            let (sin, cos) = (PI * f64::from(k) / 6.0).sin_cos();
            let across = DVec3::new(cos, sin, 0.0);
            let height = degrees.to_radians().tan();
            let mesh = both(&floor(), &wall(across, across, 1e5, height));
            let bvh = Bvh::new(&mesh);
            let found = overcast(&mesh, &below(&mesh, &bvh, DVec3::ZERO));
            assert!(
                (found - wanted).abs() < 0.06,
                "{degrees} {k}: {found}, {wanted}"
            );
            sum += found / 12.0;
        }
        assert!((sum - wanted).abs() < 0.01, "{degrees}: {sum}, {wanted}");
    }
}

#[test]
fn a_ray_is_blocked_if_its_first_hit_is_near_enough() {
    let mesh = both(
        &ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 16),
        &ball(DVec3::new(14.0, -9.0, 24.0), 5.0, 10),
    );
    let bvh = Bvh::new(&mesh);
    let mut blocked = 0;
    for w in sky(200) {
        for t_max in [5.0, 12.0, 20.0, 40.0, f64::INFINITY] {
            let origin = DVec3::new(1.0, 1.0, 0.0);
            let wanted = bvh.first_hit(origin, w).is_some_and(|h| h.t < t_max);
            assert_eq!(bvh.blocked(origin, w, t_max), wanted, "{w} {t_max}");
            blocked += usize::from(wanted);
        }
    }
    assert!((20..980).contains(&blocked), "{blocked}");
}

const EYE: DVec3 = DVec3::new(100.0, 0.0, 20.0);
const MIDDLE: DVec3 = DVec3::new(0.0, 0.0, 20.0);

/// An upright plate before the eye, turned from it by an angle about the vertical.
fn plate(turn: f64) -> TriMesh {
    let across = DMat4::from_rotation_z(turn).transform_vector3(DVec3::Y);
    rectangle(MIDDLE, 5.0 * across, 5.0 * DVec3::Z)
}

/// An upright wall behind the eye: it keeps off the suns and is not seen.
fn screen() -> TriMesh {
    wall(DVec3::new(150.0, 0.0, -500.0), DVec3::X, 1000.0, 1500.0)
}

fn figures(view: &View, forest: &TriMesh) -> Vec<LightLikeness> {
    light_pictures(view, forest, &Bvh::new(forest)).0
}

fn suns(all: &[LightLikeness]) -> impl Iterator<Item = (f64, &LightLikeness)> {
    all.iter().filter_map(|f| Some((f.elevation_deg?, f)))
}

#[test]
fn a_forest_that_is_the_model_looks_like_it_in_any_light() {
    let two = both(
        &ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 24),
        &ball(DVec3::new(12.0, -4.0, 26.0), 4.0, 12),
    );
    let view = view("owl", DVec3::new(90.0, -40.0, 25.0), two.clone(), ORANGE);
    let all = figures(&view, &two);
    let names: Vec<&str> = all.iter().map(|f| f.light.as_str()).collect();
    assert_eq!(names, ["sun_15", "sun_30", "sun_60", "overcast", "flash"]);
    for f in &all {
        assert_eq!(
            (f.rmse, f.rmse_unshadowed, f.gain, f.rmse_fitted),
            (0.0, 0.0, 1.0, 0.0)
        );
        assert!((f.correlation.expect("a ball is shaded") - 1.0).abs() < 1e-12);
        assert!(f.false_shadow_share.is_none_or(|s| s == 0.0));
        assert!(f.lost_shadow_share.is_none_or(|s| s == 0.0));
    }
    assert_eq!(all[3].false_shadow_share, None);
}

#[test]
fn a_screen_before_the_suns_is_one_false_shadow() {
    let target = view("plate", EYE, plate(0.0), ORANGE);
    for (elevation, f) in suns(&figures(&target, &both(&plate(0.0), &screen()))) {
        let wanted = 217.0 * elevation.to_radians().cos() * FRAC_1_SQRT_2;
        assert!((f.rmse - wanted).abs() < 1e-9, "{f:?}");
        assert_eq!(
            (f.rmse_unshadowed, f.gain, f.rmse_fitted),
            (0.0, 1.0, f.rmse)
        );
        assert_eq!(
            (f.false_shadow_share, f.lost_shadow_share),
            (Some(1.0), Some(0.0))
        );
        assert_eq!(f.correlation, None, "both are plain");
    }
}

#[test]
fn a_shadow_that_only_the_model_casts_is_lost() {
    // A level lid from 1 to 9 mm before the plate at the height of the eye, which sees nothing of it.
    let mut target = view("plate", EYE, plate(0.0), ORANGE);
    let mut lid = target.models[0].clone();
    lid.mesh = rectangle(MIDDLE + 5.0 * DVec3::X, 4.0 * DVec3::X, 15.0 * DVec3::Y);
    target.models.push(lid);
    for (elevation, f) in suns(&figures(&target, &plate(0.0))) {
        // At 45 degrees aside its edges throw their shadows this far down; the lower half of the plate is 5 mm.
        let [near, far] = [1.0, 9.0].map(|x| x * 2f64.sqrt() * elevation.to_radians().tan());
        let wanted = (far.min(5.0) - near.min(5.0)) / 10.0;
        let lost = f.lost_shadow_share.expect("of a sun");
        assert_eq!(f.false_shadow_share, Some(0.0));
        assert!(
            (lost - wanted).abs() < 0.02,
            "{elevation}: {lost}, {wanted}"
        );
    }
}

#[test]
fn a_turned_plate_differs_by_the_cosines_and_a_gain_makes_it_good() {
    let target = view("plate", EYE, plate(0.0), ORANGE);
    let turn = 20f64;
    let wide = rectangle(
        MIDDLE,
        40.0 * DMat4::from_rotation_z(turn.to_radians()).transform_vector3(DVec3::Y),
        20.0 * DVec3::Z,
    );
    let [front, near, far] = [45.0, 45.0 - turn, 45.0 + turn].map(|d: f64| d.to_radians().cos());
    for (elevation, f) in suns(&figures(&target, &wide)) {
        let level = elevation.to_radians().cos();
        let rmse = 217.0 * level * ((front - near).abs() + (front - far).abs()) / 2.0;
        assert!((f.rmse - rmse).abs() < 1e-9, "{elevation}: {f:?}, {rmse}");
        assert!(
            (f.gain - (front / near + front / far) / 2.0).abs() < 1e-9,
            "{f:?}"
        );
        assert!(f.rmse_fitted < 1e-9, "{f:?}");
    }
}

#[test]
fn no_forest_is_white_paper() {
    let target = view("plate", EYE, plate(0.0), ORANGE);
    for (elevation, f) in suns(&figures(&target, &TriMesh::default())) {
        let wanted = 225.0 - 217.0 * elevation.to_radians().cos() * FRAC_1_SQRT_2;
        assert!((f.rmse - wanted).abs() < 1e-9, "{f:?}");
        assert_eq!(f.false_shadow_share, Some(0.0));
    }
}

/// The flash of [`EYE`], and how it lights a plate of 10 x 10 mm, seen straight on: it stands at (5, -15, 20).
fn flash_of(forest: &TriMesh) -> LightLikeness {
    let target = view("plate", EYE, plate(0.0), ORANGE);
    let all = figures(&target, forest);
    all.into_iter().find(|f| f.light == "flash").expect("one")
}

#[test]
fn the_flash_stands_beside_the_model() {
    let plane = ImagePlane::looking_at(EYE, MIDDLE);
    let model = both(&plate(0.0), &ball(MIDDLE + 4.0 * DVec3::X, 2.0, 12));
    let left = Flash::beside(&plane, &model, true);
    // The plate's left edge is at y = -5, the ball reaches to x = 6; the width is 10 mm.
    assert!(left.place.distance(DVec3::new(11.0, -15.0, 20.0)) < 1e-9);
    let nearest = model.vertices.iter().map(|v| v.distance(left.place));
    assert_eq!(left.unit_mm, nearest.fold(f64::INFINITY, f64::min));
    let right = Flash::beside(&plane, &model, false);
    assert!(right.place.distance(DVec3::new(11.0, 15.0, 20.0)) < 1e-9);
}

#[test]
fn a_far_flash_is_a_sun() {
    let mesh = both(&floor(), &ball(DVec3::new(1.0, 2.0, 9.0), 5.0, 16));
    let bvh = Bvh::new(&mesh);
    let body = Caster::new(&mesh, &bvh);
    let l = DVec3::new(0.5, -0.3, 0.6).normalize();
    let flash = Flash {
        place: 1e8 * l,
        unit_mm: 1e8,
    };
    let (mut lit, mut dark) = (0, 0);
    for k in 0..40 {
        for j in 0..40 {
            let from = DVec3::new(f64::from(k) - 20.3, f64::from(j) - 19.7, 60.0);
            let meet = body.meet(from, -DVec3::Z).expect("the floor at least");
            let (near, far) = (flash.light(&body, &meet), body.sunlight(&meet, l));
            assert!((near.free - far.free).abs() < 1e-5, "{near:?} {far:?}");
            assert_eq!(near.open, far.open, "{from}");
            lit += usize::from(far.shade() > 0.0);
            dark += usize::from(far.free > 0.0 && far.open == 0.0);
        }
    }
    assert!(lit > 500 && dark > 30, "{lit} {dark}");
}

#[test]
fn a_flash_lights_a_ball_by_formula() {
    // A point at the angle t from the flash at the distance D of the middle: (D cos t - R) (D - R)^2 / d^3.
    const RADIUS: f64 = 6.0;
    const AWAY: f64 = 15.0;
    let mesh = ball(DVec3::ZERO, RADIUS, 200);
    let bvh = Bvh::new(&mesh);
    let body = Caster::new(&mesh, &bvh);
    let towards = DVec3::new(0.3, -0.8, 0.4).normalize();
    let flash = Flash {
        place: AWAY * towards,
        unit_mm: AWAY - RADIUS,
    };
    let aside = towards.any_orthonormal_vector();
    for degrees in [0.0f64, 10.0, 25.0, 40.0, 60.0, 75.0, 120.0, 180.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let way = cos * towards + sin * aside;
        let meet = body.meet(20.0 * way, -way).expect("the ball");
        let d2 = AWAY * AWAY + RADIUS * RADIUS - 2.0 * AWAY * RADIUS * cos;
        let facing = (AWAY * cos - RADIUS).max(0.0);
        let wanted = facing * (AWAY - RADIUS).powi(2) / d2.powf(1.5);
        let found = flash.light(&body, &meet).shade();
        assert!((found - wanted).abs() < 0.01, "{degrees}: {found} {wanted}");
    }
}

#[test]
fn the_flash_of_a_mirrored_scene_on_the_other_side_gives_the_mirrored_light() {
    let mirrored = |p: DVec3| DVec3::new(p.x, -p.y, p.z);
    let mesh = both(
        &ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 24),
        &ball(DVec3::new(12.0, -4.0, 26.0), 4.0, 12),
    );
    let twin = TriMesh {
        vertices: mesh.vertices.iter().map(|v| mirrored(*v)).collect(),
        faces: mesh.faces.iter().map(|f| [f[0], f[2], f[1]]).collect(),
    };
    let (bvh, twin_bvh) = (Bvh::new(&mesh), Bvh::new(&twin));
    let (body, twin_body) = (Caster::new(&mesh, &bvh), Caster::new(&twin, &twin_bvh));
    let plane = ImagePlane::looking_at(EYE, MIDDLE);
    let flash = Flash::beside(&plane, &mesh, true);
    let other = Flash::beside(&plane, &twin, false);
    assert!(mirrored(flash.place).distance(other.place) < 1e-9);
    let mut lit = 0;
    for k in -20..20 {
        for j in -20..20 {
            let aim = DVec3::new(0.0, 0.7 * f64::from(k) + 0.1, 20.2 + 0.7 * f64::from(j));
            let meet = body.meet(EYE, (aim - EYE).normalize());
            let twin = twin_body.meet(mirrored(EYE), (mirrored(aim) - mirrored(EYE)).normalize());
            let (Some(meet), Some(twin)) = (meet, twin) else {
                continue;
            };
            let (a, b) = (flash.light(&body, &meet), other.light(&twin_body, &twin));
            assert!(
                (a.free - b.free).abs() < 1e-9 && a.open == b.open,
                "{a:?} {b:?}"
            );
            lit += usize::from(a.shade() > 0.0);
        }
    }
    assert!(lit > 100, "{lit}");
}

#[test]
fn only_what_stands_between_casts_a_shadow_in_the_flash() {
    let screen = |y: f64| wall(DVec3::new(5.0, y, 0.0), DVec3::Y, 20.0, 60.0);
    let hidden = flash_of(&both(&plate(0.0), &screen(-10.0)));
    assert_eq!(hidden.false_shadow_share, Some(1.0));
    assert_eq!((hidden.rmse_unshadowed, hidden.gain), (0.0, 1.0));
    let beyond = flash_of(&both(&plate(0.0), &screen(-20.0)));
    assert_eq!((beyond.rmse, beyond.false_shadow_share), (0.0, Some(0.0)));
}

#[test]
fn a_plate_behind_the_model_gets_less_of_the_flash() {
    // One of the same image twice as far away lies at (-100, y, 20 + z) with twice the size: the shade of every point by formula.
    let far = plate(0.0).transformed(
        DMat4::from_translation(EYE)
            * DMat4::from_scale(DVec3::splat(2.0))
            * DMat4::from_translation(-EYE),
    );
    let found = flash_of(&far);
    let flash = DVec3::new(5.0, -15.0, 20.0);
    // To the nearest vertex, a corner.
    let unit2: f64 = 5.0 * 5.0 + 10.0 * 10.0 + 5.0 * 5.0;
    let shade = |p: DVec3| {
        let way = flash - p;
        way.x * unit2 / way.length().powi(3)
    };
    let (mut sum, mut count) = (0.0, 0.0);
    for k in 0..100 {
        for j in 0..100 {
            let [y, z] = [k, j].map(|i| 0.1 * (f64::from(i) + 0.5) - 5.0);
            let near = DVec3::new(0.0, y, 20.0 + z);
            sum += (shade(near) - shade(EYE + 2.0 * (near - EYE))).powi(2);
            count += 1.0;
        }
    }
    let wanted = 217.0 * f64::sqrt(sum / count);
    assert!(
        (found.rmse / wanted - 1.0).abs() < 0.01,
        "{found:?} {wanted}"
    );
    assert_eq!(found.rmse, found.rmse_unshadowed);
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let model = ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 16);
    let view = view("owl", DVec3::new(90.0, -40.0, 25.0), model, ORANGE);
    let forest = both(
        &ball(DVec3::new(4.0, 2.0, 20.0), 8.0, 12),
        &ball(DVec3::new(14.0, -9.0, 24.0), 5.0, 10),
    );
    let bvh = Bvh::new(&forest);
    let draw = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| light_pictures(&view, &forest, &bvh))
    };
    assert_eq!(draw(1), draw(3));
}

#[test]
fn the_sheet_shows_ten_panels_and_lights_differ() {
    let model = ball(DVec3::new(3.0, 2.0, 20.0), 9.0, 24);
    let view = view("owl", DVec3::new(90.0, -40.0, 25.0), model.clone(), ORANGE);
    let (_, png) = light_pictures(&view, &model, &Bvh::new(&model));
    let sheet = tiny_skia::Pixmap::decode_png(&png).unwrap();
    let (across, down) = (sheet.width() / 5, 320);
    let grey = |column: u32, row: u32| {
        let x = column * across + across / 2;
        let y = 26 + row * (down + 8) + down / 2;
        sheet.pixel(x, y).expect("inside").red()
    };
    for column in 0..5 {
        assert_eq!(
            grey(column, 0),
            grey(column, 1),
            "model and forest are the same ball"
        );
        assert!((30..=250).contains(&grey(column, 0)));
    }
    assert!(grey(0, 0) > grey(2, 0), "a low sun shines into the face");
}

/// A cube in a block.
const ONE_BLOCK: &str = r#"(
    models: [(name: "cube", file: "cube.obj", place: Fit(height: 20, spin: 30, at: (0, 0, 15)))],
    views: [(name: "front", eye: (0, -300, 40), models: ["cube"])],
    pillars: [(shape: Rectangle(width: 40, depth: 20), height: 60, places: At([(0, 0)]))],
)"#;

#[test]
fn a_scene_may_do_without_light() {
    let built = |text: &str| {
        let read = |_: &str| -> Result<Vec<u8>, Diagnostic> { Ok(CUBE.into()) };
        let scene = scene::resolve(text, &read).expect("a scene").value;
        build(&scene, &|_, _| {}, &|| false).expect("a forest")
    };
    let dark = built(&scene::set(ONE_BLOCK, "output.lights=false").expect("a field"));
    let report = |build: &pillarforest::compile::Build| -> serde_json::Value {
        let file = build.files.iter().find(|f| f.path == "report.json");
        serde_json::from_slice(&file.expect("a report").bytes).unwrap()
    };
    assert!(dark.files.iter().all(|f| !f.path.contains("lights")));
    assert!(report(&dark)["views"][0].get("lights").is_none());
    let lit = built(ONE_BLOCK);
    let sheets = lit.files.iter().filter(|f| f.path.ends_with("-lights.png"));
    let views = report(&lit)["views"].as_array().expect("views").clone();
    assert_eq!(sheets.count(), views.len());
    for view in views {
        let lights = view["lights"].as_array().expect("lights");
        assert_eq!(lights.len(), 5);
        assert_eq!(lights[1]["light"], "sun_30");
        assert_eq!(lights[1]["elevation_deg"], 30.0);
        assert!(lights.iter().all(|l| l["rmse"].as_f64().is_some()));
        assert!(lights[3].get("false_shadow_share").is_none());
        assert_eq!(lights[4]["light"], "flash");
        assert!(lights[4]["false_shadow_share"].as_f64().is_some());
        assert!(lights[4].get("elevation_deg").is_none());
    }
}
