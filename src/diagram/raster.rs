//! Drawings as pixels (tiny-skia).

use crate::diagram::drawing::{Drawing, Ink, Mark, Verb};
use tiny_skia::{
    Color, FillRule, IntRect, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke,
    StrokeDash, Transform,
};

/// Largest side of a picture in pixels: 8k by 8k needs 256 MB.
const MAX_SIDE: u32 = 8192;

impl Drawing {
    /// The page as a PNG of this width in pixels (1 to 8192), on white.
    pub fn png(&self, width_px: u32) -> Vec<u8> {
        let width = width_px.clamp(1, MAX_SIDE);
        let scale = f64::from(width) / self.size.x;
        let height = ((self.size.y * scale).round() as u32).clamp(1, MAX_SIDE);
        let mut pixmap = blank(width, height);
        self.paint(&mut pixmap, scale);
        encode(&pixmap)
    }

    /// Paints the list over what is there, `scale` pixels a unit.
    pub fn paint(&self, pixmap: &mut Pixmap, scale: f64) {
        for shape in &self.shapes {
            paint(pixmap, shape, scale as f32);
        }
    }
}

/// A white picture; sides are clamped to 1..=8192.
///
/// # Panics
/// Never: such sides fit.
pub fn blank(width: u32, height: u32) -> Pixmap {
    let mut pixmap = Pixmap::new(width.clamp(1, MAX_SIDE), height.clamp(1, MAX_SIDE))
        .expect("sides between 1 and 8192");
    pixmap.fill(Color::WHITE);
    pixmap
}

/// Puts colours (sRGB, 0 to 255, by rows of `side` pixels) into a picture; `corner` is where the top left pixel goes.
pub fn put_square(
    pixmap: &mut Pixmap,
    corner: (usize, usize),
    side: usize,
    colours: impl Iterator<Item = [f32; 3]>,
) {
    let across = pixmap.width() as usize;
    for (k, rgb) in colours.enumerate() {
        let at = 4 * ((corner.1 + k / side) * across + corner.0 + k % side);
        let rgb = rgb.map(|c| c.round().clamp(0.0, 255.0) as u8);
        pixmap.data_mut()[at..at + 3].copy_from_slice(&rgb);
    }
}

/// The square with this top left corner.
///
/// # Panics
/// If it does not lie within the picture.
pub fn square(pixmap: &Pixmap, corner: (usize, usize), side: usize) -> Pixmap {
    let [x, y] = [corner.0, corner.1].map(|c| i32::try_from(c).unwrap_or(i32::MAX));
    let rect = IntRect::from_xywh(x, y, side as u32, side as u32);
    rect.and_then(|r| pixmap.clone_rect(r))
        .expect("a square within the picture")
}

/// The bytes of a PNG file.
///
/// # Panics
/// Never: memory takes all that is written.
pub fn encode(pixmap: &Pixmap) -> Vec<u8> {
    pixmap.encode_png().expect("writing a PNG to memory")
}

fn paint(pixmap: &mut Pixmap, shape: &Mark, scale: f32) {
    // `None` for outlines with coordinates that are not finite: nothing to draw.
    let Some(path) = path(&shape.steps) else {
        return;
    };
    let transform = Transform::from_scale(scale, scale);
    if let Some(ink) = shape.fill {
        pixmap.fill_path(&path, &paint_of(ink), FillRule::Winding, transform, None);
    }
    if let Some(pen) = shape.pen {
        let dash = pen
            .dash
            .and_then(|[dash, gap]| StrokeDash::new(vec![dash as f32, gap as f32], 0.0));
        let stroke = Stroke {
            width: pen.width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        pixmap.stroke_path(&path, &paint_of(pen.ink), &stroke, transform, None);
    }
}

fn paint_of(ink: Ink) -> Paint<'static> {
    let [r, g, b] = ink.rgb;
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, (255.0 * ink.alpha).round() as u8);
    paint.anti_alias = true;
    paint
}

fn path(steps: &[Verb]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for step in steps {
        match *step {
            Verb::Move(p) => builder.move_to(p.x as f32, p.y as f32),
            Verb::Line(p) => builder.line_to(p.x as f32, p.y as f32),
            Verb::Quad(a, p) => builder.quad_to(a.x as f32, a.y as f32, p.x as f32, p.y as f32),
            Verb::Cubic(a, b, p) => builder.cubic_to(
                a.x as f32, a.y as f32, b.x as f32, b.y as f32, p.x as f32, p.y as f32,
            ),
            Verb::Close => builder.close(),
        }
    }
    builder.finish()
}
