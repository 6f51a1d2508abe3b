//! Which faces and vertices of a mesh hang together.
//!
//! Takes any indexed mesh whose indices are in range; gives answers that depend on face order only (sorted arrays,
//! no hash order). Knows nothing of positions: weld first if equal positions are to count as one vertex.

use crate::index::{ComponentId, FaceId, VertexId, indices};
use crate::mesh::tri_mesh::TriMesh;

/// One side of a face: the edge from corner `k` to corner `k + 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct HalfEdge {
    /// The smaller and the larger of its two vertex indices.
    pub low: VertexId,
    pub high: VertexId,
    pub face: FaceId,
    /// Corner of the face it starts at, 0 to 2.
    pub corner: u8,
    /// Whether it runs from `low` to `high`.
    pub forward: bool,
}

indices! {
    /// A corner of a face: three a face, in their order.
    FaceCorner
}

impl FaceCorner {
    /// Corner `k` of a face.
    pub const fn of(face: FaceId, k: usize) -> Self {
        Self(3 * face.0 + (k % 3) as u32)
    }

    /// The vertex there.
    pub fn vertex(self, mesh: &TriMesh) -> VertexId {
        mesh.faces[self.face()][self.k()]
    }

    pub const fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    pub const fn k(self) -> usize {
        self.at() % 3
    }
}

/// From corner to corner of a face, beginning at the first.
pub fn sides(face: [VertexId; 3]) -> [[VertexId; 2]; 3] {
    let [a, b, c] = face;
    [[a, b], [b, c], [c, a]]
}

impl HalfEdge {
    /// Where it starts (0) and ends (1).
    pub fn end(&self, end: usize) -> FaceCorner {
        FaceCorner::of(self.face, usize::from(self.corner) + end)
    }
}

/// All half-edges of a mesh, those of the same edge next to each other in face order.
///
/// Faces that repeat an index give half-edges too, except from a vertex to itself.
#[derive(Clone, Debug)]
pub struct Edges {
    half: Vec<HalfEdge>,
}

impl Edges {
    pub fn new(mesh: &TriMesh) -> Self {
        let mut half = Vec::with_capacity(3 * mesh.faces.len());
        for (face, v) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
            for corner in 0..3 {
                let (from, to) = (v[corner], v[(corner + 1) % 3]);
                if from != to {
                    half.push(HalfEdge {
                        low: from.min(to),
                        high: from.max(to),
                        face,
                        corner: corner as u8,
                        forward: from < to,
                    });
                }
            }
        }
        Self {
            half: sorted_by_vertex(half, |h| h.low),
        }
    }

    /// The half-edges of each edge, edges by rising vertex indices.
    pub fn iter(&self) -> impl Iterator<Item = &[HalfEdge]> {
        self.half
            .chunk_by(|a, b| (a.low, a.high) == (b.low, b.high))
    }
}

/// Sorted, where the order of items begins with that of a vertex: in linear time, as few items share one.
pub(crate) fn sorted_by_vertex<T: Ord + Copy>(
    items: Vec<T>,
    vertex: impl Fn(&T) -> VertexId,
) -> Vec<T> {
    let (Some(any), Some(last)) = (items.first().copied(), items.iter().map(&vertex).max()) else {
        return items;
    };
    let mut end = vec![0usize; last.at() + 1];
    items.iter().for_each(|x| end[vertex(x)] += 1);
    let mut before = 0;
    for slot in &mut end {
        before += std::mem::replace(slot, before);
    }
    let mut sorted = vec![any; items.len()];
    for x in &items {
        let slot = &mut end[vertex(x)];
        sorted[*slot] = *x;
        *slot += 1;
    }
    let mut start = 0;
    for end in end {
        sorted[start..end].sort_unstable();
        start = end;
    }
    sorted
}

/// The faces around each vertex, rising; a face that names a vertex twice is there twice.
pub(crate) fn faces_around(mesh: &TriMesh) -> Vec<Vec<FaceId>> {
    let mut around = vec![Vec::new(); mesh.vertices.len()];
    for (f, face) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
        face.iter().for_each(|v| around[*v].push(f));
    }
    around
}

/// For each face the number of its component, components being joined by shared edges (also edges of more than two
/// faces) and numbered by their first face.
pub fn face_components(mesh: &TriMesh) -> Vec<ComponentId> {
    face_components_of(&Edges::new(mesh), mesh.faces.len())
}

/// As [`face_components`], for edges already at hand.
pub fn face_components_of(edges: &Edges, faces: usize) -> Vec<ComponentId> {
    let mut sets = DisjointSets::new(faces);
    for edge in edges.iter() {
        for pair in edge.windows(2) {
            sets.join(pair[0].face.0, pair[1].face.0);
        }
    }
    sets.numbers().1.into_iter().map(ComponentId).collect()
}

