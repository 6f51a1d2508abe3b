//! Files as other programs write them: dialects that say the same, numbers that do not matter, parts that are no bodies. Each is read to
//! the right value, whatever words it comes in.

use crate::shapes::{ball, boxes};
use glam::DVec3;
use pillarforest::diag::{Diagnostic, Place, Warned};
use pillarforest::formats::{read_as_one, read_bodies, read_mesh};
use pillarforest::index::FaceId;
use pillarforest::intake::{inspect, load_model};
use pillarforest::mesh::TriMesh;
use std::fmt::Write as _;

/// A ball whose coordinates binary and text files hold alike.
fn shape() -> TriMesh {
    let mut mesh = ball(DVec3::new(1.0, -2.0, 3.0), 10.0, 8);
    mesh.vertices
        .iter_mut()
        .for_each(|v| *v = v.as_vec3().as_dvec3());
    mesh
}

fn messages(warnings: &[Diagnostic]) -> Vec<&str> {
    warnings.iter().map(|w| w.message.as_str()).collect()
}

/// The mesh of a file that is to be read without a word.
fn silent(name: &str, bytes: &[u8]) -> TriMesh {
    let read = load_model(name, bytes, true).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    assert!(
        read.warnings.is_empty(),
        "{name}: {:?}",
        messages(&read.warnings)
    );
    read.value
}

fn refused(name: &str, bytes: &[u8]) -> Diagnostic {
    match read_mesh(name, bytes) {
        Ok(_) => panic!("{name}: read"),
        Err(error) => error,
    }
}

fn line_of(error: &Diagnostic) -> usize {
    match &error.place {
        Some(Place::Line { line, .. }) => *line,
        other => panic!("no line: {other:?}"),
    }
}

