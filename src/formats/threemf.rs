//! 3MF: an OPC package (zip) with one XML model, written by hand.
//!
//! What slicers agree on decides the form: `unit="millimeter"`, one plain mesh object per part, no components and no
//! build transforms, one `m:colorgroup` of one colour per colour, referred to by each object's `pid`/`pindex`
//! (slicers of the Bambu and Orca family match the literal prefix `m` and read nothing else).

use crate::formats::markup::escaped;
use crate::formats::part::Part;
use crate::index::VertexId;
use crate::mesh::TriMesh;
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Of deflate, 1 to 9. On 600k triangles 6 takes 1.7 times as long and saves 3 %; 2 saves a seventh of the time and costs 11 %.
const LEVEL: i64 = 4;

/// What a 3MF file says about itself. Empty texts are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata {
    pub title: String,
    pub designer: String,
    pub description: String,
    pub licence: String,
    /// Name and version of the program.
    pub application: String,
    /// Written as CreationDate and as the time of the zip's entries; `None` leaves out the first and zeroes the second.
    pub created: Option<ZipTime>,
    /// Names (letters, digits, `_`, `-`) and values in the program's own namespace, such as `views` and `pillars`.
    pub own: Vec<(String, String)>,
}

/// A moment in UTC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ZipTime {
    pub year: u16,
    pub month: u8,
    pub day: u8,
    pub hour: u8,
    pub minute: u8,
    pub second: u8,
}

impl ZipTime {
    /// From seconds since 1970, as in `SOURCE_DATE_EPOCH`; clamped to the years 1980 to 2107 that zip can tell.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "hours, minutes and seconds of a day"
    )]
    pub fn from_unix(seconds: u64) -> Self {
        const FIRST: u64 = 315_532_800;
        const LAST: u64 = 4_354_819_199;
        let seconds = seconds.clamp(FIRST, LAST);
        let (days, rest) = (seconds / 86_400, seconds % 86_400);
        let (year, month, day) = civil_from_days(days);
        Self {
            year,
            month,
            day,
            hour: (rest / 3600) as u8,
            minute: (rest / 60 % 60) as u8,
            second: (rest % 60) as u8,
        }
    }

    fn date(self) -> String {
        format!("{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }

    fn zip(self) -> DateTime {
        DateTime::from_date_and_time(
            self.year,
            self.month,
            self.day,
            self.hour,
            self.minute,
            self.second,
        )
        .unwrap_or_default()
    }
}

/// Year, month and day of a day since 1970-01-01 (Hinnant, chrono-compatible low-level date algorithms).
#[expect(
    clippy::cast_possible_truncation,
    reason = "of a day before the year 2108"
)]
fn civil_from_days(days: u64) -> (u16, u8, u8) {
    let z = days + 719_468;
    let (era, day_of_era) = (z / 146_097, z % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 {
        shifted_month + 3
    } else {
        shifted_month - 9
    };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    (year as u16, month as u8, day as u8)
}

/// The bytes of a 3MF file with one object per part, in the order given.
///
/// # Panics
/// Never for data that fits in memory: the zip is written to a buffer, which cannot fail otherwise.
pub fn write_3mf(parts: &[Part], meta: &Metadata, thumbnail_png: Option<&[u8]>) -> Vec<u8> {
    let model = model_xml(parts, meta);
    let thumbnail = thumbnail_png.is_some();
    let mut entries = vec![
        (
            "[Content_Types].xml",
            content_types_xml(thumbnail).into_bytes(),
        ),
        ("_rels/.rels", relationships_xml(thumbnail).into_bytes()),
        ("3D/3dmodel.model", model.into_bytes()),
    ];
    entries.extend(thumbnail_png.map(|png| ("Metadata/thumbnail.png", png.to_vec())));
    pack(&entries, meta.created).expect("writing a zip to memory")
}

/// A zip whose bytes depend on the entries and the time given alone.
fn pack(entries: &[(&str, Vec<u8>)], created: Option<ZipTime>) -> zip::result::ZipResult<Vec<u8>> {
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(created.map_or_else(DateTime::default, ZipTime::zip))
        .unix_permissions(0o644);
    let packed = plain
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(LEVEL));
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        let options = if name.ends_with(".png") {
            plain
        } else {
            packed
        };
        zip.start_file(
            *name,
            options.large_file(bytes.len() as u64 > u64::from(u32::MAX) / 2),
        )?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}

