//! The closed mesh of a block: its cells at their depths, walls along the rays, and its back.

use super::cells::{BlockCells, CellCorner, FanId};
use crate::index::{CellId, VertexId};
use crate::mesh::TriMesh;
use glam::DVec2;

pub(crate) fn closed(block: &BlockCells, back: impl Fn(CellId, DVec2) -> f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    let columns: Vec<Column> = FanId::all(block.fans.len())
        .map(|f| column(block, f, &back, &mut mesh))
        .collect();
    for c in block.all() {
        let corners = [0, 1, 2].map(|k| CellCorner { cell: c, k });
        let columns = corners.map(|at| &columns[block.fan_at(at)]);
        mesh.faces
            .push([0, 1, 2].map(|k| columns[k].at(block.depth[c][k])));
        mesh.faces.push([0, 2, 1].map(|k| columns[k].back));
        for k in 0..3 {
            let next = (k + 1) % 3;
            let (u, v) = (columns[k], columns[next]);
            let (du, dv) = (block.depth[c][k], block.depth[c][next]);
            match block.across(corners[k]) {
                None => wall(&mut mesh.faces, &v.down(dv), &u.down(du)),
                Some(n) if n > c => {
                    let depth_across = |k: usize| {
                        let fan = block.fan_at(corners[k]);
                        let at = block.fan_of[n].iter().position(|x| *x == fan);
                        block.depth[n][at.expect("neighbours share both fans of a side")]
                    };
                    let (eu, ev) = (depth_across(k), depth_across(next));
                    wall(&mut mesh.faces, &v.between(dv, ev), &u.between(du, eu));
                }
                Some(_) => {}
            }
        }
    }
    mesh
}

/// The middle one of what the cells around a point say: where two facets of a support meet, a thin cell may carry the wrong one.
fn back_at(block: &BlockCells, f: FanId, q: DVec2, back: &impl Fn(CellId, DVec2) -> f64) -> f64 {
    let corners = block.fans[f].corners.iter();
    let mut depths: Vec<f64> = corners.map(|at| back(block.in_map[at.cell], q)).collect();
    depths.sort_by(f64::total_cmp);
    depths[depths.len() / 2]
}

/// Makes the vertices on one ray.
fn column(
    block: &BlockCells,
    f: FanId,
    back: &impl Fn(CellId, DVec2) -> f64,
    mesh: &mut TriMesh,
) -> Column {
    let q = block.fans[f].q;
    let mut levels = block.fan_depths(f);
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let mut vertex = |z: f64| {
        let own = VertexId::new(mesh.vertices.len());
        mesh.vertices.push(block.plane.point(q, z));
        own
    };
    let back = vertex(back_at(block, f, q, back));
    Column {
        levels: levels.into_iter().map(|z| (z, vertex(z))).collect(),
        back,
    }
}

/// The vertices on one ray: levels from near to far, then the back.
struct Column {
    levels: Vec<(f64, VertexId)>,
    back: VertexId,
}

impl Column {
    fn at(&self, depth: f64) -> VertexId {
        self.levels
            .iter()
            .find(|l| l.0 == depth)
            .expect("every depth of a fan is a level of its column")
            .1
    }

    /// From a depth to the back.
    fn down(&self, depth: f64) -> Vec<VertexId> {
        self.levels
            .iter()
            .filter(|l| l.0 >= depth)
            .map(|l| l.1)
            .chain([self.back])
            .collect()
    }

    /// From one depth to another, with the levels between.
    fn between(&self, from: f64, to: f64) -> Vec<VertexId> {
        let (lo, hi) = (from.min(to), from.max(to));
        let mut chain: Vec<VertexId> = self
            .levels
            .iter()
            .filter(|l| (lo..=hi).contains(&l.0))
            .map(|l| l.1)
            .collect();
        if from > to {
            chain.reverse();
        }
        chain
    }
}

/// Triangulates the wall between two chains that run from the cell's own depths to its neighbour's; `v` ends the cell's side.
fn wall(faces: &mut Vec<[VertexId; 3]>, v: &[VertexId], u: &[VertexId]) {
    let (mut i, mut j) = (0, 0);
    while i + 1 < u.len() || j + 1 < v.len() {
        // Advance the chain that lags behind, so that triangles stay as stout as the levels allow.
        let advance_u =
            j + 1 >= v.len() || (i + 1 < u.len() && (i + 1) * v.len() <= (j + 1) * u.len());
        if advance_u {
            faces.push([v[j], u[i], u[i + 1]]);
            i += 1;
        } else {
            faces.push([v[j], u[i], v[j + 1]]);
            j += 1;
        }
    }
}