/// A mesh as text STL: the words of every facet with a blank between them.
fn text_stl(mesh: &TriMesh) -> String {
    let mut text = "solid a part\n".to_owned();
    for face in FaceId::all(mesh.faces.len()) {
        text += "facet normal 0 0 0\nouter loop\n";
        for c in mesh.corners(face) {
            writeln!(text, "vertex {} {} {}", c.x, c.y, c.z).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid a part\n"
}

#[test]
fn text_stl_is_read_in_every_dialect() {
    let plain = text_stl(&shape());
    let wanted = silent("plain.stl", plain.as_bytes());
    assert_eq!(wanted.faces.len(), shape().faces.len());
    let facet = "facet normal 0 0 0\nouter loop";
    for (name, text) in [
        ("end loop", plain.replace("endloop", "end loop")),
        ("end facet", plain.replace("endfacet", "end\nfacet")),
        ("end solid", plain.replace("endsolid", "END solid")),
        ("doubled", {
            let (head, tail) = ("solid a part\n", "endsolid a part\n");
            format!("{head}{plain}{tail}")
        }),
        (
            "endsolid between",
            plain.replacen("endfacet\nfacet", "endfacet\nendsolid\nsolid\nfacet", 3),
        ),
        (
            "facet after endsolid",
            plain.replacen("endfacet\nfacet", "endfacet\nendsolid\nfacet", 1),
        ),
        ("a facet a line", {
            let lines = plain.replace('\n', " ").replace("endfacet ", "endfacet\n");
            lines.replacen("part ", "part\n", 1)
        }),
        ("one line", plain.replace('\n', " ")),
        (
            "a word a line",
            plain
                .replacen("a part", "part", 2)
                .replace(' ', "\n")
                .replacen("solid\npart", "solid part", 2),
        ),
        ("upper case", plain.to_uppercase()),
        (
            "normals that are none",
            plain.replace("normal 0 0 0", "normal -1.#IND nan 1,5"),
        ),
        ("no normals", plain.replace(" normal 0 0 0", "")),
        (
            "a facet in the name",
            plain.replace("a part", "my facet end loop"),
        ),
        ("no outer loop", plain.replace(facet, "facet normal 0 0 0")),
    ] {
        let read = silent("dialect.stl", text.as_bytes());
        assert_eq!(read, wanted, "{name}");
    }
}

#[test]
fn text_stl_is_wrong_with_its_line() {
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\n";
    let sound = format!("solid x\n{facet}{facet}endsolid x\n");
    for (found, put, line, words) in [
        ("vertex 9 0 0", "vertex 9 0", 5, "2 coordinates, 3 wanted"),
        (
            "vertex 9 0 0",
            "vertex 9 0 0 0",
            5,
            "4 coordinates, 3 wanted",
        ),
        ("vertex 9 0 0", "vertex 9 0 q", 5, "`q`"),
        ("vertex 9 0 0", "vertex 9 0 nan", 5, "not a finite number"),
        (
            "vertex 9 0 0\n",
            "",
            6,
            "`vertex` (three of them in a facet) wanted",
        ),
        (
            "endloop",
            "vertex 1 1 1",
            7,
            "`endloop` or `endfacet` wanted",
        ),
        (
            "endfacet\n",
            "",
            8,
            "`facet` found, `endloop` or `endfacet` wanted",
        ),
        (
            "endfacet\n",
            "endfacet\ncolour 3\n",
            9,
            "`colour` found, `facet` or `endsolid` wanted",
        ),
    ] {
        let error = refused("a.stl", sound.replacen(found, put, 1).as_bytes());
        assert!(error.message.contains(words), "{put}: {}", error.message);
        assert_eq!(line_of(&error), line, "{put}: {}", error.message);
    }
    for (end, words) in [
        ("endsolid x\n", "without `endsolid`"),
        ("endloop\nendfacet\nendsolid x\n", "inside of a facet"),
    ] {
        let error = refused("a.stl", sound.strip_suffix(end).unwrap().as_bytes());
        assert!(error.message.contains(words), "{}", error.message);
    }
}

/// A mesh as PLY, text or binary, with three more numbers a vertex; `stray` are vertices that no face uses, before all others.
fn ply(mesh: &TriMesh, names: [&str; 3], more: &str, stray: &[&str], binary: bool) -> Vec<u8> {
    let format = if binary {
        "binary_little_endian"
    } else {
        "ascii"
    };
    let properties = names.map(|n| format!("property float {n}\n")).concat();
    let count = stray.len() + mesh.vertices.len();
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\n{properties}\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.faces.len()
    )
    .into_bytes();
    let own = mesh
        .vertices
        .iter()
        .map(|v| format!("{} {} {}", v.x, v.y, v.z));
    for point in stray.iter().map(|s| (*s).to_owned()).chain(own) {
        let row = format!("{point} {more}");
        if binary {
            let number = |w: &str| w.parse::<f32>().unwrap_or(f32::NAN);
            row.split(' ')
                .for_each(|w| bytes.extend(number(w).to_le_bytes()));
        } else {
            bytes.extend(format!("{row}\n").bytes());
        }
    }
    for face in &mesh.faces {
        let corners = face.map(|v| v.0 + stray.len() as u32);
        if binary {
            bytes.push(3);
            corners.iter().for_each(|c| bytes.extend(c.to_le_bytes()));
        } else {
            let [a, b, c] = corners;
            bytes.extend(format!("3 {a} {b} {c}\n").bytes());
        }
    }
    bytes
}

#[test]
fn numbers_that_nothing_uses_do_not_matter() {
    let normals = ["nx", "ny", "nz"];
    let wanted = silent("a.ply", &ply(&shape(), normals, "0 0 1", &[], true));
    for binary in [false, true] {
        let name = if binary { "binary" } else { "text" };
        for none in ["nan nan nan", "-1.#IND 1.#QNAN -1.#INF", "-nan(ind) inf 0"] {
            let read = silent("a.ply", &ply(&shape(), normals, none, &[], binary));
            assert_eq!(read, wanted, "{name}, {none}");
            // Of properties that are kept it is told, once each.
            let file = ply(&shape(), ["quality", "b", "c"], none, &[], binary);
            let read = load_model("a.ply", &file, true).expect("a model");
            assert_eq!(read.value, wanted, "{name}, {none}");
            let told = messages(&read.warnings);
            assert!(told[0].contains("`quality` is not used"), "{told:?}");
        }
        // Vertices without a place.
        let file = ply(
            &shape(),
            normals,
            "0 0 1",
            &["nan nan nan", "0 inf 0", "0 0 1e30"],
            binary,
        );
        let read = load_model("a.ply", &file, true).expect("a model");
        assert_eq!(read.value, wanted, "{name}");
        let told = messages(&read.warnings);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(
            told[0].starts_with("left out 3 vertices that no face uses"),
            "{told:?}"
        );
        let found = inspect("a.ply", &file).expect("a model").value;
        assert!(found.printable(), "{found}");
        // One that a face uses is an error at its place.
        let mut used = shape();
        used.vertices[5].y = f64::NAN;
        let error = refused("a.ply", &ply(&used, normals, "0 0 1", &[], binary));
        assert_eq!(
            error.message,
            "vertex 5: a coordinate that is not a finite number"
        );
        match (&error.place, binary) {
            (Some(Place::Line { line, .. }), false) => assert_eq!(*line, 12 + 6),
            (Some(Place::Byte { .. }), true) => {}
            other => panic!("{other:?}"),
        }
    }
    // A word that is no number at all is no hole of a scanner.
    let error = refused("a.ply", &ply(&shape(), normals, "0 abc 1", &[], false));
    assert!(error.message.contains("`abc`"), "{}", error.message);
}

fn obj(mesh: &TriMesh) -> String {
    String::from_utf8(crate::shapes::obj(mesh)).unwrap()
}

#[test]
fn obj_vertices_without_a_place_go_if_no_face_uses_them() {
    let wanted = silent("a.obj", obj(&shape()).as_bytes());
    let behind = format!("{}v nan nan nan\nv 0 -inf 0\n", obj(&shape()));
    let read = load_model("a.obj", behind.as_bytes(), true).expect("a model");
    assert_eq!(read.value, wanted);
    let told = messages(&read.warnings);
    assert!(
        told.len() == 1 && told[0].starts_with("left out 2 vertices"),
        "{told:?}"
    );
    // Colours stay with their vertices.
    let text = "v 0 0 0 1 0 0\nv nan 0 0\nv 9 0 0 0 1 0\nv 0 9 0 0 0 1\nf 1 3 -1\n";
    let read = read_as_one("a.obj", text.as_bytes()).expect("a mesh").value;
    assert_eq!(read.mesh.vertices.len(), 3);
    let red_green_blue = [
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [0.0, 0.0, 1.0, 1.0],
    ];
    assert_eq!(read.attributes.colours, red_green_blue);
    // A face that uses one, by a relative number or before the vertex is there.
    for face in [["", "f 1 -3 -1\n"], ["f 1 2 4\n", ""]] {
        let text = format!(
            "{}v 0 0 0\nv nan 0 0\nv 9 0 0\nv 0 9 0\n{}",
            face[0], face[1]
        );
        let error = refused("a.obj", text.as_bytes());
        assert_eq!(
            error.message,
            "vertex 2 has a coordinate that is not a finite number"
        );
        assert_eq!(line_of(&error), if face[0].is_empty() { 2 } else { 3 });
    }
}

#[test]
fn only_lines_of_numbers_go_on_behind_a_backslash() {
    let wanted = silent("a.obj", obj(&shape()).as_bytes());
    let (vertices, faces) = {
        let text = obj(&shape());
        let at = text.find("f ").unwrap();
        (text[..at].to_owned(), text[at..].to_owned())
    };
    for name in ["o", "g", "usemtl", "mtllib", "s", "shadow_obj"] {
        let text = format!("{vertices}{name} C:\\models\\\n{faces}");
        assert_eq!(silent("a.obj", text.as_bytes()), wanted, "{name}");
    }
    let text = format!(
        "g x\\\n{}{}",
        vertices.replace("v ", "v\\\n "),
        faces.replace(' ', " \\\n")
    );
    assert_eq!(silent("a.obj", text.as_bytes()), wanted, "continued");
}

/// The mesh as OFF; every row of a vertex and of a face ends in one of these.
fn off(head: &str, mesh: &TriMesh, [vertex, face]: [&str; 2]) -> String {
    let mut text = head.to_owned();
    for v in &mesh.vertices {
        writeln!(text, "{} {} {}{vertex}", v.x, v.y, v.z).unwrap();
    }
    for f in &mesh.faces {
        let [a, b, c] = f.map(|v| v.0);
        writeln!(text, "3 {a} {b} {c}{face}").unwrap();
    }
    text
}

#[test]
fn off_is_read_in_every_form() {
    let mesh = shape();
    let wanted = silent("a.obj", obj(&mesh).as_bytes());
    let counts = format!("{} {}", mesh.vertices.len(), mesh.faces.len());
    for (head, ends) in [
        (format!("OFF\n{counts} 0\n"), ["", ""]),
        (
            format!("# made by hand\n\nOFF {counts} 0 # so many\n"),
            [" # a point", ""],
        ),
        (format!("OFF\r\n{counts}\r\n"), ["\r", "\r"]),
        (
            format!("COFF\n{counts} 0\n"),
            [" 255 0 0 255", " 0.1 0.2 0.3"],
        ),
        (format!("NOFF\n{counts} 0\n"), [" 0 0 1", ""]),
        (
            format!("STCNOFF\n{counts} 0\n"),
            [" 0 0 1 1 0 0 1 0.5 0.5", " 7"],
        ),
    ] {
        let text = off(&head, &mesh, ends);
        assert_eq!(silent("a.off", text.as_bytes()), wanted, "{head}");
    }
    let coloured = off(&format!("COFF\n{counts} 0\n"), &mesh, [" 255 0 51 255", ""]);
    let read = read_as_one("a.off", coloured.as_bytes())
        .expect("a mesh")
        .value;
    assert_eq!(read.attributes.colours[3], [1.0, 0.0, 0.2, 1.0]);
    // A concave polygon.
    let arrow = "OFF\n4 1 0\n0 0 0\n4 -2 0\n1 0 0\n4 2 0\n4 0 1 2 3\n";
    let area = read_mesh("a.off", arrow.as_bytes())
        .expect("a mesh")
        .value
        .area();
    assert!((area - 2.0).abs() < 1e-12, "{area}");
    let stray = arrow
        .replace("4 1 0", "5 1 0")
        .replace("\n4 0 1", "\nnan nan nan\n4 0 1");
    let read = read_mesh("a.off", stray.as_bytes()).expect("a mesh");
    assert_eq!(read.value.vertices.len(), 4);
    assert!(read.warnings[0].message.starts_with("left out 1 vertex"));
}

#[test]
fn off_is_wrong_with_its_line() {
    let sound = "OFF\n4 2 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 1 2\n3 0 2 3\n";
    for (found, put, line, words) in [
        ("OFF", "OF", 1, "its first word is `OF`"),
        ("OFF", "OFF BINARY", 1, "a binary OFF file"),
        ("OFF", "4OFF", 1, "other than three coordinates"),
        ("4 2 0", "4", 2, "the numbers of vertices and faces wanted"),
        (
            "4 2 0",
            "-4 2 0",
            2,
            "the numbers of vertices and faces wanted",
        ),
        ("4 2 0", "99999999999999 2 0", 8, "ends before vertex 6"),
        ("4 2 0", "4 18446744073709551615 0", 8, "ends before face 2"),
        ("4 0 0", "4 0", 4, "vertex 1 has 2 coordinates"),
        ("4 0 0", "4 0,5 0", 4, "decimals are written with a point"),
        (
            "4 0 0",
            "4 nan 0",
            4,
            "vertex 1 has a coordinate that is not a finite number",
        ),
        ("3 0 2 3", "3 0 2", 8, "face 1 has 2 of the 3 corners"),
        (
            "3 0 2 3",
            "3 0 2 4",
            8,
            "face 1 uses vertex 4, but the file has 4",
        ),
        ("3 0 2 3", "2 0 2 3", 8, "face 1 has 2 corners"),
        (
            "3 0 2 3",
            "4294967295 0 2 3",
            8,
            "face 1 has 3 of the 4294967295 corners",
        ),
        ("3 0 2 3", "3 0 2 x", 8, "`x`"),
    ] {
        let error = refused("a.off", sound.replacen(found, put, 1).as_bytes());
        assert!(error.message.contains(words), "{put}: {}", error.message);
        assert_eq!(line_of(&error), line, "{put}: {}", error.message);
    }
    let Warned { warnings, .. } =
        read_mesh("a.off", format!("{sound}9 9\n9\n").as_bytes()).unwrap();
    assert_eq!(
        messages(&warnings),
        ["ignored 2 lines after the last declared face"]
    );
}

#[test]
fn what_cannot_be_read_says_what_to_do() {
    for (name, bytes, words, help) in [
        (
            "a.glb",
            b"glTF\x02\0\0\0".as_slice(),
            "a binary glTF model (GLB); OBJ, STL",
            "in Blender: File, Import",
        ),
        (
            "a.gltf",
            b"{\"asset\": {\"version\": \"2.0\"}}",
            "a glTF model",
            "Wavefront (.obj)",
        ),
        (
            "a.stl",
            b"glTF\x02\0\0\0",
            "the extension says STL, but the content is a binary glTF",
            "in Blender",
        ),
        (
            "a.fbx",
            b"; FBX 7.7 project file",
            "a model of that format cannot be read",
            "in Blender",
        ),
        (
            "a.step",
            b"ISO-10303-21;\nHEADER;",
            "a STEP drawing",
            "in FreeCAD",
        ),
        (
            "a.STP",
            b"junk",
            "a drawing of that format cannot be read; OBJ, STL",
            "in FreeCAD",
        ),
        (
            "a.jpg",
            b"\xFF\xD8\xFF\xE0",
            "a JPEG picture",
            "Wave(heights: Image(",
        ),
        (
            "a.obj",
            b"OFF\n4 2 0\n",
            "the extension says OBJ, but the content is OFF",
            "name it .off",
        ),
        (
            "a.obj",
            b"COFF 4 2 0\n",
            "the content is OFF",
            "name it .off",
        ),
        (
            "a.off",
            b"ply\nformat",
            "the content is PLY",
            "name it .ply",
        ),
        ("a.stl", b"\x1F\x8B\x08", "gzip-compressed", "unpack it"),
    ] {
        let error = refused(name, bytes);
        assert!(error.message.contains(words), "{name}: {}", error.message);
        assert!(
            error.help.iter().any(|h| h.contains(help)),
            "{name}: {:?}",
            error.help
        );
    }
}

const NAMESPACE: &str = "http://schemas.microsoft.com/3dmanufacturing";

/// The triangles of meshes as one 3MF mesh.
fn xml(meshes: &[&TriMesh]) -> String {
    let mut all = TriMesh::default();
    meshes.iter().for_each(|m| all.append(m));
    let mut text = "<mesh><vertices>".to_owned();
    for v in &all.vertices {
        write!(text, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", v.x, v.y, v.z).unwrap();
    }
    text += "</vertices><triangles>";
    for f in &all.faces {
        let [a, b, c] = f.map(|v| v.0);
        write!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>").unwrap();
    }
    text + "</triangles></mesh>"
}

fn package(model: &str, more: &[(&str, &str)]) -> Vec<u8> {
    let more = more.iter().map(|(name, text)| (*name, text.as_bytes()));
    let entries: Vec<(&str, &[u8])> = [("3D/3dmodel.model", model.as_bytes())]
        .into_iter()
        .chain(more)
        .collect();
    crate::hostile::zipped(&entries)
}

fn model(resources: &str, items: &[u32]) -> String {
    let items = items.iter().map(|id| format!("<item objectid=\"{id}\"/>"));
    format!(
        "<model unit=\"millimeter\"><resources>{resources}</resources><build>{}</build></model>",
        items.collect::<String>()
    )
}

#[test]
fn parts_of_slicer_projects_that_are_no_bodies_are_left_out() {
    let cube = boxes(&[(DVec3::ZERO, DVec3::splat(30.0))]);
    let pocket = boxes(&[(DVec3::new(5.0, 5.0, 10.0), DVec3::new(25.0, 25.0, 40.0))]);
    let both = format!("<object id=\"1\">{}</object>", xml(&[&cube, &pocket]));
    let volume = |last: [usize; 2], meta: &str| {
        format!(
            "<volume firstid=\"{}\" lastid=\"{}\">{meta}</volume>",
            last[0], last[1]
        )
    };
    let meta = |key: &str, value: &str| {
        format!("<metadata type=\"volume\" key=\"{key}\" value=\"{value}\"/>")
    };
    for (role, told) in [
        (meta("volume_type", "NegativeVolume"), "cuts away"),
        (meta("volume_type", "ParameterModifier"), "changes settings"),
        (meta("modifier", "1"), "changes settings"),
        (meta("volume_type", "SupportBlocker"), "steers supports"),
    ] {
        let config = format!(
            "<config><object id=\"1\">{}{}</object></config>",
            volume([0, 11], &meta("volume_type", "ModelPart")),
            volume([12, 23], &(meta("name", "pocket") + &role))
        );
        let file = package(
            &model(&both, &[1]),
            &[("Metadata/Slic3r_PE_model.config", &config)],
        );
        let found = inspect("a.3mf", &file).expect("bodies");
        assert_eq!(found.value.bodies[0].volume_mm3, Some(27_000.0), "{told}");
        assert!(found.value.printable());
        let wanted = format!("left out what is no body: `pocket` ({told})");
        assert_eq!(messages(&found.warnings), [wanted]);
        assert_eq!(found.warnings[0].help.is_empty(), told != "cuts away");
    }
    // Components, as the other family writes them; the same object elsewhere is a body.
    let parts = format!(
        "<object id=\"1\">{}</object><object id=\"2\">{}</object>\
         <object id=\"3\"><components><component objectid=\"1\"/><component objectid=\"2\"/></components></object>",
        xml(&[&cube]),
        xml(&[&pocket])
    );
    for role in ["negative_part", "modifier_part", "support_enforcer"] {
        let config = format!(
            "<config><object id=\"3\"><part id=\"1\" subtype=\"normal_part\"/><part id=\"2\" subtype=\"{role}\">\
             <metadata key=\"name\" value=\"pocket\"/></part></object></config>"
        );
        let file = package(
            &model(&parts, &[3, 2]),
            &[("Metadata/model_settings.config", &config)],
        );
        let found = read_bodies("a.3mf", &file).expect("bodies");
        let volumes: Vec<f64> = found.value.iter().map(|b| b.mesh.volume()).collect();
        assert_eq!(volumes, [27_000.0, 12_000.0], "{role}");
        assert!(found.warnings[0].message.contains("`pocket`"), "{role}");
    }
    // What the standard itself calls no body.
    for kind in ["other", "support", "solidsupport"] {
        let typed = parts.replace(
            "<object id=\"2\">",
            &format!("<object id=\"2\" name=\"p\" type=\"{kind}\">"),
        );
        let found = read_bodies("a.3mf", &package(&model(&typed, &[3]), &[])).expect("bodies");
        assert_eq!(found.value.len(), 1);
        let wanted = format!("left out what is no body: `p` (type {kind})");
        assert_eq!(messages(&found.warnings), [wanted]);
        let error = refused("a.3mf", &package(&model(&typed, &[2]), &[]));
        assert!(
            error.message.contains("no triangles of bodies: left out"),
            "{}",
            error.message
        );
    }
    let odd = parts.replace("<object id=\"2\">", "<object id=\"2\" type=\"ghost\">");
    let error = refused("a.3mf", &package(&model(&odd, &[3]), &[]));
    assert!(
        error.message.contains("unknown type `ghost`"),
        "{}",
        error.message
    );
    // Numbers beyond the object are no reason to fail, broken notes are told.
    let config = "<config><object id=\"1\"><volume firstid=\"7\" lastid=\"99999999999\"><metadata key=\"volume_type\" value=\"NegativeVolume\"/>";
    for (text, count) in [(config, 0), ("<config></wrong>", 1)] {
        let file = package(
            &model(&parts, &[1]),
            &[("Metadata/Slic3r_PE_model.config", text)],
        );
        let found = read_bodies("a.3mf", &file).expect("bodies");
        assert_eq!(
            found.warnings.len(),
            count,
            "{:?}",
            messages(&found.warnings)
        );
    }
}

#[test]
fn packages_that_cannot_be_read_whole_say_so() {
    let cube = xml(&[&boxes(&[(DVec3::ZERO, DVec3::splat(30.0))])]);
    let sound = model(&format!("<object id=\"1\">{cube}</object>"), &[1]);
    let needs = |namespace: &str| {
        sound.replace(
            "<model ",
            &format!("<model xmlns:q=\"{NAMESPACE}/{namespace}\" requiredextensions=\"q\" "),
        )
    };
    for (text, words) in [
        (
            needs("beamlattice/2017/02"),
            "needs the beam lattice extension of 3MF, which is not read",
        ),
        (needs("secret/2030/01"), "needs the extension `q`"),
        (
            sound.replace("<model ", "<model requiredextensions=\"z\" "),
            "needs the extension `z`",
        ),
        (format!("{sound}{sound}"), "a second `model` in one part"),
        (
            format!("<models>{sound}</models>"),
            "the outermost element is `models`, `model` wanted",
        ),
        (
            sound.replace(
                "</resources>",
                &format!("<object id=\"1\">{cube}</object></resources>"),
            ),
            "two objects have the id 1",
        ),
    ] {
        let error = refused("a.3mf", &package(&text, &[]));
        assert!(error.message.contains(words), "{words}: {}", error.message);
        assert!(error.place.is_some());
    }
    silent("a.3mf", &package(&needs("production/2015/06"), &[]));
    // The relations of the package.
    let relation = |target: &str, mode: &str| {
        format!("<Relationship Type=\"{NAMESPACE}/2013/01/3dmodel\" Target=\"{target}\" {mode}/>")
    };
    for (relations, words) in [
        (
            relation("/3D/gone.model", ""),
            "names `/3D/gone.model` as its model, but does not hold it",
        ),
        (
            relation(
                "https://example.org/3dmodel.model",
                "TargetMode=\"External\"",
            ),
            "lies outside of the archive",
        ),
        (
            relation("/3D/3dmodel.model", "") + &relation("/3D/b.model", ""),
            "names several parts as its model",
        ),
    ] {
        let rels = format!("<Relationships>{relations}</Relationships>");
        let error = refused("a.3mf", &package(&sound, &[("_rels/.rels", &rels)]));
        assert!(error.message.contains(words), "{words}: {}", error.message);
    }
    // Beams beside triangles.
    // Properties that are there are no matter; those that are not make one warning.
    for (group, pid, told) in [
        (
            "<basematerials id=\"7\"><base name=\"red\" displaycolor=\"#FF0000\"/></basematerials>",
            7,
            0,
        ),
        (
            "<m:colorgroup id=\"7\"><m:color color=\"#FF0000\"/></m:colorgroup>",
            7,
            0,
        ),
        ("<basematerials id=\"7\"/>", 8, 1),
        ("", 8, 1),
    ] {
        for bearer in ["<object ", "<triangle "] {
            let text = sound.replace(bearer, &format!("{bearer}pid=\"{pid}\" pindex=\"0\" "));
            let text = text.replace("<resources>", &format!("<resources>{group}"));
            let found = read_bodies("a.3mf", &package(&text, &[])).expect("bodies");
            assert_eq!(found.value.len(), 1);
            let words = "object 1 names the properties 8 (`pid`), which the file does not have";
            let warned = found.warnings.iter().filter(|w| w.message.contains(words));
            assert_eq!(
                (warned.count(), found.warnings.len()),
                (told, told),
                "{text}"
            );
        }
    }
    let beams = sound.replace(
        "</mesh>",
        "<b:beamlattice><b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams></b:beamlattice></mesh>",
    );
    let found = read_bodies("a.3mf", &package(&beams, &[])).expect("bodies");
    assert_eq!(
        messages(&found.warnings),
        ["the beams of a lattice are not read: only triangles are"]
    );
}
