//! Height fields of waves from images. The only module that names `png`.
//!
//! An image comes from a stranger as a model does: its size is read and limited before anything is unpacked.

use super::heights::Heights;
use crate::scene::defaults::MOST_PIXELS;
use crate::scene::language::raw::RawImage;
use crate::scene::request::ReadFile;
use crate::scene::text::{Reader, Span, error_at};
use std::io::Cursor;

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
    let Grey {
        columns,
        rows,
        values,
    } = match grey(&bytes) {
        Ok(grey) => grey,
        Err((message, help)) => {
            reader
                .problems
                .push(error_at(&file_span, message).help(help));
            return None;
        }
    };
    Some(Box::new(move |x, y| {
        let at = |share: f64, count: usize| {
            let place = (share * count as f64 - 0.5).clamp(0.0, (count - 1) as f64);
            let low = place.floor() as usize;
            (low, (low + 1).min(count - 1), place - low as f64)
        };
        let (i, i1, u) = at(x / width + 0.5, columns);
        let (j, j1, v) = at(1.0 - y / height, rows);
        let pixel = |i: usize, j: usize| f64::from(values[j * columns + i]);
        let row = |j: usize| pixel(i, j) * (1.0 - u) + pixel(i1, j) * u;
        from + (to - from) * (row(j) * (1.0 - v) + row(j1) * v)
    }))
}

/// Brightness from 0 to 1, row by row from the top; black where an image is wholly transparent.
struct Grey {
    columns: usize,
    rows: usize,
    values: Vec<f32>,
}

const SAVE_AS_PNG: &str = "open it in a program for pictures and save it as PNG; in 16 bits of grey, slopes are smoothest";

/// # Errors
/// A message, and what to do.
fn grey(bytes: &[u8]) -> Result<Grey, (String, &'static str)> {
    const OTHERS: [(&[u8], &str); 6] = [
        (b"\xFF\xD8\xFF", "a JPEG picture"),
        (b"GIF8", "a GIF picture"),
        (b"BM", "a BMP picture"),
        (b"II*\0", "a TIFF picture"),
        (b"MM\0*", "a TIFF picture"),
        (b"RIFF", "a WebP picture"),
    ];
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        let other = OTHERS.iter().find(|(magic, _)| bytes.starts_with(magic));
        let what = other.map_or("no PNG", |(_, what)| what);
        return Err((format!("the image is {what}; a PNG is wanted"), SAVE_AS_PNG));
    }
    let broken = |why: png::DecodingError| {
        let message = format!("the PNG is damaged or cut short: {why}");
        (message, "save it anew as PNG")
    };
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    let (width, height) = decoder.read_header_info().map_err(broken)?.size();
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        let message = format!(
            "the image has {width} x {height} pixels; at most {} million are read, as 5000 x 5000",
            MOST_PIXELS / 1_000_000
        );
        return Err((message, "make it smaller: no printer shows as much"));
    }
    // Palettes and fewer than 8 bits become 8 bits; 16 stay.
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let size = reader.output_buffer_size().unwrap_or(0);
    let mut buffer = vec![0; size];
    let frame = reader.next_frame(&mut buffer).map_err(broken)?;
    let samples = frame.color_type.samples();
    let (deep, wide) = match frame.bit_depth {
        png::BitDepth::Sixteen => (true, 2 * samples),
        _ => (false, samples),
    };
    let shade = |pixel: &[u8]| {
        let sample = |k: usize| match deep {
            true => f64::from(u16::from_be_bytes([pixel[2 * k], pixel[2 * k + 1]])) / 65535.0,
            false => f64::from(pixel[k]) / 255.0,
        };
        // Rec. 709 weights; the values are heights, not light: no gamma.
        let mixed = || 0.2126 * sample(0) + 0.7152 * sample(1) + 0.0722 * sample(2);
        let (value, opacity) = match samples {
            1 => (sample(0), 1.0),
            2 => (sample(0), sample(1)),
            3 => (mixed(), 1.0),
            _ => (mixed(), sample(3)),
        };
        if opacity > 0.0 { value as f32 } else { 0.0 }
    };
    Ok(Grey {
        columns: width as usize,
        rows: height as usize,
        values: buffer.chunks_exact(wide).map(shade).collect(),
    })
}
