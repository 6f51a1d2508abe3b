//! Whether the forest can be printed: walls, gaps, overhangs, slenderness, bed, loose parts, core.
//!
//! Takes the finished solid, its supports and the printer's measures; gives one [`PrintCheck`] for each question with the worst
//! place, what was measured there and what was wanted. Nothing is changed. The same solid gives the same figures on any number of
//! threads.
//!
//! # Wanted, and the limit
//!
//! `wanted_mm` is what prints without any loss, `limit_mm` where printing fails; `ok` tells on which side of the *limit* the value
//! lies, and the note what is lost in between. They differ where reliefs cannot help it: a surface that is cut along an eye's rays
//! and scaled back ends in lips as thin as one likes, and its pieces stand out from the pillar without anything below them. Slicers
//! blunt the first by a fraction of a millimetre and put supports under the second; neither makes a print fail.
//!
//! - `wall`: 2.25 nozzles wanted, the width of two printed lines that overlap; from 1.6 nozzles down slicers print nothing at all. A
//!   lip is no wall, and what is too small to be missed does not count (see `walls`); the note tells how much will be missing.
//! - `gap` between pillars: 0.5 nozzles wanted, below 0.25 nozzles two pillars fuse. Reliefs that meet on purpose, spots,
//!   and slots within one pillar do not count.
//! - `overhang`: how far reliefs stand out over nothing. 3 nozzles are printed freely, more needs a slicer's supports; the limit is
//!   what a single tower of them holds.
//! - `slenderness`: the least width against a given share of the height.
//! - `bed`: the size against the printer's.
//! - `part`, `cavity`: extent of the largest piece that would come off, of the largest hollow without a way out; none wanted.
//! - `core`: the widest circle in the thinnest horizontal section of a pillar as carved by all views, against its layer's `core`.

mod overhang;
mod section;
mod walls;

use crate::bvh::Bvh;
use crate::geom::narrowest;
use crate::mesh::shells::shells;
use crate::mesh::{Solid, TriMesh, face_components};
use crate::support::{Support, SupportKind};
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

/// A question about printing and its answer; lengths in millimetres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PrintCheck {
    /// `wall`, `gap`, `overhang`, `slenderness`, `bed`, `part`, `cavity` or `core`.
    pub check: &'static str,
    /// Where the value was measured.
    pub place: [f64; 3],
    pub value_mm: f64,
    /// What prints without loss.
    pub wanted_mm: f64,
    /// What fails.
    pub limit_mm: f64,
    /// Whether the value is on the right side of the limit.
    pub ok: bool,
    /// Extent and meaning, for people.
    pub note: String,
}

/// What the printer can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintLimits {
    /// Width of a printed line, millimetres.
    pub nozzle: f64,
    /// Width, depth and height of the build volume, millimetres.
    pub bed: [f64; 3],
    /// Thinnest wall wanted, in nozzles.
    pub wall_nozzles: f64,
    /// Narrowest gap wanted, in nozzles.
    pub gap_nozzles: f64,
    /// Height of a pillar over its least width that still stands.
    pub slimmest: f64,
}

/// What is printed: the forest as one, and as it goes on the bed.
pub struct Subject<'a> {
    pub supports: &'a [Support],
    pub whole: &'a Solid,
    pub bvh: &'a Bvh,
    /// Every support with its reliefs.
    pub standing: &'a [Solid],
    /// Bodies that go on the bed one by one, as name and size; empty: the forest as one.
    pub bodies: &'a [(String, DVec3)],
}

/// All checks, in the order of the module's list.
pub fn printability(subject: &Subject, limits: &PrintLimits) -> Vec<PrintCheck> {
    let mesh = subject.whole.mesh();
    let ((wall_and_gap, overhang), core) = rayon::join(
        || {
            rayon::join(
                || walls::walls(mesh, subject.bvh, subject.supports, limits),
                || overhang::overhang(mesh, limits),
            )
        },
        || core(subject),
    );
    let mut checks = wall_and_gap.to_vec();
    checks.push(overhang);
    checks.extend(slenderness(subject.supports, limits));
    checks.push(bed(subject, limits));
    checks.extend(loose(subject.whole));
    checks.extend(core);
    checks
}

/// The pillar whose least width is the smallest share of what its height wants.
fn slenderness(supports: &[Support], limits: &PrintLimits) -> Option<PrintCheck> {
    let pillars = supports.iter().filter_map(|s| match &s.kind {
        SupportKind::Pillar {
            axis, profile, top, ..
        } => {
            let (width, height) = (narrowest(profile), top.max(0.0));
            Some((s, axis.extend(height), width, height / limits.slimmest))
        }
        SupportKind::Base { .. } | SupportKind::Body { .. } => None,
    });
    let (support, place, width, wanted) =
        pillars.min_by(|a, b| (a.2 / a.3).total_cmp(&(b.2 / b.3)))?;
    Some(PrintCheck {
        check: "slenderness",
        place: tidy(place),
        value_mm: width,
        wanted_mm: wanted,
        limit_mm: wanted,
        ok: width >= wanted,
        note: format!(
            "{} is {:.1} times as high as wide; {} times is the limit",
            support.name,
            place.z / width,
            limits.slimmest
        ),
    })
}

