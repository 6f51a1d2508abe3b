//! Minima against all assignments, and against the largest flow found in another way.

use super::*;

/// Knuth's linear congruential generator, its upper half.
pub(crate) struct Lcg(pub u64);

impl Lcg {
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    /// From 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        self.below(1 << 31) as f64 / f64::from(1u32 << 31)
    }
}

/// What a [`BinaryEnergy`] is told.
struct CutInstance {
    unary: Vec<[f64; 2]>,
    pairs: Vec<(usize, usize, [f64; 4])>,
}

impl CutInstance {
    fn minimum(&self) -> Vec<bool> {
        let mut energy = BinaryEnergy::new(self.unary.len());
        for (i, [zero, one]) in self.unary.iter().enumerate() {
            energy.unary(i, *zero, *one);
        }
        for (i, j, cost) in &self.pairs {
            energy.pair(*i, *j, *cost);
        }
        energy.minimise()
    }

    /// Pairs that are not submodular count as raised.
    fn value(&self, x: &[bool]) -> f64 {
        let unary = self
            .unary
            .iter()
            .zip(x)
            .map(|(u, x)| u[usize::from(*x)].min(NEVER));
        let pairs = self.pairs.iter().map(|(i, j, cost)| {
            let [a, b, c, d] = cost.map(|x| x.min(NEVER));
            [a, b.max(a + d - c), c, d][2 * usize::from(x[*i]) + usize::from(x[*j])]
        });
        unary.sum::<f64>() + pairs.sum::<f64>()
    }

    /// Over all assignments: the least value, and of those that have it the fewest ones.
    fn searched(&self) -> (f64, usize) {
        let n = self.unary.len();
        let all = (0..1u32 << n).map(|bits| {
            let x: Vec<bool> = (0..n).map(|i| bits >> i & 1 == 1).collect();
            (self.value(&x), bits.count_ones() as usize)
        });
        all.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .expect("at least one assignment")
    }
}

fn random(lcg: &mut Lcg) -> CutInstance {
    let n = 1 + lcg.below(10) as usize;
    // Small whole numbers bring ties; eighths are exact in the unit of costs.
    let range = [3, 20, 4000][lcg.below(3) as usize];
    let cost = |lcg: &mut Lcg, dear: u64| match lcg.below(dear) {
        0 => f64::INFINITY,
        1..3 => 0.0,
        _ => lcg.below(range) as f64 / 8.0,
    };
    let unary = (0..n).map(|_| [cost(lcg, 30), cost(lcg, 30)]).collect();
    let dense = [2, 3, 8][lcg.below(3) as usize] * n as u64;
    let pairs = if n == 1 { 0 } else { lcg.below(dense) };
    let pair = |lcg: &mut Lcg| {
        let i = lcg.below(n as u64) as usize;
        let j = (i + 1 + lcg.below(n as u64 - 1) as usize) % n;
        let (a, d) = match lcg.below(3) {
            0 => (0.0, 0.0),
            _ => (lcg.below(range) as f64 / 8.0, lcg.below(range) as f64 / 8.0),
        };
        let (b, c) = (cost(lcg, 12), cost(lcg, 12));
        // One in ten stays as it is, submodular or not.
        let lift = if lcg.below(10) == 0 {
            0.0
        } else {
            (a + d - b - c).max(0.0)
        };
        (i, j, [a, b, c + lift, d])
    };
    CutInstance {
        unary,
        pairs: (0..pairs).map(|_| pair(lcg)).collect(),
    }
}

#[test]
fn the_minimum_is_that_of_all_assignments() {
    let mut lcg = Lcg(1);
    let (mut ties, mut mixed) = (0, 0);
    for n in 0..2000 {
        let instance = random(&mut lcg);
        let x = instance.minimum();
        let ones = x.iter().filter(|x| **x).count();
        let (least, fewest) = instance.searched();
        // Beside costs of "never" the last digits of others are lost.
        let found = instance.value(&x);
        assert!(
            (found - least).abs() <= 1e-15 * least.abs(),
            "{n}: {found} instead of {least}"
        );
        if least < NEVER {
            assert_eq!(ones, fewest, "{n}: {x:?}");
        }
        mixed += usize::from(ones > 0 && ones < x.len());
        let flipped: Vec<bool> = (0..x.len()).map(|i| x[i] != (i == 0)).collect();
        ties += usize::from(instance.value(&flipped) == least);
    }
    assert!(
        mixed > 500 && ties > 100,
        "too easy: {mixed} mixed, {ties} ties"
    );
}

