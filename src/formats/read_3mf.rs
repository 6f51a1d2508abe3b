//! 3MF: the zip container and the putting together of its objects.
//!
//! Untrusted throughout: entries are inflated up to a cap only, no entry is ever written by its name, components may
//! neither form a cycle nor multiply without end.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::text::excerpt;
use crate::formats::xml_3mf::{self, Instance, ModelPart, XmlObject};
use crate::mesh::Attributes;
use glam::{DMat4, DVec3};
use quick_xml::events::Event;
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// Meshes as XML deflate to a tenth or a thirtieth; a bomb to a thousandth.
const MAX_RATIO: u64 = 120;
/// Room for small files, which may deflate better.
const ALWAYS_ALLOWED: u64 = 1 << 20;
/// Objects after all components are expanded (with or without a mesh of their own), and their triangles together.
const MAX_INSTANCES: usize = 10_000;
const MAX_TRIANGLES: usize = 20_000_000;
const MAX_COMPONENT_DEPTH: usize = 32;

/// The bodies of the build, in place, in millimetres.
///
/// # Errors
/// A broken container, no model, forbidden XML, or objects that cannot be put together.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Warned<Vec<NamedMesh>>, Diagnostic> {
    let of_file = |why: String| Diagnostic::error(why).at(Place::File(file.to_owned()));
    let mut container = Container::open(bytes).map_err(of_file)?;
    let root = container.model_part().map_err(of_file)?;
    let mut assembly = Assembly {
        file,
        container,
        parts: Vec::new(),
        bodies: Vec::new(),
        instances: 0,
        triangles: 0,
    };
    let root = assembly.part(&root)?;
    let mut warnings = Vec::new();
    let mut items = assembly.parts[root].1.items.clone();
    if items.is_empty() {
        let message = "the build is empty: all objects are taken";
        warnings.push(Diagnostic::warning(message).at(Place::File(file.to_owned())));
        let all = assembly.parts[root].1.objects.iter();
        items = all
            .map(|o| Instance {
                object: o.id,
                part: None,
                transform: DMat4::IDENTITY,
            })
            .collect();
    }
    for item in &items {
        assembly.add(root, item, DMat4::IDENTITY, "", 0)?;
    }
    if assembly.bodies.iter().all(|b| b.mesh.faces.is_empty()) {
        return Err(of_file("the file has no triangles".to_owned()));
    }
    Ok(Warned {
        value: assembly.bodies,
        warnings,
    })
}

/// The zip archive with its cap.
struct Container<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    cap: u64,
}

impl<'a> Container<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, String> {
        let archive = ZipArchive::new(Cursor::new(bytes))
            .map_err(|e| format!("not a readable zip archive, which a 3MF file is: {e}"))?;
        for name in archive.file_names() {
            let mut steps = name.split(['/', '\\']);
            let leaves = name.starts_with(['/', '\\'])
                || name.as_bytes().get(1) == Some(&b':')
                || steps.any(|step| step == "..");
            if leaves {
                let name = excerpt(name.as_bytes());
                return Err(format!(
                    "the archive has an entry that points out of it: `{name}`"
                ));
            }
        }
        Ok(Self {
            archive,
            cap: bytes.len() as u64 * MAX_RATIO + ALWAYS_ALLOWED,
        })
    }

    /// The name of an entry, in any case, with either slash, with or without a leading one.
    fn entry(&self, path: &str) -> Option<String> {
        let path = path.trim_start_matches('/');
        self.archive
            .file_names()
            .find(|name| name.replace('\\', "/").eq_ignore_ascii_case(path))
            .map(str::to_owned)
    }

    fn inflate(&mut self, entry: &str) -> Result<Vec<u8>, String> {
        let shown = excerpt(entry.as_bytes());
        let file = self
            .archive
            .by_name(entry)
            .map_err(|e| format!("`{shown}` in the archive cannot be read: {e}"))?;
        let mut bytes = Vec::new();
        file.take(self.cap + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| format!("`{shown}` in the archive cannot be read: {e}"))?;
        if bytes.len() as u64 > self.cap {
            return Err(format!(
                "`{shown}` in the archive inflates to more than {MAX_RATIO} times the file: refused as a zip bomb"
            ));
        }
        Ok(bytes)
    }

    /// The part that the package's relations name as the model, or the usual one.
    fn model_part(&mut self) -> Result<String, String> {
        let named = match self.entry("_rels/.rels") {
            Some(rels) => model_target(&self.inflate(&rels)?),
            None => None,
        };
        let candidates = [named.as_deref().unwrap_or_default(), "3D/3dmodel.model"];
        candidates
            .iter()
            .find_map(|path| self.entry(path))
            .ok_or_else(|| "the archive has no model part (3D/3dmodel.model)".to_owned())
    }
}

