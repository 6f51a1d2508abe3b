//! How the method goes about it: Fig 8 and the inset at Eq 12.

use super::figure::Figure;
use super::findings::Findings;
use super::made::Made;
use super::workshop::{LEAN, Workshop, with};

pub(crate) const GROUPS: Figure = Figure {
    name: "fig08",
    paper: "Fig 8",
    title: "Groups with scales of their own",
    statement: "Bounds are given for every piece of the support (left), moved by a scale for each in the optimisation (middle), and the pieces of the optimum scaled back onto their supports (right), within the bounds exactly.",
    make: groups,
};

fn groups(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let made = shop.build("hare on pillars", "fig08-groups", &[])?;
    let groups = made.groups()?;
    found.case("hare on pillars", &made, &[("groups", groups)])?;
    let is_section = |f: &str| f.starts_with("groups-") && f.ends_with(".png");
    let section = made.file("section of its groups", is_section)?;
    found.picture("bounds, optimum, scaled back", section);
    let outside = made.outside_mm()?;
    found.claim(
        groups > 1.0 && outside <= 1e-6,
        format!("{groups} groups with scales of their own; scaled back they leave their layers by {outside:.6} mm"),
    );
    Ok(())
}

pub(crate) const ORDERING: Figure = Figure {
    name: "eq12",
    paper: "Inset at Eq 12",
    title: "Depth order on and off",
    statement: "Where the order of depths is not asked for, parts of the surface go through each other, as at the ear of a bunny; the rows of Eq 12 prevent it, but for crossings of edges.",
    make: ordering,
};

fn ordering(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let scene = "eq12-ordering";
    let off = with(&["energy=Curvature(ordering: false)"], &LEAN);
    let off = shop.build("without order", scene, &off)?;
    let on = shop.build("with order", scene, &with(&["energy=Curvature()"], &LEAN))?;
    let count = |made: &Made| made.sum(|c| c.order_inversions as f64);
    let [before, after] = [count(&off)?, count(&on)?];
    found.counter_case("without order", &off, &[("crossings", before)])?;
    found.case("with order", &on, &[("crossings", after)])?;
    found.claim(
        before > 0.0 && after == 0.0,
        format!("{before} crossings before, {after} after"),
    );
    found.note("Crossings of edges are held off too, which the paper leaves to the resolution of the printer.");
    Ok(())
}
