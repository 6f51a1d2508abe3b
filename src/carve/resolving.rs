//! What rounding to f32 took.

/// What it took to make a solid of what booleans gave.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resolving {
    /// Pairs of faces that rounding to f32 brought into each other's way.
    pub pairs: usize,
    /// Rounds until there was none.
    pub rounds: usize,
    /// No point of the surface was moved by more, millimetres.
    pub moved_mm: f64,
}

impl Resolving {
    pub(super) fn add(&mut self, other: &Self) {
        self.pairs += other.pairs;
        self.rounds = self.rounds.max(other.rounds);
        self.moved_mm = self.moved_mm.max(other.moved_mm);
    }
}
