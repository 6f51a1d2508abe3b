//! The contact sheet of a view in several lights: a column for each light, the model above the forest, figures below.

use crate::diagram::drawing::{Align, Drawing, TextStyle};
use crate::diagram::lettering::{Typeface, width};
use crate::diagram::raster;
use crate::render::caster::{DARK, SPAN};
use crate::render::inks::{QUIET, TEXT};
use crate::render::light_figures::LightLikeness;
use crate::render::shading::{self, Rgb, differ};
use crate::render::stage::{FLASH_LAMP, Lit, SIDE, SKY_LAMP, SUNS_DEG, Stage};
use crate::view::View;
use glam::DVec2;
use rayon::prelude::*;

/// Lights, and columns.
const COLUMNS: usize = SUNS_DEG.len() + 2;

/// Model and forest in every light.
type Panels = [Rgb; 2 * COLUMNS];

/// Rays across a measured pixel. The picture is that much finer; how much of the sky is seen is not.
const FINER: usize = 2;

/// Side of a panel, pixels.
const PANEL: usize = FINER * SIDE;

/// Layout in pixels: between the panels, above them and below them.
const GAP: usize = 8;
const HEAD: usize = 26;
const FOOT: usize = 64;

/// A PNG. `pixels` are the stage's, by rows of [`SIDE`]; `figures` one for each column.
pub(super) fn sheet(
    view: &View,
    stage: &Stage,
    pixels: &[[Option<Lit>; 2]],
    figures: &[LightLikeness],
) -> Vec<u8> {
    let measured: Vec<Panels> = pixels.par_iter().map(panels).collect();
    let calm: Vec<bool> = (0..measured.len())
        .into_par_iter()
        .map(|k| is_calm(&measured, k))
        .collect();
    let panels: Vec<Panels> = (0..PANEL * PANEL)
        .into_par_iter()
        .map(|k| {
            let [x, y] = [k % PANEL, k / PANEL].map(|i| (i as f64 + 0.5) / FINER as f64);
            let middle = y as usize * SIDE + x as usize;
            match calm[middle] {
                true => between(&measured, x, y),
                false => panels(&stage.lit_near(x, y, &pixels[middle])),
            }
        })
        .collect();
    let across = COLUMNS * PANEL + (COLUMNS + 1) * GAP;
    let down = HEAD + 2 * PANEL + GAP + FOOT;
    let mut pixmap = raster::blank(across as u32, down as u32);
    for panel in 0..2 * COLUMNS {
        let corner = (
            column(panel % COLUMNS),
            HEAD + panel / COLUMNS * (PANEL + GAP),
        );
        raster::put_square(&mut pixmap, corner, PANEL, panels.iter().map(|p| p[panel]));
    }
    let mut drawing = Drawing::new(DVec2::new(across as f64, down as f64));
    captions(&mut drawing, view, figures);
    drawing.paint(&mut pixmap, 1.0);
    raster::encode(&pixmap)
}

/// Whether a measured pixel looks much like all around it: there nothing is cast again.
fn is_calm(measured: &[Panels], k: usize) -> bool {
    let (x, y) = (k % SIDE, k / SIDE);
    let near = |i: usize| i.saturating_sub(1)..(i + 2).min(SIDE);
    let mut around = near(y).flat_map(|v| near(x).map(move |u| v * SIDE + u));
    around.all(|other| !differ(&measured[k], &measured[other]))
}

/// The colours at a place, in pixels from the top left corner, from the four pixels whose middles are nearest.
fn between(measured: &[Panels], x: f64, y: f64) -> Panels {
    let place = |at: f64| {
        let from = (at - 0.5).clamp(0.0, (SIDE - 1) as f64);
        let first = (from as usize).min(SIDE - 2);
        (first, (from - first as f64) as f32)
    };
    let ((u, right), (v, down)) = (place(x), place(y));
    let corners = [0, 1, SIDE, SIDE + 1].map(|step| &measured[v * SIDE + u + step]);
    std::array::from_fn(|panel| {
        std::array::from_fn(|i| {
            let [a, b, c, d] = corners.map(|corner| corner[panel][i]);
            let (above, below) = (a + right * (b - a), c + right * (d - c));
            above + down * (below - above)
        })
    })
}

/// Left edge of a column, pixels.
fn column(k: usize) -> usize {
    GAP + k * (PANEL + GAP)
}

/// The lamp of a column.
fn lamp(column: usize) -> usize {
    match column.checked_sub(SUNS_DEG.len()) {
        None => 2 * column,
        Some(0) => SKY_LAMP,
        Some(_) => FLASH_LAMP,
    }
}

/// Colours of one pixel, the model's panels first. Suns are the left ones.
fn panels(lit: &[Option<Lit>; 2]) -> Panels {
    std::array::from_fn(|panel| {
        let lamp = lamp(panel % COLUMNS);
        lit[panel / COLUMNS].map_or(shading::BACKGROUND, |lit| {
            let brightness = DARK + SPAN * lit[lamp].shade();
            shading::scaled(shading::PLASTER, brightness / (DARK + SPAN))
        })
    })
}

fn captions(drawing: &mut Drawing, view: &View, figures: &[LightLikeness]) {
    let head = TextStyle {
        size: 13.0,
        ink: TEXT,
        face: Typeface::Regular,
        anchor: Align::Start,
        halo: None,
    };
    let body = TextStyle {
        size: 10.0,
        ink: QUIET,
        face: Typeface::Light,
        ..head
    };
    let mut put = |x: usize, y: usize, text: &str, style: TextStyle, most: usize| {
        let fit = (most as f64 / width(text, style.size, style.face).max(1e-9)).min(1.0);
        let style = TextStyle {
            size: style.size * fit,
            ..style
        };
        drawing.text(DVec2::new(x as f64, y as f64), text, style);
    };
    let title = format!(
        "{}: the target above, the forest below, with the shadows they cast",
        view.name
    );
    put(column(0), HEAD - 9, &title, head, column(COLUMNS) - 2 * GAP);
    let below = HEAD + 2 * PANEL + GAP;
    for (k, f) in figures.iter().enumerate() {
        let lines = [
            (18, name(f), head),
            (33, differences(f), body),
            (46, shadows(f), body),
        ];
        for (down, text, style) in lines {
            put(column(k), below + down, &text, style, PANEL);
        }
    }
}

fn name(f: &LightLikeness) -> String {
    match f.elevation_deg {
        Some(elevation) => format!("sun at {elevation:.0}°, from the left"),
        None if f.light == "flash" => "flash, from the left".into(),
        None => "overcast sky".into(),
    }
}

/// Figures of a sun are those of the left and the right one.
fn differences(f: &LightLikeness) -> String {
    format!(
        "rms difference {:.1} of 255, {:.1} at equal brightness",
        f.rmse, f.rmse_fitted
    )
}

fn shadows(f: &LightLikeness) -> String {
    match (f.false_shadow_share, f.lost_shadow_share) {
        (Some(added), Some(lost)) => format!(
            "shadows added on {:.1} %, lost on {:.1} %",
            100.0 * added,
            100.0 * lost
        ),
        _ => format!("lit {:.2} times as brightly it comes closest", f.gain),
    }
}
