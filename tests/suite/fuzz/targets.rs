//! What is read, one target each, and what counts as a failure.
//!
//! A target fails by a panic. Besides, readers are held to what they promise: errors have text, numbers that come out are finite,
//! indices name vertices. Its answer is what it told. `tests/fuzz` includes this file.

use pillarforest::diag::{Diagnostic, Warned};
use pillarforest::formats::read_mesh;
use pillarforest::intake::{inspect, load_original};
use pillarforest::mesh::{NO_UV, Original, TriMesh};
use pillarforest::scene::{self, Scene};
use std::io::{Cursor, Write};
use std::str::from_utf8;
use zip::write::SimpleFileOptions;

/// Reads an input and gives its answer.
type Run = fn(&[u8]) -> String;
/// Makes an input of a scene's text.
type Make = fn(&[u8]) -> Vec<u8>;

/// What reads inputs of one kind; the name is that of the folder of its kept ones.
pub(crate) struct Target {
    pub name: &'static str,
    pub run: Run,
    /// How a scene of `tests/cases` becomes an input, if it does.
    pub of_case: Option<Make>,
}

pub(crate) const TARGETS: [Target; 11] = [
    target("obj", |bytes| model("fuzz.obj", bytes)),
    target("off", |bytes| model("fuzz.off", bytes)),
    target("ply", |bytes| model("fuzz.ply", bytes)),
    target("stl", |bytes| model("fuzz.stl", bytes)),
    target("threemf", threemf),
    of_scenes("scene", scene, <[u8]>::to_vec),
    of_scenes("set", set, |text| [ASSIGNMENT, text].concat()),
    of_scenes("resolve", resolve, |text| [text, b"\0", TRIANGLE].concat()),
    target("formula", formula),
    target("image", image),
    target("layout", layout),
];

const fn target(name: &'static str, run: Run) -> Target {
    Target {
        name,
        run,
        of_case: None,
    }
}

const fn of_scenes(name: &'static str, run: Run, of_case: Make) -> Target {
    Target {
        name,
        run,
        of_case: Some(of_case),
    }
}

const ASSIGNMENT: &[u8] = b"pillars[0].height=80\n";
const TRIANGLE: &[u8] = b"v 0 0 0\nv 20 0 0\nv 0 0 20\nf 1 2 3\n";

// ---- What is read ----

/// Archives as they are, and any other bytes as the model part of a sound archive, whose checksums would keep almost every change
/// of an archive from the XML inside.
fn threemf(bytes: &[u8]) -> String {
    if bytes.starts_with(b"PK") {
        return model("fuzz.3mf", bytes);
    }
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    archive
        .start_file("3D/3dmodel.model", options)
        .expect("an entry in memory");
    archive.write_all(bytes).expect("bytes in memory");
    let whole = archive.finish().expect("an archive in memory").into_inner();
    model("fuzz.3mf", &whole)
}

/// A scene's text whose model files do not exist: the reader of the language and all checks of values.
fn scene(bytes: &[u8]) -> String {
    from_utf8(bytes).map_or_else(|_| String::new(), |text| resolved(text, &nothing))
}

/// `--set`: the first line is the assignment, the rest the scene.
fn set(bytes: &[u8]) -> String {
    let Ok(input) = from_utf8(bytes) else {
        return String::new();
    };
    let (assignment, text) = input.split_once('\n').unwrap_or((input, ""));
    match scene::set(text, assignment) {
        Err(problem) => telling(&[problem]),
        Ok(changed) => {
            let value = assignment.split_once('=').map_or("", |(_, value)| value);
            assert!(changed.contains(value.trim()), "{changed}");
            resolved(&changed, &nothing)
        }
    }
}

/// Scenes with models: the text up to the first zero byte, then the bytes of every model file.
fn resolve(bytes: &[u8]) -> String {
    let split = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    let (text, model) = bytes.split_at(split);
    let model = model.get(1..).unwrap_or(&[]);
    from_utf8(text).map_or_else(
        |_| String::new(),
        |text| resolved(text, &|_| Ok(model.to_vec())),
    )
}

/// A wave's heights.
fn formula(bytes: &[u8]) -> String {
    let Ok(text) = from_utf8(bytes) else {
        return String::new();
    };
    wave(&format!("Formula({text:?})"), bytes)
}

/// The same as an image, with sums of its chunks that fit: wrong ones would end almost every reading.
fn image(bytes: &[u8]) -> String {
    let heights = "Image(file: \"a.png\", to: 4)";
    let as_is = wave(heights, bytes);
    as_is + &wave(heights, &summed(bytes))
}

fn wave(heights: &str, file: &[u8]) -> String {
    let text = format!(
        "(models: [(name: \"a\", file: \"a.obj\")], views: [(name: \"v\", eye: (0, -300, 45), models: [\"a\"])], \
         supports: [Wave(width: 20, height: 20, pitch: 4, heights: {heights})])"
    );
    let read = |name: &str| match name {
        "a.png" => Ok(file.to_vec()),
        _ => Ok(TRIANGLE.to_vec()),
    };
    resolved(&text, &read)
}

