//! What files say of vertices and faces besides where they are: read, followed through repairs, and left out with a word.

use crate::shapes::ball;
use glam::{DVec2, DVec3};
use pillarforest::diag::Warned;
use pillarforest::index::VertexId;
use pillarforest::intake::{Admitted, load_original};
use pillarforest::mesh::NO_UV;

/// A strip of two quads, one without texture points at its end.
const OBJ: &str = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
v 2 0 1 1 0 0\nv 1 0 0 0 1 0\nv 0 0 0 0 0 1\nv 0 0 1 0.5 0.25 0.125\nv 2 0 0 1 1 1\n\
f 3/1 2/2/9 4/-1\nvn 0 1 0\nf 2//1 5 1 4\n";

fn loaded(name: &str, bytes: &[u8]) -> Warned<Admitted> {
    load_original(name, bytes, false).expect("a mesh")
}

/// All warnings in one text.
fn said(read: &Warned<Admitted>) -> String {
    let messages: Vec<&str> = read.warnings.iter().map(|w| w.message.as_str()).collect();
    messages.join("\n")
}

#[test]
fn obj_keeps_its_order_colours_and_the_texture_points_of_corners() {
    let text = OBJ.replace("/9", "/1");
    let read = loaded("strip.obj", text.as_bytes()).value.original;
    let xs: Vec<f64> = read.mesh.vertices.iter().map(|v| v.x).collect();
    assert_eq!(xs, [2.0, 1.0, 0.0, 0.0, 2.0]);
    assert_eq!(read.mesh.faces[0], [2, 1, 3].map(VertexId));
    assert_eq!(read.mesh.faces.len(), 3);
    let uvs = read.attributes.uvs.as_ref().expect("texture points");
    assert_eq!(uvs.corners[0], [0, 1, 3]);
    assert_eq!(uvs.corners[1..], [[NO_UV; 3]; 2]);
    assert_eq!(uvs.points[3], DVec2::new(0.0, 1.0));
    assert_eq!(read.attributes.colours[3], [0.5, 0.25, 0.125, 1.0]);
    assert_eq!(read.attributes.names(), ["red", "green", "blue", "alpha"]);
    // Vertex 3 has a texture point in one face and none in the next.
    assert_eq!(uvs.per_vertex(&read.mesh), None);
    // 0 to 255 as some programs write them.
    let bytes = text
        .replace("0.5 0.25 0.125", "51 0 255")
        .replace(" 1 0 0\n", " 255 0 0\n");
    let read = loaded("strip.obj", bytes.as_bytes()).value.original;
    assert_eq!(read.attributes.colours[3], [0.2, 0.0, 1.0, 1.0]);
    assert_eq!(read.attributes.colours[0], [1.0, 0.0, 0.0, 1.0]);
}

/// Colours, texture points, a weight, a normal and an index of a tetrahedron, in any encoding.
fn ply(encoding: &str, corner_uvs: bool) -> Vec<u8> {
    let list = if corner_uvs {
        "property list uchar float texcoord\n"
    } else {
        ""
    };
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n\
         property float s\nproperty float t\nproperty double weight\nproperty int id\n\
         element face 4\n{list}property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    let places = [
        [0.0, 0.0, 0.0],
        [8.0, 0.0, 0.0],
        [0.0, 8.0, 0.0],
        [0.0, 0.0, 8.0],
    ];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    for (k, p) in places.iter().enumerate() {
        let colour = [255, 51 * k as u8, 0, 255];
        let uv = [k as f32 / 4.0, 0.5];
        if encoding == "ascii" {
            let line = format!(
                "{} {} {} 0 {} {} {} {} {} {} {} {}\n",
                p[0],
                p[1],
                p[2],
                colour[0],
                colour[1],
                colour[2],
                colour[3],
                uv[0],
                uv[1],
                k as f64 / 3.0,
                7 - k
            );
            bytes.extend(line.bytes());
            continue;
        }
        let swap = |mut b: Vec<u8>| {
            if encoding.contains("big") {
                b.reverse();
            }
            b
        };
        for x in [p[0] as f32, p[1] as f32, p[2] as f32, 0.0] {
            bytes.extend(swap(x.to_le_bytes().to_vec()));
        }
        bytes.extend(colour);
        uv.iter()
            .for_each(|c| bytes.extend(swap(c.to_le_bytes().to_vec())));
        bytes.extend(swap((k as f64 / 3.0).to_le_bytes().to_vec()));
        bytes.extend(swap(
            (7 - i32::try_from(k).expect("a few"))
                .to_le_bytes()
                .to_vec(),
        ));
    }
    for (f, face) in faces.iter().enumerate() {
        if encoding == "ascii" {
            if corner_uvs {
                bytes.extend(format!("6 0 0 1 0 1 {f} ").bytes());
            }
            bytes.extend(format!("3 {} {} {}\n", face[0], face[1], face[2]).bytes());
            continue;
        }
        let big = encoding.contains("big");
        let push = |bytes: &mut Vec<u8>, b: [u8; 4]| {
            let mut b = b;
            if big {
                b.reverse();
            }
            bytes.extend(b);
        };
        if corner_uvs {
            bytes.push(6);
            for c in [0.0, 0.0, 1.0, 0.0, 1.0, f as f32] {
                push(&mut bytes, c.to_le_bytes());
            }
        }
        bytes.push(3);
        face.iter()
            .for_each(|v: &i32| push(&mut bytes, v.to_le_bytes()));
    }
    bytes
}

