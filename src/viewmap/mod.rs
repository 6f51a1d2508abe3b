//! The view map: what one eye sees, and on which support, as a planar arrangement of its image.
//!
//! Takes the image plane of an eye, the mesh it is to see and the supports with their ray casters.
//! Gives a triangulation of the image in which every cell lies in one model face (the front-most, or none) and on one
//! support (the first hit, or none), with solid angles. Promises: cells are counter-clockwise, share their points,
//! do not overlap and cover a rectangle around the model; no cell is thinner than [`TIDY_MM`] at the model's distance
//! except where the triangulation cannot give way. Does *not* promise anything about depth.
//!
//! The edges of every face that is seen at all and the seen parts of the supports' outlines (and edges, where a layer follows
//! their surface, so that every cell lies on one of its planes) are constraints of a
//! constrained Delaunay triangulation (`spade`, split at crossings). Labels come from one ray a cell; a cell that
//! sticks out of the face its ray met proves that a face is missing, which is then found, added, and the map rebuilt.

mod arrange;
mod outline;
mod tidy;

use crate::bvh::{Bvh, Hit};
use crate::geom::{ImagePlane, barycentric, orient};
use crate::mesh::{DisjointSets, Edges, TriMesh, face_components};
use crate::support::{Datum, Support, SupportKind};
use crate::view::Marks;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Cells thinner than this, in millimetres at the model's mean distance, are merged away: below it, f32 coordinates and
/// exact intersection tests of finished solids no longer agree (0.0005 leaves some crossings), above it lines visibly shift.
pub const TIDY_MM: f64 = 0.002;

/// Rounds of finding faces that the first guess missed. The creatures and scans need two or three.
const MAX_ROUNDS: usize = 5;

/// One triangle of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Indices of image points, counter-clockwise.
    pub corners: [u32; 3],
    /// The model face seen here.
    pub face: Option<u32>,
    /// The support first hit here.
    pub support: Option<u32>,
    /// The face of the supports' mesh hit here, for [`SupportField::facet_depth`].
    pub facet: Option<u32>,
    /// The face of the supports' mesh at which rays leave the wall behind, where a layer goes through that.
    pub leaves: Option<u32>,
    /// Depth along the forward axis at which the cell's centre meets it; infinite without.
    pub support_depth: f64,
    /// Which corners lie on the outline of the face's component, as the eye sees it.
    pub outline: [bool; 3],
}

/// See the module.
#[derive(Clone, Debug)]
pub struct ViewMap {
    pub plane: ImagePlane,
    pub points: Vec<DVec2>,
    pub cells: Vec<Cell>,
    /// The cell across the side from corner `k` to `k + 1`.
    pub neighbours: Vec<[Option<u32>; 3]>,
    /// Solid angle in steradians of cells whose label was still in doubt after the last round: 0 unless faces are tangled.
    pub doubtful_sr: f64,
}

impl ViewMap {
    pub fn triangle(&self, cell: usize) -> [DVec2; 3] {
        self.cells[cell].corners.map(|p| self.points[p as usize])
    }

    /// Number of connected regions of cells that are `inside`.
    pub fn regions(&self, inside: impl Fn(usize) -> bool) -> usize {
        let mut sets = DisjointSets::new(self.cells.len());
        let pairs = (0..self.cells.len())
            .flat_map(|c| self.neighbours[c].iter().flatten().map(move |n| (c, *n)));
        pairs
            .filter(|(c, n)| inside(*c) && inside(*n as usize))
            .for_each(|(c, n)| sets.join(c as u32, n));
        (0..self.cells.len())
            .filter(|c| inside(*c) && sets.root(*c as u32) == *c as u32)
            .count()
    }

    /// Mean of three image points.
    pub fn points_mean(&self, corners: [u32; 3]) -> DVec2 {
        corners
            .iter()
            .map(|p| self.points[*p as usize])
            .sum::<DVec2>()
            / 3.0
    }

    /// Solid angle of a cell in steradians, as [`ImagePlane::solid_angle`] has it.
    pub fn solid_angle(&self, cell: usize) -> f64 {
        self.plane.solid_angle(self.triangle(cell)).abs()
    }
}

/// The supports as one target for rays.
pub struct SupportField<'a> {
    pub supports: &'a [Support],
    mesh: TriMesh,
    /// Support of every face, and first face of every support.
    owner: Vec<u32>,
    first: Vec<u32>,
    bvh: Bvh,
}

