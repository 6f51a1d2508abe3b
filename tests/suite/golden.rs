//! Pictures kept under `tests/golden`. `BLESS=1` rewrites them; a failure leaves expected | found | difference in the temporary directory.

use std::path::Path;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Components may differ by this much before a pixel counts: rounding of another processor.
const TOLERANCE: u8 = 12;

/// Compares a PNG with the golden one; fails if more than one pixel in 2000 differs.
pub fn picture(name: &str, png: &[u8]) {
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
