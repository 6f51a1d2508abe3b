//! Height fields of waves: by formula or from an image. The only module that names `exmex`.

use crate::scene::defaults;
use crate::scene::language::raw::RawImage;
use crate::scene::request::ReadFile;
use crate::scene::text::{Reader, Span, error_at};
use exmex::{Express, FlatEx};

/// Height over the face, millimetres, at x to the right of its middle and y above its lower edge, millimetres.
pub(crate) type Heights = Box<dyn Fn(f64, f64) -> f64>;

/// What a formula of x and y says.
pub(crate) fn formula(reader: &mut Reader, text: &str, span: &Span) -> Option<Heights> {
    if text.len() > defaults::LONGEST_FORMULA {
        let text = format!(
            "the formula has {} characters; the limit is {}",
            text.len(),
            defaults::LONGEST_FORMULA
        );
        reader.error(span, text);
        return None;
    }
    let help = "a formula of x and y in mm, as \"3 * sin(x / 8) + cos(y / 5)\"; angles are radians";
    let parsed = match exmex::parse::<f64>(text) {
        Ok(parsed) => parsed,
        Err(error) => {
            let text = format!("the formula cannot be read: {error}");
            reader.problems.push(error_at(span, text).help(help));
            return None;
        }
    };
    let known = |n: &str| n == "x" || n == "y";
    if let Some(unknown) = parsed.var_names().iter().find(|n| !known(n)) {
        let text = format!("the formula has an unknown name: {unknown}");
        reader.problems.push(error_at(span, text).help(help));
        return None;
    }
    let names: Vec<String> = parsed.var_names().to_vec();
    Some(Box::new(move |x, y| value(&parsed, &names, [x, y])))
}

fn value(parsed: &FlatEx<f64>, names: &[String], [x, y]: [f64; 2]) -> f64 {
    let values: Vec<f64> = names.iter().map(|n| if n == "x" { x } else { y }).collect();
    parsed.eval(&values).unwrap_or(f64::NAN)
}

/// What a PNG says, stretched over a face of this size: black is `from`, white is `to`; linear between the middles of pixels.
pub(crate) fn image(
    reader: &mut Reader,
    raw: &RawImage,
    span: &Span,
    [width, height]: [f64; 2],
    read: ReadFile,
) -> Option<Heights> {
    let (file, file_span) = reader.required(&raw.file, "file", "this Image", span)?;
    reader.need(&raw.to, "to", "this Image", span);
    let from = reader.length(&raw.from, "from").map_or(0.0, |(v, _)| v);
    let (to, _) = reader.length(&raw.to, "to")?;
    let bytes = reader.read(read(file), &file_span)?;
    let pixmap = match tiny_skia::Pixmap::decode_png(&bytes) {
        Ok(pixmap) => pixmap,
        Err(error) => {
            let text = format!("the image cannot be read: {error}");
            let problem = error_at(&file_span, text).help("a PNG is wanted");
            reader.problems.push(problem);
            return None;
        }
    };
    let (columns, rows) = (pixmap.width() as usize, pixmap.height() as usize);
    let grey: Vec<f64> = pixmap
        .pixels()
        .iter()
        .map(|p| {
            let p = p.demultiply();
            // Rec. 709 weights; the values are heights, not light: no gamma.
            (0.2126 * f64::from(p.red())
                + 0.7152 * f64::from(p.green())
                + 0.0722 * f64::from(p.blue()))
                / 255.0
        })
        .collect();
    Some(Box::new(move |x, y| {
        let at = |share: f64, count: usize| {
            let place = (share * count as f64 - 0.5).clamp(0.0, (count - 1) as f64);
            let low = place.floor() as usize;
            (low, (low + 1).min(count - 1), place - low as f64)
        };
        let (i, i1, u) = at(x / width + 0.5, columns);
        let (j, j1, v) = at(1.0 - y / height, rows);
        let pixel = |i: usize, j: usize| grey[j * columns + i];
        let row = |j: usize| pixel(i, j) * (1.0 - u) + pixel(i1, j) * u;
        from + (to - from) * (row(j) * (1.0 - v) + row(j1) * v)
    }))
}