impl<'a> SupportField<'a> {
    pub fn new(supports: &'a [Support]) -> Self {
        let mut mesh = TriMesh::default();
        let (mut owner, mut first) = (Vec::new(), Vec::new());
        for (i, support) in supports.iter().enumerate() {
            first.push(mesh.faces.len() as u32);
            mesh.append(&support.mesh);
            owner.resize(mesh.faces.len(), i as u32);
        }
        let bvh = Bvh::new(&mesh);
        Self {
            supports,
            mesh,
            owner,
            first,
            bvh,
        }
    }

    /// The first support on a ray and the ray's parameter there.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(u32, f64)> {
        self.bvh
            .first_hit(origin, direction)
            .map(|h| (self.owner[h.face], h.t))
    }

    /// The ray's parameter at the plane of a face of the supports; not finite if they are parallel.
    pub fn facet_depth(&self, facet: u32, origin: DVec3, direction: DVec3) -> f64 {
        let normal = self.mesh.area_vector(facet as usize);
        let corner = self.mesh.corners(facet as usize)[0];
        normal.dot(corner - origin) / normal.dot(direction)
    }

    /// As [`Self::first_hit`], of one support, whatever stands before it.
    pub fn hit_of(&self, support: u32, origin: DVec3, direction: DVec3) -> Option<f64> {
        let own = |face: usize| self.owner[face] == support;
        let hit = self.bvh.first_hit_where(origin, direction, own);
        hit.map(|h| h.t)
    }

    /// How thick a support is behind where a ray first meets it, in units of the ray's direction; infinite if it never leaves it.
    pub fn thickness(&self, support: u32, origin: DVec3, direction: DVec3) -> f64 {
        let found = self.wall(support, origin, direction);
        found.map_or(f64::INFINITY, |(first, leaves)| leaves.t - first.t)
    }

    /// Where a ray first meets a support and where it leaves it again.
    pub fn wall(&self, support: u32, origin: DVec3, direction: DVec3) -> Option<(Hit, Hit)> {
        let hits = self.bvh.all_hits(origin, direction).into_iter();
        let mut own = hits.filter(|h| self.owner[h.face] == support);
        let leaves = |face: usize| self.mesh.area_vector(face).dot(direction) > 0.0;
        Some((own.next()?, own.find(|h| leaves(h.face))?))
    }

    /// Whether the layer of a support goes through walls.
    fn goes_through(&self, support: u32) -> bool {
        let layer = self.supports[support as usize].layer;
        layer.is_some_and(|l| l.through)
    }

    /// The part of its support that a face of the supports' mesh belongs to.
    pub fn part(&self, facet: u32) -> u32 {
        let support = self.owner[facet as usize];
        self.supports[support as usize].part((facet - self.first[support as usize]) as usize)
    }

    /// Whether the layer of the support that a face belongs to follows its surface.
    fn is_shell(&self, facet: u32) -> bool {
        let layer = self.supports[self.owner[facet as usize] as usize].layer;
        layer.is_some_and(|l| l.datum == Datum::Surface)
    }

    /// Top of the base, if there is one.
    fn base_top(&self) -> Option<f64> {
        self.supports.iter().find_map(|s| match s.kind {
            SupportKind::Base { top, .. } => Some(top),
            SupportKind::Pillar { .. } | SupportKind::Body { .. } => None,
        })
    }
}

/// What is looked at, ready for rays.
pub struct Target {
    pub mesh: TriMesh,
    pub bvh: Bvh,
    /// Image of every vertex in the plane the target was made for.
    pub image: Vec<DVec2>,
    /// Depth of every vertex along the plane's forward axis.
    pub depth: Vec<f64>,
    /// Factor on every vertex's weight `w` (paper Eq 13); empty: 1 everywhere.
    pub weights: Vec<f64>,
    /// Which vertices have no depth bounds; empty: none.
    pub free: Vec<bool>,
    /// Whether every edge has two faces: then only faces turned to the eye can be seen.
    closed: bool,
}

impl Target {
    /// `None` if part of the mesh does not lie in front of the eye.
    pub fn new(mesh: TriMesh, plane: &ImagePlane) -> Option<Self> {
        let image = mesh
            .vertices
            .iter()
            .map(|v| plane.project(*v))
            .collect::<Option<Vec<_>>>()?;
        let depth = mesh.vertices.iter().map(|v| plane.depth(*v)).collect();
        let closed = Edges::new(&mesh).iter().all(|e| e.len() == 2);
        Some(Self {
            bvh: Bvh::new(&mesh),
            mesh,
            image,
            depth,
            weights: Vec::new(),
            free: Vec::new(),
            closed,
        })
    }

