//! The XML of a 3MF model part: meshes, components and build items.
//!
//! Takes the inflated bytes of one part; gives what it says, not yet put together. Elements of other namespaces and
//! unknown ones are passed over; document type declarations are refused, as the standard asks.

use crate::formats::text::{coordinate, excerpt};
use crate::index::VertexId;
use crate::mesh::TriMesh;
use glam::{DMat4, DVec3, DVec4};
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use std::collections::{BTreeMap, BTreeSet};

/// One part.
#[derive(Debug, Default)]
pub(super) struct ModelPart {
    /// Millimetres per unit of its coordinates.
    pub unit_mm: f64,
    pub objects: Vec<XmlObject>,
    pub items: Vec<Instance>,
    /// Whether it has beams, which are not read.
    pub beams: bool,
    has_model: bool,
    /// Of objects.
    ids: BTreeSet<u32>,
    /// Of groups of properties.
    resources: BTreeSet<u32>,
    /// Groups of properties (materials, colours, textures) that objects and triangles name, and an object that does.
    properties: BTreeMap<u32, u32>,
}

impl ModelPart {
    /// A group of properties that is named, but not in the part, and an object that names it.
    pub(super) fn missing_properties(&self) -> Option<(u32, u32)> {
        let all = self
            .properties
            .iter()
            .map(|(group, object)| (*group, *object));
        all.filter(|(group, _)| !self.resources.contains(group))
            .min()
    }
}

#[derive(Debug)]
pub(super) struct XmlObject {
    pub id: u32,
    pub name: String,
    /// Its type, if that says that it is no body.
    pub no_body: Option<&'static str>,
    pub mesh: TriMesh,
    pub components: Vec<Instance>,
}

/// An object put somewhere.
#[derive(Clone, Debug)]
pub(super) struct Instance {
    pub object: u32,
    /// The part it is in, if another one (production extension).
    pub part: Option<String>,
    pub transform: DMat4,
}

/// Where in the part, bytes, and why.
pub(super) type XmlError = (u64, String);

/// # Errors
/// Broken XML, a document type, a part that is no model or several, extensions that are needed but not read, numbers that are none,
/// indices out of range.
pub(super) fn parse(bytes: &[u8]) -> Result<ModelPart, XmlError> {
    let mut reader = Reader::from_reader(bytes);
    let mut part = ModelPart {
        unit_mm: 1.0,
        ..ModelPart::default()
    };
    let mut depth = 0usize;
    loop {
        let at = reader.buffer_position();
        let event = reader
            .read_event()
            .map_err(|e| (reader.error_position(), format!("broken XML: {e}")))?;
        match event {
            Event::Start(e) => {
                outermost(&part, &e, depth).map_err(|why| (at, why))?;
                depth += 1;
                element(&mut part, &e).map_err(|why| (at, why))?;
            }
            Event::Empty(e) => {
                outermost(&part, &e, depth).map_err(|why| (at, why))?;
                element(&mut part, &e).map_err(|why| (at, why))?;
                close(&part, e.local_name().as_ref()).map_err(|why| (at, why))?;
            }
            Event::End(e) => {
                depth = depth.saturating_sub(1);
                close(&part, e.local_name().as_ref()).map_err(|why| (at, why))?;
            }
            Event::DocType(_) => {
                let why = "a document type declaration, which 3MF forbids (entity attacks)";
                return Err((at, why.to_owned()));
            }
            Event::Eof if depth > 0 => return Err((at, "the XML ends too early".to_owned())),
            Event::Eof => return Ok(part),
            _ => {}
        }
    }
}

/// A part is one `model` and nothing else.
fn outermost(part: &ModelPart, e: &BytesStart, depth: usize) -> Result<(), String> {
    let name = e.local_name();
    match (name.as_ref(), depth) {
        (b"model", 0) if !part.has_model => Ok(()),
        (b"model", _) => Err("a second `model` in one part, which has one".to_owned()),
        (_, 0) => Err(format!(
            "the outermost element is `{}`, `model` wanted",
            excerpt(name.as_ref())
        )),
        _ => Ok(()),
    }
}

