//! The pillars of a scene and their base: listed, included from a layout file, or to be found.

use super::checks::{self, Eye};
use super::resolve::{Purpose, ReadFile};
use crate::planner::{Adjustment, Brief};
use crate::scene::language::raw::{RawAuto, RawForest, RawForestChoice, RawScene};
use crate::scene::layout::auto::{self, as_written};
use crate::scene::layout::included::{Included, included};
use crate::scene::layout::region::{self, Room};
use crate::scene::resolved::Printer;
use crate::scene::supports::bases;
use crate::scene::supports::bodies;
use crate::scene::supports::depths::{Wish, layer};
use crate::scene::supports::pillars::{Entry, Supports, some_entries};
use crate::scene::text::reader::{Reader, Span, error_at};
use crate::scene::text::spanned::Field;
use crate::support::Support;
use glam::DVec2;

/// What of the scene the pillars depend on.
pub struct Around<'a> {
    pub read: ReadFile<'a>,
    pub purpose: Purpose,
    pub printer: &'a Printer,
    /// Names of the views that could be read, and how many there should be.
    pub views: Vec<&'a str>,
    pub view_count: usize,
}

/// What the scene says of pillars and base.
#[derive(Default)]
pub struct Forest {
    supports: Supports,
    /// What is to be found or mended.
    brief: Option<Brief>,
    /// Where pillars are to be found.
    room: Option<Room>,
    /// Where listed pillars come from, if not from the scene's own text.
    included: Option<Included>,
    /// Supports that are no pillars.
    bodies: Vec<Support>,
}

/// Reads pillars, base and depth layers.
pub fn forest(reader: &mut Reader, raw: &RawScene, whole: &Span, around: &Around) -> Forest {
    let depth = match reader.given(&raw.depth) {
        Some((depth, span)) => layer(reader, depth, &span, &Wish::default()),
        None => Wish::default(),
    };
    let mut forest = Forest {
        bodies: bodies::bodies(reader, &raw.supports, &depth, around.read),
        ..Forest::default()
    };
    let others = matches!(raw.supports, Field::Given(_));
    if others && matches!(raw.pillars, Field::Missing) {
        // Bodies stand on a base only if there is one.
        if matches!(raw.base, Field::Given(_)) {
            let held: Vec<DVec2> = forest
                .bodies
                .iter()
                .flat_map(Support::outline)
                .copied()
                .collect();
            forest.supports.base = bases::base(reader, &raw.base, &held, None);
        }
        return forest;
    }
    let Some((pillars, span)) = reader.required(&raw.pillars, "pillars", "the scene", whole) else {
        forest.supports.base = bases::base(reader, &raw.base, &[], None);
        return forest;
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
                forest.included = file_of(reader, file, &span, &depth, around);
                let included = forest.included.as_mut();
                included.map(|i| std::mem::take(&mut i.entries))
            }
            None => None,
        },
    };
    forest.list(reader, raw, listed.unwrap_or_default(), &span, around);
    forest
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
) -> Forest {
    let depth = match reader.given(&auto.depth) {
        Some((own, at)) => layer(reader, own, &at, depth),
        None => depth.clone(),
    };
    let fixed = auto::fixed(reader, auto, &depth);
    let mut supports = Supports::of(fixed.iter().map(Entry::row));
    let given = reader.given(&auto.region);
    let room_span = given.as_ref().map_or(span, |(_, at)| at).clone();
    let given = given.map(|(raw, at)| region::region(reader, raw, &at));
    let loose = Some("the planned pillars".to_string());
    let region = match given {
        Some(region) => {
            let region = region.unwrap_or_default();
            let held = [region.clone(), supports.corners()].concat();
            supports.base = bases::base(reader, &raw.base, &held, loose);
            region
        }
        None if bases::has_size(&raw.base) => {
            supports.base = bases::base(reader, &raw.base, &[], loose);
            let base = supports.base.as_ref();
            base.map_or(Vec::new(), |b| region::on_base(reader, b, span))
        }
        None => {
            let region = region::usual();
            let held = [region.clone(), supports.corners()].concat();
            supports.base = bases::base(reader, &raw.base, &held, loose);
            region
        }
    };
    let (brief, spans) = auto::brief(reader, (auto, span), region, &fixed, &depth, around);
    // Without a region there is an error already, and nothing to check.
    let room = (!brief.region.outline().is_empty()).then(|| auto::room(&brief, &room_span, &spans));
    Forest {
        supports,
        brief: Some(brief),
        room,
        ..Forest::default()
    }
}

impl Forest {
    /// Pillars that are listed, put up on their base.
    fn list(
        &mut self,
        reader: &mut Reader,
        raw: &RawScene,
        entries: Vec<Entry>,
        span: &Span,
        around: &Around,
    ) {
        let mend = around.purpose == Purpose::Mend;
        let entries = match mend {
            true => entries.into_iter().map(as_written).collect(),
            false => entries,
        };
        self.supports = Supports::of(entries.iter().map(Entry::row));
        let (n, corners) = (self.supports.pillars.len(), self.supports.corners());
        let loose = (n > 1).then(|| format!("the {n} pillars"));
        let base = bases::base(reader, &raw.base, &corners, loose);
        if mend {
            let region = match &base {
                Some(base) => region::on_base(reader, base, span),
                None => region::around(&corners),
            };
            self.brief = Some(auto::mending(&entries, region, around));
        }
        self.supports.base = base;
    }

    /// Rules that join several values.
    pub fn check(&self, reader: &mut Reader, eyes: &[Eye], around: &Around) {
        let before = reader.problems.len();
        let checked = checks::Checked {
            pillars: &self.supports.pillars,
            base: self.supports.base.as_ref(),
            room: self.room.as_ref(),
            mend: around.purpose == Purpose::Mend,
        };
        checks::all(reader, &checked, eyes, around.printer);
        if let Some(included) = &self.included {
            let found = reader.problems.split_off(before);
            let told = found.into_iter().map(|p| included.told(p));
            reader.problems.extend(told);
        }
    }

    /// How many pillars there may be.
    pub fn most_pillars(&self) -> usize {
        match (&self.brief, &self.room) {
            (Some(brief), Some(_)) => brief.count[1],
            _ => self.supports.pillars.len(),
        }
    }

    /// How the models of every view are changed.
    pub fn adjusted(&self, views: &[&str]) -> Vec<Adjustment> {
        let list = self.included.as_ref().map_or(&[][..], |i| &i.adjust);
        let of = |view: &&str| list.iter().find(|(v, _)| v == view);
        let found = views.iter().map(of);
        found
            .map(|f| f.map_or(Adjustment::NONE, |(_, a)| *a))
            .collect()
    }

    /// Supports that are no pillars.
    pub fn bodies(&self) -> &[Support] {
        &self.bodies
    }

    /// The solids, and what is to be done about them.
    pub fn finished(self) -> (Vec<Support>, Option<Brief>) {
        let mut supports = self.supports.solids();
        supports.extend(self.bodies);
        (supports, self.brief)
    }
}
