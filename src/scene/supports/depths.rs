//! Depth layers: what the scene asks for, and what a pillar of some shape makes of it.

use super::shapes;
use crate::scene::defaults;
use crate::scene::language::raw::{RawDatum, RawDepth, RawOutline};
use crate::scene::text::{Reader, Span, error_at, short};
use crate::support::{Datum, Extent, Layer, SUNK_MM};
use glam::DVec2;

/// A depth layer as far as the scene gives it, millimetres.
#[derive(Clone, Default)]
pub(crate) struct Wish {
    /// Where the scene asks for it.
    span: Option<Span>,
    datum: Option<(Datum, &'static str)>,
    front: Option<f64>,
    back: Option<f64>,
    core: Option<f64>,
    hull: Option<bool>,
    through: Option<bool>,
}

impl Wish {
    /// The same for another text, in which it has no place.
    pub(crate) fn placeless(&self) -> Self {
        Self {
            span: None,
            ..self.clone()
        }
    }
}

/// What `raw` asks for; fields left out are taken from `under`.
pub(crate) fn layer(reader: &mut Reader, raw: &RawDepth, span: &Span, under: &Wish) -> Wish {
    let datum = reader.given(&raw.from).map(|(from, _)| match from {
        RawDatum::Axis => (Datum::Plane, "Axis"),
        RawDatum::Face => (Datum::Plane, "Face"),
        RawDatum::Surface => (Datum::Surface, "Surface"),
    });
    let hull = reader
        .given(&raw.outline)
        .map(|(outline, _)| *outline == RawOutline::OnSupport);
    let through = through(reader, raw);
    let mut length = |field, name, under| {
        reader
            .length_from(field, name, 0.0)
            .map(|(value, _)| value)
            .or(under)
    };
    let front = length(&raw.front, "front", under.front);
    let back = length(&raw.back, "back", under.back);
    let core = length(&raw.core, "core", under.core);
    if let (Some(front), Some(back)) = (front, back)
        && front + back < 0.05
    {
        reader.problems.push(
            error_at(
                span,
                format!(
                    "the depth layer is {} mm thick (front + back): no relief fits in",
                    short(front + back)
                ),
            )
            .help("a few millimetres are usual: (front: 5, back: 2)"),
        );
    }
    Wish {
        span: Some(span.clone()),
        datum: datum.or(under.datum),
        front,
        back,
        core,
        hull: hull.or(under.hull),
        through: through.or(under.through),
    }
}

/// Between which hits of rays with a support the layer lies: whether it goes through the wall behind the first.
fn through(reader: &mut Reader, raw: &RawDepth) -> Option<bool> {
    let (hits, at) = reader.given(&raw.hits)?;
    let through = match hits.0 {
        [1, 1] => Some(false),
        [1, 2] => Some(true),
        [from, to] => {
            let text = format!(
                "hits: ({from}, {to}): a relief behind other parts of its support would not be seen"
            );
            reader.problems.push(error_at(&at, text).help(
                "write `hits: (1, 1)`, around where rays first meet it, or `hits: (1, 2)`, from there through the wall behind",
            ));
            None
        }
    };
    if through == Some(true)
        && let Some((_, at)) = reader.given(&raw.back)
    {
        let text = "`back` plays no part with hits: (1, 2): the layer ends `core` before rays leave the wall";
        reader
            .problems
            .push(error_at(&at, text).help("leave `back` out, and say `core`"));
    }
    through
}

/// The layer of a body, of which a plane is known or not: defaults filled in. Whether it leaves the body standing is seen from the
/// eyes.
pub(crate) fn settled_on_body(reader: &mut Reader, flat: bool, wish: &Wish, entry: &Span) -> Layer {
    let span = wish.span.as_ref().unwrap_or(entry);
    let through = wish.through == Some(true);
    let usual = match flat && !through {
        true => Datum::Plane,
        false => Datum::Surface,
    };
    if through && wish.datum.is_some_and(|(datum, _)| datum == Datum::Plane) {
        let text = "hits: (1, 2) are counted along rays, and this layer is square to a plane";
        let help = "leave `from` out, or write `from: Surface`";
        reader.problems.push(error_at(span, text).help(help));
    }
    let known = |name: &str| name == "Surface" || (name == "Face" && flat);
    if let Some((_, name)) = wish.datum.filter(|(_, name)| !known(name)) {
        let (what, help) = match name {
            "Axis" => (
                "only pillars have an axis",
                "leave `from` out, or write `from: Surface`",
            ),
            _ => (
                "only plates and strips have one face",
                "leave `from` out: the layer then follows the surface",
            ),
        };
        reader
            .problems
            .push(error_at(span, format!("a layer from: {name} here: {what}")).help(help));
    }
    let back = wish.back.unwrap_or(defaults::ON_BODIES.back()).max(SUNK_MM);
    let datum = wish.datum.map_or(usual, |(datum, _)| datum);
    Layer {
        extent: match datum {
            Datum::Surface if through => Extent::Wall,
            _ => Extent::behind(datum, back),
        },
        front: wish.front.unwrap_or(defaults::ON_BODIES.front),
        core: wish.core.unwrap_or(defaults::ON_BODIES.core),
        hull: wish.hull.unwrap_or(defaults::ON_BODIES.hull),
    }
}

/// The layer of a pillar: defaults filled in; an error if it does not leave the pillar standing. `entry` is the pillars' place.
pub(crate) fn settled(
    reader: &mut Reader,
    profile: &[DVec2],
    round: bool,
    wish: &Wish,
    entry: &Span,
) -> Layer {
    let span = wish.span.as_ref().unwrap_or(entry);
    let reach = profile.iter().map(|p| p.length()).fold(0.0, f64::max);
    let width = shapes::narrowest(profile);
    if wish.datum.is_some_and(|(_, name)| name == "Face") {
        let text = "a layer from: Face here: pillars have no face";
        reader
            .problems
            .push(error_at(span, text).help("write `from: Axis` or `from: Surface`"));
    }
    if wish.through == Some(true) {
        let text =
            "hits: (1, 2) here: pillars are carved to `back` behind their axis or their surface";
        let help = "`hits` belong into the `depth` of supports that are no pillars";
        reader.problems.push(error_at(span, text).help(help));
    }
    let datum = wish
        .datum
        .map_or(defaults::LAYER.datum(), |(datum, _)| datum);
    let (room, of) = match (datum, round) {
        (Datum::Plane, true) => (reach, "the radius"),
        (Datum::Plane, false) => (width / 2.0, "half the width"),
        (Datum::Surface, _) => (width, "the width"),
    };
    let front = wish.front.unwrap_or(defaults::LAYER.front);
    let core = wish
        .core
        .unwrap_or(defaults::LAYER.core.min(defaults::CORE_SHARE * room));
    let back = wish
        .back
        .unwrap_or(defaults::LAYER.back().min(defaults::BACK_SHARE * room));
    if back + core > room + 1e-6 {
        let (back, core) = (short(back), short(core));
        reader.problems.push(
            error_at(span, format!("reliefs would cut the pillar through: back {back} mm + core {core} mm is more than {of}, {} mm", short(room)))
                .help(format!("thicker pillars, or a smaller `back` or `core` in `depth`: back + core <= {}", short(room))),
        );
    }
    Layer {
        extent: Extent::behind(datum, back),
        front,
        core,
        hull: wish.hull.unwrap_or(defaults::LAYER.hull),
    }
}