#[test]
fn ply_keeps_colours_texture_points_and_every_other_number() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let read = loaded("tetra.ply", &ply(encoding, false));
        assert_eq!(said(&read), "", "{encoding}");
        let original = read.value.original;
        let attributes = &original.attributes;
        assert_eq!(attributes.colours[3], [1.0, 0.6, 0.0, 1.0], "{encoding}");
        let known = ["red", "green", "blue", "alpha", "weight", "id"];
        assert_eq!(attributes.names(), known, "{encoding}");
        let ids = attributes.values("id").expect("ids");
        assert_eq!(ids, [7.0, 6.0, 5.0, 4.0]);
        let weights = attributes.values("weight").expect("weights");
        assert!((weights[2] - 2.0 / 3.0).abs() < 1e-15);
        let uvs = attributes.uvs.as_ref().expect("texture points");
        let at_vertices = uvs.per_vertex(&original.mesh).expect("one at every vertex");
        assert_eq!(at_vertices[3], DVec2::new(0.75, 0.5));
        // Those of face corners are more than those of vertices.
        let read = loaded("tetra.ply", &ply(encoding, true)).value.original;
        let uvs = read.attributes.uvs.expect("texture points");
        assert_eq!(uvs.corners[2], [6, 7, 8], "{encoding}");
        assert_eq!(uvs.points[8], DVec2::new(1.0, 2.0));
    }
}

/// A ball taken apart into single triangles in a scrambled order, with the number of its vertex in the ball at every corner,
/// some corners a hair off, a stray vertex, a face twice and a face of one edge.
fn soup() -> (String, Vec<VertexId>) {
    let ball = ball(DVec3::ZERO, 10.0, 6);
    let n = ball.faces.len();
    let (mut vertices, mut faces, mut came_from) = (String::new(), String::new(), Vec::new());
    let order: Vec<usize> = (0..n).map(|k| (k * 7 + 3) % n).chain([5]).collect();
    for (k, f) in order.iter().enumerate() {
        for v in ball.faces[*f] {
            let p = ball.vertices[v] + DVec3::splat(if k % 5 == 0 && k < n { 3e-6 } else { 0.0 });
            vertices += &format!("{:?} {:?} {:?} {}\n", p.x, p.y, p.z, v.0);
            came_from.push(v);
        }
        faces += &format!("3 {} {} {}\n", 3 * k, 3 * k + 1, 3 * k + 2);
    }
    vertices += "1 2 3 77\n";
    faces += "3 0 0 1\n";
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nproperty float quality\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n{vertices}{faces}",
        came_from.len() + 1,
        order.len() + 1
    );
    (text, came_from)
}

#[test]
fn attributes_follow_vertices_through_repairs() {
    let (text, came_from) = soup();
    let read = loaded("soup.ply", text.as_bytes());
    let Admitted { mesh, original } = &read.value;
    assert!(said(&read).contains("joined"), "{}", said(&read));
    assert_eq!(original.vertex_of.len(), came_from.len() + 1);
    assert_eq!(original.vertex_of.last(), Some(&None), "the stray one");
    // What was one vertex of the ball is one again, near where it was.
    let mut number = vec![None; mesh.vertices.len()];
    for (k, ball_vertex) in came_from.iter().enumerate() {
        let v = original.vertex_of[k].expect("a vertex of the model");
        assert!(mesh.vertices[v].distance(original.mesh.vertices[k]) < 1e-5);
        assert_eq!(*number[v].get_or_insert(*ball_vertex), *ball_vertex);
    }
    let quality = original
        .values("quality", mesh.vertices.len())
        .expect("kept");
    for (v, number) in number.iter().enumerate() {
        assert_eq!(
            quality[v],
            f64::from(number.expect("every vertex comes from one").0)
        );
    }
    // Every face of the model is one of the file, by its vertices; only the doubled and the broken one are nobody's.
    let faces = original.faces_of(mesh);
    assert_eq!(faces.len(), original.mesh.faces.len() - 2);
    for (face, from) in mesh.faces.iter().zip(faces) {
        let from = original.mesh.faces[from.expect("a face of the file")];
        let became = from.map(|v| original.vertex_of[v]);
        assert!(face.iter().all(|v| became.contains(&Some(*v))));
    }
}

