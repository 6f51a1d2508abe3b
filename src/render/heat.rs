//! The scale of colours for errors of normals.

use crate::diagram::drawing::{Align, Drawing, Ink, Pen, TextStyle};
use crate::diagram::lettering::Typeface;
use crate::render::inks::QUIET;
use crate::render::shading::Rgb;
use glam::DVec2;

/// Angle in degrees at the end of the error scale; larger errors look the same.
pub const SCALE_END_DEG: f64 = 45.0;

/// Colours of the error scale at equal steps from 0 to [`SCALE_END_DEG`].
pub const HEAT: [[u8; 3]; 5] = [
    [0xDF, 0xEA, 0xF0],
    [0x9C, 0xC3, 0xD5],
    [0xF3, 0xC6, 0x4B],
    [0xE0, 0x6B, 0x2E],
    [0x8C, 0x14, 0x34],
];

/// The error scale's colour.
pub(super) fn heat(degrees: f64) -> Rgb {
    let x = (degrees / SCALE_END_DEG).clamp(0.0, 1.0) * (HEAT.len() - 1) as f64;
    let k = (x as usize).min(HEAT.len() - 2);
    let share = (x - k as f64) as f32;
    std::array::from_fn(|c| {
        f32::from(HEAT[k][c]) * (1.0 - share) + f32::from(HEAT[k + 1][c]) * share
    })
}

/// The colours of the error scale with its ends in degrees.
pub(super) fn scale(drawing: &mut Drawing, at: DVec2, unit: f64) {
    const STEPS: usize = 60;
    let (length, height) = (34.0 * unit, 2.6 * unit);
    for k in 0..STEPS {
        let lo = at + DVec2::new(length * k as f64 / STEPS as f64, 0.0);
        // Half a step wider than it must be: no seams between neighbours.
        let hi = at
            + DVec2::new(
                (length * (k as f64 + 1.5) / STEPS as f64).min(length),
                height,
            );
        let colour = heat(SCALE_END_DEG * k as f64 / (STEPS - 1) as f64).map(|c| c.round() as u8);
        drawing.rect(lo, hi, Some(Ink::new(colour)), None);
    }
    let style = TextStyle {
        size: 2.8 * unit,
        ink: QUIET,
        face: Typeface::Light,
        anchor: Align::Middle,
        halo: None,
    };
    for (share, text) in [
        (0.0, "0"),
        (1.0 / 3.0, "15"),
        (2.0 / 3.0, "30"),
        (1.0, "45° +"),
    ] {
        let anchor = match share {
            0.0 => Align::Start,
            1.0 => Align::End,
            _ => Align::Middle,
        };
        let x = at.x + share * length;
        drawing.polyline(
            &[DVec2::new(x, at.y), DVec2::new(x, at.y + height)],
            Pen::new(Ink::new([255; 3]).fade(0.6), 0.15 * unit),
        );
        drawing.text(
            DVec2::new(x, at.y + height + 3.1 * unit),
            text,
            TextStyle { anchor, ..style },
        );
    }
}