fn content_types_xml(thumbnail: bool) -> String {
    let png = if thumbnail {
        "\n <Default Extension=\"png\" ContentType=\"image/png\"/>"
    } else {
        ""
    };
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>{png}
</Types>
"#
    )
}

fn relationships_xml(thumbnail: bool) -> String {
    let picture = if thumbnail {
        "\n <Relationship Id=\"rel-2\" Target=\"/Metadata/thumbnail.png\" Type=\"http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail\"/>"
    } else {
        ""
    };
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Id="rel-1" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>{picture}
</Relationships>
"#
    )
}

fn model_xml(parts: &[Part], meta: &Metadata) -> String {
    // About 40 bytes a vertex and 45 a triangle; a guess that only saves copying.
    let size: usize = parts
        .iter()
        .map(|p| 40 * p.solid.mesh().vertices.len() + 45 * p.solid.mesh().faces.len())
        .sum();
    let mut xml = String::with_capacity(size + 4096);
    xml.push_str(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" xmlns:pillarforest="urn:pillarforest:metadata:1">
"#,
    );
    push_metadata(&mut xml, meta);
    xml.push_str(" <resources>\n");
    let colours = push_colours(&mut xml, parts);
    let first_object = colours.len() + 1;
    for (k, part) in parts.iter().enumerate() {
        let pid = 1 + colours.iter().position(|c| *c == part.colour).unwrap_or(0);
        push_object(&mut xml, first_object + k, pid, part);
    }
    xml.push_str(" </resources>\n <build>\n");
    for k in 0..parts.len() {
        _ = writeln!(xml, "  <item objectid=\"{}\"/>", first_object + k);
    }
    xml.push_str(" </build>\n</model>\n");
    xml
}

fn push_metadata(xml: &mut String, meta: &Metadata) {
    let date = meta.created.map(ZipTime::date).unwrap_or_default();
    let known = [
        ("Title", &meta.title),
        ("Designer", &meta.designer),
        ("Description", &meta.description),
        ("LicenseTerms", &meta.licence),
        ("Application", &meta.application),
        ("CreationDate", &date),
    ];
    for (name, value) in known.into_iter().filter(|(_, value)| !value.is_empty()) {
        _ = writeln!(
            xml,
            " <metadata name=\"{name}\">{}</metadata>",
            escaped(value)
        );
    }
    for (name, value) in &meta.own {
        let name: String = name
            .chars()
            .filter(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'))
            .collect();
        _ = writeln!(
            xml,
            " <metadata name=\"pillarforest:{name}\">{}</metadata>",
            escaped(value)
        );
    }
}

/// Writes one colour group for each different colour, with ids from 1, and gives the colours in that order.
fn push_colours(xml: &mut String, parts: &[Part]) -> Vec<[u8; 3]> {
    let mut colours: Vec<[u8; 3]> = Vec::new();
    for part in parts {
        if !colours.contains(&part.colour) {
            colours.push(part.colour);
        }
    }
    for (k, [r, g, b]) in colours.iter().enumerate() {
        _ = writeln!(
            xml,
            "  <m:colorgroup id=\"{}\"><m:color color=\"#{r:02X}{g:02X}{b:02X}FF\"/></m:colorgroup>",
            k + 1
        );
    }
    colours
}

fn push_object(xml: &mut String, id: usize, pid: usize, part: &Part) {
    _ = writeln!(
        xml,
        "  <object id=\"{id}\" type=\"model\" name=\"{}\" pid=\"{pid}\" pindex=\"0\">",
        escaped(&part.name)
    );
    xml.push_str("   <mesh>\n    <vertices>\n");
    let mesh: &TriMesh = part.solid.mesh();
    for v in &mesh.vertices {
        // The shortest text that reads back as the same f32; `+ 0.0` turns -0 into 0.
        let [x, y, z] = (v.as_vec3() + 0.0).to_array();
        _ = writeln!(xml, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    xml.push_str("    </vertices>\n    <triangles>\n");
    for [VertexId(a), VertexId(b), VertexId(c)] in &mesh.faces {
        _ = writeln!(xml, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
    }
    xml.push_str("    </triangles>\n   </mesh>\n  </object>\n");
}
