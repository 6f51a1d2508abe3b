//! What slicers write into 3MF files besides the standard: which parts of an object are no bodies.
//!
//! PrusaSlicer keeps all volumes of an object in one mesh and says in `Metadata/Slic3r_PE_model.config` which of its triangles are
//! what; Bambu Studio and OrcaSlicer make every part a component and say in `Metadata/model_settings.config` what it is. To all other
//! readers a shape that is to be cut away looks like a body.

use crate::formats::text::excerpt;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Part of an object that is no body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Aside {
    /// Of the object in the root part.
    pub object: u32,
    pub of: PartOf,
    pub role: &'static str,
    pub name: String,
}

/// Which part of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PartOf {
    /// Its components of this object.
    Component(u32),
    /// Its triangles from the first to the last.
    Faces(usize, usize),
}

/// What is done with negative parts.
pub(super) const NEGATIVE: &str = "cuts away";

/// What a part is, by the words of both families; `None`: a body.
fn role(word: &str) -> Option<&'static str> {
    Some(match word {
        "NegativeVolume" | "negative_part" => NEGATIVE,
        "ParameterModifier" | "modifier_part" => "changes settings",
        "SupportEnforcer" | "SupportBlocker" | "support_enforcer" | "support_blocker" => {
            "steers supports"
        }
        _ => return None,
    })
}

/// The paths of both files.
pub(super) const CONFIGS: [&str; 2] = [
    "Metadata/Slic3r_PE_model.config",
    "Metadata/model_settings.config",
];

/// The parts of either file that are no bodies.
///
/// # Errors
/// Broken XML.
pub(super) fn asides(bytes: &[u8]) -> Result<Vec<Aside>, String> {
    let mut reader = Reader::from_reader(bytes);
    let mut found = Vec::new();
    let mut object = None;
    let mut part: Option<SlicerPart> = None;
    loop {
        match reader
            .read_event()
            .map_err(|e| format!("broken XML: {e}"))?
        {
            Event::Start(e) | Event::Empty(e) => match e.local_name().as_ref() {
                b"object" => object = value(&e, "id").and_then(|id| id.parse().ok()),
                b"volume" | b"part" => {
                    finish(&mut found, object, part.take());
                    part = SlicerPart::new(&e);
                }
                b"metadata" => {
                    if let (Some(part), Some(key)) = (&mut part, value(&e, "key")) {
                        part.learn(&key, &value(&e, "value").unwrap_or_default());
                    }
                }
                _ => {}
            },
            Event::End(e) if matches!(e.local_name().as_ref(), b"volume" | b"part") => {
                finish(&mut found, object, part.take());
            }
            Event::Eof => return Ok(found),
            _ => {}
        }
    }
}

/// A part as far as it has been read.
struct SlicerPart {
    of: PartOf,
    role: Option<&'static str>,
    name: String,
}

impl SlicerPart {
    fn new(e: &BytesStart) -> Option<Self> {
        let number = |name: &str| value(e, name)?.parse::<usize>().ok();
        let of = match (number("firstid"), number("lastid")) {
            (Some(first), Some(last)) => PartOf::Faces(first, last),
            _ => PartOf::Component(u32::try_from(number("id")?).ok()?),
        };
        Some(Self {
            of,
            role: value(e, "subtype").and_then(|word| role(&word)),
            name: String::new(),
        })
    }

    fn learn(&mut self, key: &str, value: &str) {
        match key {
            "name" => self.name = excerpt(value.as_bytes()),
            "volume_type" => self.role = role(value),
            // Before there were negative volumes.
            "modifier" if value == "1" => self.role = role("ParameterModifier"),
            _ => {}
        }
    }
}

fn finish(found: &mut Vec<Aside>, object: Option<u32>, part: Option<SlicerPart>) {
    if let (
        Some(object),
        Some(SlicerPart {
            of,
            role: Some(role),
            name,
        }),
    ) = (object, part)
    {
        found.push(Aside {
            object,
            of,
            role,
            name,
        });
    }
}

fn value(e: &BytesStart, name: &str) -> Option<String> {
    let attribute = e.try_get_attribute(name).ok()??;
    let value = attribute.unescape_value().ok()?;
    Some(value.into_owned())
}