/// The target of the first relation whose type is the 3D model.
fn model_target(rels: &[u8]) -> Option<String> {
    let mut reader = quick_xml::Reader::from_reader(rels);
    loop {
        match reader.read_event().ok()? {
            Event::Start(e) | Event::Empty(e) if e.local_name().as_ref() == b"Relationship" => {
                let value = |name: &str| {
                    let attribute = e.try_get_attribute(name).ok()??;
                    attribute
                        .unescape_value()
                        .ok()
                        .map(std::borrow::Cow::into_owned)
                };
                if value("Type").is_some_and(|t| t.ends_with("/3dmodel")) {
                    return value("Target");
                }
            }
            Event::Eof => return None,
            _ => {}
        }
    }
}

/// Parts read so far and bodies made of them.
struct Assembly<'a> {
    file: &'a str,
    container: Container<'a>,
    parts: Vec<(String, ModelPart)>,
    bodies: Vec<NamedMesh>,
    instances: usize,
    triangles: usize,
}

impl Assembly<'_> {
    fn fail(&self, why: String) -> Diagnostic {
        Diagnostic::error(why).at(Place::File(self.file.to_owned()))
    }

    /// The number of a part, read when first asked for.
    fn part(&mut self, path: &str) -> Result<usize, Diagnostic> {
        let Some(entry) = self.container.entry(path) else {
            let why = format!("the archive has no part `{}`", excerpt(path.as_bytes()));
            return Err(self.fail(why));
        };
        if let Some(known) = self.parts.iter().position(|(name, _)| *name == entry) {
            return Ok(known);
        }
        let bytes = self
            .container
            .inflate(&entry)
            .map_err(|why| self.fail(why))?;
        let part = xml_3mf::parse(&bytes).map_err(|(offset, why)| {
            Diagnostic::error(why).at(Place::Byte {
                file: format!("{}:{}", self.file, excerpt(entry.as_bytes())),
                offset,
            })
        })?;
        self.parts.push((entry, part));
        Ok(self.parts.len() - 1)
    }

    /// Adds the meshes of an object and of its components; `outer` places the object it is a component of.
    fn add(
        &mut self,
        part: usize,
        instance: &Instance,
        outer: DMat4,
        name: &str,
        depth: usize,
    ) -> Result<(), Diagnostic> {
        let part = match &instance.part {
            Some(path) => self.part(path)?,
            None => part,
        };
        let id = instance.object;
        if depth > MAX_COMPONENT_DEPTH {
            return Err(self.fail(format!("components are nested more than {MAX_COMPONENT_DEPTH} deep, or in a cycle, at object {id}")));
        }
        let Some(object) = self.parts[part].1.objects.iter().find(|o| o.id == id) else {
            return Err(self.fail(format!("object {id} is used but does not exist")));
        };
        let matrix = outer * instance.transform;
        let name = if object.name.is_empty() {
            name.to_owned()
        } else {
            object.name.clone()
        };
        let components = object.components.clone();
        let triangles = object.mesh.faces.len();
        self.instances += 1;
        self.triangles += triangles;
        if self.instances > MAX_INSTANCES || self.triangles > MAX_TRIANGLES {
            return Err(self.fail(format!(
                "components multiply to more than {MAX_INSTANCES} objects or {MAX_TRIANGLES} triangles"
            )));
        }
        if triangles > 0 {
            let body = placed(object, matrix, self.parts[part].1.unit_mm, name.clone());
            if body.mesh.vertices.iter().any(|v| !v.is_finite()) {
                return Err(self.fail(format!(
                    "object {id} is placed at coordinates that are not finite"
                )));
            }
            self.bodies.push(body);
        }
        for component in &components {
            self.add(part, component, matrix, &name, depth + 1)?;
        }
        Ok(())
    }
}

fn placed(object: &XmlObject, matrix: DMat4, unit_mm: f64, name: String) -> NamedMesh {
    let scale = DMat4::from_scale(DVec3::splat(unit_mm));
    NamedMesh {
        name,
        mesh: object.mesh.transformed(scale * matrix),
        attributes: Attributes::default(),
    }
}
