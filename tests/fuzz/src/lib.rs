//! What the fuzz targets share: a limit on memory, the properties every reader has, scenes with their models.
//!
//! A target fails by a panic. Besides panics, hangs (`-timeout`) and leaks of memory (`-rss_limit_mb`) the targets hold readers
//! to what they promise: errors have text, numbers that come out are finite, indices name vertices, and no allocation is
//! larger than the input justifies.

use pillarforest::diag::{Diagnostic, Warned};
use pillarforest::formats::read_mesh;
use pillarforest::intake::{inspect, load_original};
use pillarforest::mesh::{NO_UV, Original, TriMesh};
use pillarforest::scene::{self, Scene};
use std::alloc::{GlobalAlloc, Layout, System};

/// One allocation may not be larger, bytes: inputs are some kilobytes, and pictures are not made here.
const LARGEST_ALLOCATION: usize = 64 << 20;

/// Memory that refuses what only a lying header can ask for.
pub struct Limited;

// SAFETY: everything is handed on to the system's allocator; a refusal is the null pointer that `alloc` may give.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() > LARGEST_ALLOCATION {
            return std::ptr::null_mut();
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static MEMORY: Limited = Limited;

/// Errors and warnings must say something.
fn telling(list: &[Diagnostic]) {
    for d in list {
        assert!(!d.message.trim().is_empty(), "{d:?}");
        assert!(d.help.iter().all(|h| !h.trim().is_empty()), "{d:?}");
    }
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
pub fn model(name: &str, bytes: &[u8]) {
    let read = read_mesh(name, bytes);
    match &read {
        Ok(Warned { value, warnings }) => {
            sound(value);
            telling(warnings);
        }
        Err(problem) => {
            assert!(
                problem.place.is_some(),
                "an error without a place: {problem:?}"
            );
            telling(std::slice::from_ref(problem));
        }
    }
    let inspected = inspect(name, bytes);
    assert_eq!(inspected.is_ok(), read.is_ok());
    for at_own_size in [false, true] {
        match load_original(name, bytes, at_own_size) {
            Ok(Warned { value, warnings }) => {
                assert!(read.is_ok() && !value.mesh.faces.is_empty());
                sound(&value.mesh);
                fitting(&value.original);
                telling(&warnings);
            }
            Err(problem) => telling(&[problem]),
        }
    }
}

/// A whole scene whose models all have the same bytes; `None` in their place if no file exists.
pub fn resolve(text: &str, models: Option<&[u8]>) {
    let read = |name: &str| {
        let missing = || Diagnostic::error(format!("no file {name}"));
        models.map(<[u8]>::to_vec).ok_or_else(missing)
    };
    match scene::resolve(text, &read) {
        Err(problems) => {
            assert!(problems.iter().any(Diagnostic::is_error));
            telling(&problems);
        }
        Ok(Warned { value, warnings }) => {
            assert!(warnings.iter().all(|w| !w.is_error()));
            telling(&warnings);
            nothing_left_to_decide(&value);
        }
    }
}

/// What later stages rely on.
fn nothing_left_to_decide(scene: &Scene) {
    assert!(!scene.views.is_empty() && !scene.supports.is_empty());
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