    /// The same target with what a scene says of its vertices.
    pub fn marked(self, marks: Marks) -> Self {
        Self {
            weights: marks.weights,
            free: marks.free,
            ..self
        }
    }

    /// Factor on the weight of a vertex.
    pub fn weight(&self, vertex: u32) -> f64 {
        self.weights.get(vertex as usize).copied().unwrap_or(1.0)
    }

    /// Factor on the weight of a face: the mean of its vertices'.
    pub fn face_weight(&self, face: usize) -> f64 {
        if self.weights.is_empty() {
            return 1.0;
        }
        let corners = self.mesh.faces[face].map(|v| self.weight(v));
        corners.iter().sum::<f64>() / 3.0
    }

    /// Whether a vertex has no depth bounds.
    pub fn is_free(&self, vertex: u32) -> bool {
        self.free.get(vertex as usize) == Some(&true)
    }

    /// The same surface as another mesh: `mesh` has a vertex at each of `vertices` of this one.
    pub fn cut(&self, mesh: TriMesh, vertices: &[u32]) -> Self {
        Self {
            bvh: Bvh::new(&mesh),
            mesh,
            image: vertices.iter().map(|v| self.image[*v as usize]).collect(),
            depth: vertices.iter().map(|v| self.depth[*v as usize]).collect(),
            weights: picked(&self.weights, vertices),
            free: picked(&self.free, vertices),
            closed: false,
        }
    }

    pub fn image_of(&self, face: usize) -> [DVec2; 3] {
        self.mesh.faces[face].map(|v| self.image[v as usize])
    }

    /// Whether the face could be seen from the eye if nothing stood before it.
    fn may_be_seen(&self, face: usize) -> bool {
        let [a, b, c] = self.image_of(face);
        let turn = orient(a, b, c);
        turn > 0.0 || (turn < 0.0 && !self.closed)
    }
}

/// Entries of a list that is empty or has one for every vertex.
fn picked<T: Copy>(list: &[T], vertices: &[u32]) -> Vec<T> {
    if list.is_empty() {
        return Vec::new();
    }
    vertices.iter().map(|v| list[*v as usize]).collect()
}

/// Why no view map could be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewMapError {
    #[error("no part of the models is seen from the eye")]
    NothingSeen,
    #[error("the image could not be triangulated: {0}")]
    Triangulation(String),
}

/// Computes the view map of `target` over `supports`.
///
/// # Errors
/// If no face is seen, or the triangulation fails on every snapping grid tried.
pub fn view_map(
    plane: ImagePlane,
    target: &Target,
    supports: &SupportField,
) -> Result<ViewMap, ViewMapError> {
    let mut wanted = seen_at_samples(&plane, target);
    if !wanted.iter().any(|w| *w) {
        return Err(ViewMapError::NothingSeen);
    }
    let outlines = outline::seen_outlines(&plane, supports, image_box(target));
    let mut map = arrange::arrange(&plane, target, &wanted, &outlines)?;
    let mut doubtful = label(&mut map, target, supports);
    for _ in 1..MAX_ROUNDS {
        let missing = missing_faces(&map, target, &doubtful, &wanted);
        if missing.is_empty() {
            break;
        }
        missing.iter().for_each(|f| wanted[*f] = true);
        map = arrange::arrange(&plane, target, &wanted, &outlines)?;
        doubtful = label(&mut map, target, supports);
    }
    map.doubtful_sr = doubtful.iter().map(|c| map.solid_angle(*c)).sum();
    tidy::tidy(&mut map, TIDY_MM / plane.scale(mean(&target.depth)));
    mark_outlines(&mut map, &face_components(&target.mesh));
    Ok(map)
}

/// Marks the corners of cells that lie on sides where the image of their component ends.
fn mark_outlines(map: &mut ViewMap, component: &[u32]) {
    let of = |cell: &Cell| cell.face.map(|f| component[f as usize]);
    let mut marked: Vec<(u32, u32)> = Vec::new();
    for (cell, across) in map.cells.iter().zip(&map.neighbours) {
        let Some(own) = of(cell) else { continue };
        for (k, next) in across.iter().enumerate() {
            let beyond = next.and_then(|n| of(&map.cells[n as usize]));
            if beyond != Some(own) {
                marked.extend([k, (k + 1) % 3].map(|k| (cell.corners[k], own)));
            }
        }
    }
    marked.sort_unstable();
    for cell in &mut map.cells {
        if let Some(own) = of(cell) {
            cell.outline = cell
                .corners
                .map(|p| marked.binary_search(&(p, own)).is_ok());
        }
    }
}

