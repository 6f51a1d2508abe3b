//! Where models stand: by matrix as written, or fitted to a size and turned towards the eye.

use crate::diag::Diagnostic;
use crate::mesh::TriMesh;
use crate::planner::Adjustment;
use crate::scene::defaults;
use crate::scene::language::raw::{RawFit, RawPlace};
use crate::scene::resolved::MakingWay;
use crate::scene::text::{Field, List, Reader, Span, error_at, short, warning_at};
use crate::view::PlacedModel;
use glam::{DMat3, DMat4, DVec2, DVec3};

/// How large a fitted model becomes, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Size {
    /// As the file has it.
    AsIs,
    Height(f64),
    /// Along the horizontal direction square to where the front looks.
    Width(f64),
    /// The longest of width, depth and height.
    Largest(f64),
}

/// A fitted model: everything but the eye it is turned to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fit {
    pub size: Size,
    /// Unit axes of the file.
    pub up: DVec3,
    pub front: DVec3,
    /// Where the front looks; `None`: to the eye.
    pub facing: Option<DVec2>,
    /// Radians, counter-clockwise seen from above.
    pub spin: f64,
    /// Where the middle of its underside goes.
    pub at: DVec3,
}

/// How a model is placed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Placing {
    Matrix(DMat4),
    Fit(Fit),
}

impl Placing {
    /// The same, looking along `way` where it would turn to an eye.
    pub(crate) fn or_facing(self, way: DVec2) -> Self {
        match self {
            Placing::Fit(fit) => Placing::Fit(Fit {
                facing: fit.facing.or(Some(way)),
                ..fit
            }),
            matrix => matrix,
        }
    }

    /// The matrix from the file's coordinates to millimetres for an eye.
    ///
    /// `unit` is millimetres per unit of the file. A matrix is taken as written: it includes the unit.
    pub(crate) fn matrix(&self, mesh: &TriMesh, unit: f64, eye: DVec3) -> DMat4 {
        match self {
            Placing::Matrix(matrix) => *matrix,
            Placing::Fit(fit) => fit.matrix(mesh, unit, (eye - fit.at).truncate()),
        }
    }

    /// The same for an eye at infinity, which in plan stands along `from`.
    pub(crate) fn facing(&self, mesh: &TriMesh, unit: f64, from: DVec2) -> DMat4 {
        match self {
            Placing::Matrix(matrix) => *matrix,
            Placing::Fit(fit) => fit.matrix(mesh, unit, from),
        }
    }
}

/// A side of a model below this share of its longest one is none: it cannot be made any size.
const FLAT: f64 = 1e-9;

impl Placing {
    /// An error if the model has no extent along what it is to be fitted by.
    pub(crate) fn no_extent(&self, name: &str, mesh: &TriMesh, span: &Span) -> Option<Diagnostic> {
        let Placing::Fit(fit) = self else { return None };
        let (lo, hi) = bounds(mesh, fit.turned())?;
        let extent = hi - lo;
        let (side, what) = match fit.size {
            Size::Height(_) => (extent.z, "height"),
            Size::Width(_) => (extent.x, "width"),
            _ => return None,
        };
        if side > FLAT * extent.max_element() {
            return None;
        }
        let [wide, deep, high] = extent.to_array().map(short);
        let message = format!(
            "model \"{name}\" has no {what} that could be fitted: as it stands it is {wide} wide, {deep} deep and {high} high, in units of its file"
        );
        let help = "turn it, as `up: \"y\"`, or fit another side, as `place: Fit(largest: 60)`";
        Some(error_at(span, message).help(help))
    }
}

impl Fit {
    /// From the file's axes to those of the upright model (x its left-right, -y its front, z up), with its spin.
    fn turned(&self) -> DMat3 {
        let upright =
            DMat3::from_cols((-self.front).cross(self.up), -self.front, self.up).transpose();
        DMat3::from_rotation_z(self.spin) * upright
    }

