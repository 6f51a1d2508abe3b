//! Regions of models: vertices that count more or less than others, or are free of depth bounds.
//!
//! Regions are given in the coordinates of the model's file, as every mesh editor and `inspect` show them, so that they stay
//! where they are on the model however it is fitted, turned to an eye or moved by a layout.

use crate::diag::Diagnostic;
use crate::intake;
use crate::scene::defaults;
use crate::scene::language::raw::{RawModelRegion, RawVolume};
use crate::scene::text::{
    Field, List, Reader, Span, error_at, nearest, printable, short, warning_at,
};
use crate::view::Marks;
use glam::DVec3;

/// Part of a model, in its file's coordinates.
#[derive(Clone, Debug, PartialEq)]
enum Volume {
    Box { least: DVec3, most: DVec3 },
    Ball { centre: DVec3, radius: f64 },
    Painted(String),
}

/// A region as the scene describes it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MarkedRegion {
    volume: Volume,
    weight: f64,
    free: bool,
    /// Of the volume.
    span: Span,
}

/// A painted value above this is inside, where only inside or outside matters.
const INSIDE: f64 = 0.5;

/// What a scene says of a model's regions; those that are wrong are noted and left out.
pub(crate) fn regions(
    reader: &mut Reader,
    field: &Field<List<RawModelRegion>>,
) -> Vec<MarkedRegion> {
    let Some((list, span)) = reader.given(field) else {
        return Vec::new();
    };
    if list.len() > defaults::MOST_REGIONS {
        let limit = defaults::MOST_REGIONS;
        let message = format!("{} regions in one model; the limit is {limit}", list.len());
        reader.error(&span, message);
        return Vec::new();
    }
    let mut regions = Vec::new();
    for item in list {
        let span = reader.span(item);
        let found = reader
            .value(item)
            .and_then(|raw| region(reader, raw, &span));
        regions.extend(found);
    }
    regions
}

fn region(reader: &mut Reader, raw: &RawModelRegion, span: &Span) -> Option<MarkedRegion> {
    let shape = reader.required(&raw.shape, "shape", "this region", span);
    let weight = reader.within(&raw.weight, "weight", defaults::VERTEX_WEIGHTS);
    let free = reader.given(&raw.free).is_some_and(|(free, _)| *free);
    let (shape, at) = shape?;
    let volume = volume(reader, shape, &at)?;
    let nothing = weight.is_none() && !free && !matches!(volume, Volume::Painted(_));
    if nothing && matches!(raw.weight, Field::Missing) {
        let message = "this region changes nothing: it has neither a weight nor `free: true`";
        reader.problems.push(warning_at(span, message));
    }
    Some(MarkedRegion {
        volume,
        weight: weight.map_or(1.0, |(w, _)| w),
        free,
        span: at,
    })
}

fn volume(reader: &mut Reader, raw: &RawVolume, span: &Span) -> Option<Volume> {
    match raw {
        RawVolume::Box(raw) => {
            let from = place(reader, &raw.from, "from", "this Box", span);
            let to = place(reader, &raw.to, "to", "this Box", span);
            let (from, to) = (from?, to?);
            Some(Volume::Box {
                least: from.min(to),
                most: from.max(to),
            })
        }
        RawVolume::Ball(raw) => {
            let centre = place(reader, &raw.centre, "centre", "this Ball", span);
            reader.need(&raw.radius, "radius", "this Ball", span);
            let (radius, at) = reader.number(&raw.radius, "radius")?;
            if radius <= 0.0 {
                reader.error(&at, format!("`radius` is {radius}; it must be more than 0"));
                return None;
            }
            Some(Volume::Ball {
                centre: centre?,
                radius,
            })
        }
        RawVolume::Painted(name) => Some(Volume::Painted(name.clone())),
    }
}

/// A point in the file's coordinates: neither in the scene's unit nor bounded by its size.
fn place(
    reader: &mut Reader,
    field: &Field<[f64; 3]>,
    name: &str,
    owner: &str,
    span: &Span,
) -> Option<DVec3> {
    let (point, at) = reader.required(field, name, owner, span)?;
    for value in point {
        reader.finite(*value, name, &at)?;
    }
    Some((*point).into())
}

