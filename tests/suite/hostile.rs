//! Bad and odd mesh files: none may panic, hang or pass in silence.

use crate::shapes::CUBE_FACES;
use pillarforest::diag::{Diagnostic, Place, Warned};
use pillarforest::intake::{inspect, load_model};
use pillarforest::mesh::TriMesh;
use std::fmt::Write as _;
use std::path::Path;

/// What a reader is to make of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Class {
    Ok,
    Warn,
    Error,
}

fn class_of(result: &Result<Warned<TriMesh>, Diagnostic>) -> Class {
    match result {
        Ok(read) if read.warnings.is_empty() => Class::Ok,
        Ok(_) => Class::Warn,
        Err(_) => Class::Error,
    }
}

/// The messages of a result, one a line.
fn said(result: &Result<Warned<TriMesh>, Diagnostic>) -> String {
    let messages: Vec<String> = match result {
        Ok(read) => read.warnings.iter().map(|w| w.message.clone()).collect(),
        Err(error) => vec![format!("{} {:?}", error.message, error.place)],
    };
    messages.join("\n    ")
}

fn expect(name: &str, bytes: &[u8], class: Class, words: &str) {
    let result = load_model(name, bytes, true);
    assert_eq!(class_of(&result), class, "{name}: {}", said(&result));
    assert!(
        said(&result).contains(words),
        "{name}: `{words}` wanted in: {}",
        said(&result)
    );
    if let Err(error) = &result {
        assert!(error.place.is_some(), "{name}: an error without a place");
    }
    // The same bytes must not hurt the other entrance either.
    assert_eq!(
        inspect(name, bytes).is_err(),
        matches!(&result, Err(e) if !from_gate(e)),
        "{name}"
    );
}

/// Errors of the check of the whole model come after reading.
fn from_gate(error: &Diagnostic) -> bool {
    ["no extent", "no thickness", "degenerate"]
        .iter()
        .any(|w| error.message.contains(w))
}

const CUBE_VERTICES: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [20.0, 0.0, 0.0],
    [0.0, 20.0, 0.0],
    [20.0, 20.0, 0.0],
    [0.0, 0.0, 20.0],
    [20.0, 0.0, 20.0],
    [0.0, 20.0, 20.0],
    [20.0, 20.0, 20.0],
];