    /// `to_eye` is where the eye is in plan, as a direction.
    fn matrix(&self, mesh: &TriMesh, unit: f64, to_eye: DVec2) -> DMat4 {
        let Some((lo, hi)) = bounds(mesh, self.turned()) else {
            return DMat4::IDENTITY;
        };
        let extent = (hi - lo).max(DVec3::splat(1e-12));
        let scale = match self.size {
            Size::AsIs => unit,
            Size::Height(h) => h / extent.z,
            Size::Width(w) => w / extent.x,
            Size::Largest(l) => l / extent.max_element(),
        };
        let to_eye = self.facing.unwrap_or(to_eye);
        let to_eye = if to_eye.length() > 1e-9 {
            to_eye.normalize()
        } else {
            DVec2::NEG_Y
        };
        // Turns -y to the eye.
        let facing = DMat3::from_rotation_z(to_eye.perp().to_angle());
        let underside = DVec3::new((lo.x + hi.x) / 2.0, (lo.y + hi.y) / 2.0, lo.z);
        let turned = facing * self.turned();
        DMat4::from_translation(self.at - scale * (facing * underside))
            * DMat4::from_mat3(scale * turned)
    }
}

fn bounds(mesh: &TriMesh, turn: DMat3) -> Option<(DVec3, DVec3)> {
    let mut points = mesh.vertices.iter().map(|v| turn * *v);
    let first = points.next()?;
    Some(points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p))))
}

/// Reads a placing; a missing one fits the model as it is.
pub(crate) fn placing(
    reader: &mut Reader,
    field: &Field<RawPlace>,
) -> Option<(Placing, Option<Span>)> {
    let bare = RawFit::default();
    match reader.given(field) {
        None if matches!(field, Field::Given(_)) => None,
        None => Some((Placing::Fit(fit(reader, &bare)?), None)),
        Some((RawPlace::Fit(raw), span)) => Some((Placing::Fit(fit(reader, raw)?), Some(span))),
        Some((RawPlace::Matrix(rows), span)) => {
            Some((Placing::Matrix(matrix(reader, rows, &span)?), Some(span)))
        }
    }
}

fn fit(reader: &mut Reader, raw: &RawFit) -> Option<Fit> {
    let before = reader.problems.len();
    let size = size(reader, raw);
    let up = axis(reader, &raw.up, "up", defaults::UP);
    let front = axis(reader, &raw.front, "front", defaults::FRONT);
    let facing = reader.point_field(&raw.facing, "facing");
    let spin = reader
        .number(&raw.spin, "spin")
        .map_or(0.0, |(degrees, _)| degrees.to_radians());
    let at = reader
        .point_field(&raw.at, "at")
        .map_or(DVec3::ZERO, |(p, _)| p.into());
    if let Some((_, span)) = facing
        .as_ref()
        .filter(|(p, _)| DVec2::from(*p).length() < 1e-9)
    {
        reader.error(
            span,
            "`facing` is (0, 0); it must point somewhere in the ground plane",
        );
    }
    let (up, front) = (up?, front?);
    if up.0.dot(front.0).abs() > 0.5 {
        let span = front.1.or(up.1).unwrap_or(0..0);
        reader.error(
            &span,
            "`up` and `front` are the same axis of the file; they must be square to each other",
        );
    }
    let facing = facing.map(|(p, _)| p.into());
    (reader.problems.len() == before).then_some(Fit {
        size,
        up: up.0,
        front: front.0,
        facing,
        spin,
        at,
    })
}

fn size(reader: &mut Reader, raw: &RawFit) -> Size {
    let height = reader.positive_at(&raw.height, "height");
    let width = reader.positive_at(&raw.width, "width");
    let largest = reader.positive_at(&raw.largest, "largest");
    let sizes = [
        height.map(|(v, s)| (Size::Height(v), s)),
        width.map(|(v, s)| (Size::Width(v), s)),
        largest.map(|(v, s)| (Size::Largest(v), s)),
    ];
    let mut given = sizes.into_iter().flatten();
    let first = given.next().map_or(Size::AsIs, |(size, _)| size);
    if let Some((_, span)) = given.next() {
        reader.problems.push(
            error_at(
                &span,
                "a model is fitted to one size only: height, width or largest",
            )
            .label("a second size"),
        );
    }
    first
}

