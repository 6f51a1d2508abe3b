//! Pictures and figures kept under `tests/golden`. `BLESS=1` rewrites them; a picture that differs leaves
//! expected | found | difference in the temporary directory.

use serde_json::Value;
use std::path::Path;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Components may differ by this much before a pixel counts: rounding of another processor.
const TOLERANCE: u8 = 12;

/// Compares a PNG with the golden one; fails if more than one pixel in 2000 differs.
pub(crate) fn picture(name: &str, png: &[u8]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/golden")
        .join(name);
    if std::env::var_os("BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, png).unwrap();
        return;
    }
    let expected = Pixmap::load_png(&path)
        .unwrap_or_else(|e| panic!("{}: {e}; BLESS=1 writes it", path.display()));
    let found = Pixmap::decode_png(png).unwrap();
    let same_size = (expected.width(), expected.height()) == (found.width(), found.height());
    let wrong = expected
        .pixels()
        .iter()
        .zip(found.pixels())
        .filter(|(a, b)| distance(**a, **b) > TOLERANCE)
        .count();
    if !same_size || wrong * 2000 > expected.pixels().len() {
        let diff =
            std::env::temp_dir().join(format!("pillarforest-{}.diff.png", name.replace('/', "-")));
        three_panels(&expected, &found).save_png(&diff).unwrap();
        panic!("{name}: {wrong} pixels differ; see {}", diff.display());
    }
}

fn distance(a: PremultipliedColorU8, b: PremultipliedColorU8) -> u8 {
    a.red()
        .abs_diff(b.red())
        .max(a.green().abs_diff(b.green()))
        .max(a.blue().abs_diff(b.blue()))
}

fn three_panels(expected: &Pixmap, found: &Pixmap) -> Pixmap {
    let (w, h) = (
        expected.width().max(found.width()),
        expected.height().max(found.height()),
    );
    let mut panels = Pixmap::new(3 * w, h).unwrap();
    for y in 0..h {
        for x in 0..w {
            let (a, b) = (expected.pixel(x, y), found.pixel(x, y));
            let gap = a
                .zip(b)
                .map_or(255, |(a, b)| distance(a, b).saturating_mul(4));
            let shade = PremultipliedColorU8::from_rgba(gap, gap, gap, 255);
            for (panel, colour) in [a, b, shade].into_iter().enumerate() {
                if let Some(colour) = colour {
                    panels.pixels_mut()[(y * 3 * w + panel as u32 * w + x) as usize] = colour;
                }
            }
        }
    }
    panels
}

/// Compares figures of a scene with the golden ones: same keys and texts, numbers within [`tolerance`].
pub(crate) fn figures(name: &str, found: &Value) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/golden")
        .join(name);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, serde_json::to_string_pretty(found).unwrap() + "\n").unwrap();
        return;
    }
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|e| panic!("{}: {e}; BLESS=1 writes it", path.display()));
    let mut wrong = Vec::new();
    differences("", &serde_json::from_str(&text).unwrap(), found, &mut wrong);
    assert!(wrong.is_empty(), "{name}:\n{}", wrong.join("\n"));
}

/// Relative: what another processor's rounding may change. Small counts must be the same.
fn tolerance(key: &str) -> f64 {
    match key {
        "volume_mm3" | "area_mm2" | "size_mm" | "solid_angle_sr" => 0.001,
        _ => 0.02,
    }
}

fn differences(key: &str, expected: &Value, found: &Value, wrong: &mut Vec<String>) {
    match (expected, found) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            a.iter()
                .for_each(|(key, value)| differences(key, value, &b[key], wrong));
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter()
                .zip(b)
                .for_each(|(a, b)| differences(key, a, b, wrong));
        }
        (Value::Number(_), Value::Number(_)) => {
            let (a, b) = (expected.as_f64().unwrap(), found.as_f64().unwrap());
            if (a - b).abs() > tolerance(key) * a.abs() {
                wrong.push(format!("{key}: expected {a}, found {b}"));
            }
        }
        _ if expected == found => {}
        _ => wrong.push(format!("{key}: expected {expected}, found {found}")),
    }
}
