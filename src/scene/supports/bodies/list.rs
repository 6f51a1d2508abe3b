//! The scene's `supports`, one after the other, from entries to solids with layers.

use super::entry::BodyEntry;
use super::framed::FramedMesh;
use super::{groove, mesh, plates, stairs, wave};
use crate::geom::hull;
use crate::mesh::{DisjointSets, Edges, Solid, TriMesh};
use crate::scene::defaults;
use crate::scene::language::raw::RawSupport;
use crate::scene::request::ReadFile;
use crate::scene::supports::depths::{Wish, layer, settled_on_body};
use crate::scene::text::{Field, List, Reader};
use crate::support::{Face, Support, SupportKind};
use glam::DVec3;

/// All bodies that can be read; `depth` is what holds where they say nothing. Their names are numbered where there are several.
pub(crate) fn bodies(
    reader: &mut Reader,
    field: &Field<List<RawSupport>>,
    depth: &Wish,
    read: ReadFile,
) -> Vec<Support> {
    let Some((list, span)) = reader.given(field) else {
        return Vec::new();
    };
    let mut found: Vec<Support> = Vec::new();
    for item in list {
        let span = reader.span(item);
        let Some(raw) = reader.value(item) else {
            continue;
        };
        let entry = BodyEntry {
            span: &span,
            depth,
            read,
        };
        found.extend(supports(reader, raw, &entry));
    }
    if found.len() > defaults::MOST_BODIES {
        let text = format!(
            "{} supports; the limit is {}",
            found.len(),
            defaults::MOST_BODIES
        );
        reader.error(&span, text);
    }
    numbered(&mut found);
    found
}

/// Names that several have get numbers.
fn numbered(bodies: &mut [Support]) {
    let names: Vec<String> = bodies.iter().map(|b| b.name.clone()).collect();
    for (i, body) in bodies.iter_mut().enumerate() {
        let same = |n: &&String| **n == names[i];
        if names.iter().filter(same).count() > 1 {
            let number = names[..i].iter().filter(same).count() + 1;
            body.name = format!("{}-{number}", names[i]);
        }
    }
}

/// The supports of one entry, or none if anything is wrong with it.
fn supports(reader: &mut Reader, raw: &RawSupport, entry: &BodyEntry) -> Vec<Support> {
    let before = reader.problems.len();
    let forms = match raw {
        RawSupport::Plate(raw) => one(plates::plate(reader, raw, entry)),
        RawSupport::Strips(raw) => plates::strips(reader, raw, entry).unwrap_or_default(),
        RawSupport::Stairs(raw) => one(stairs::stairs(reader, raw, entry)),
        RawSupport::Groove(raw) => one(groove::groove(reader, raw, entry)),
        RawSupport::Wave(raw) => one(wave::wave(reader, raw, entry)),
        RawSupport::Mesh(raw) => one(mesh::mesh(reader, raw, entry)),
    };
    let supports: Vec<Support> = forms
        .into_iter()
        .filter_map(|form| support(reader, form, entry))
        .collect();
    let sound = reader.problems[before..].iter().all(|p| !p.is_error());
    if sound { supports } else { Vec::new() }
}

fn one<T>(found: Option<T>) -> Vec<T> {
    found.into_iter().collect()
}

/// In its frame, with its layer; an error if it is no solid.
fn support(reader: &mut Reader, form: FramedMesh, entry: &BodyEntry) -> Option<Support> {
    let wish = match reader.given(form.depth) {
        Some((own, at)) => layer(reader, own, &at, entry.depth),
        None => entry.depth.clone(),
    };
    let layer = settled_on_body(reader, form.flat, &wish, entry.span);
    let mesh = form.mesh.transformed(form.frame);
    if let Err(defects) = Solid::new(mesh.clone()) {
        let list: Vec<String> = defects.iter().take(3).map(ToString::to_string).collect();
        let text = format!("\"{}\" is no sound solid: {}", form.name, list.join("; "));
        reader.error(entry.span, text);
        return None;
    }
    let seen = mesh.vertices.iter().map(|v| v.truncate());
    Some(Support {
        kind: SupportKind::Body {
            outline: hull(seen.collect()),
            face: form.flat.then(|| Face {
                point: form.frame.transform_point3(DVec3::ZERO),
                normal: form.frame.transform_vector3(DVec3::Z),
            }),
            parts: match form.crease {
                Some(crease) => parts(&mesh, crease),
                None => vec![0; mesh.faces.len()],
            },
        },
        name: form.name,
        layer: Some(layer),
        mesh,
    })
}

/// Faces of a mesh in parts that meet at angles of more than `crease` radians; numbered by their first face.
fn parts(mesh: &TriMesh, crease: f64) -> Vec<u32> {
    let mut sets = DisjointSets::new(mesh.faces.len());
    for sides in Edges::new(mesh).iter().filter(|sides| sides.len() == 2) {
        let [f, g] = [sides[0].face, sides[1].face];
        let [a, b] = [f, g].map(|f| mesh.normal(f));
        if a.cross(b).length().atan2(a.dot(b)) <= crease {
            sets.join(f.0, g.0);
        }
    }
    sets.numbers().1
}
