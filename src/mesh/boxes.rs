//! A tree of boxes in f64, for exact overlap questions.
//!
//! Takes closed boxes, gives for a query box every box that overlaps or touches it. Nothing is padded or rounded.
//! (The trees of the `bvh` module are f32 and made for rays.)

use crate::index::{FaceId, indices};
use crate::mesh::tri_mesh::TriMesh;
use glam::DVec3;

/// A closed box: smallest and largest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box3 {
    pub lo: DVec3,
    pub hi: DVec3,
}

impl Box3 {
    /// Of a whole mesh; `None` without vertices.
    pub fn of(mesh: &TriMesh) -> Option<Self> {
        mesh.bounds().map(|(lo, hi)| Self { lo, hi })
    }

    pub fn of_face(mesh: &TriMesh, face: FaceId) -> Self {
        let [a, b, c] = mesh.corners(face);
        Self {
            lo: a.min(b).min(c),
            hi: a.max(b).max(c),
        }
    }

    /// Of all faces, in their order.
    pub fn of_faces(mesh: &TriMesh) -> Vec<Self> {
        let faces = FaceId::all(mesh.faces.len());
        faces.map(|f| Self::of_face(mesh, f)).collect()
    }

    pub fn overlaps(&self, other: &Self) -> bool {
        self.lo.cmple(other.hi).all() && other.lo.cmple(self.hi).all()
    }

    /// What two boxes have in common, if they meet.
    pub fn common(&self, other: &Self) -> Option<Self> {
        self.overlaps(other).then(|| Self {
            lo: self.lo.max(other.lo),
            hi: self.hi.min(other.hi),
        })
    }

    fn union(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }
}

/// More boxes in a leaf make the tree smaller but each query test more boxes; 2 to 8 are within 20 % of each other.
const LEAF: usize = 4;
/// Halving 2^32 boxes down to leaves needs fewer levels than this.
const MAX_DEPTH: usize = 48;

indices! {
    /// A box: its place among those given.
    BoxId
    /// A node of a tree.
    NodeId
}

/// A leaf of a tree.
#[derive(Clone, Copy, Debug)]
pub struct LeafId(NodeId);

struct Node {
    bounds: Box3,
    /// A leaf's items are `first .. first + count`; an inner node has `count` 0, its left child follows it directly
    /// and `first` is its right child.
    first: u32,
    count: u32,
}

/// Boxes in a balanced tree.
pub struct BoxTree {
    nodes: Vec<Node>,
    /// Box numbers and boxes in tree order.
    order: Vec<BoxId>,
    boxes: Vec<Box3>,
}

impl BoxTree {
    pub fn new(boxes: &[Box3]) -> Self {
        let centred = |id: BoxId| Centred {
            centre: boxes[id].lo + boxes[id].hi,
            id,
        };
        let mut order: Vec<Centred> = BoxId::all(boxes.len()).map(centred).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        if !boxes.is_empty() {
            split(&mut order, 0, boxes, &mut nodes);
        }
        Self {
            nodes,
            boxes: order.iter().map(|c| boxes[c.id]).collect(),
            order: order.into_iter().map(|c| c.id).collect(),
        }
    }

    /// Of all faces of a mesh, numbered as they are.
    pub fn of_faces(mesh: &TriMesh) -> Self {
        Self::new(&Box3::of_faces(mesh))
    }

    /// In an order in which neighbours are near each other.
    pub fn leaves(&self) -> Vec<LeafId> {
        let all = NodeId::all(self.nodes.len());
        let leaves = all.filter(|n| self.nodes[*n].count > 0);
        leaves.map(LeafId).collect()
    }

    /// Calls `visit` with every two boxes that meet, of which one is in the leaf and the other one there too or in a later leaf; stops
    /// when it returns false.
    pub fn meeting(&self, leaf: LeafId, mut visit: impl FnMut([BoxId; 2]) -> bool) {
        let LeafId(leaf) = leaf;
        let bounds = self.nodes[leaf].bounds;
        let mut stack = [NodeId(0); MAX_DEPTH];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index];
            if !node.bounds.overlaps(&bounds) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = NodeId(node.first);
                depth += 1;
                // What is left of a node has smaller numbers than what is right of it.
                if node.first > leaf.0 {
                    stack[depth] = index.plus(1);
                    depth += 1;
                }
            } else if index >= leaf && !self.meeting_of(leaf, index, &mut visit) {
                return;
            }
        }
    }

    /// The same of two leaves, the first not after the second; gives whether to go on.
    fn meeting_of(
        &self,
        leaf: NodeId,
        other: NodeId,
        visit: &mut impl FnMut([BoxId; 2]) -> bool,
    ) -> bool {
        let items = |n: NodeId| {
            let node = &self.nodes[n];
            node.first as usize..(node.first + node.count) as usize
        };
        for i in items(leaf) {
            for j in items(other).filter(|j| leaf != other || *j > i) {
                let meet = self.boxes[i].overlaps(&self.boxes[j]);
                if meet && !visit([self.order[i], self.order[j]]) {
                    return false;
                }
            }
        }
        true
    }

    /// Whether a place lies in any of the boxes.
    pub fn covers(&self, place: DVec3) -> bool {
        let mut found = false;
        let point = Box3 {
            lo: place,
            hi: place,
        };
        self.overlapping(&point, |_| {
            found = true;
            false
        });
        found
    }

    /// Calls `visit` with the number of every box that meets `query`; stops when it returns false.
    pub fn overlapping(&self, query: &Box3, mut visit: impl FnMut(BoxId) -> bool) {
        let mut stack = [NodeId(0); MAX_DEPTH];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index];
            if !node.bounds.overlaps(query) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = NodeId(node.first);
                stack[depth + 1] = index.plus(1);
                depth += 2;
                continue;
            }
            for item in node.first as usize..(node.first + node.count) as usize {
                if self.boxes[item].overlaps(query) && !visit(self.order[item]) {
                    return;
                }
            }
        }
    }
}

/// A box on its way to a leaf.
struct Centred {
    /// Twice the centre.
    centre: DVec3,
    id: BoxId,
}

/// Adds the nodes of `order`, whose first item is item `offset` of the tree, and gives the bounds; halves at the median of the widest
/// axis.
fn split(order: &mut [Centred], offset: usize, boxes: &[Box3], nodes: &mut Vec<Node>) -> Box3 {
    let index = nodes.len();
    nodes.push(Node {
        bounds: boxes[order[0].id],
        first: offset as u32,
        count: order.len() as u32,
    });
    let bounds = if order.len() <= LEAF {
        let all = order.iter().map(|c| boxes[c.id]);
        all.fold(boxes[order[0].id], Box3::union)
    } else {
        let axis = centre_spread(order).max_position();
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |a, b| {
            let by_centre = a.centre[axis].total_cmp(&b.centre[axis]);
            by_centre.then(a.id.cmp(&b.id))
        });
        let (left, right) = order.split_at_mut(middle);
        let left = split(left, offset, boxes, nodes);
        nodes[index].first = nodes.len() as u32;
        nodes[index].count = 0;
        left.union(split(right, offset + middle, boxes, nodes))
    };
    nodes[index].bounds = bounds;
    bounds
}

fn centre_spread(order: &[Centred]) -> DVec3 {
    let first = order[0].centre;
    let (lo, hi) = order.iter().fold((first, first), |(lo, hi), c| {
        (lo.min(c.centre), hi.max(c.centre))
    });
    hi - lo
}