/// A list of pillars in a file of its own.
fn layout(bytes: &[u8]) -> String {
    let text = "(models: [(name: \"a\", file: \"a.obj\")], views: [(name: \"v\", eye: (0, -300, 45), models: [\"a\"])], \
                pillars: File(\"layout.ron\"))";
    let read = |name: &str| match name {
        "layout.ron" => Ok(bytes.to_vec()),
        _ => Ok(TRIANGLE.to_vec()),
    };
    resolved(text, &read)
}

fn nothing(name: &str) -> Result<Vec<u8>, Diagnostic> {
    Err(Diagnostic::error(format!("no file {name}")))
}

/// A PNG whose chunks have the sums they should have.
fn summed(bytes: &[u8]) -> Vec<u8> {
    let mut whole = bytes.to_vec();
    let mut at = 8;
    while let Some(length) = whole.get(at..at + 4) {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let end = at + 8 + length;
        let Some(chunk) = whole.get(at + 4..end) else {
            break;
        };
        let sum = crc(chunk).to_be_bytes();
        if let Some(place) = whole.get_mut(end..end + 4) {
            place.copy_from_slice(&sum);
        }
        at = end + 4;
    }
    whole
}

fn crc(bytes: &[u8]) -> u32 {
    let bit = |sum: u32| {
        if sum & 1 == 1 {
            sum >> 1 ^ 0xedb8_8320
        } else {
            sum >> 1
        }
    };
    let byte = |sum: u32, b: &u8| (0..8).fold(sum ^ u32::from(*b), |sum, _| bit(sum));
    !bytes.iter().fold(!0, byte)
}

// ---- What is promised ----

/// Errors and warnings must say something.
fn telling(list: &[Diagnostic]) -> String {
    for d in list {
        assert!(!d.message.trim().is_empty(), "{d:?}");
        assert!(d.help.iter().all(|h| !h.trim().is_empty()), "{d:?}");
    }
    list.iter()
        .map(|d| d.message.as_str())
        .collect::<Vec<_>>()
        .join("\n")
}

fn sound(mesh: &TriMesh) {
    assert!(mesh.vertices.iter().all(|v| v.is_finite()));
    let count = mesh.vertices.len();
    assert!(mesh.faces.as_flattened().iter().all(|v| v.at() < count));
}

/// Attributes fit the mesh they belong to.
fn fitting(original: &Original) {
    sound(&original.mesh);
    let count = original.mesh.vertices.len();
    let attributes = &original.attributes;
    assert_eq!(original.vertex_of.len(), count);
    assert!(attributes.colours.is_empty() || attributes.colours.len() == count);
    let unit = |c: &f64| (0.0..=1.0).contains(c);
    assert!(attributes.colours.as_flattened().iter().all(unit));
    for scalar in &attributes.scalars {
        assert!(scalar.values.len() == count && scalar.values.iter().all(|v| v.is_finite()));
    }
    if let Some(uvs) = &attributes.uvs {
        assert_eq!(uvs.corners.len(), original.mesh.faces.len());
        assert!(uvs.points.iter().all(|p| p.is_finite()));
        let known = |uv: &u32| *uv == NO_UV || (*uv as usize) < uvs.points.len();
        assert!(uvs.corners.as_flattened().iter().all(known));
    }
}

/// Every way a model file is read.
fn model(name: &str, bytes: &[u8]) -> String {
    let read = read_mesh(name, bytes);
    let mut answer = match &read {
        Ok(Warned { value, warnings }) => {
            sound(value);
            telling(warnings)
        }
        Err(problem) => {
            assert!(
                problem.place.is_some(),
                "an error without a place: {problem:?}"
            );
            telling(std::slice::from_ref(problem))
        }
    };
    let inspected = inspect(name, bytes);
    assert_eq!(inspected.is_ok(), read.is_ok());
    for at_own_size in [false, true] {
        answer += &match load_original(name, bytes, at_own_size) {
            Ok(Warned { value, warnings }) => {
                assert!(read.is_ok() && !value.mesh.faces.is_empty());
                sound(&value.mesh);
                fitting(&value.original);
                telling(&warnings)
            }
            Err(problem) => telling(&[problem]),
        };
    }
    answer
}

/// A whole scene.
fn resolved(text: &str, read: &dyn Fn(&str) -> Result<Vec<u8>, Diagnostic>) -> String {
    match scene::resolve(text, read) {
        Err(problems) => {
            assert!(problems.iter().any(Diagnostic::is_error));
            telling(&problems)
        }
        Ok(Warned { value, warnings }) => {
            assert!(warnings.iter().all(|w| !w.is_error()));
            nothing_left_to_decide(&value);
            telling(&warnings)
        }
    }
}

/// What later stages rely on.
fn nothing_left_to_decide(scene: &Scene) {
    // Pillars that are to be found stand in a brief.
    assert!(!scene.views.is_empty() && (!scene.supports.is_empty() || scene.brief.is_some()));
    for view in &scene.views {
        assert!(view.eye.is_finite() && view.look_at.is_finite() && !view.models.is_empty());
        let in_names = |c: char| c.is_alphanumeric() || "-_ .".contains(c);
        assert!(view.name.chars().all(in_names), "{:?}", view.name);
        view.models.iter().for_each(|m| sound(&m.mesh));
    }
    for support in &scene.supports {
        sound(&support.mesh);
    }
}
