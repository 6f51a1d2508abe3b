//! Small pieces of the page: escaped text, figures with units, tables, pictures in the text itself.

use crate::formats::markup::escaped;
use std::fmt::Write as _;

/// Where there is no figure.
pub(crate) const DASH: &str = "\u{2013}";
/// Between a figure and its unit: narrow, and no line breaks there.
const THIN: char = '\u{202F}';

/// A figure as people read it, with its exact value beside it for programs. A dash if it is not finite.
fn figure(exact: f64, shown: &str) -> String {
    if exact.is_finite() {
        let shown = shown.replace('-', "\u{2212}");
        format!("<data value=\"{exact:?}\">{shown}</data>")
    } else {
        "\u{2013}".to_owned()
    }
}

/// With so many decimals and a unit. What would read as zero and is none is told as being below the last place.
pub(crate) fn measure(exact: f64, decimals: usize, unit: &str) -> String {
    let least = last_place(decimals);
    let number = if exact > 0.0 && exact < least / 2.0 {
        format!("below {least:.decimals$}")
    } else {
        rounded(exact, decimals)
    };
    let gap = if ["", "°", "′"].contains(&unit) {
        String::new()
    } else {
        THIN.to_string()
    };
    figure(exact, &format!("{number}{gap}{unit}"))
}

/// The same, or `none`.
pub(crate) fn measure_or(exact: Option<f64>, decimals: usize, unit: &str, none: &str) -> String {
    exact.map_or_else(|| none.to_owned(), |x| measure(x, decimals, unit))
}

/// The least number above zero with so many decimals.
fn last_place(decimals: usize) -> f64 {
    0.1_f64.powi(i32::try_from(decimals).unwrap_or(i32::MAX))
}

/// Without the sign of what rounds to zero.
fn rounded(exact: f64, decimals: usize) -> String {
    let nothing = exact.abs() < last_place(decimals) / 2.0;
    format!("{:.decimals$}", if nothing { 0.0 } else { exact })
}

/// A share as a percentage, rounded down: only a perfect one reads as 100 %.
pub(crate) fn percent(share: f64) -> String {
    // What rounding took off a share of exactly 1/100 of a percent is given back.
    let shown = (share * 1e4 + 1e-7).floor() / 100.0;
    figure(share, &format!("{:.2}{THIN}%", shown + 0.0))
}

/// A count, its thousands set apart.
pub(crate) fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut shown = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            shown.push(THIN);
        }
        shown.push(digit);
    }
    format!("<data value=\"{n}\">{shown}</data>")
}

/// A small number by its power of ten.
pub(crate) fn tiny(exact: f64) -> String {
    if exact == 0.0 || !exact.is_finite() {
        return figure(exact, "0");
    }
    let text = format!("{exact:.1e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    figure(exact, &format!("{digits} × 10<sup>{power}</sup>"))
}

/// A place in millimetres.
pub(crate) fn place(p: [f64; 3]) -> String {
    let [x, y, z] = p.map(|c| figure(c, &rounded(c, 1)));
    format!("<span class=\"place\">({x}, {y}, {z}){THIN}mm</span>")
}

/// A table that may be wider than the screen. Cells are HTML; the first of each row is its head.
pub(crate) fn table<const N: usize>(
    caption: &str,
    heads: [&str; N],
    rows: &[[String; N]],
) -> String {
    let mut html =
        format!("<div class=\"scroll\"><table>\n<caption>{caption}</caption>\n<thead><tr>");
    for head in heads {
        _ = write!(html, "<th scope=\"col\">{head}</th>");
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        let (first, rest) = row.split_first().map_or(("", &[][..]), |(f, r)| (f, r));
        _ = write!(html, "<tr><th scope=\"row\">{first}</th>");
        for cell in rest {
            _ = write!(html, "<td>{cell}</td>");
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    html
}

/// The same, or nothing if there are no rows.
pub(crate) fn table_if_any<const N: usize>(
    caption: &str,
    heads: [&str; N],
    rows: &[[String; N]],
) -> String {
    if rows.is_empty() {
        String::new()
    } else {
        table(caption, heads, rows)
    }
}

/// Figures under words, side by side. Both are HTML.
pub(crate) fn facts(facts: &[(&str, String)]) -> String {
    let mut html = String::from("<dl class=\"facts\">\n");
    for (what, found) in facts {
        _ = writeln!(html, "<div><dt>{what}</dt><dd>{found}</dd></div>");
    }
    html.push_str("</dl>\n");
    html
}

/// Texts as a list.
pub(crate) fn list(texts: &[String]) -> String {
    let mut html = String::from("<ul>\n");
    for text in texts {
        _ = writeln!(html, "<li>{}</li>", escaped(text));
    }
    html.push_str("</ul>\n");
    html
}

/// A sign and a word: the colour alone says nothing.
pub(crate) fn mark(holds: bool) -> &'static str {
    if holds {
        "<span class=\"mark holds\">✓ holds</span>"
    } else {
        "<span class=\"mark off\">! see here</span>"
    }
}

/// A PNG within the page; `alt` is plain text.
pub(crate) fn picture(png: &[u8], alt: &str) -> String {
    format!(
        "<img alt=\"{}\" src=\"data:image/png;base64,{}\">",
        escaped(alt),
        base64(png)
    )
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k) & 63) as usize];
            text.push(if k <= three.len() {
                letter as char
            } else {
                '='
            });
        }
    }
    text
}
