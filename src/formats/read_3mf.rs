//! 3MF: the zip container and the putting together of its objects.
//!
//! Untrusted throughout: entries are inflated up to a cap only, no entry is ever written by its name, components may
//! neither form a cycle nor multiply without end. Objects that are no bodies (supports, and what slicers cut away or only use to
//! modify settings) are left out with a warning.

use crate::diag::{Diagnostic, Place, Warned};
use crate::formats::body::NamedMesh;
use crate::formats::slicer_3mf::{Aside, CONFIGS, NEGATIVE, PartOf, asides};
use crate::formats::text::excerpt;
use crate::formats::xml_3mf::{self, Instance, ModelPart, XmlObject};
use crate::mesh::Attributes;
use crate::mesh::weld::{drop_unreferenced, retain_faces};
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
/// Parts left out that a warning names one by one.
const MAX_NAMED: usize = 8;

/// The bodies of the build, in place, in millimetres.
///
/// # Errors
/// A broken container, no model, forbidden XML, or objects that cannot be put together.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Warned<Vec<NamedMesh>>, Diagnostic> {
    let of_file = |why: String| Diagnostic::error(why).at(Place::File(file.to_owned()));
    let mut container = Container::open(bytes).map_err(of_file)?;
    let root = container.model_part().map_err(of_file)?;
    let mut warnings = Vec::new();
    let asides = container.asides(|why| {
        warnings.push(Diagnostic::warning(why).at(Place::File(file.to_owned())));
    });
    let mut assembly = Assembly {
        file,
        container,
        parts: Vec::new(),
        bodies: Vec::new(),
        asides,
        root: 0,
        left_out: Vec::new(),
        instances: 0,
        triangles: 0,
    };
    let root = assembly.part(&root)?;
    assembly.root = root;
    assembly.drop_volumes();
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
    if assembly.parts.iter().any(|(_, part)| part.beams) {
        let message = "the beams of a lattice are not read: only triangles are";
        warnings.push(Diagnostic::warning(message).at(Place::File(file.to_owned())));
    }
    let missing = assembly
        .parts
        .iter()
        .find_map(|(_, part)| part.missing_properties());
    if let Some((group, object)) = missing {
        let message = format!(
            "object {object} names the properties {group} (`pid`), which the file does not have; no materials or colours are read"
        );
        warnings.push(Diagnostic::warning(message).at(Place::File(file.to_owned())));
    }
    let left_out = assembly.left_out();
    if assembly.bodies.is_empty() {
        let why = "the file has no triangles".to_owned();
        return Err(of_file(match &left_out {
            Some(left_out) => format!("{why} of bodies: {}", left_out.message),
            None => why,
        }));
    }
    warnings.extend(left_out);
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

    /// The part that the package's relations name as the model, or the usual one where they name none.
    fn model_part(&mut self) -> Result<String, String> {
        let mut named = match self.entry("_rels/.rels") {
            Some(rels) => models(&self.inflate(&rels)?)?,
            None => Vec::new(),
        };
        named.dedup();
        let path = match &named[..] {
            [] => "3D/3dmodel.model",
            [path] => path,
            [a, b, ..] => {
                let [a, b] = [a, b].map(|p| excerpt(p.as_bytes()));
                return Err(format!(
                    "the archive names several parts as its model, `{a}` and `{b}`; one wanted"
                ));
            }
        };
        self.entry(path).ok_or_else(|| match named.is_empty() {
            true => "the archive has no model part (3D/3dmodel.model)".to_owned(),
            false => format!(
                "the archive names `{}` as its model, but does not hold it",
                excerpt(path.as_bytes())
            ),
        })
    }

    /// Parts of objects that are no bodies, by what slicers write; what cannot be read of that is passed to `warn`.
    fn asides(&mut self, mut warn: impl FnMut(String)) -> Vec<Aside> {
        let mut all = Vec::new();
        for path in CONFIGS {
            let Some(entry) = self.entry(path) else {
                continue;
            };
            match self.inflate(&entry).and_then(|bytes| asides(&bytes)) {
                Ok(found) => all.extend(found),
                Err(why) => warn(format!(
                    "`{path}` in the archive is not used, so that parts which cut away look like bodies: {why}"
                )),
            }
        }
        all
    }
}

