//! Supports that are no pillars: plates, strips, stairs, grooves, waves and meshes.

use super::depths::{Wish, layer, settled_on_body};
use super::forms;
use super::heights;
use crate::geom::hull;
use crate::mesh::{Edges, Solid, TriMesh};
use crate::scene::defaults;
use crate::scene::language::raw::{
    RawBody, RawDepth, RawGroove, RawHeights, RawPlate, RawStairs, RawStrips, RawSupport, RawWave,
};
use crate::scene::models::placing;
use crate::scene::request::ReadFile;
use crate::scene::text::names;
use crate::scene::text::{Field, List, Reader, Span, error_at, placed, short};
use crate::support::{Face, Support, SupportKind};
use glam::{DMat4, DVec2, DVec3};

/// All bodies that can be read; `depth` is what holds where they say nothing. Their names are numbered where there are several.
pub fn bodies(
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
        let maker = Maker {
            span: &span,
            depth,
            read,
        };
        found.extend(maker.bodies(reader, raw));
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

/// One entry of `supports`.
struct Maker<'a> {
    span: &'a Span,
    depth: &'a Wish,
    read: ReadFile<'a>,
}

/// A mesh in a frame of its own, and what is said of it.
struct FramedMesh<'a> {
    name: String,
    mesh: TriMesh,
    frame: DMat4,
    /// Whether its face is the plane z = 0 of the frame.
    flat: bool,
    /// Radians: edges sharper than this part its surface, if any do.
    crease: Option<f64>,
    depth: &'a Field<RawDepth>,
}

impl<'a> FramedMesh<'a> {
    /// Neither flat nor in parts.
    fn plain(name: String, mesh: TriMesh, frame: DMat4, depth: &'a Field<RawDepth>) -> Self {
        Self {
            name,
            mesh,
            frame,
            flat: false,
            crease: None,
            depth,
        }
    }
}

/// Facets of one plane, but for rounding, radians.
const FLAT: f64 = 1e-6;

