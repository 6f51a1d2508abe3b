//! Vertices with a coordinate that is none (scanners leave holes that way): no harm if no face uses them.

use crate::diag::{Diagnostic, Place};

/// The flawed vertices of a file; `At` is where its reader finds them again.
#[derive(Clone, Debug)]
pub(super) struct Flaws<At> {
    /// Rising by vertex.
    list: Vec<Flaw<At>>,
}

#[derive(Clone, Debug)]
pub(super) struct Flaw<At> {
    /// Counted from 0.
    pub vertex: usize,
    pub at: At,
    /// What the coordinate is, as a message goes on after "a coordinate that is".
    pub why: String,
}

impl<At> Default for Flaws<At> {
    fn default() -> Self {
        Self { list: Vec::new() }
    }
}

impl<At> Flaws<At> {
    /// `vertex` is above all that were added.
    pub(super) fn add(&mut self, vertex: usize, at: At, why: String) {
        self.list.push(Flaw { vertex, at, why });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Which of `count` vertices are without flaws.
    pub(super) fn sound(&self, count: usize) -> Vec<bool> {
        let mut sound = vec![true; count];
        self.list.iter().for_each(|f| sound[f.vertex] = false);
        sound
    }

    /// The flaw of the lowest vertex that is among those `used`.
    pub(super) fn first_used(
        &self,
        count: usize,
        used: impl Iterator<Item = usize>,
    ) -> Option<&Flaw<At>> {
        let sound = self.sound(count);
        let first = used.filter(|v| sound.get(*v) == Some(&false)).min()?;
        self.list.iter().find(|f| f.vertex == first)
    }

    /// A warning that they are not in the mesh.
    pub(super) fn left_out(&self, file: &str) -> Option<Diagnostic> {
        let message = match self.list.len() {
            0 => return None,
            1 => "left out 1 vertex that no face uses and whose coordinates are not finite numbers"
                .to_owned(),
            n => format!(
                "left out {n} vertices that no face uses and whose coordinates are not finite numbers"
            ),
        };
        Some(Diagnostic::warning(message).at(Place::File(file.to_owned())))
    }
}