/// The rectangle around the model's image, a little widened: the part of the image that is mapped.
fn image_box(target: &Target) -> (DVec2, DVec2) {
    let first = target.image[0];
    let (lo, hi) = target
        .image
        .iter()
        .fold((first, first), |(lo, hi), q| (lo.min(*q), hi.max(*q)));
    let margin = 0.02 * (hi - lo).max_element();
    (lo - margin, hi + margin)
}

/// Faces seen at their centre or near a corner.
fn seen_at_samples(plane: &ImagePlane, target: &Target) -> Vec<bool> {
    let is_seen = |f: usize| {
        let corners = target.image_of(f);
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        let samples = [
            centre,
            centre.lerp(corners[0], 0.9),
            centre.lerp(corners[1], 0.9),
            centre.lerp(corners[2], 0.9),
        ];
        samples
            .iter()
            .any(|q| seen_face(plane, target, *q) == Some(f))
    };
    (0..target.mesh.faces.len())
        .into_par_iter()
        .map(|f| target.may_be_seen(f) && is_seen(f))
        .collect()
}

/// The front-most face on the ray `q`.
fn seen_face(plane: &ImagePlane, target: &Target, q: DVec2) -> Option<usize> {
    let hit = target
        .bvh
        .first_hit_where(plane.eye, plane.direction(q), |f| target.may_be_seen(f));
    hit.map(|h| h.face)
}

/// Labels every cell by a ray through its centre; gives the cells that stick out of their face.
fn label(map: &mut ViewMap, target: &Target, supports: &SupportField) -> Vec<usize> {
    let labelled = |c| labelled(map, c, target, supports);
    map.cells = (0..map.cells.len()).into_par_iter().map(labelled).collect();
    let sticks_out = |c: &usize| {
        let face = map.cells[*c].face;
        face.is_some_and(|f| !holds(target.image_of(f as usize), map.triangle(*c)))
    };
    (0..map.cells.len()).filter(sticks_out).collect()
}

/// A cell with what the ray through its centre meets.
fn labelled(map: &ViewMap, c: usize, target: &Target, supports: &SupportField) -> Cell {
    let centre = map.points_mean(map.cells[c].corners);
    let direction = map.plane.direction(centre);
    let hit = supports.bvh.first_hit(map.plane.eye, direction);
    let support = hit.map(|h| supports.owner[h.face]);
    let through = support.filter(|s| supports.goes_through(*s));
    let wall = through.and_then(|s| supports.wall(s, map.plane.eye, direction));
    Cell {
        face: seen_face(&map.plane, target, centre).map(|f| f as u32),
        support,
        facet: hit.map(|h| h.face as u32),
        leaves: wall.map(|(_, leaves)| leaves.face as u32),
        support_depth: hit.map_or(f64::INFINITY, |h| h.t),
        ..map.cells[c]
    }
}

/// Whether `outer` holds all points of `inner` but for rounding.
fn holds(outer: [DVec2; 3], inner: [DVec2; 3]) -> bool {
    let [a, b, c] = outer;
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let area = (b - a).perp_dot(c - a).abs();
    // A point may lie outside by 1e-7 of the image: ten times the snapping grid, a fortieth of a micrometre at 250 mm.
    let slack = 1e-7 * longest / area + 1e-9;
    inner
        .iter()
        .all(|q| barycentric(a, b, c, *q).min_element() >= -slack)
}

/// Faces not yet wanted that rays near the corners of doubtful cells meet.
fn missing_faces(
    map: &ViewMap,
    target: &Target,
    doubtful: &[usize],
    wanted: &[bool],
) -> Vec<usize> {
    let mut found = Vec::new();
    for c in doubtful {
        let corners = map.triangle(*c);
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        for share in [0.0, 0.5, 0.98] {
            for corner in corners {
                found.extend(seen_face(&map.plane, target, centre.lerp(corner, share)));
            }
        }
    }
    found.retain(|f| !wanted[*f]);
    found.sort_unstable();
    found.dedup();
    found
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
