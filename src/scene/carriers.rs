//! All that carries reliefs: pillars on their base, listed, included from a layout file or to be found, and other supports.

use super::checks;
use super::language::raw::{RawAuto, RawForest, RawForestChoice, RawScene};
use super::layout::included::{Included, included};
use super::layout::{Around, Room, as_written, auto, region};
use super::request::Purpose;
use super::supports::bases::{base, has_size};
use super::supports::bodies::bodies;
use super::supports::depths::{Wish, layer};
use super::supports::pillars::{Colonnade, PillarEntry, some_entries};
use super::text::{Field, Reader, Span, error_at};
use super::views::Eye;
use crate::planner::{Adjustment, Brief};
use crate::support::Support;
use glam::DVec2;

/// What the scene says of pillars, base and other supports.
#[derive(Default)]
pub(crate) struct Carriers {
    colonnade: Colonnade,
    /// What is to be found or mended.
    brief: Option<Brief>,
    /// Where pillars are to be found.
    room: Option<Room>,
    /// Where listed pillars come from, if not from the scene's own text.
    included: Option<Included>,
    /// Supports that are no pillars.
    bodies: Vec<Support>,
}

/// Reads pillars, base, other supports and depth layers.
pub(crate) fn carriers(
    reader: &mut Reader,
    raw: &RawScene,
    scene_span: &Span,
    around: &Around,
) -> Carriers {
    let depth = match reader.given(&raw.depth) {
        Some((depth, span)) => layer(reader, depth, &span, &Wish::default()),
        None => Wish::default(),
    };
    let mut carriers = Carriers {
        bodies: bodies(reader, &raw.supports, &depth, around.read),
        ..Carriers::default()
    };
    let others = matches!(raw.supports, Field::Given(_));
    if others && matches!(raw.pillars, Field::Missing) {
        carriers.stand_bodies(reader, raw);
        return carriers;
    }
    let pillars = reader.required(&raw.pillars, "pillars", "the scene", scene_span);
    let Some((pillars, span)) = pillars else {
        carriers.colonnade.base = base(reader, &raw.base, &[]);
        return carriers;
    };
    let found = around.purpose == Purpose::Mend
        || matches!(pillars, RawForest::Choice(c) if matches!(&c.value, Ok(RawForestChoice::Auto(_))));
    if others && found {
        let text = "layouts of pillars are found and mended without other `supports`: these are not looked at";
        reader.problems.push(error_at(&span, text).help(
            "list the pillars, or keep them in a layout file that was found without the supports",
        ));
    }
    let listed = match pillars {
        RawForest::List(list) => reader
            .value(list)
            .map(|list| some_entries(reader, list, &span, &depth)),
        RawForest::Choice(choice) => match reader.value(choice) {
            Some(RawForestChoice::Auto(auto)) => {
                return planned(reader, raw, (auto, &span), &depth, around);
            }
            Some(RawForestChoice::File(file)) => {
                carriers.included = file_of(reader, file, &span, &depth, around);
                let included = carriers.included.as_mut();
                included.map(|i| std::mem::take(&mut i.entries))
            }
            None => None,
        },
    };
    carriers.list(reader, raw, listed.unwrap_or_default(), &span, around);
    carriers
}

fn file_of(
    reader: &mut Reader,
    file: &str,
    span: &Span,
    depth: &Wish,
    around: &Around,
) -> Option<Included> {
    let bytes = reader.read((around.read)(file), span)?;
    included(reader, file, bytes, depth, around)
}

