//! Closed meshes of supports that are no pillars, in a frame of their own: x to the right, y up, z out of the face, the origin in the
//! middle of the face's lower edge.

use super::shapes;
use crate::geom::polygon_area;
use crate::mesh::{DisjointSets, Edges, TriMesh};
use glam::{DMat4, DVec2, DVec3};

/// The frame of a face whose lower edge has its middle at `at`, that looks along the unit ground direction `facing` and leans back
/// by `lean` radians (a quarter turn: it lies, face up).
pub fn frame(at: DVec3, facing: DVec2, lean: f64) -> DMat4 {
    let ahead = facing.extend(0.0);
    let out = lean.cos() * ahead + lean.sin() * DVec3::Z;
    let up = lean.cos() * DVec3::Z - lean.sin() * ahead;
    DMat4::from_cols(
        up.cross(out).extend(0.0),
        up.extend(0.0),
        out.extend(0.0),
        at.extend(1.0),
    )
}

/// A box behind its face.
pub fn plate(width: f64, height: f64, thickness: f64) -> TriMesh {
    let half = width / 2.0;
    let outline = [
        (-half, -thickness),
        (half, -thickness),
        (half, 0.0),
        (-half, 0.0),
    ];
    upright(&outline.map(DVec2::from), height)
}

/// A block with a groove of V section, `opening` wide at the face and `deep` in the middle, from bottom to top.
pub fn groove(width: f64, height: f64, thickness: f64, opening: f64, deep: f64) -> TriMesh {
    let (half, edge) = (width / 2.0, opening / 2.0);
    let outline = [
        (-half, -thickness),
        (half, -thickness),
        (half, 0.0),
        (edge, 0.0),
        (0.0, -deep),
        (-edge, 0.0),
        (-half, 0.0),
    ];
    upright(&outline.map(DVec2::from), height)
}

/// Steps that go up away from the viewer, solid down to the ground; the lowest riser is the face.
pub fn stairs(steps: u32, width: f64, rise: f64, going: f64) -> TriMesh {
    // (z, y): the outline seen from the side.
    let mut outline = vec![DVec2::ZERO];
    for k in 0..steps {
        let (back, low) = (-going * f64::from(k), rise * f64::from(k));
        outline.push(DVec2::new(back, low + rise));
        outline.push(DVec2::new(back - going, low + rise));
    }
    outline.push(DVec2::new(-going * f64::from(steps), 0.0));
    if polygon_area(&outline) < 0.0 {
        outline.reverse();
    }
    let half = width / 2.0;
    let turned = shapes::prism(&outline, -half, half);
    moved(&turned, |p| DVec3::new(-p.z, p.y, p.x))
}

/// A prism over an outline in (x, z), counter-clockwise seen from above, from y = 0 to `height`.
fn upright(outline: &[DVec2], height: f64) -> TriMesh {
    // Seen from above, x to the right and z towards the viewer are left-handed.
    let mut mirrored: Vec<DVec2> = outline
        .iter()
        .rev()
        .map(|p| DVec2::new(p.x, -p.y))
        .collect();
    mirrored.dedup();
    let standing = shapes::prism(&mirrored, 0.0, height);
    moved(&standing, |p| DVec3::new(p.x, p.z, -p.y))
}

fn moved(mesh: &TriMesh, by: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh {
        vertices: mesh.vertices.iter().map(|p| by(*p)).collect(),
        faces: mesh.faces.clone(),
    }
}

/// A block whose face is the height field `heights(x, y)`, sampled at most `pitch` apart, and whose back is flat, `thickness` behind
/// z = 0. Heights below the back are the caller's to refuse.
pub fn wave(
    width: f64,
    height: f64,
    thickness: f64,
    pitch: f64,
    heights: impl Fn(f64, f64) -> f64,
) -> TriMesh {
    let columns = (width / pitch).ceil().max(1.0) as u32;
    let rows = (height / pitch).ceil().max(1.0) as u32;
    let mut mesh = TriMesh::default();
    for back in [false, true] {
        for j in 0..=rows {
            for i in 0..=columns {
                let x = width * (f64::from(i) / f64::from(columns) - 0.5);
                let y = height * f64::from(j) / f64::from(rows);
                let z = if back { -thickness } else { heights(x, y) };
                mesh.vertices.push(DVec3::new(x, y, z));
            }
        }
    }
    let behind = (columns + 1) * (rows + 1);
    let at = |i: u32, j: u32| j * (columns + 1) + i;
    let mut quad = |a: u32, b: u32, c: u32, d: u32| mesh.faces.extend([[a, b, c], [a, c, d]]);
    for j in 0..rows {
        for i in 0..columns {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            quad(a, b, c, d);
            quad(d + behind, c + behind, b + behind, a + behind);
        }
    }
    let mut border: Vec<u32> = (0..columns).map(|i| at(i, 0)).collect();
    border.extend((0..rows).map(|j| at(columns, j)));
    border.extend((0..columns).map(|i| at(columns - i, rows)));
    border.extend((0..rows).map(|j| at(0, rows - j)));
    for (k, a) in border.iter().copied().enumerate() {
        let b = border[(k + 1) % border.len()];
        quad(b, a, a + behind, b + behind);
    }
    mesh
}

/// A surface with a border made solid: a copy of it `by` away, and walls between the borders.
pub fn thickened(mesh: &TriMesh, by: DVec3) -> TriMesh {
    let n = mesh.vertices.len() as u32;
    let mut solid = mesh.clone();
    solid.vertices.extend(mesh.vertices.iter().map(|v| *v + by));
    let back = mesh.faces.iter().map(|[a, b, c]| [c + n, b + n, a + n]);
    solid.faces.extend(back);
    for sides in Edges::new(mesh).iter().filter(|sides| sides.len() == 1) {
        let side = &sides[0];
        let (a, b) = match side.forward {
            true => (side.low, side.high),
            false => (side.high, side.low),
        };
        solid.faces.extend([[b, a, a + n], [b, a + n, b + n]]);
    }
    solid
}

/// Faces of a mesh in parts that meet at angles of more than `crease` radians; numbered by their first face.
pub fn parts(mesh: &TriMesh, crease: f64) -> Vec<u32> {
    let mut sets = DisjointSets::new(mesh.faces.len());
    for sides in Edges::new(mesh).iter().filter(|sides| sides.len() == 2) {
        let [f, g] = [sides[0].face, sides[1].face];
        let [a, b] = [f, g].map(|f| mesh.normal(f as usize));
        if a.cross(b).length().atan2(a.dot(b)) <= crease {
            sets.join(f, g);
        }
    }
    sets.numbers().1
}