/// What all regions together say of a model's vertices; `name` and `file` are for messages.
pub(crate) fn marks(
    reader: &mut Reader,
    regions: &[MarkedRegion],
    model: &intake::Admitted,
    name: &str,
    file: &str,
) -> Marks {
    let mut marks = Marks::default();
    let count = model.mesh.vertices.len();
    for region in regions {
        let share = match region.shares(model, file) {
            Ok(share) => share,
            Err(mut problem) => {
                problem.message = format!("model \"{name}\": {}", problem.message);
                reader.problems.push(problem);
                continue;
            }
        };
        if region.free {
            marks.free.resize(count, false);
            let inside = share.iter().map(|s| *s > INSIDE);
            marks.free.iter_mut().zip(inside).for_each(|(f, s)| *f |= s);
        }
        let painted = matches!(region.volume, Volume::Painted(_)) && !region.free;
        if region.weight == 1.0 && !painted {
            continue;
        }
        marks.weights.resize(count, 1.0);
        for (weight, share) in marks.weights.iter_mut().zip(share) {
            let factor = if painted {
                share * region.weight
            } else if share > INSIDE {
                region.weight
            } else {
                1.0
            };
            *weight *= factor;
        }
    }
    let (least, most) = defaults::VERTEX_WEIGHTS.into_inner();
    marks
        .weights
        .iter_mut()
        .for_each(|w| *w = w.clamp(least, most));
    marks
}

impl MarkedRegion {
    /// How far every vertex belongs to the region: 0 or 1, or as painted.
    ///
    /// # Errors
    /// A region without vertices, or an attribute that is not there or is no weight.
    fn shares(&self, model: &intake::Admitted, file: &str) -> Result<Vec<f64>, Diagnostic> {
        let points = &model.mesh.vertices;
        let (lo, hi) = model.mesh.bounds().unwrap_or_default();
        let within = |inside: &dyn Fn(&DVec3) -> bool, what: String| {
            let shares: Vec<f64> = points.iter().map(|p| f64::from(inside(p))).collect();
            if shares.contains(&1.0) {
                return Ok(shares);
            }
            let model = format!("{} to {}", written(lo), written(hi));
            Err(error_at(
                &self.span,
                format!("{what} holds no vertex: in its file the model goes from {model}"),
            )
            .help(
                "regions are in the coordinates and the unit of the model's file, before `place`",
            ))
        };
        match &self.volume {
            Volume::Box { least, most } => within(
                &|p| p.cmpge(*least).all() && p.cmple(*most).all(),
                format!("the box from {} to {}", written(*least), written(*most)),
            ),
            Volume::Ball { centre, radius } => within(
                &|p| p.distance(*centre) <= *radius,
                format!("the ball of {} around {}", short(*radius), written(*centre)),
            ),
            Volume::Painted(name) => self.painted(name, model, file),
        }
    }

    fn painted(
        &self,
        name: &str,
        model: &intake::Admitted,
        file: &str,
    ) -> Result<Vec<f64>, Diagnostic> {
        let original = &model.original;
        let shown = printable(name);
        let Some(values) = original.values(name, model.mesh.vertices.len()) else {
            let known = original.attributes.names();
            let known: Vec<String> = known.into_iter().map(printable).collect();
            let guess = nearest(name, known.iter().map(String::as_str))
                .map_or(String::new(), |g| format!(", did you mean \"{g}\"?"));
            let problem = error_at(
                &self.span,
                format!("its file has no attribute \"{shown}\"{guess}"),
            );
            return Err(problem.help(match known.is_empty() {
                true => format!("{file} has none; PLY keeps numbers of vertices by name, OBJ and PLY colours as red, green and blue"),
                false => format!("attributes of {file}: {}", known.join(", ")),
            }));
        };
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = format!("its values go from {} to {}", short(least), short(most));
        let limit = *defaults::VERTEX_WEIGHTS.end();
        let wrong = match self.free {
            true if most <= INSIDE => {
                format!("the attribute \"{shown}\" is nowhere above {INSIDE}: {range}")
            }
            false if least < 0.0 || most > limit => {
                format!(
                    "the attribute \"{shown}\" is no weight: {range}, weights from 0 to {limit}"
                )
            }
            _ => return Ok(values),
        };
        Err(error_at(&self.span, wrong))
    }
}

/// `(1, -2.5, 0)`.
fn written(p: DVec3) -> String {
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}
