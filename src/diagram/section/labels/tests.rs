//! Labels never touch, keep their order and stay in their row.

use super::{AIR, SIZES, fitting, spread};
use crate::diagram::lettering::{Typeface, width};

const ROW: (f64, f64) = (100.0, 188.0);

fn labels(count: usize) -> Vec<String> {
    (0..count).map(|k| format!("1.{k:03}")).collect()
}

#[test]
fn labels_stand_apart_wherever_they_want_to_be() {
    let crowds: [fn(f64) -> f64; 4] = [
        |_| 101.0,
        |_| 187.0,
        |t| 100.0 + 88.0 * t,
        |t| 140.0 + 3.0 * t,
    ];
    for count in 1..30 {
        let texts = labels(count);
        let importance: Vec<f64> = (0..count).map(|k| (k * 7 % 11) as f64).collect();
        let (size, kept) = fitting(&texts, &importance, ROW.1 - ROW.0);
        let shown: Vec<&str> = kept.iter().map(|k| texts[*k].as_str()).collect();
        for crowd in crowds {
            let wanted: Vec<f64> = kept
                .iter()
                .map(|k| crowd(*k as f64 / count as f64))
                .collect();
            let at = spread(&wanted, &shown, size, ROW);
            let half: Vec<f64> = shown
                .iter()
                .map(|t| width(t, size, Typeface::Regular) / 2.0)
                .collect();
            for k in 1..at.len() {
                let gap = (at[k] - half[k]) - (at[k - 1] + half[k - 1]);
                assert!(gap >= AIR * size - 1e-9, "{count} {k}: {gap}");
            }
            let last = at.len() - 1;
            assert!(
                at[0] - half[0] >= ROW.0 && at[last] + half[last] <= ROW.1,
                "{count}"
            );
        }
    }
}

#[test]
fn labels_with_room_stay_where_they_want_to_be() {
    let wanted = [110.0, 130.0, 170.0];
    assert_eq!(spread(&wanted, &["1.0", "2.0", "3.0"], 2.6, ROW), wanted);
}

#[test]
fn the_most_important_ones_are_kept() {
    let texts = labels(40);
    let importance: Vec<f64> = (0..40)
        .map(|k| if k % 2 == 0 { 1.0 } else { 0.5 })
        .collect();
    let (size, kept) = fitting(&texts, &importance, 50.0);
    assert_eq!(size, SIZES[3]);
    assert!((5..20).contains(&kept.len()), "{kept:?}");
    assert!(kept.iter().all(|k| k % 2 == 0) && kept.is_sorted());
    let (size, kept) = fitting(&texts[..3], &importance[..3], 50.0);
    assert_eq!((size, kept), (SIZES[0], vec![0, 1, 2]));
}