#[test]
fn merged_vertices_have_the_mean_of_their_values() {
    let text = String::from_utf8(ply("ascii", false)).unwrap();
    let text = text
        .replace("element vertex 4", "element vertex 5")
        .replace("\n3 0 2 1\n", "\n0 0 0 0 255 0 0 255 0 0 1.5 9\n3 4 2 1\n");
    let original = loaded("tetra.ply", text.as_bytes()).value.original;
    assert_eq!(original.vertex_of[0], original.vertex_of[4]);
    let at = original.vertex_of[0].expect("a vertex");
    assert_eq!(original.values("weight", 4).expect("weights")[at], 0.75);
}

#[test]
fn what_cannot_be_used_is_left_out_with_a_word() {
    let sound = OBJ.replace("/9", "/1");
    let obj = [
        (
            "1 0 0\n",
            "1 0 red\n",
            "a colour that is not a number: `red`",
        ),
        (
            "1 0 0\n",
            "1 0 nan\n",
            "a colour that is not a finite number",
        ),
        (
            "1 0 0\n",
            "1 0 300\n",
            "a colour that is 300, not from 0 to 1",
        ),
        ("1 0 0\n", "1 -0.5 0\n", "a colour that is -0.5"),
        (" 1 0 0\n", "\n", "4 of 5 vertices have a colour"),
        (
            "vt 1 1",
            "vt 1 inf",
            "a texture point has a coordinate that is not a finite number",
        ),
        (
            "vt 1 1",
            "vt x 1",
            "a texture point has a coordinate that is not a number",
        ),
        ("4/-1", "4/9", "texture points are not used"),
    ];
    for (from, to, words) in obj {
        assert!(sound.contains(from), "{from}");
        let read = loaded("odd.obj", sound.replacen(from, to, 1).as_bytes());
        assert!(
            said(&read).contains(words),
            "`{words}` wanted in: {}",
            said(&read)
        );
        let attributes = &read.value.original.attributes;
        match words.contains("texture") {
            true => assert!(attributes.uvs.is_none() && !attributes.colours.is_empty()),
            false => assert!(attributes.uvs.is_some() && attributes.colours.is_empty()),
        }
    }
    let mut nan = ply("binary_little_endian", false);
    let third = 1f64 / 3.0;
    let at = nan
        .windows(8)
        .position(|w| w == third.to_le_bytes())
        .expect("a weight");
    nan[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    let text = String::from_utf8(ply("ascii", true)).unwrap();
    let many: String = (0..60).map(|k| format!("property uchar p{k}\n")).collect();
    let widened = |line: &str| match line.split(' ').count() {
        12 => format!("{line}{}\n", " 0".repeat(60)),
        _ => format!("{line}\n"),
    };
    let wide = text.replace("element face", &format!("{many}element face"));
    let wide: String = wide.lines().map(widened).collect();
    let ply = [
        (
            nan,
            "`weight` is not used: 1 of its values are not finite numbers, the first at vertex 1",
        ),
        (
            text.replace("double weight", "double id").into_bytes(),
            "`id` is not used: its name stands there twice",
        ),
        (wide.into_bytes(), "`p59` is not used"),
        (
            text.replace("6 0 0 1 0 1 3", "5 0 0 1 0 1").into_bytes(),
            "some faces have other than two numbers a corner",
        ),
        (
            text.replace("uchar red", "float red")
                .replace("0 255 0 0 255", "0 -1 0 0 255")
                .into_bytes(),
            "`red` is not used: a colour is -1",
        ),
    ];
    for (bytes, words) in ply {
        let read = loaded("odd.ply", &bytes);
        assert!(
            said(&read).contains(words),
            "`{words}` wanted in: {}",
            said(&read)
        );
        assert_eq!(read.value.mesh.faces.len(), 4);
    }
}