fn element(part: &mut ModelPart, e: &BytesStart) -> Result<(), String> {
    let name = e.local_name();
    if RESOURCES.contains(&name.as_ref()) {
        part.resources.insert(index(e, b"id")?);
    }
    match name.as_ref() {
        b"model" => {
            part.has_model = true;
            check_extensions(e)?;
            if let Some(unit) = attribute(e, b"unit")? {
                part.unit_mm = unit_mm(&unit)?;
            }
        }
        b"object" => {
            let id = index(e, b"id")?;
            if !part.ids.insert(id) {
                return Err(format!("two objects have the id {id}"));
            }
            properties(part, e, id)?;
            part.objects.push(XmlObject {
                id,
                no_body: match attribute(e, b"type")? {
                    Some(word) => no_body(&word)?,
                    None => None,
                },
                name: attribute(e, b"name")?.unwrap_or_default(),
                mesh: TriMesh::default(),
                components: Vec::new(),
            });
        }
        b"vertex" => {
            if let Some(object) = part.objects.last_mut() {
                let p = DVec3::new(number(e, b"x")?, number(e, b"y")?, number(e, b"z")?);
                object.mesh.vertices.push(p);
            }
        }
        b"triangle" => {
            if let Some(object) = part.objects.last_mut() {
                let face = [index(e, b"v1")?, index(e, b"v2")?, index(e, b"v3")?];
                object.mesh.faces.push(face.map(VertexId));
                let id = object.id;
                properties(part, e, id)?;
            }
        }
        b"component" => {
            let instance = instance(e)?;
            if let Some(object) = part.objects.last_mut() {
                object.components.push(instance);
            }
        }
        b"item" => part.items.push(instance(e)?),
        b"beam" => part.beams = true,
        _ => {}
    }
    Ok(())
}

/// Elements that objects and triangles may name as their properties.
const RESOURCES: [&[u8]; 5] = [
    b"basematerials",
    b"colorgroup",
    b"texture2dgroup",
    b"compositematerials",
    b"multiproperties",
];

/// Notes the group of properties that an element of an object names.
fn properties(part: &mut ModelPart, e: &BytesStart, object: u32) -> Result<(), String> {
    if attribute(e, b"pid")?.is_some() {
        part.properties.entry(index(e, b"pid")?).or_insert(object);
    }
    Ok(())
}

/// Triangles may only come after all vertices of their mesh, so they are checked when it ends.
fn close(part: &ModelPart, name: &[u8]) -> Result<(), String> {
    let Some(object) = part.objects.last().filter(|_| name == b"object") else {
        return Ok(());
    };
    let count = object.mesh.vertices.len();
    let bad = object.mesh.faces.iter().flatten().find(|v| v.at() >= count);
    match bad {
        Some(VertexId(v)) => Err(format!(
            "object {}: a triangle uses vertex {v}, but there are {count} vertices (counted from 0)",
            object.id
        )),
        None => Ok(()),
    }
}

/// What an object of this type is, if it is no body.
fn no_body(word: &str) -> Result<Option<&'static str>, String> {
    Ok(match word {
        "model" | "surface" => None,
        "support" => Some("type support"),
        "solidsupport" => Some("type solidsupport"),
        "other" => Some("type other"),
        _ => {
            return Err(format!(
                "an object of the unknown type `{}`; model, surface, support, solidsupport or other wanted",
                excerpt(word.as_bytes())
            ));
        }
    })
}