/// The neighbour of each face over its edge `k` (from corner `k` to corner `k + 1`); `None` where the edge is open or
/// has more than two faces. Winding plays no part.
pub fn face_neighbours(mesh: &TriMesh) -> Vec<[Option<FaceId>; 3]> {
    let mut neighbours = vec![[None; 3]; mesh.faces.len()];
    for edge in Edges::new(mesh).iter() {
        if let [a, b] = edge {
            neighbours[a.face][usize::from(a.corner)] = Some(b.face);
            neighbours[b.face][usize::from(b.corner)] = Some(a.face);
        }
    }
    neighbours
}

/// The number of parts joined by shared vertices, and for each vertex the part it is in: parts are numbered by their
/// lowest vertex, vertices without a face are in none.
pub fn vertex_parts(mesh: &TriMesh) -> (usize, Vec<Option<usize>>) {
    let mut sets = DisjointSets::new(mesh.vertices.len());
    let mut used = vec![false; mesh.vertices.len()];
    for &[a, b, c] in &mesh.faces {
        sets.join(a.0, b.0);
        sets.join(b.0, c.0);
        for v in [a, b, c] {
            used[v] = true;
        }
    }
    let mut number_of_root = vec![None; used.len()];
    let mut parts = 0;
    let mut part = |v: VertexId| {
        let root = VertexId(sets.root(v.0));
        *number_of_root[root].get_or_insert_with(|| {
            parts += 1;
            parts - 1
        })
    };
    let part_of = VertexId::all(used.len())
        .map(|v| used[v].then(|| part(v)))
        .collect();
    (parts, part_of)
}

/// Vertices at which faces meet without being joined by edges (two cones tip to tip), rising.
pub fn bowtie_vertices(mesh: &TriMesh, edges: &Edges) -> Vec<VertexId> {
    let mut sets = DisjointSets::new(3 * mesh.faces.len());
    let corner_at = |h: &HalfEdge, low: bool| {
        let start = h.forward == low;
        h.end(usize::from(!start)).0
    };
    for edge in edges.iter() {
        for pair in edge.windows(2) {
            for low in [true, false] {
                sets.join(corner_at(&pair[0], low), corner_at(&pair[1], low));
            }
        }
    }
    let mut fan_of_vertex = vec![None; mesh.vertices.len()];
    let mut bowties = Vec::new();
    for (face, vertices) in FaceId::all(mesh.faces.len()).zip(&mesh.faces) {
        for (k, &v) in vertices.iter().enumerate() {
            // A face that repeats an index has two corners there; that is reported as such, not as a bowtie.
            if vertices.iter().filter(|&&w| w == v).count() > 1 {
                continue;
            }
            let fan = sets.root(FaceCorner::of(face, k).0);
            if *fan_of_vertex[v].get_or_insert(fan) != fan {
                bowties.push(v);
            }
        }
    }
    bowties.sort_unstable();
    bowties.dedup();
    bowties
}

indices! {
    /// A member of a set.
    MemberId
}

/// Union-find over whatever has numbers; the root of a set is its smallest member.
pub struct DisjointSets {
    parent: Vec<MemberId>,
}

impl DisjointSets {
    pub fn new(len: usize) -> Self {
        Self {
            parent: MemberId::all(len).collect(),
        }
    }

    pub fn root(&mut self, x: u32) -> u32 {
        let mut x = MemberId(x);
        while self.parent[x] != x {
            let up = self.parent[self.parent[x]];
            self.parent[x] = up;
            x = up;
        }
        x.0
    }

    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[MemberId(a.max(b))] = MemberId(a.min(b));
    }

    /// The number of sets, and the number of the set of each member; sets are numbered by their smallest member.
    pub fn numbers(&mut self) -> (usize, Vec<u32>) {
        let mut numbers = vec![0; self.parent.len()];
        let mut count = 0;
        for x in MemberId::all(self.parent.len()) {
            let root = MemberId(self.root(x.0));
            if root == x {
                numbers[x] = count;
                count += 1;
            } else {
                numbers[x] = numbers[root];
            }
        }
        (count as usize, numbers)
    }

    /// The members of each set, rising; sets by their smallest member.
    pub fn members(&mut self) -> Vec<Vec<usize>> {
        let mut set_of_root = vec![None; self.parent.len()];
        let mut sets: Vec<Vec<usize>> = Vec::new();
        for x in MemberId::all(self.parent.len()) {
            let root = MemberId(self.root(x.0));
            let set = *set_of_root[root].get_or_insert_with(|| {
                sets.push(Vec::new());
                sets.len() - 1
            });
            sets[set].push(x.at());
        }
        sets
    }
}
