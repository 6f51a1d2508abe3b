//! What was bent and merged in a complex, and what that makes of a face.
//!
//! A bent edge never comes back: a face that has it becomes its two parts, each with a shorter edge if the corner is not at one of its
//! ends (which [`glue`](super::glue) sees to). The same goes for bent faces. Parts may have bent edges again; as sums of faces in which
//! opposite ones cancel ([`Chain`]) they stay few however often that happens.

use crate::index::VertexId;
use crate::mesh::topology::sides;
use std::collections::{BTreeMap, HashMap};

/// Faces with rising corners, and how many times each counts; turned over, it counts against.
pub(super) type Chain = BTreeMap<[VertexId; 3], i32>;

/// A face that would be a part of itself, and the corner that it goes through.
#[derive(Debug)]
pub(super) struct Contradiction {
    pub face: [VertexId; 3],
    pub through: VertexId,
}

#[derive(Default)]
pub(super) struct Bends {
    /// The corner that each bent edge goes through. Looked up, never iterated.
    edges: HashMap<[VertexId; 2], VertexId>,
    /// The corner that each bent face goes through. Looked up, never iterated.
    faces: HashMap<[VertexId; 3], VertexId>,
    /// Where each merged vertex went. Looked up, never iterated.
    merged: HashMap<VertexId, VertexId>,
}

impl Bends {
    pub(super) fn bend_edge(&mut self, edge: [VertexId; 2], v: VertexId) {
        self.edges.insert(ends(edge), v);
    }

    pub(super) fn bend_face(&mut self, face: [VertexId; 3], v: VertexId) {
        self.faces.insert(sorted(face), v);
    }

    pub(super) fn merge(&mut self, from: VertexId, to: VertexId) {
        self.merged.insert(from, to);
    }

    /// Where a vertex is now.
    pub(super) fn now(&self, mut v: VertexId) -> VertexId {
        while let Some(to) = self.merged.get(&v) {
            v = *to;
        }
        v
    }

    pub(super) fn is_bent_edge(&self, edge: [VertexId; 2]) -> bool {
        self.edges.contains_key(&ends(edge))
    }

    /// The corner that a face goes through because it, or one of its edges, was bent; and the parts that makes of it. A side that goes
    /// through the face's own third corner comes first: it leaves nothing of the face, while any other may lead back to it.
    pub(super) fn parts(&self, face: [VertexId; 3]) -> Option<(VertexId, Vec<[VertexId; 3]>)> {
        let through = |v: VertexId, corners: &[VertexId]| {
            let parts = corners.iter().map(|out| replaced(face, *out, v));
            (!corners.contains(&v)).then(|| (v, parts.collect()))
        };
        let bent = |[a, b]: [VertexId; 2]| self.edges.get(&ends([a, b])).map(|v| self.now(*v));
        let own = |side| bent(side).filter(|v| !side.contains(v) && face.contains(v));
        if let Some(v) = sides(face).into_iter().find_map(own) {
            return Some((v, Vec::new()));
        }
        let of_side = |[a, b]: [VertexId; 2]| through(bent([a, b])?, &[b, a]);
        let of_face = || through(self.now(*self.faces.get(&sorted(face))?), &face);
        sides(face).into_iter().find_map(of_side).or_else(of_face)
    }

    /// What the sum of some faces becomes.
    ///
    /// # Errors
    /// If bends lead in a circle.
    pub(super) fn chain(&self, faces: &[[VertexId; 3]]) -> Result<Chain, Contradiction> {
        let mut unfolding = Unfolding {
            bends: self,
            known: Default::default(),
            open: Vec::new(),
        };
        unfolding.sum(faces)
    }
}

struct Unfolding<'a> {
    bends: &'a Bends,
    /// What faces with rising corners become. Looked up, never iterated.
    known: HashMap<[VertexId; 3], Chain>,
    /// The faces that those in hand are parts of.
    open: Vec<[VertexId; 3]>,
}

impl Unfolding<'_> {
    fn sum(&mut self, faces: &[[VertexId; 3]]) -> Result<Chain, Contradiction> {
        let mut sum = Chain::new();
        for (face, sign) in faces.iter().filter_map(|face| oriented(*face)) {
            if !self.known.contains_key(&face) {
                let becomes = self.unfold(face)?;
                self.known.insert(face, becomes);
            }
            for (part, times) in &self.known[&face] {
                *sum.entry(*part).or_insert(0) += sign * times;
            }
        }
        sum.retain(|_, times| *times != 0);
        Ok(sum)
    }

    fn unfold(&mut self, face: [VertexId; 3]) -> Result<Chain, Contradiction> {
        let Some((through, parts)) = self.bends.parts(face) else {
            return Ok(Chain::from([(face, 1)]));
        };
        if self.open.contains(&face) {
            return Err(Contradiction { face, through });
        }
        self.open.push(face);
        let becomes = self.sum(&parts)?;
        self.open.pop();
        Ok(becomes)
    }
}

/// A face with one corner in place of another.
pub(super) fn replaced(face: [VertexId; 3], out: VertexId, by: VertexId) -> [VertexId; 3] {
    face.map(|v| if v == out { by } else { v })
}

/// With rising corners, and 1, or -1 where that turns it over; `None` for a face that names a vertex twice.
fn oriented(face: [VertexId; 3]) -> Option<([VertexId; 3], i32)> {
    let [a, b, c] = sorted(face);
    let along = [[a, b, c], [b, c, a], [c, a, b]];
    let sign = if along.contains(&face) { 1 } else { -1 };
    (a != b && b != c).then_some(([a, b, c], sign))
}

fn ends([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

fn sorted(mut face: [VertexId; 3]) -> [VertexId; 3] {
    face.sort_unstable();
    face
}
