//! Where numbers stand on plates.

use super::cuts::is_inside;
use super::digits::Lettering;
use super::pieces::{PlateNumber, STROKE_NOZZLES, Split, SplitOptions};
use crate::geom::gap;
use glam::DVec2;

/// Distance of a number from sockets, cuts and edges, millimetres.
const NUMBER_MARGIN_MM: f64 = 0.8;
/// Directions in which a number may stand beside its socket.
const NUMBER_WAYS: usize = 24;

/// Finds a place for every number beside its socket.
pub(crate) fn label(
    outline: &[DVec2],
    holes: &[Vec<DVec2>],
    options: &SplitOptions,
    split: &mut Split,
) {
    let mut taken: Vec<[DVec2; 4]> = Vec::new();
    let cuts = split.cuts.clone();
    for (socket, hole) in split.sockets.iter_mut().zip(holes) {
        let centre = hole.iter().sum::<DVec2>() / hole.len() as f64;
        let size = Lettering::new(socket.number).size();
        let free = |at: DVec2, stroke: f64| {
            let half = size * stroke / 2.0 + NUMBER_MARGIN_MM;
            let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|c| at + half * DVec2::from(c));
            let cut = |list: &[f64], at: f64, half: f64| list.iter().any(|c| (c - at).abs() < half);
            let stands = is_inside(outline, &ring, 0.0)
                && !cut(&cuts.x, at.x, half.x)
                && !cut(&cuts.y, at.y, half.y)
                && holes.iter().all(|h| gap(h, &ring) > 0.0)
                && taken.iter().all(|t| gap(t, &ring) > 0.0);
            stands.then_some(ring)
        };
        let places = STROKE_NOZZLES.iter().zip(0..).flat_map(|(nozzles, rung)| {
            let stroke = nozzles * options.nozzle;
            (0..NUMBER_WAYS).map(move |k| {
                // First below the socket, then to both sides in turn.
                let turn = k.div_ceil(2) as f64 * if k % 2 == 0 { 1.0 } else { -1.0 };
                let way = DVec2::from_angle(
                    -std::f64::consts::FRAC_PI_2
                        + turn * std::f64::consts::TAU / NUMBER_WAYS as f64,
                );
                (way, stroke, rung)
            })
        });
        let found = places
            .map(|(way, stroke, rung)| {
                let reach = hole
                    .iter()
                    .map(|p| (*p - centre).dot(way))
                    .fold(0.0, f64::max);
                let half = size * stroke / 2.0 + NUMBER_MARGIN_MM;
                // As near as the box comes to a round socket in this direction.
                let by = reach + half.dot(way.abs()) + 0.1;
                let middle = centre + by * way;
                PlateNumber {
                    middle,
                    stroke,
                    rung,
                }
            })
            .find_map(|label| Some((label, free(label.middle, label.stroke)?)));
        if let Some((label, ring)) = found {
            taken.push(ring);
            socket.label = Some(label);
        }
    }
}