impl Maker<'_> {
    fn bodies(&self, reader: &mut Reader, raw: &RawSupport) -> Vec<Support> {
        let before = reader.problems.len();
        let forms = match raw {
            RawSupport::Plate(raw) => self.plate(reader, raw).into_iter().collect(),
            RawSupport::Strips(raw) => self.strips(reader, raw).unwrap_or_default(),
            RawSupport::Stairs(raw) => self.stairs(reader, raw).into_iter().collect(),
            RawSupport::Groove(raw) => self.groove(reader, raw).into_iter().collect(),
            RawSupport::Wave(raw) => self.wave(reader, raw).into_iter().collect(),
            RawSupport::Mesh(raw) => self.mesh(reader, raw).into_iter().collect::<Vec<_>>(),
        };
        let supports: Vec<Support> = forms
            .into_iter()
            .filter_map(|form| self.support(reader, form))
            .collect();
        let sound = reader.problems[before..].iter().all(|p| !p.is_error());
        if sound { supports } else { Vec::new() }
    }

    fn support(&self, reader: &mut Reader, form: FramedMesh) -> Option<Support> {
        let wish = match reader.given(form.depth) {
            Some((own, at)) => layer(reader, own, &at, self.depth),
            None => self.depth.clone(),
        };
        let layer = settled_on_body(reader, form.flat, &wish, self.span);
        let mesh = form.mesh.transformed(form.frame);
        if let Err(defects) = Solid::new(mesh.clone()) {
            let list: Vec<String> = defects.iter().take(3).map(ToString::to_string).collect();
            let text = format!("\"{}\" is no sound solid: {}", form.name, list.join("; "));
            reader.error(self.span, text);
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
                    Some(crease) => forms::parts(&mesh, crease),
                    None => vec![0; mesh.faces.len()],
                },
            },
            name: form.name,
            layer: Some(layer),
            mesh,
        })
    }

    fn plate<'r>(&self, reader: &mut Reader, raw: &'r RawPlate) -> Option<FramedMesh<'r>> {
        let name = self.name(reader, &raw.name, "plate");
        let [width, height] =
            self.sizes(reader, [(&raw.width, "width"), (&raw.height, "height")])?;
        let thickness = self.or(
            reader,
            &raw.thickness,
            "thickness",
            defaults::BODY_THICKNESS,
        )?;
        Some(FramedMesh {
            flat: true,
            ..FramedMesh::plain(
                name?,
                forms::plate(width, height, thickness),
                frame(reader, &raw.at, &raw.facing, &raw.lean)?,
                &raw.depth,
            )
        })
    }

    /// Plates side by side, from left to right as they are looked at, each turned against its neighbour about their common edge.
    fn strips<'r>(&self, reader: &mut Reader, raw: &'r RawStrips) -> Option<Vec<FramedMesh<'r>>> {
        let name = self.name(reader, &raw.name, "strip")?;
        reader.need(&raw.count, "count", "this row of strips", self.span);
        let (count, _) = reader.count(&raw.count, "count", 1..=100)?;
        let [width, height] =
            self.sizes(reader, [(&raw.width, "width"), (&raw.height, "height")])?;
        let thickness = self.or(
            reader,
            &raw.thickness,
            "thickness",
            defaults::BODY_THICKNESS,
        )?;
        let gap = match &raw.gap {
            Field::Missing => defaults::STRIP_GAP,
            field => reader.length_from(field, "gap", 0.0)?.0,
        };
        let turn = reader.turn(&raw.turn);
        let row = frame(reader, &raw.at, &raw.facing, &Field::Missing)?;
        // The middle of the row stays at `at`, and the middle strip looks along `facing`.
        let angle = |k: u32| turn * (f64::from(k) - f64::from(count - 1) / 2.0);
        let way = |k: u32| DVec2::from_angle(-angle(k));
        let step = |k: u32| (width + gap) * (way(k) + way(k + 1)) / 2.0;
        let mut middles = vec![DVec2::ZERO];
        (1..count).for_each(|k| middles.push(middles[k as usize - 1] + step(k - 1)));
        let n = count as usize;
        let middle = (middles[(n - 1) / 2] + middles[n / 2]) / 2.0;
        let strip = |k: u32| {
            let at = middles[k as usize] - middle;
            // In the frame x is to the right and z towards the viewer.
            let turned = DMat4::from_rotation_y(angle(k));
            let moved = DMat4::from_translation(DVec3::new(at.x, 0.0, at.y));
            FramedMesh {
                flat: true,
                ..FramedMesh::plain(
                    name.clone(),
                    forms::plate(width, height, thickness),
                    row * moved * turned,
                    &raw.depth,
                )
            }
        };
        Some((0..count).map(strip).collect())
    }

    fn stairs<'r>(&self, reader: &mut Reader, raw: &'r RawStairs) -> Option<FramedMesh<'r>> {
        let name = self.name(reader, &raw.name, "stairs");
        reader.need(&raw.steps, "steps", "this staircase", self.span);
        let steps = reader.count(&raw.steps, "steps", 1..=200);
        let [width] = self.sizes(reader, [(&raw.width, "width")])?;
        let [rise, going] = defaults::STEP;
        let rise = self.or(reader, &raw.rise, "rise", rise)?;
        let going = self.or(reader, &raw.going, "going", going)?;
        Some(FramedMesh {
            crease: Some(FLAT),
            ..FramedMesh::plain(
                name?,
                forms::stairs(steps?.0, width, rise, going),
                frame(reader, &raw.at, &raw.facing, &Field::Missing)?,
                &raw.depth,
            )
        })
    }

    fn groove<'r>(&self, reader: &mut Reader, raw: &'r RawGroove) -> Option<FramedMesh<'r>> {
        let name = self.name(reader, &raw.name, "groove");
        let sizes = [
            (&raw.width, "width"),
            (&raw.height, "height"),
            (&raw.opening, "opening"),
            (&raw.deep, "deep"),
        ];
        let [width, height, opening, deep] = self.sizes(reader, sizes)?;
        let usual = deep + defaults::BODY_THICKNESS;
        let thickness = self.or(reader, &raw.thickness, "thickness", usual)?;
        if opening > width || deep >= thickness {
            let text = format!(
                "the groove, {} mm wide and {} mm deep, is not inside its block of {} x {} mm",
                short(opening),
                short(deep),
                short(width),
                short(thickness)
            );
            reader.problems.push(
                error_at(self.span, text)
                    .help("keep `opening` <= `width` and `deep` < `thickness`"),
            );
            return None;
        }
        Some(FramedMesh::plain(
            name?,
            forms::groove(width, height, thickness, opening, deep),
            frame(reader, &raw.at, &raw.facing, &raw.lean)?,
            &raw.depth,
        ))
    }

    fn wave<'r>(&self, reader: &mut Reader, raw: &'r RawWave) -> Option<FramedMesh<'r>> {
        let name = self.name(reader, &raw.name, "wave");
        let [width, height] =
            self.sizes(reader, [(&raw.width, "width"), (&raw.height, "height")])?;
        let thickness = self.or(
            reader,
            &raw.thickness,
            "thickness",
            2.0 * defaults::BODY_THICKNESS,
        )?;
        let pitch = self.or(reader, &raw.pitch, "pitch", defaults::WAVE_PITCH)?;
        if (width / pitch + 1.0) * (height / pitch + 1.0) > defaults::MOST_WAVE_POINTS {
            let text = format!(
                "a grid of {} x {} points is too fine",
                (width / pitch).ceil(),
                (height / pitch).ceil()
            );
            reader
                .problems
                .push(error_at(self.span, text).help("a larger `pitch`"));
            return None;
        }
        let (raw_heights, at) = reader.required(&raw.heights, "heights", "this Wave", self.span)?;
        let field = match raw_heights {
            RawHeights::Formula(text) => heights::formula(reader, text, &at),
            RawHeights::Image(image) => {
                heights::image(reader, image, &at, [width, height], self.read)
            }
        }?;
        let mesh = forms::wave(width, height, thickness, pitch, field);
        let lowest = mesh.vertices[..mesh.vertices.len() / 2].iter().map(|v| v.z);
        let lowest = lowest.fold(f64::INFINITY, |low, z| {
            if z.is_finite() {
                low.min(z)
            } else {
                f64::NEG_INFINITY
            }
        });
        if lowest <= -thickness {
            let text = match lowest.is_finite() {
                true => format!(
                    "heights go down to {} mm, but the body behind is {} mm thick",
                    short(lowest),
                    short(thickness)
                ),
                false => "heights are not finite numbers everywhere".to_string(),
            };
            reader
                .problems
                .push(error_at(&at, text).help("a larger `thickness`, or other heights"));
            return None;
        }
        Some(FramedMesh::plain(
            name?,
            mesh,
            frame(reader, &raw.at, &raw.facing, &raw.lean)?,
            &raw.depth,
        ))
    }

    fn mesh<'r>(&self, reader: &mut Reader, raw: &'r RawBody) -> Option<FramedMesh<'r>> {
        let name = self.name(reader, &raw.name, "mesh");
        let (file, file_span) = reader.required(&raw.file, "file", "this Mesh", self.span)?;
        let unit = reader.given(&raw.units).map_or(1.0, |(u, _)| u.measure().0);
        let (placing, _) = placing::placing(reader, &raw.place)?;
        let crease = match &raw.creases {
            Field::Missing => None,
            field => Some(reader.within(field, "creases", defaults::CREASES)?.0),
        };
        let crease = crease.map(f64::to_radians);
        let loaded =
            (self.read)(file).and_then(|bytes| crate::intake::load_model(file, &bytes, false));
        let loaded = reader.read(loaded, &file_span)?;
        // Whether it is sound is found below: warnings with advice for models would only repeat it.
        let repairs = loaded.warnings.into_iter().filter(|w| w.help.is_empty());
        let repairs = repairs.map(|w| placed(w, &file_span));
        reader.problems.extend(repairs);
        // A support does not turn to an eye.
        let placing = placing.or_facing(defaults::FACING.into());
        let matrix = placing.matrix(&loaded.value, unit, DVec3::ZERO);
        let mesh = loaded.value.transformed(matrix);
        Some(FramedMesh {
            crease,
            ..FramedMesh::plain(
                name?,
                self.solid(reader, mesh, &raw.thickness, &file_span)?,
                DMat4::IDENTITY,
                &raw.depth,
            )
        })
    }

    /// The mesh itself if it is closed; otherwise what it is with some thickness behind its mean direction.
    fn solid(
        &self,
        reader: &mut Reader,
        mesh: TriMesh,
        thickness: &Field<f64>,
        span: &Span,
    ) -> Option<TriMesh> {
        let open = Edges::new(&mesh).iter().filter(|e| e.len() == 1).count();
        match (open, thickness) {
            (0, Field::Missing) => Some(mesh),
            (0, _) => {
                reader.error(
                    span,
                    "`thickness` is for meshes with a border; this one is closed",
                );
                None
            }
            (_, Field::Missing) => {
                let text = format!("the mesh is open: {open} edges have one face only");
                reader.problems.push(error_at(span, text).help(
                    "make it solid: `thickness: 5` goes on behind it, square to its mean direction",
                ));
                None
            }
            (_, field) => {
                let thickness = reader.positive(field, "thickness")?;
                let mean: DVec3 = (0..mesh.faces.len()).map(|f| mesh.area_vector(f)).sum();
                let Some(ahead) = mean.try_normalize() else {
                    reader.error(span, "the mesh looks to all sides alike: it has no behind");
                    return None;
                };
                Some(forms::thickened(&mesh, -thickness * ahead))
            }
        }
    }

    fn name(&self, reader: &mut Reader, field: &Field<String>, usual: &str) -> Option<String> {
        match reader.given(field) {
            Some((name, span)) => names::checked(reader, name, &span, "support"),
            None => Some(usual.to_string()),
        }
    }

    /// Lengths above zero that must be there.
    fn sizes<const N: usize>(
        &self,
        reader: &mut Reader,
        fields: [(&Field<f64>, &str); N],
    ) -> Option<[f64; N]> {
        for (field, name) in &fields {
            reader.need(field, name, "this support", self.span);
        }
        let found = fields.map(|(field, name)| reader.positive(field, name));
        let all: Option<Vec<f64>> = found.into_iter().collect();
        all?.try_into().ok()
    }

    /// A length above zero, or the usual one.
    fn or(&self, reader: &mut Reader, field: &Field<f64>, name: &str, usual: f64) -> Option<f64> {
        match field {
            Field::Missing => Some(usual),
            field => reader.positive(field, name),
        }
    }
}

/// Where a face stands and looks.
fn frame(
    reader: &mut Reader,
    at: &Field<[f64; 3]>,
    facing: &Field<[f64; 2]>,
    lean: &Field<f64>,
) -> Option<DMat4> {
    let at = reader
        .point_field(at, "at")
        .map_or(DVec3::ZERO, |(p, _)| p.into());
    let facing = match reader.point_field(facing, "facing") {
        Some((p, span)) => match DVec2::from(p).try_normalize() {
            Some(way) => way,
            None => {
                let text = "`facing` is (0, 0); it must point somewhere in the ground plane";
                reader.error(&span, text);
                return None;
            }
        },
        None => DVec2::from(defaults::FACING),
    };
    let lean = reader
        .within(lean, "lean", defaults::LEANS)
        .map_or(0.0, |(degrees, _)| degrees.to_radians());
    Some(forms::frame(at, facing, lean))
}