/// Largest flow from node 0 to the last by shortest paths (Edmonds & Karp 1972).
fn largest_flow(mut rooms: Vec<Vec<(usize, i64)>>) -> i64 {
    let sink = rooms.len() - 1;
    let mut flow = 0;
    loop {
        let mut from = vec![usize::MAX; rooms.len()];
        let mut queue = VecDeque::from([0]);
        while let Some(v) = queue.pop_front() {
            for (w, room) in &rooms[v] {
                if *room > 0 && *w != 0 && from[*w] == usize::MAX {
                    from[*w] = v;
                    queue.push_back(*w);
                }
            }
        }
        if from[sink] == usize::MAX {
            return flow;
        }
        let mut path = vec![sink];
        while path[path.len() - 1] != 0 {
            path.push(from[path[path.len() - 1]]);
        }
        let room = |v: usize, w: usize| rooms[v].iter().position(|a| a.0 == w && a.1 > 0);
        let arcs: Vec<(usize, usize, usize)> = path
            .windows(2)
            .map(|p| (p[1], p[0], room(p[1], p[0]).expect("an arc of the path")))
            .collect();
        let least = arcs
            .iter()
            .map(|(v, _, a)| rooms[*v][*a].1)
            .min()
            .unwrap_or(0);
        for (v, w, a) in arcs {
            rooms[v][a].1 -= least;
            let back = rooms[w]
                .iter()
                .position(|b| b.0 == v)
                .expect("arcs both ways");
            rooms[w][back].1 += least;
        }
        flow += least;
    }
}

#[test]
fn a_grid_is_cut_as_by_the_largest_flow() {
    const SIDE: usize = 30;
    let at = |x: usize, y: usize| SIDE * y + x;
    for seed in 0..4 {
        let mut lcg = Lcg(seed);
        let blob = |i: usize, k: usize| u64::from((i / 5 + i / SIDE / 6) % 2 == k);
        let unary: Vec<[u64; 2]> = (0..SIDE * SIDE)
            .map(|i| [0, 1].map(|k| lcg.below(40) * (1 + blob(i, k))))
            .collect();
        let mut pairs = Vec::new();
        for (x, y) in (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE)) {
            let mut pair = |to: usize| {
                let [b, c] = [0, 0].map(|_| lcg.below(12 + 8 * seed) as f64);
                pairs.push((at(x, y), to, [0.0, b, c, 0.0]));
            };
            if x + 1 < SIDE {
                pair(at(x + 1, y));
            }
            if y + 1 < SIDE {
                pair(at(x, y + 1));
            }
        }
        // FlowNode 0 is the source, its side 0; what it costs to be 1 is cut from it.
        let mut rooms = vec![Vec::new(); SIDE * SIDE + 2];
        let mut arcs = |v: usize, w: usize, there: i64, back: i64| {
            rooms[v].push((w, there));
            rooms[w].push((v, back));
        };
        for (i, [zero, one]) in unary.iter().enumerate() {
            arcs(0, i + 1, one.cast_signed(), 0);
            arcs(i + 1, SIDE * SIDE + 1, zero.cast_signed(), 0);
        }
        for (i, j, [_, b, c, _]) in &pairs {
            arcs(i + 1, j + 1, *b as i64, *c as i64);
        }
        let instance = CutInstance {
            unary: unary.iter().map(|u| u.map(|u| u as f64)).collect(),
            pairs,
        };
        let x = instance.minimum();
        let ones = x.iter().filter(|x| **x).count();
        assert!((100..800).contains(&ones), "too easy: {ones} ones");
        assert_eq!(instance.value(&x), largest_flow(rooms) as f64);
    }
}
