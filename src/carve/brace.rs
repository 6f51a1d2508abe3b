//! Ties for parts that would float: pieces of relief or pillar at a pillar's very edge, where nothing stands behind them.
//!
//! A brace is a stub in the piece's own shadow, back to the depth of the reliefs' backing, and a bar from there to the support's
//! axis, behind the layer and within the support's shadow: the eye sees neither.

use super::boolean::{Boolean, BooleanError};
use crate::support::Slab;
use glam::DVec3;

/// What of a loose part counts as its rear, millimetres of depth.
const REAR_MM: f64 = 0.6;

/// A brace is this much slimmer than the piece it holds, so that no face of one lies in a face of the other.
const SLIM: f64 = 0.83;

/// One brace for every loose part larger than `crumb` cubic millimetres (the largest part is the support itself). A part that reaches
/// down to where the support's `foot` stands in a base is held by that.
pub(crate) fn braces(
    joined: &Boolean,
    slab: &Slab,
    foot: Option<f64>,
    crumb: f64,
) -> Result<Vec<Boolean>, BooleanError> {
    let parts = joined.parts();
    let loose = parts.iter().skip(1).filter(|p| p.volume() >= crumb);
    let mut braces = Vec::new();
    for vertices in loose.map(|p| p.mesh().vertices) {
        let stands = |p: &DVec3| foot.is_some_and(|foot| p.z <= foot);
        if !vertices.iter().any(stands) {
            let brace = brace(vertices, slab)?;
            // Of points in one plane there is nothing but that plane, twice.
            if brace.volume() >= crumb {
                braces.push(brace);
            }
        }
    }
    Ok(braces)
}

/// For a part with these vertices.
fn brace(vertices: Vec<DVec3>, slab: &Slab) -> Result<Boolean, BooleanError> {
    let rear = vertices
        .iter()
        .map(|p| slab.offset(*p))
        .fold(f64::NEG_INFINITY, f64::max);
    let rear: Vec<DVec3> = vertices
        .into_iter()
        .filter(|p| slab.offset(*p) > rear - REAR_MM)
        .collect();
    let middle = rear.iter().sum::<DVec3>() / rear.len().max(1) as f64;
    let rear: Vec<DVec3> = rear.iter().map(|p| middle.lerp(*p, SLIM)).collect();
    let thickness = slab.backing() - slab.deepest();
    let at = |p: &DVec3, offset: f64| slab.moved(*p, offset - slab.offset(*p));
    let (front, back) = (
        slab.deepest() + 0.1 * thickness,
        slab.backing() - 0.1 * thickness,
    );
    let stub: Vec<DVec3> = rear.iter().flat_map(|p| [*p, at(p, back)]).collect();
    let bar = rear
        .iter()
        .flat_map(|p| [at(p, front), at(p, back)])
        .flat_map(|p| [p, slab.onto_axis(p)]);
    let bar = Boolean::hull(&bar.collect::<Vec<_>>())?;
    Boolean::hull(&stub)?.plus(&bar)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriMesh;
    use crate::support::{Extent, Layer, Support, SupportKind};
    use glam::DVec2;

    fn slab() -> Slab {
        let profile = [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]].map(DVec2::from_array);
        let support = Support {
            name: "pillar".into(),
            mesh: TriMesh::default(),
            kind: SupportKind::Pillar {
                axis: DVec2::ZERO,
                profile: profile.to_vec(),
                bottom: -1.0,
                top: 90.0,
                round: false,
            },
            layer: Some(Layer {
                extent: Extent::Plane { back: 1.0 },
                front: 2.0,
                core: 0.5,
                hull: false,
            }),
        };
        Slab::new(&support, DVec3::new(0.0, -250.0, 40.0)).expect("it faces the eye")
    }

    #[test]
    fn what_floats_is_tied_and_what_stands_in_the_base_is_not() {
        let block = |x: f64, back: f64, bottom: f64, top: f64| {
            let (lo, hi) = (DVec3::new(x, 0.0, bottom), DVec3::new(x + 1.0, back, top));
            Boolean::cuboid(lo, hi).expect("a box")
        };
        let parts = vec![
            block(-0.5, 3.0, -1.0, 90.0),
            block(2.0, 1.0, -1.0, 3.0),
            block(-2.0, 1.0, 40.0, 44.0),
        ];
        let joined = Boolean::union(parts).expect("three boxes");
        let ties = |foot| braces(&joined, &slab(), foot, 0.005).expect("braces");
        let [tie] = &ties(Some(-1.0))[..] else {
            panic!("only one part floats")
        };
        let whole = joined.plus(tie).expect("a union");
        assert_eq!(whole.parts().len(), 2, "the tie reaches the support");
        // Without a base nothing holds the foot.
        assert_eq!(ties(None).len(), 2);
        assert_eq!(ties(Some(-2.0)).len(), 2);
    }
}
