//! Depths filled in until they fit for a manifold.

use super::cells::{BlockCells, CellCorner, FanId, LocalId};

/// Depths nearer than this at one point are one level, millimetres. Rounding leaves 1e-9, f32 files resolve 8e-6; steps
/// below a printer's reach but above this are kept because they are parts of steps that grow along a line.
const LEVEL_MM: f64 = 0.003;

/// Makes depths around every point and along every side fit for a manifold; gives the number of corners changed.
pub(crate) fn settle(block: &mut BlockCells) -> usize {
    let fans = FanId::all(block.fans.len());
    fans.clone().for_each(|f| cluster_levels(block, f));
    let before = block.depth.clone();
    // Every change fills a corner up to a depth that another corner of its fan has: it ends, and in practice at once.
    loop {
        let mut changed = false;
        for f in fans.clone() {
            changed |= fill_pits(block, f);
        }
        for c in block.all() {
            changed |= uncross(block, c);
        }
        if !changed {
            let both = before.iter().flatten().zip(block.depth.iter().flatten());
            return both.filter(|(a, b)| a != b).count();
        }
    }
}

fn set_fan_depths(block: &mut BlockCells, f: FanId, depths: &[f64]) -> bool {
    let mut changed = false;
    for (i, d) in depths.iter().enumerate() {
        let CellCorner { cell, k } = block.fans[f].corners[i];
        let slot = &mut block.depth[cell][k];
        changed |= *slot != *d;
        *slot = *d;
    }
    changed
}

/// Makes nearly equal depths equal.
fn cluster_levels(block: &mut BlockCells, f: FanId) {
    let depths = block.fan_depths(f);
    let mut order: Vec<usize> = (0..depths.len()).collect();
    order.sort_by(|a, b| depths[*a].total_cmp(&depths[*b]));
    let mut result = depths.clone();
    for run in order.chunk_by(|a, b| depths[*b] - depths[*a] < LEVEL_MM) {
        let mean = run.iter().map(|i| depths[*i]).sum::<f64>() / run.len() as f64;
        run.iter().for_each(|i| result[*i] = mean);
    }
    set_fan_depths(block, f, &result);
}

/// Lowers depths so that, going round from the deepest (outside counts as deepest), they fall to one valley and rise again.
fn fill_pits(block: &mut BlockCells, f: FanId) -> bool {
    let mut depths = block.fan_depths(f);
    let n = depths.len();
    let by_depth = |a: &usize, b: &usize| depths[*a].total_cmp(&depths[*b]);
    let closed = block.fans[f].closed;
    let start = if closed {
        (0..n).max_by(by_depth).unwrap_or(0)
    } else {
        0
    };
    let limit = if closed { depths[start] } else { f64::INFINITY };
    depths.rotate_left(start);
    let valley = (0..n)
        .min_by(|a, b| depths[*a].total_cmp(&depths[*b]))
        .unwrap_or(0);
    let mut run = limit;
    for d in &mut depths[..valley] {
        run = run.min(*d);
        *d = run;
    }
    run = limit;
    for d in depths[valley..].iter_mut().rev() {
        run = run.min(*d);
        *d = run;
    }
    depths.rotate_right(start);
    set_fan_depths(block, f, &depths)
}

/// Joins two sheets that swap order along a side at the end where they are nearer.
fn uncross(block: &mut BlockCells, cell: LocalId) -> bool {
    let mut changed = false;
    for k in 0..3 {
        let side = CellCorner { cell, k };
        let Some(n) = block.across(side).filter(|n| *n > cell) else {
            continue;
        };
        let ends = [k, (k + 1) % 3].map(|k| {
            let own = CellCorner { cell, k };
            let point = block.point(own);
            let across = block.points_of(n).iter().position(|x| *x == point);
            let k = across.expect("neighbours share both points of a side");
            [own, CellCorner { cell: n, k }]
        });
        let gaps = ends.map(|[i, j]| block.depth_at(i) - block.depth_at(j));
        if gaps[0] * gaps[1] < 0.0 {
            let nearer = usize::from(gaps[0].abs() >= gaps[1].abs());
            let [i, j] = ends[nearer];
            let near = block.depth_at(i).min(block.depth_at(j));
            block.depth[i.cell][i.k] = near;
            block.depth[j.cell][j.k] = near;
            changed = true;
        }
    }
    changed
}
