//! Numbers as outlines for engraving: seven segments, on a grid whose unit is the stroke.
//!
//! A digit is three strokes wide and five high; a number that reads as another one upside down is underlined.

use glam::DVec2;
use std::collections::BTreeMap;

/// Rows of a digit from the top, three bits each.
const DIGITS: [[u8; 5]; 10] = [
    [0b111, 0b101, 0b101, 0b101, 0b111],
    [0b010, 0b010, 0b010, 0b010, 0b010],
    [0b111, 0b001, 0b111, 0b100, 0b111],
    [0b111, 0b001, 0b111, 0b001, 0b111],
    [0b101, 0b101, 0b111, 0b001, 0b001],
    [0b111, 0b100, 0b111, 0b001, 0b111],
    [0b111, 0b100, 0b111, 0b101, 0b111],
    [0b111, 0b001, 0b001, 0b001, 0b001],
    [0b111, 0b101, 0b111, 0b101, 0b111],
    [0b111, 0b101, 0b111, 0b001, 0b111],
];

/// What the digits read as after half a turn, if anything.
const TURNED: [Option<usize>; 10] = [
    Some(0),
    Some(1),
    Some(2),
    None,
    None,
    Some(5),
    Some(9),
    None,
    Some(8),
    Some(6),
];

/// A number as a grid of filled cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Lettering {
    /// By rows from the bottom.
    cells: Vec<Vec<bool>>,
}

impl Lettering {
    pub fn new(number: usize) -> Self {
        let digits: Vec<usize> = number
            .to_string()
            .bytes()
            .map(|b| usize::from(b - b'0'))
            .collect();
        let row = |r: usize| {
            let mut cells = Vec::new();
            for (k, d) in digits.iter().enumerate() {
                if k > 0 {
                    cells.push(false);
                }
                cells.extend((0..3).rev().map(|bit| DIGITS[*d][r] >> bit & 1 == 1));
            }
            cells
        };
        let mut cells: Vec<Vec<bool>> = (0..5).rev().map(row).collect();
        if ambiguous(&digits) {
            let width = cells[0].len();
            cells.splice(0..0, [vec![true; width], vec![false; width]]);
        }
        Self { cells }
    }

    /// Width and height in strokes.
    pub fn size(&self) -> DVec2 {
        DVec2::new(self.cells[0].len() as f64, self.cells.len() as f64)
    }

    /// As read from the other side.
    pub fn mirrored(mut self) -> Self {
        self.cells.iter_mut().for_each(|row| row.reverse());
        self
    }

    /// Outlines around `centre`, outer ones counter-clockwise, holes clockwise; `stroke` in millimetres.
    pub fn rings(&self, centre: DVec2, stroke: f64) -> Vec<Vec<[f64; 2]>> {
        let corner = centre - self.size() * stroke / 2.0;
        let place =
            |(x, y): (usize, usize)| (corner + stroke * DVec2::new(x as f64, y as f64)).to_array();
        let rings = self.grid_rings().into_iter();
        rings
            .map(|ring| ring.into_iter().map(place).collect())
            .collect()
    }

    /// The sides between filled and empty cells, chained. Cells never meet in a corner alone, so a corner has one way on.
    fn grid_rings(&self) -> Vec<Vec<(usize, usize)>> {
        let filled = |x: usize, y: usize| {
            let row = self.cells.get(y);
            row.is_some_and(|r| r.get(x).copied().unwrap_or(false))
        };
        let mut next: BTreeMap<(usize, usize), (usize, usize)> = BTreeMap::new();
        for (y, row) in self.cells.iter().enumerate() {
            for x in (0..row.len()).filter(|x| row[*x]) {
                if y == 0 || !filled(x, y - 1) {
                    next.insert((x, y), (x + 1, y));
                }
                if !filled(x + 1, y) {
                    next.insert((x + 1, y), (x + 1, y + 1));
                }
                if !filled(x, y + 1) {
                    next.insert((x + 1, y + 1), (x, y + 1));
                }
                if x == 0 || !filled(x - 1, y) {
                    next.insert((x, y + 1), (x, y));
                }
            }
        }
        let mut rings = Vec::new();
        while let Some((&start, _)) = next.first_key_value() {
            let (mut ring, mut at) = (Vec::new(), start);
            while let Some(to) = next.remove(&at) {
                ring.push(at);
                at = to;
            }
            rings.push(corners(&ring));
        }
        rings
    }
}

/// A ring without the points on its straight sides.
fn corners(ring: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let n = ring.len();
    let turns = |k: &usize| {
        let (a, b, c) = (ring[(k + n - 1) % n], ring[*k], ring[(k + 1) % n]);
        !((a.0 == b.0 && b.0 == c.0) || (a.1 == b.1 && b.1 == c.1))
    };
    (0..n).filter(turns).map(|k| ring[k]).collect()
}

/// Whether the digits are another number upside down.
fn ambiguous(digits: &[usize]) -> bool {
    let turned: Option<Vec<usize>> = digits.iter().rev().map(|d| TURNED[*d]).collect();
    turned.is_some_and(|t| t != digits && t[0] != 0)
}
