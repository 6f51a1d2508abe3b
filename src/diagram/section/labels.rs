//! Labels in a row above a panel, in the order of what they name and without overlap.

use crate::diagram::lettering::{Typeface, width};

/// Room between labels, in ems.
const AIR: f64 = 0.7;

/// Sizes tried, millimetres on the page: the last one can still be read on A4.
const SIZES: [f64; 4] = [2.6, 2.3, 2.0, 1.8];

/// The largest size at which all texts fit side by side, and which of them fit at the smallest: the most important ones first.
pub(crate) fn fitting(texts: &[String], importance: &[f64], room: f64) -> (f64, Vec<usize>) {
    let need = |k: usize, size: f64| width(&texts[k], size, Typeface::Regular) + AIR * size;
    let all: Vec<usize> = (0..texts.len()).collect();
    let fits = |size: &&f64| all.iter().map(|k| need(*k, **size)).sum::<f64>() <= room;
    if let Some(size) = SIZES.iter().find(fits) {
        return (*size, all);
    }
    let size = SIZES[SIZES.len() - 1];
    let mut ranked = all;
    ranked.sort_by(|a, b| importance[*b].total_cmp(&importance[*a]).then(a.cmp(b)));
    let mut used = 0.0;
    let mut kept: Vec<usize> = ranked
        .into_iter()
        .take_while(|k| {
            used += need(*k, size);
            used <= room
        })
        .collect();
    kept.sort_unstable();
    (size, kept)
}

/// Middles of labels as near to where they want to be as the row from `lo` to `hi` lets them; `wanted` rises.
pub(crate) fn spread(wanted: &[f64], texts: &[&str], size: f64, (lo, hi): (f64, f64)) -> Vec<f64> {
    let half: Vec<f64> = texts
        .iter()
        .map(|t| (width(t, size, Typeface::Regular) + AIR * size) / 2.0)
        .collect();
    let mut at = wanted.to_vec();
    let mut end = lo;
    for (x, half) in at.iter_mut().zip(&half) {
        *x = x.max(end + half);
        end = *x + half;
    }
    let mut start = hi;
    for (x, half) in at.iter_mut().zip(&half).rev() {
        *x = x.min(start - half);
        start = *x - half;
    }
    at
}

#[cfg(test)]
mod tests;
