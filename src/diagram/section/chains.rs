//! Stretches of a section as lines.

use super::values::{Section, Stretch};
use glam::DVec2;

/// Ends that lie nearer to each other are one point, millimetres: above what merging thin cells moves, below what can be seen.
const JOIN_MM: f64 = 0.02;

/// A value at both ends of a stretch, and what it belongs to: lines end where that changes.
pub(crate) type DepthsOfGroup = Option<(Option<usize>, [f64; 2])>;

/// A line in the section and what it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polyline {
    pub of: Option<usize>,
    pub points: Vec<DVec2>,
}

/// The lines of a value: from stretch to stretch as long as it does not jump.
pub(crate) fn chains(
    section: &Section,
    value: impl Fn(&Stretch) -> DepthsOfGroup,
) -> Vec<Polyline> {
    let mut chains: Vec<Polyline> = Vec::new();
    for stretch in &section.stretches {
        let Some((of, [a, b])) = value(stretch) else {
            continue;
        };
        let [from, to] =
            [(stretch.x[0], a), (stretch.x[1], b)].map(|(x, z)| section.cut.place(x, z));
        let goes_on = chains.last_mut().filter(|c| {
            let end = c.points.last();
            c.of == of && end.is_some_and(|p| p.distance(from) < JOIN_MM)
        });
        match goes_on {
            Some(chain) => chain.points.push(to),
            None => chains.push(Polyline {
                of,
                points: vec![from, to],
            }),
        }
    }
    chains
}

/// The surface before it is cut.
pub(crate) fn surface(s: &Stretch) -> (Option<usize>, [f64; 2]) {
    (None, s.surface)
}

/// Rooms between the bounds of every group, scaled by `scale` of the group: polygons.
pub(crate) fn rooms(section: &Section, scale: impl Fn(usize) -> f64) -> Vec<Polyline> {
    let side = |far: bool| {
        let scale = &scale;
        move |s: &Stretch| -> DepthsOfGroup {
            let laid = s.laid?;
            let depth = if far { laid.far } else { laid.near };
            Some((Some(laid.group), depth.map(|z| scale(laid.group) * z)))
        }
    };
    let (far, near) = (chains(section, side(true)), chains(section, side(false)));
    if far.len() == near.len() && far.iter().zip(&near).all(|(f, n)| same_rays(f, n)) {
        return far
            .into_iter()
            .zip(near)
            .map(|(f, n)| between(f, n))
            .collect();
    }
    // One of both jumps where the other does not: stretch by stretch.
    let quad = |s: &Stretch| {
        let laid = s.laid?;
        let at = |k: usize, z: [f64; 2]| section.cut.place(s.x[k], scale(laid.group) * z[k]);
        Some(Polyline {
            of: Some(laid.group),
            points: vec![
                at(0, laid.far),
                at(1, laid.far),
                at(1, laid.near),
                at(0, laid.near),
            ],
        })
    };
    section.stretches.iter().filter_map(quad).collect()
}

fn same_rays(a: &Polyline, b: &Polyline) -> bool {
    a.of == b.of && a.points.len() == b.points.len()
}

fn between(far: Polyline, near: Polyline) -> Polyline {
    let mut points = far.points;
    points.extend(near.points.into_iter().rev());
    Polyline { of: far.of, points }
}

/// Where the surface jumps along a ray and the model does not: both places.
pub(crate) fn tears(section: &Section) -> Vec<[DVec2; 2]> {
    let pairs = section.stretches.windows(2);
    let tear = |pair: &[Stretch]| {
        let (a, b) = (pair[0], pair[1]);
        let x = a.x[1];
        let place = |z: f64| section.cut.place(x, z);
        let apart = |p: f64, q: f64| place(p).distance(place(q));
        let meet = section
            .cut
            .place(b.x[0], b.model[0])
            .distance(place(a.model[1]))
            < JOIN_MM;
        let jumps = apart(a.surface[1], b.surface[0]) >= JOIN_MM;
        (meet && jumps).then(|| [place(a.surface[1]), place(b.surface[0])])
    };
    pairs.filter_map(tear).collect()
}