/// Pillars that are to be found.
fn planned(
    reader: &mut Reader,
    raw: &RawScene,
    (auto, span): (&RawAuto, &Span),
    depth: &Wish,
    around: &Around,
) -> Carriers {
    let depth = match reader.given(&auto.depth) {
        Some((own, at)) => layer(reader, own, &at, depth),
        None => depth.clone(),
    };
    let fixed = auto::fixed(reader, auto, &depth);
    let mut colonnade = Colonnade::of(fixed.iter().map(PillarEntry::batch));
    let given = reader.given(&auto.region);
    let room_span = given.as_ref().map_or(span, |(_, at)| at).clone();
    let given = given.map(|(raw, at)| region::region(reader, raw, &at));
    let region = match given {
        Some(region) => {
            let region = region.unwrap_or_default();
            let held = [region.clone(), colonnade.corners()].concat();
            colonnade.base = base(reader, &raw.base, &held);
            region
        }
        None if has_size(&raw.base) => {
            colonnade.base = base(reader, &raw.base, &[]);
            let base = colonnade.base.as_ref();
            base.map_or(Vec::new(), |b| region::on_base(reader, b, span))
        }
        None => {
            let region = region::usual();
            let held = [region.clone(), colonnade.corners()].concat();
            colonnade.base = base(reader, &raw.base, &held);
            region
        }
    };
    let (brief, spans) = auto::brief(reader, (auto, span), region, &fixed, &depth, around);
    // Without a region there is an error already, and nothing to check.
    let room = (!brief.region.outline().is_empty()).then(|| auto::room(&brief, &room_span, &spans));
    Carriers {
        colonnade,
        brief: Some(brief),
        room,
        ..Carriers::default()
    }
}

impl Carriers {
    /// Bodies stand on a base only if there is one.
    fn stand_bodies(&mut self, reader: &mut Reader, raw: &RawScene) {
        if matches!(raw.base, Field::Given(_)) {
            let outlines = self.bodies.iter().flat_map(Support::outline);
            let held: Vec<DVec2> = outlines.copied().collect();
            self.colonnade.base = base(reader, &raw.base, &held);
        }
    }

    /// Pillars that are listed, put up on their base.
    fn list(
        &mut self,
        reader: &mut Reader,
        raw: &RawScene,
        entries: Vec<PillarEntry>,
        span: &Span,
        around: &Around,
    ) {
        let mend = around.purpose == Purpose::Mend;
        let entries = match mend {
            true => entries.into_iter().map(as_written).collect(),
            false => entries,
        };
        self.colonnade = Colonnade::of(entries.iter().map(PillarEntry::batch));
        let corners = self.colonnade.corners();
        let base = base(reader, &raw.base, &corners);
        if mend {
            let region = match &base {
                Some(base) => region::on_base(reader, base, span),
                None => region::around(&corners),
            };
            self.brief = Some(auto::mending(&entries, region, around));
        }
        self.colonnade.base = base;
    }

    /// Rules that join several values.
    pub(crate) fn check(&self, reader: &mut Reader, eyes: &[Eye], around: &Around) {
        let before = reader.problems.len();
        let checked = checks::Checked {
            pillars: &self.colonnade.pillars,
            base: self.colonnade.base.as_ref(),
            room: self.room.as_ref(),
            mend: around.purpose == Purpose::Mend,
        };
        checks::all(reader, &checked, eyes, around.making);
        if let Some(included) = &self.included {
            let found = reader.problems.split_off(before);
            let told = found.into_iter().map(|p| included.told(p));
            reader.problems.extend(told);
        }
    }

    /// How many pillars there may be.
    pub(crate) fn most_pillars(&self) -> usize {
        match (&self.brief, &self.room) {
            (Some(brief), Some(_)) => brief.count[1],
            _ => self.colonnade.pillars.len(),
        }
    }

    /// How the models of every view are changed.
    pub(crate) fn adjusted(&self, views: &[&str]) -> Vec<Adjustment> {
        let list = self.included.as_ref().map_or(&[][..], |i| &i.adjust);
        let of = |view: &&str| list.iter().find(|(v, _)| v == view);
        let found = views.iter().map(of);
        found
            .map(|f| f.map_or(Adjustment::NONE, |(_, a)| *a))
            .collect()
    }

    /// Supports that are no pillars.
    pub(crate) fn bodies(&self) -> &[Support] {
        &self.bodies
    }

    /// The solids, and what is to be done about them.
    pub(crate) fn finished(self) -> (Vec<Support>, Option<Brief>) {
        let mut supports = self.colonnade.solids();
        supports.extend(self.bodies);
        (supports, self.brief)
    }
}