/// An axis of the file: `"z"`, `"+z"`, `"-y"`.
fn axis(
    reader: &mut Reader,
    field: &Field<String>,
    name: &str,
    default: &str,
) -> Option<(DVec3, Option<Span>)> {
    let (text, span) = match reader.given(field) {
        Some((text, span)) => (text.as_str(), Some(span)),
        None if matches!(field, Field::Given(_)) => return None,
        None => (default, None),
    };
    let axis = match text.trim_start_matches(['+', '-']).to_lowercase().as_str() {
        "x" => DVec3::X,
        "y" => DVec3::Y,
        "z" => DVec3::Z,
        _ => {
            let place = span.unwrap_or(0..0);
            reader.error(&place, format!("`{name}` must be an axis of the file: \"x\", \"-x\", \"y\", \"-y\", \"z\" or \"-z\""));
            return None;
        }
    };
    Some((if text.starts_with('-') { -axis } else { axis }, span))
}

/// A row-major affine matrix that can be undone.
fn matrix(reader: &mut Reader, list: &List<[f64; 4]>, span: &Span) -> Option<DMat4> {
    let given: Vec<[f64; 4]> = list
        .iter()
        .filter_map(|row| reader.value(row).copied())
        .collect();
    if given.len() < list.len() {
        return None;
    }
    let Ok(rows) = <[[f64; 4]; 4]>::try_from(given) else {
        reader.error(
            span,
            format!(
                "a placing matrix has four rows of four numbers, found {} rows",
                list.len()
            ),
        );
        return None;
    };
    if rows.iter().flatten().any(|v| !v.is_finite()) {
        reader.error(span, "the matrix has an entry that is not a finite number");
        return None;
    }
    if rows[3] != [0.0, 0.0, 0.0, 1.0] {
        reader.problems.push(
            error_at(span, "the last row of a placing matrix must be (0, 0, 0, 1)")
                .help("rows are written one after the other; the translation is the last number of each of the first three"),
        );
        return None;
    }
    let matrix = DMat4::from_cols_array_2d(&rows).transpose();
    let columns = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    let determinant = matrix.determinant();
    if columns == 0.0 || determinant.abs() < 1e-9 * columns {
        reader.error(
            span,
            "the matrix squeezes the model flat: its determinant is 0",
        );
        return None;
    }
    if determinant < 0.0 {
        reader.problems.push(warning_at(
            span,
            "the matrix mirrors the model: its determinant is negative",
        ));
    }
    Some(matrix)
}

/// Lowest and highest corner of the box around all models.
pub(crate) fn extent(models: &[PlacedModel]) -> Option<(DVec3, DVec3)> {
    let bounds = models.iter().filter_map(|m| m.mesh.bounds());
    bounds.reduce(|(l, h), (lo, hi)| (l.min(lo), h.max(hi)))
}

/// Changes the models of one view, all together about the middle of their underside.
pub(crate) fn adjust(models: &mut [PlacedModel], adjustment: &Adjustment) {
    let Some((lo, hi)) = extent(models).filter(|_| *adjustment != Adjustment::NONE) else {
        return;
    };
    let matrix = adjustment.matrix(((lo + hi) / 2.0).with_z(lo.z));
    for model in models {
        model.matrix = matrix * model.matrix;
        model.mesh = model.mesh.transformed(matrix);
    }
}

/// Warnings and errors about the size of a placed model.
pub(crate) fn size_suspicion(
    name: &str,
    mesh: &TriMesh,
    span: &Span,
    way: MakingWay,
) -> Option<Diagnostic> {
    let (lo, hi) = mesh.bounds()?;
    let largest = (hi - lo).max_element();
    let fit = "fit it: `place: Fit(largest: 60)`, or give its `units`";
    if largest > defaults::LARGEST {
        let message = format!(
            "model \"{name}\" is {} mm large in the scene; the limit is {} mm, as for all lengths",
            short(largest),
            short(defaults::LARGEST)
        );
        return Some(error_at(span, message).help(fit));
    }
    let say = |text: &str, help: &str| {
        let message = format!(
            "model \"{name}\" is {} mm large in the scene{text}",
            short(largest)
        );
        warning_at(span, message).help(help)
    };
    if largest < 2.0 {
        return Some(say(
            ": too small to be seen or printed",
            "saved in metres? add `units: m` to the model, or fit it: `place: Fit(largest: 60)`",
        ));
    }
    let too_large = way == MakingWay::Printed && largest > 1500.0;
    too_large.then(|| {
        say(": larger than any printer", fit)
            .help("or say that it is no print: `make: Built()`, `make: Milled()`")
    })
}