/// A 20 mm cube with other coordinates in place of the first vertex's.
fn cube_obj(first_vertex: &str) -> String {
    let mut text = format!("v {first_vertex}\n");
    for [x, y, z] in &CUBE_VERTICES[1..] {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [a, b, c] in CUBE_FACES {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    text
}

fn cube_stl(declared: u32) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(declared.to_le_bytes());
    for face in CUBE_FACES {
        bytes.extend([0; 12]);
        for v in face {
            for x in CUBE_VERTICES[v as usize] {
                bytes.extend((x as f32).to_le_bytes());
            }
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn cube_ply(header_vertices: &str, list: &str) -> String {
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {header_vertices}\nproperty float x\nproperty float y\nproperty double z\n\
         element face 12\nproperty list {list} vertex_indices\nend_header\n"
    );
    for [x, y, z] in CUBE_VERTICES {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    for [a, b, c] in CUBE_FACES {
        writeln!(text, "3 {a} {b} {c}").unwrap();
    }
    text
}

#[test]
fn cubes_load_in_every_form() {
    let cube = cube_obj("0 0 0");
    for (name, bytes) in [
        ("cube.obj", cube.clone().into_bytes()),
        (
            "crlf.obj",
            format!("\u{FEFF}{}", cube.replace('\n', "\r\n")).into_bytes(),
        ),
        ("old-mac.obj", cube.replace('\n', "\r").into_bytes()),
        (
            "continued.obj",
            cube.replace("v 20 0 0", "v 20 \\\n0 0").into_bytes(),
        ),
        (
            "latin1.obj",
            [b"# gr\xFC\xDFe\n".as_slice(), cube.as_bytes()].concat(),
        ),
        (
            "grouped.OBJ",
            format!("mtllib none.mtl\no a&b<\ng x\nusemtl y\n{cube}").into_bytes(),
        ),
        ("cube.stl", cube_stl(12)),
        (
            "solid.stl",
            [b"solid x".as_slice(), &cube_stl(12)[7..]].concat(),
        ),
        ("cube.ply", cube_ply("8", "uchar int").into_bytes()),
        ("uint.ply", cube_ply("8", "uint uint16").into_bytes()),
    ] {
        expect(name, &bytes, Class::Ok, "");
        let report = inspect(name, &bytes).unwrap().value;
        assert!(report.printable(), "{name}: {report}");
        assert_eq!(report.bodies[0].volume_mm3, Some(8000.0), "{name}");
        assert_eq!(
            (report.bodies[0].vertices, report.bodies[0].triangles),
            (8, 12),
            "{name}"
        );
    }
}

#[test]
fn coordinates_that_are_no_numbers() {
    for (first, words) in [
        (
            "nan 0 0",
            "vertex 1 has a coordinate that is not a finite number",
        ),
        ("0 -inf 0", "not a finite number"),
        ("1e999 0 0", "not a finite number"),
        ("1e30 0 0", "too large"),
        ("0x10 0 0", "`0x10`"),
        ("1.2.3 0 0", "`1.2.3`"),
        ("0,5 0 0", "decimals are written with a point"),
        ("1.#IND 0 0", "not a number"),
        ("0 0", "2 coordinates"),
    ] {
        expect("bad.obj", cube_obj(first).as_bytes(), Class::Error, words);
    }
    let mut stl = cube_stl(12);
    stl[84 + 12..84 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    expect("nan.stl", &stl, Class::Error, "triangle 1 has a coordinate");
}

#[test]
fn indices_that_name_no_vertex() {
    let cube = cube_obj("0 0 0");
    for (face, words) in [
        ("f 1 2 9", "vertex 9, but the file has 8"),
        ("f 0 1 2", "counts from 1"),
        ("f -9 1 2", "relative vertex index -9"),
        ("f 1 2 4294967297", "more than 4294967294"),
        ("f 1 2 99999999999999999999", "not a whole number"),
        ("f 1 2.5 3", "not a whole number"),
        ("f 1 2", "2 corners"),
        ("f 1/1/1/1 2 3", "too many slashes"),
    ] {
        let text = format!("{cube}{face}\n");
        expect("index.obj", text.as_bytes(), Class::Error, words);
        let Err(error) = load_model("index.obj", text.as_bytes(), true) else {
            unreachable!()
        };
        assert!(
            matches!(error.place, Some(Place::Line { line: 21, .. })),
            "{face}: {:?}",
            error.place
        );
    }
    expect(
        "vt.obj",
        cube.replace("f 1 3 4", "f 1/7 3/8 4/9").as_bytes(),
        Class::Warn,
        "texture point 9",
    );
    let late = format!("f 1 2 3\n{cube}");
    expect("faces-first.obj", late.as_bytes(), Class::Warn, "");
}

#[test]
fn counts_that_lie() {
    for declared in [0, 6, 13, 0x051e_b852, 0x8000_0000, u32::MAX] {
        expect(
            "count.stl",
            &cube_stl(declared),
            Class::Error,
            "the file holds 12",
        );
    }
    let tailed = [cube_stl(12).as_slice(), b"tail"].concat();
    expect("tail.stl", &tailed, Class::Warn, "ignored 4 bytes");
    for vertices in [
        "9",
        "4294967295",
        "184467440737095516160",
        "-1",
        "1e3",
        "0x10",
    ] {
        expect(
            "count.ply",
            cube_ply(vertices, "uchar int").as_bytes(),
            Class::Error,
            "",
        );
    }
    expect(
        "float-list.ply",
        cube_ply("8", "float int").as_bytes(),
        Class::Error,
        "length is not a whole number",
    );
    expect(
        "type.ply",
        cube_ply("8", "uchar quux").as_bytes(),
        Class::Error,
        "unknown property type `quux`",
    );
    let endless = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n";
    expect("endless.ply", endless.as_bytes(), Class::Error, "no faces");
    let wide = format!(
        "ply\nformat ascii 1.0\nelement vertex 1\n{}end_header\n",
        "property float x\n".repeat(20_000)
    );
    expect(
        "wide.ply",
        wide.as_bytes(),
        Class::Error,
        "header has more than",
    );
}

#[test]
fn cut_files_and_wrong_types() {
    let stl = cube_stl(12);
    for length in [1, 79, 83, 84, 400, 683] {
        expect("cut.stl", &stl[..length], Class::Error, "");
    }
    let text = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
    expect(
        "cut-text.stl",
        text.as_bytes(),
        Class::Error,
        "ends inside of a facet",
    );
    for (name, bytes, words) in [
        ("a.obj", b"".as_slice(), "empty"),
        ("a.xyz", b"0 0 0".as_slice(), "unknown extension"),
        ("a.off", b"OFF", "cut short"),
        ("a.stl", b"<!DOCTYPE html><html>404</html>", "HTML"),
        (
            "a.stl",
            b"version https://git-lfs.github.com/spec/v1\n",
            "git-lfs pointer",
        ),
        ("a.stl", b"\x89PNG\r\n\x1a\n", "PNG"),
        ("a.obj", b"PK\x03\x04", "zip archive"),
        ("a.obj", b"\xFF\xFEv\0 \0", "UTF-16"),
        ("a.obj", b"v 0 0 0\n\0v 1 0 0\n", "zero byte"),
        ("a.obj", b"# nothing\n", "no vertices and no faces"),
        ("a.obj", b"v 0 0 0\n", "1 vertices but no faces"),
        ("a.3mf", b"PK\x05\x06", "zip"),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 8\n",
            "end_header",
        ),
    ] {
        expect(name, bytes, Class::Error, words);
    }
}

#[test]
fn sizes_that_cannot_be_meant() {
    let scaled = |scale: f64, shift: f64| {
        let mut text = String::new();
        for p in CUBE_VERTICES {
            let [x, y, z] = p.map(|c| c * scale + shift);
            writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
        }
        text + &cube_obj("0 0 0")
            .lines()
            .filter(|l| l.starts_with('f'))
            .collect::<Vec<_>>()
            .join("\n")
    };
    for (scale, shift, class, words) in [
        (0.0, 1.0, Class::Error, "no extent"),
        (1e-309, 0.0, Class::Error, "no extent"),
        (1e-6, 0.0, Class::Warn, "which unit"),
        (1e-3, 0.0, Class::Warn, "metres? That would be 20.0 mm"),
        (
            1.0 / 25.4,
            0.0,
            Class::Warn,
            "inches? That would be 20.0 mm",
        ),
        (1.0, 1e7, Class::Warn, "from the origin"),
        (1e12, 0.0, Class::Warn, "which unit"),
    ] {
        expect("size.obj", scaled(scale, shift).as_bytes(), class, words);
    }
    // A model that is fitted to a size anyway is not asked for its unit.
    let fitted = load_model("size.obj", scaled(1e-3, 0.0).as_bytes(), false);
    assert_eq!(class_of(&fitted), Class::Ok);
    let flat = cube_obj("0 0 0").replace(" 20\n", " 0\n");
    expect("flat.obj", flat.as_bytes(), Class::Error, "no thickness");
}

#[test]
fn three_mf_attacks() {
    let model = |body: &str| {
        zipped(&[(
            "3D/3dmodel.model",
            format!("<?xml version=\"1.0\"?>{body}").as_bytes(),
        )])
    };
    let tetra = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"9\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"9\" z=\"0\"/>\
                 <vertex x=\"0\" y=\"0\" z=\"9\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/>\
                 <triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/></triangles></mesh>";
    let sound = format!(
        "<model unit=\"centimeter\"><resources><object id=\"1\" name=\"a &amp; b\">{tetra}</object></resources>\
         <build><item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 20 0 0\"/></build></model>"
    );
    expect("two.3mf", &model(&sound), Class::Ok, "");
    let report = inspect("two.3mf", &model(&sound)).unwrap().value;
    assert_eq!(report.bodies.len(), 2);
    assert_eq!(
        (report.bodies[0].name.as_str(), report.bodies[0].size_mm),
        ("a & b", [90.0; 3])
    );
    assert_eq!(report.bodies[1].min_mm, [200.0, 0.0, 0.0]);
    assert_eq!(report.together.unwrap().parts, 2);

    let cycle = "<model><resources><object id=\"1\"><components><component objectid=\"1\"/></components></object></resources>\
                 <build><item objectid=\"1\"/></build></model>";
    expect("cycle.3mf", &model(cycle), Class::Error, "cycle");
    let mut bomb = format!("<model><resources><object id=\"0\">{tetra}</object>");
    for level in 1..12 {
        let children = format!("<component objectid=\"{}\"/>", level - 1).repeat(10);
        write!(
            bomb,
            "<object id=\"{level}\"><components>{children}</components></object>"
        )
        .unwrap();
    }
    bomb += "</resources><build><item objectid=\"11\"/></build></model>";
    expect("bomb.3mf", &model(&bomb), Class::Error, "multiply");
    expect(
        "hollow-bomb.3mf",
        &model(&bomb.replace(tetra, "")),
        Class::Error,
        "multiply",
    );
    expect(
        "range.3mf",
        &model(&sound.replace("v3=\"2\"", "v3=\"4\"")),
        Class::Error,
        "vertex 4",
    );
    expect(
        "nan.3mf",
        &model(&sound.replace("x=\"9\"", "x=\"nan\"")),
        Class::Error,
        "not a finite number",
    );
    expect(
        "cut.3mf",
        &model(&sound[..sound.len() - 8]),
        Class::Error,
        "too early",
    );
    expect(
        "dtd.3mf",
        &model(&format!("<!DOCTYPE x [<!ENTITY a \"b\">]>{sound}")),
        Class::Error,
        "document type",
    );
    expect(
        "none.3mf",
        &zipped(&[("readme.txt", b"x")]),
        Class::Error,
        "no model part",
    );
    expect(
        "slip.3mf",
        &zipped(&[("../x.model", b"x")]),
        Class::Error,
        "points out of it",
    );
    let spaces = sound.replace("<build>", &format!("{}<build>", " ".repeat(3_000_000)));
    expect("inflate.3mf", &model(&spaces), Class::Error, "zip bomb");
}

pub(crate) fn zipped(entries: &[(&str, &[u8])]) -> Vec<u8> {
    use std::io::Write as _;
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        archive
            .start_file(*name, zip::write::SimpleFileOptions::default())
            .unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

#[test]
fn polygons_of_every_shape() {
    let comb = |teeth: usize, cover: bool| {
        let mut text = String::new();
        let mut corners = 0;
        for k in 0..teeth {
            writeln!(
                text,
                "v {} 0 0\nv {} 9 {}",
                2 * k,
                2 * k + 1,
                if cover { 0 } else { k % 3 }
            )
            .unwrap();
            corners += 2;
        }
        writeln!(text, "v {} 20 0\nv 0 20 0", 2 * teeth).unwrap();
        let list: Vec<String> = (1..=corners + 2).map(|k| k.to_string()).collect();
        text + "f " + &list.join(" ") + "\n"
    };
    for teeth in [2, 7, 500] {
        let text = comb(teeth, true);
        let mesh = load_model("comb.obj", text.as_bytes(), false)
            .unwrap()
            .value;
        assert_eq!(mesh.faces.len(), 2 * teeth);
        // The outline's area by the shoelace formula: no triangle lies outside or twice.
        let outline: Vec<[f64; 2]> = text
            .lines()
            .filter(|l| l.starts_with('v'))
            .map(|l| {
                let w: Vec<f64> = l[2..].split(' ').map(|x| x.parse().unwrap()).collect();
                [w[0], w[1]]
            })
            .collect();
        let area: f64 = (0..outline.len())
            .map(|k| {
                let (p, q) = (outline[k], outline[(k + 1) % outline.len()]);
                (p[0] * q[1] - q[0] * p[1]) / 2.0
            })
            .sum();
        assert!(
            (mesh.area() - area.abs()).abs() < 1e-9 * area.abs(),
            "{teeth} teeth: {} and {area}",
            mesh.area()
        );
    }
    expect(
        "bent.obj",
        comb(40, false).as_bytes(),
        Class::Warn,
        "open edges",
    );
}

#[test]
fn polygons_with_thousands_of_corners_keep_their_area() {
    // A gear: every other corner is reflex, 50,000 of them.
    let corners = 100_000u32;
    let at = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(corners)).sin_cos();
        let radius = if k.is_multiple_of(2) { 20.0 } else { 12.0 };
        [radius * cos, radius * sin]
    };
    let mut text = String::new();
    for k in 0..corners {
        let [x, y] = at(k);
        writeln!(text, "v {x} {y} 0").unwrap();
    }
    let list: Vec<String> = (1..=corners).map(|k| k.to_string()).collect();
    text += &format!("f {}\n", list.join(" "));
    let turn = std::f64::consts::TAU / f64::from(corners);
    let area = f64::from(corners) * 20.0 * 12.0 * turn.sin() / 2.0;
    let mesh = load_model("gear.obj", text.as_bytes(), false)
        .expect("a model")
        .value;
    let ratio = mesh.area() / area;
    assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
}

#[test]
fn names_play_no_tricks_on_a_terminal() {
    let evil = "a\u{1b}]0;t\u{7}\u{202e}b&#10;all fine: printable";
    let model = format!(
        "<model><resources><object id=\"1\" name=\"{evil}\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
         <vertex x=\"9\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"9\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/>\
         </triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>"
    );
    let odd = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    let shown = inspect(
        "a\u{1b}.3mf",
        &zipped(&[("3D/3dmodel.model", model.as_bytes())]),
    )
    .unwrap();
    let shown = shown.value.to_string();
    assert!(!shown.contains(odd), "{shown:?}");
    assert!(
        shown.contains(r"a\u{1b}]0;t\u{7}\u{202e}b\u{a}all fine"),
        "{shown}"
    );
    for (name, text) in [
        ("a.obj", "v 0 0 0\nv 1 0 \u{1b}[2J\u{202e}0\n"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement \u{202e}x\u{1b}[2J many\n",
        ),
        ("a.stl", "solid\n\u{1b}]0;t\u{7}\u{202e}\n"),
        ("a.off", "\u{1b}[2J\u{202e}\n"),
    ] {
        let error = inspect(name, text.as_bytes()).unwrap_err();
        let shown = format!(
            "{} {}",
            error.message,
            match &error.place {
                Some(Place::Line { excerpt, .. }) => excerpt,
                _ => "",
            }
        );
        assert!(!shown.contains(odd), "{shown:?}");
    }
}

#[test]
fn vertices_without_faces_say_nothing_of_the_size() {
    let stray = format!("{}v 1000 0 0\n", cube_obj("0 0 0"));
    let found = inspect("stray.obj", stray.as_bytes()).unwrap();
    assert_eq!(found.value.bodies[0].size_mm, [20.0; 3]);
    assert_eq!(found.value.bodies[0].defects[0].kind, "unreferenced_vertex");
    let small = stray.replace("20", "0.02");
    let found = inspect("small.obj", small.as_bytes()).unwrap();
    let told = &found.warnings[0].message;
    assert!(
        told.contains("saved in metres? That would be 20.0 mm"),
        "{told}"
    );
}

#[test]
fn warnings_show_their_line() {
    let coloured = cube_obj("0 0 0 nan nan nan");
    let texture = cube_obj("0 0 0").replace("f 1 3 4", "vt 1 q\nf 1/1 3/1 4/1");
    let dangling = cube_obj("0 0 0").replace("f 1 3 4", "f 1/7 3/8 4/9");
    let unknown = format!("{}colour me red\n", cube_obj("0 0 0"));
    for (text, line) in [
        (coloured, "v 0 0 0 nan nan nan"),
        (texture, "vt 1 q"),
        (dangling, "f 1/7 3/8 4/9"),
        (unknown, "colour me red"),
    ] {
        let read = load_model("a.obj", text.as_bytes(), false).unwrap();
        match &read.warnings[0].place {
            Some(Place::Line {
                line: number,
                excerpt,
                ..
            }) => {
                assert!(excerpt.starts_with(line), "{excerpt}");
                assert_eq!(text.lines().nth(number - 1), Some(excerpt.as_str()));
            }
            other => panic!("{other:?}"),
        }
    }
}

/// Meshes with all faces in one place, which would need the square of their number to be compared.
#[test]
fn hopeless_meshes_are_judged_soon() {
    let count = 60_000u32;
    // So many faces on one edge, none of which cuts another.
    let mut book = "v 0 0 0\nv 0 0 10\n".to_owned();
    for k in 0..count {
        let (sin, cos) = (f64::from(k) / f64::from(count)).sin_cos();
        writeln!(book, "v {} {} 5\nf 1 2 {}", 10.0 * cos, 10.0 * sin, k + 3).unwrap();
    }
    let mut pile = cube_stl(12);
    let triangle = pile[84..134].to_vec();
    pile.truncate(84);
    pile[80..84].copy_from_slice(&count.to_le_bytes());
    (0..count).for_each(|_| pile.extend(&triangle));
    for (name, bytes, kind) in [
        ("book.obj", book.into_bytes(), "crowded_edge"),
        ("pile.stl", pile, "duplicate_face"),
    ] {
        let start = std::time::Instant::now();
        let found = inspect(name, &bytes).unwrap().value;
        let defects = &found.bodies[0].defects;
        assert!(defects.iter().any(|d| d.kind == kind), "{found}");
        let cut = defects
            .iter()
            .find(|d| d.kind == "self_intersection")
            .expect("not all compared");
        assert!(
            cut.at_least && cut.text.contains("too many in one place"),
            "{found}"
        );
        println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
    }
}

/// Sweeps a directory of files with a table of what they are to do, if one is named.
#[test]
fn listed_files_behave_as_listed() {
    let Ok(dir) = std::env::var("PILLARFOREST_HOSTILE") else {
        println!("skipped: PILLARFOREST_HOSTILE names no directory with a MANIFEST.tsv");
        return;
    };
    let manifest = std::fs::read_to_string(Path::new(&dir).join("MANIFEST.tsv")).unwrap();
    let mut wrong = Vec::new();
    for row in manifest.lines().skip(1) {
        let mut columns = row.split('\t');
        let (Some(path), Some(class)) = (columns.next(), columns.next()) else {
            continue;
        };
        if path.ends_with(".ron") {
            continue;
        }
        let wanted = match class {
            "OK" => Class::Ok,
            "WARN" => Class::Warn,
            _ => Class::Error,
        };
        let bytes = std::fs::read(Path::new(&dir).join(path)).unwrap();
        let result = load_model(path, &bytes, true);
        println!("{class} {path}\n    {}", said(&result));
        let single = match &result {
            Ok(read) => read.warnings.len() <= 2,
            Err(e) => e.place.is_some(),
        };
        if class_of(&result) != wanted || !single {
            wrong.push(format!(
                "{path}: {class} wanted, {:?}: {}",
                class_of(&result),
                said(&result)
            ));
        }
        let _ = inspect(path, &bytes).map(|i| i.value.to_string());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The same for scenes, through the command. Their language is an invented one, so all of them are errors here: what counts
/// is that they end with one clean set of messages. Each has a counterpart in this language under tests/cases, in `scene` or `files`.
#[test]
fn listed_scenes_end_with_messages() {
    let Ok(dir) = std::env::var("PILLARFOREST_HOSTILE") else {
        println!("skipped: PILLARFOREST_HOSTILE names no directory with a MANIFEST.tsv");
        return;
    };
    let manifest = std::fs::read_to_string(Path::new(&dir).join("MANIFEST.tsv")).unwrap();
    let empty = tempfile::tempdir().unwrap();
    let mut count = 0;
    for row in manifest.lines().skip(1) {
        let Some(name) = row.split('\t').next().filter(|n| n.ends_with(".ron")) else {
            continue;
        };
        let path = Path::new(&dir).join(name);
        let args = ["build", path.to_str().unwrap(), "--diagnostics", "short"];
        let (code, out, err) = crate::cli::run(empty.path(), &args);
        let odd = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert_eq!((code, out.as_str()), (1, ""), "{name}: {err}");
        assert!(err.contains("error: "), "{name}: {err}");
        assert!(
            !err.contains(odd) && !err.contains("root:"),
            "{name}: {err}"
        );
        assert!(
            err.lines().count() <= 102 && err.len() < 100_000,
            "{name}: {}",
            err.len()
        );
        count += 1;
    }
    assert!(count > 60, "{count} scenes");
    assert_eq!(std::fs::read_dir(empty.path()).unwrap().count(), 0);
}