/// Namespaces of extensions that a model may need: those that are read (production), those that add no surface (materials, sets of
/// triangles), and the names of some others.
const READ: [&str; 3] = ["/production/", "/material/", "/trianglesets/"];
const KNOWN: [(&str, &str); 6] = [
    ("/beamlattice/", "beam lattice"),
    ("/slice/", "slice"),
    ("/securecontent/", "secure content"),
    ("/volumetric/", "volumetric"),
    ("/booleanoperations/", "boolean operations"),
    ("/displacement/", "displacement"),
];

/// # Errors
/// If the model cannot be read without an extension that is not known here.
fn check_extensions(e: &BytesStart) -> Result<(), String> {
    let needed = attribute(e, b"requiredextensions")?.unwrap_or_default();
    for prefix in needed.split_ascii_whitespace() {
        let namespace = attribute(e, prefix.as_bytes())?.unwrap_or_default();
        if READ.iter().any(|r| namespace.contains(r)) {
            continue;
        }
        let known = KNOWN.iter().find(|(part, _)| namespace.contains(part));
        let name = match known {
            Some((_, name)) => format!("the {name} extension"),
            None => format!("the extension `{}`", excerpt(prefix.as_bytes())),
        };
        return Err(format!(
            "the model needs {name} of 3MF, which is not read: save it as triangles (STL)"
        ));
    }
    Ok(())
}

fn instance(e: &BytesStart) -> Result<Instance, String> {
    Ok(Instance {
        object: index(e, b"objectid")?,
        part: attribute(e, b"path")?,
        transform: match attribute(e, b"transform")? {
            Some(text) => transform(&text)?,
            None => DMat4::IDENTITY,
        },
    })
}

/// Twelve numbers, three for each axis and three for the origin.
fn transform(text: &str) -> Result<DMat4, String> {
    let mut m = [0.0; 12];
    let mut words = text.split_ascii_whitespace();
    for value in &mut m {
        let word = words.next().unwrap_or_default();
        *value = coordinate(word.as_bytes())
            .map_err(|why| format!("a transform with a value that is {why}"))?;
    }
    if words.next().is_some() {
        return Err("a transform with more than 12 values".to_owned());
    }
    let column = |k: usize, w: f64| DVec4::new(m[k], m[k + 1], m[k + 2], w);
    Ok(DMat4::from_cols(
        column(0, 0.0),
        column(3, 0.0),
        column(6, 0.0),
        column(9, 1.0),
    ))
}

fn unit_mm(unit: &str) -> Result<f64, String> {
    Ok(match unit {
        "micron" => 0.001,
        "millimeter" => 1.0,
        "centimeter" => 10.0,
        "inch" => 25.4,
        "foot" => 304.8,
        "meter" => 1000.0,
        _ => return Err(format!("unknown unit `{}`", excerpt(unit.as_bytes()))),
    })
}

/// The value of an attribute by its local name, unescaped.
fn attribute(e: &BytesStart, name: &[u8]) -> Result<Option<String>, String> {
    for attribute in e.attributes() {
        let attribute = attribute.map_err(|e| format!("broken XML: {e}"))?;
        if attribute.key.local_name().as_ref() == name {
            let value = attribute
                .unescape_value()
                .map_err(|e| format!("broken XML: {e}"))?;
            return Ok(Some(value.into_owned()));
        }
    }
    Ok(None)
}

fn wanted(e: &BytesStart, name: &[u8]) -> Result<String, String> {
    attribute(e, name)?.ok_or_else(|| {
        let element = excerpt(e.local_name().as_ref());
        format!("a `{element}` without `{}`", excerpt(name))
    })
}

fn number(e: &BytesStart, name: &[u8]) -> Result<f64, String> {
    coordinate(wanted(e, name)?.trim_ascii().as_bytes())
        .map_err(|why| format!("a coordinate that is {why}"))
}

fn index(e: &BytesStart, name: &[u8]) -> Result<u32, String> {
    let text = wanted(e, name)?;
    text.trim_ascii()
        .parse()
        .map_err(|_| format!("not a whole number: `{}`", excerpt(text.as_bytes())))
}