/// The targets of all relations whose type is the 3D model.
///
/// # Errors
/// One that lies outside of the archive: nothing is fetched from anywhere.
fn models(rels: &[u8]) -> Result<Vec<String>, String> {
    let mut reader = quick_xml::Reader::from_reader(rels);
    let mut found = Vec::new();
    while let Ok(event) = reader.read_event() {
        match event {
            Event::Start(e) | Event::Empty(e) if e.local_name().as_ref() == b"Relationship" => {
                let value = |name: &str| {
                    let attribute = e.try_get_attribute(name).ok()??;
                    attribute
                        .unescape_value()
                        .ok()
                        .map(std::borrow::Cow::into_owned)
                };
                if value("Type").is_some_and(|t| t.ends_with("/3dmodel")) {
                    let target = value("Target").unwrap_or_default();
                    if value("TargetMode").is_some_and(|mode| mode.eq_ignore_ascii_case("external"))
                    {
                        let target = excerpt(target.as_bytes());
                        return Err(format!("the model lies outside of the archive: `{target}`"));
                    }
                    found.push(target);
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    Ok(found)
}

/// Parts read so far and bodies made of them.
struct Assembly<'a> {
    file: &'a str,
    container: Container<'a>,
    parts: Vec<(String, ModelPart)>,
    bodies: Vec<NamedMesh>,
    asides: Vec<Aside>,
    /// The part that [`Assembly::asides`] speak of.
    root: usize,
    /// Names of what was left out and what that is, each once.
    left_out: Vec<(String, &'static str)>,
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
        if let Some(what) = object.no_body {
            let name = named(&object.name, || format!("object {id}"));
            self.leave_out(name, what);
            return Ok(());
        }
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
            if !self.stands_aside(part, id, component.object) {
                self.add(part, component, matrix, &name, depth + 1)?;
            }
        }
        Ok(())
    }

    /// Takes volumes that are no bodies out of the objects of the root part.
    fn drop_volumes(&mut self) {
        let mut left_out = Vec::new();
        for object in &mut self.parts[self.root].1.objects {
            // How many volumes begin or end at each triangle.
            let mut steps = vec![0i64; object.mesh.faces.len() + 1];
            let of_object = self.asides.iter().filter(|a| a.object == object.id);
            for aside in of_object {
                let PartOf::Faces(first, last) = aside.of else {
                    continue;
                };
                if first > last || last >= object.mesh.faces.len() {
                    continue;
                }
                steps[first] += 1;
                steps[last + 1] -= 1;
                let id = object.id;
                let name = named(&aside.name, || format!("a volume of object {id}"));
                left_out.push((name, aside.role));
            }
            let mut inside = 0;
            let is_body = |step: &i64| {
                inside += step;
                inside == 0
            };
            let kept: Vec<bool> = steps
                .iter()
                .map(is_body)
                .take(object.mesh.faces.len())
                .collect();
            if retain_faces(&mut object.mesh, &kept) > 0 {
                drop_unreferenced(&mut object.mesh);
            }
        }
        for (name, role) in left_out {
            self.leave_out(name, role);
        }
    }

    /// Whether a slicer says that a component of an object is no body; notes it then.
    fn stands_aside(&mut self, part: usize, object: u32, component: u32) -> bool {
        let is_it = |a: &&Aside| a.object == object && a.of == PartOf::Component(component);
        let found = self.asides.iter().find(is_it);
        let Some(aside) = found.filter(|_| part == self.root) else {
            return false;
        };
        let name = named(&aside.name, || {
            format!("part {component} of object {object}")
        });
        let role = aside.role;
        self.leave_out(name, role);
        true
    }

    fn leave_out(&mut self, name: String, what: &'static str) {
        if !self.left_out.iter().any(|(n, w)| (n, *w) == (&name, what)) {
            self.left_out.push((name, what));
        }
    }

    /// A warning that names what was left out.
    fn left_out(&self) -> Option<Diagnostic> {
        if self.left_out.is_empty() {
            return None;
        }
        let shown = self.left_out.iter().take(MAX_NAMED);
        let mut list: Vec<String> = shown
            .map(|(name, what)| format!("{name} ({what})"))
            .collect();
        if self.left_out.len() > MAX_NAMED {
            list.push(format!("{} more", self.left_out.len() - MAX_NAMED));
        }
        let message = format!("left out what is no body: {}", list.join(", "));
        let warning = Diagnostic::warning(message).at(Place::File(self.file.to_owned()));
        Some(match self.left_out.iter().any(|(_, what)| *what == NEGATIVE) {
            true => warning.help(
                "what it would cut away is still there: to have it cut, export the plate as STL from the slicer",
            ),
            false => warning,
        })
    }
}

fn named(name: &str, or: impl FnOnce() -> String) -> String {
    match name.is_empty() {
        true => or(),
        false => format!("`{}`", excerpt(name.as_bytes())),
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