/// The body that fits the bed worst: its size along the tightest direction.
fn bed(subject: &Subject, limits: &PrintLimits) -> PrintCheck {
    let (lo, hi) = subject.whole.bounds();
    let forest = [("the forest".to_owned(), hi - lo)];
    let bodies = if subject.bodies.is_empty() {
        &forest[..]
    } else {
        subject.bodies
    };
    let sides = |(name, size): &(String, DVec3)| {
        // Turned as it fits better: longer side to longer side.
        let (long, short) = (size.x.max(size.y), size.x.min(size.y));
        let [x, y, z] = limits.bed;
        [(long, x.max(y)), (short, x.min(y)), (size.z, z)]
            .into_iter()
            .map(|(value, room)| (name.clone(), value, room))
            .collect::<Vec<_>>()
    };
    let worst = bodies
        .iter()
        .flat_map(sides)
        .max_by(|a, b| (a.1 - a.2).total_cmp(&(b.1 - b.2)));
    let (name, value, room) = worst.unwrap_or_default();
    let ok = value <= room;
    let help = if ok {
        ""
    } else if subject.bodies.is_empty() {
        "; `build --split` makes plates that fit"
    } else {
        "; it cannot be divided further"
    };
    PrintCheck {
        check: "bed",
        place: tidy((lo + hi) / 2.0),
        value_mm: value,
        wanted_mm: room,
        limit_mm: room,
        ok,
        note: format!("the tightest side of {name}{help}"),
    }
}

/// What would come off, and what is enclosed.
fn loose(whole: &Solid) -> [PrintCheck; 2] {
    let mesh = whole.mesh();
    let (mut parts, mut cavities) = (Vec::new(), Vec::new());
    if whole.parts() + whole.cavities() > 1 {
        let component = face_components(mesh);
        for (k, shell) in shells(mesh).iter().enumerate() {
            let list = if shell.volume > 0.0 {
                &mut parts
            } else {
                &mut cavities
            };
            list.push((shell.volume.abs(), extent(mesh, &component, k as u32)));
        }
    }
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    cavities.sort_by(|a, b| b.0.total_cmp(&a.0));
    let check = |check, found: &[(f64, (DVec3, f64))], note| {
        let (place, size) = found.first().map_or_else(Default::default, |f| f.1);
        PrintCheck {
            check,
            place: tidy(place),
            value_mm: size,
            wanted_mm: 0.0,
            limit_mm: 0.0,
            ok: found.is_empty(),
            note,
        }
    };
    let loose = &parts[1.min(parts.len())..];
    [
        check(
            "part",
            loose,
            format!("{} parts would come off", loose.len()),
        ),
        check(
            "cavity",
            &cavities,
            format!("{} hollows are closed", cavities.len()),
        ),
    ]
}

/// Middle and diagonal of one component's box.
fn extent(mesh: &TriMesh, component: &[u32], k: u32) -> (DVec3, f64) {
    let corners = (0..mesh.faces.len())
        .filter(|f| component[*f] == k)
        .flat_map(|f| mesh.corners(f));
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| {
        (lo.min(p), hi.max(p))
    });
    ((lo + hi) / 2.0, (hi - lo).length())
}

/// The pillar whose thinnest section leaves least beyond its layer's core.
fn core(subject: &Subject) -> Option<PrintCheck> {
    let found: Vec<_> = subject
        .supports
        .par_iter()
        .zip(subject.standing)
        .filter_map(|(support, solid)| {
            let SupportKind::Pillar { bottom, top, .. } = support.kind else {
                return None;
            };
            let wanted = support.layer?.core;
            Some((
                support,
                section::thinnest(solid.mesh(), bottom.max(0.0), top)?,
                wanted,
            ))
        })
        .collect();
    let (support, thinnest, wanted) = found
        .into_iter()
        .min_by(|a, b| (a.1.width - a.2).total_cmp(&(b.1.width - b.2)))?;
    Some(PrintCheck {
        check: "core",
        place: tidy(thinnest.place),
        value_mm: thinnest.width,
        wanted_mm: wanted,
        limit_mm: wanted,
        ok: thinnest.width >= wanted,
        note: format!(
            "{} is left with {:.1} mm2 there after all views carved it",
            support.name, thinnest.area
        ),
    })
}

/// Without -0, which JSON would show.
fn tidy(p: DVec3) -> [f64; 3] {
    (p + 0.0).to_array()
}
