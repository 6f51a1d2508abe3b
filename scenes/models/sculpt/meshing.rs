//! From an implicit surface to a closed triangle mesh with well-shaped faces.
//!
//! Takes a field and a wanted edge length per point; gives one connected, closed, outward oriented mesh whose vertices
//! lie on the surface. `manifold_rust` finds the surface (marching tetrahedra, guaranteed manifold); rounds of splitting,
//! collapsing, flipping and tangential smoothing with projection then even out the triangles, after Botsch and Kobbelt,
//! "A Remeshing Approach to Multiresolution Modeling" (2004).

use crate::field::{Field, gradient, settle};
use glam::DVec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::Box as Bounds;
use rayon::prelude::*;

/// Number of rounds of remeshing; after about eight the smallest angles no longer grow.
const ROUNDS: usize = 8;
/// Edges above this multiple of the wanted length are split, edges below [`SHORT`] collapsed (Botsch and Kobbelt's 4/3, 4/5).
const LONG: f64 = 4.0 / 3.0;
const SHORT: f64 = 4.0 / 5.0;
/// Normal curvature in 1/mm at which the wanted edge length is exactly the creature's own; flatter places get longer
/// edges, the steps between feathers or scales shorter ones (as in Dunyach et al., "Adaptive Remeshing for Real-Time Mesh
/// Deformation", 2013), within the factors [`FINEST`] and [`COARSEST`].
const CURVATURE: f64 = 0.55;
const FINEST: f64 = 0.66;
const COARSEST: f64 = 1.5;
/// Smallest shape (see `Editor::shape`) a triangle may take when edges are turned along ridges: smallest angle about 22
/// degrees; below 0.5 slivers appear, above 0.75 ridges stay jagged.
const PLAIN: f64 = 0.6;
/// Marks a face that a collapse has removed.
const DEAD: [u32; 3] = [u32::MAX; 3];

/// Triangle mesh: positions in mm, faces counter-clockwise from outside.
pub(crate) struct Mesh {
    pub points: Vec<DVec3>,
    pub faces: Vec<[u32; 3]>,
}

/// What is to be meshed.
pub(crate) struct Creature {
    /// The finished surface.
    pub field: Box<Field>,
    /// A box around it, mm.
    pub low: DVec3,
    pub high: DVec3,
    /// Wanted edge length at a point of the surface, mm.
    pub edge: Box<Field>,
}

/// Meshes a creature; `pitch` is the spacing of the first grid in mm.
pub(crate) fn sculpt(creature: &Creature, pitch: f64) -> Result<Mesh, String> {
    let field = &*creature.field;
    let first = polygonise(creature, pitch)?;
    let mut editor = Editor::new(largest_part(first));
    for _ in 0..ROUNDS {
        editor.measure(field, &*creature.edge);
        editor.split_long(field);
        editor.collapse_short(field);
        editor.flip_edges();
        editor.relax(field);
    }
    editor.flip_edges();
    editor.settle_all(field, 6);
    editor.align(field);
    Ok(editor.finish())
}

/// First mesh on a regular grid.
fn polygonise(creature: &Creature, pitch: f64) -> Result<Mesh, String> {
    let field = &*creature.field;
    let coarse = Coarse::new(creature);
    let corner = |p: DVec3| manifold_rust::linalg::Vec3::new(p.x, p.y, p.z);
    let bounds = Bounds {
        min: corner(creature.low),
        max: corner(creature.high),
    };
    let inside = |q: manifold_rust::linalg::Vec3| {
        let p = DVec3::new(q.x, q.y, q.z);
        -coarse.far(p).unwrap_or_else(|| field(p))
    };
    let solid = Manifold::level_set_with_tolerance(inside, bounds, pitch, 0.0, pitch * 0.02);
    if solid.is_empty() {
        return Err("the field encloses nothing inside its box".into());
    }
    let gl = solid.get_mesh_gl64(-1);
    let n = gl.num_prop as usize;
    let points = gl
        .vert_properties
        .chunks_exact(n)
        .map(DVec3::from_slice)
        .collect();
    let faces = gl
        .tri_verts
        .chunks_exact(3)
        .map(|t| [t[0] as u32, t[1] as u32, t[2] as u32])
        .collect();
    Ok(Mesh { points, faces })
}

/// Samples of the field 2 mm apart: tells quickly that a point is far from the surface.
struct Coarse {
    low: DVec3,
    dims: [usize; 3],
    samples: Vec<f64>,
}

impl Coarse {
    const PITCH: f64 = 2.0;
    /// Beyond this distance at the nearest sample a point cannot be on the surface (the fields' slopes stay below 2).
    const FAR: f64 = 4.5;

    fn new(creature: &Creature) -> Coarse {
        let dims = ((creature.high - creature.low) / Self::PITCH)
            .ceil()
            .to_array()
            .map(|n| n as usize + 1);
        let samples = (0..dims.iter().product())
            .into_par_iter()
            .map(|i: usize| {
                let cell = [i % dims[0], i / dims[0] % dims[1], i / dims[0] / dims[1]];
                let p = creature.low + DVec3::from_array(cell.map(|c| c as f64)) * Self::PITCH;
                (creature.field)(p)
            })
            .collect();
        Coarse {
            low: creature.low,
            dims,
            samples,
        }
    }

    fn far(&self, p: DVec3) -> Option<f64> {
        let q = ((p - self.low) / Self::PITCH)
            .round()
            .max(DVec3::ZERO)
            .to_array()
            .map(|c| c as usize);
        let [x, y, z] = std::array::from_fn(|a| q[a].min(self.dims[a] - 1));
        let d = self.samples[(z * self.dims[1] + y) * self.dims[0] + x];
        (d.abs() > Self::FAR).then_some(d)
    }
}

/// The connected part with most faces; smaller ones are bubbles between blended parts.
fn largest_part(mesh: Mesh) -> Mesh {
    let mut parent: Vec<u32> = (0..mesh.points.len() as u32).collect();
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            parent[i as usize] = parent[parent[i as usize] as usize];
            i = parent[i as usize];
        }
        i
    }
    for f in &mesh.faces {
        for (a, b) in [(f[0], f[1]), (f[1], f[2])] {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a as usize] = b;
        }
    }
    let mut count = vec![0usize; mesh.points.len()];
    for f in &mesh.faces {
        count[root(&mut parent, f[0]) as usize] += 1;
    }
    let best = (0..count.len()).max_by_key(|&i| (count[i], i)).unwrap_or(0) as u32;
    let faces = mesh
        .faces
        .iter()
        .copied()
        .filter(|f| root(&mut parent, f[0]) == best)
        .collect();
    Mesh {
        points: mesh.points,
        faces,
    }
}

/// A mesh under local edits: faces around every vertex are kept current.
struct Editor {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    around: Vec<Vec<u32>>,
    /// Wanted edge length at every vertex, mm.
    size: Vec<f64>,
}

impl Editor {
    fn new(mesh: Mesh) -> Editor {
        let mut around = vec![Vec::new(); mesh.points.len()];
        for (i, f) in mesh.faces.iter().enumerate() {
            for &c in f {
                around[c as usize].push(i as u32);
            }
        }
        Editor {
            size: vec![1.0; mesh.points.len()],
            points: mesh.points,
            faces: mesh.faces,
            around,
        }
    }

    fn at(&self, i: u32) -> DVec3 {
        self.points[i as usize]
    }

    /// Every edge once, as `(a, b)` with a < b, in order of faces.
    fn edges(&self) -> Vec<(u32, u32)> {
        let corners = self.faces.iter().filter(|f| **f != DEAD);
        corners
            .flat_map(|f| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])])
            .filter(|e| e.0 < e.1)
            .collect()
    }

    /// The faces left and right of edge a-b (a to b runs in the first one's direction) and their far corners.
    fn wings(&self, a: u32, b: u32) -> Option<[(u32, u32); 2]> {
        let far = |from: u32, to: u32| {
            self.around[from as usize].iter().find_map(|&i| {
                let f = self.faces[i as usize];
                (0..3)
                    .find(|&k| f[k] == from && f[(k + 1) % 3] == to)
                    .map(|k| (i, f[(k + 2) % 3]))
            })
        };
        Some([far(a, b)?, far(b, a)?])
    }

    fn cross(&self, f: [u32; 3]) -> DVec3 {
        let [a, b, c] = f.map(|i| self.at(i));
        (b - a).cross(c - a)
    }

    /// Shape of a triangle: 1 for an equilateral one, 0 for a degenerate one.
    fn shape(&self, f: [u32; 3]) -> f64 {
        let [a, b, c] = f.map(|i| self.at(i));
        let sum = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        2.0 * 3f64.sqrt() * self.cross(f).length() / sum
    }

    fn replace(&mut self, face: u32, new: [u32; 3]) {
        for c in self.faces[face as usize] {
            if c != u32::MAX {
                self.around[c as usize].retain(|&i| i != face);
            }
        }
        self.faces[face as usize] = new;
        for c in new {
            if c != u32::MAX {
                self.around[c as usize].push(face);
            }
        }
    }

    fn push(&mut self, face: [u32; 3]) {
        let i = self.faces.len() as u32;
        self.faces.push(face);
        for c in face {
            self.around[c as usize].push(i);
        }
    }

    /// Sets the wanted edge lengths from the creature's own and the curvature, graded over neighbouring vertices.
    fn measure(&mut self, field: &Field, edge: &Field) {
        let normals: Vec<DVec3> = self
            .points
            .par_iter()
            .map(|&p| gradient(field, p).normalize_or_zero())
            .collect();
        let local = |i: u32| {
            let p = self.at(i);
            let bend = self
                .neighbours(i)
                .into_iter()
                .map(|n| {
                    normals[n as usize].distance(normals[i as usize])
                        / self.at(n).distance(p).max(0.05)
                })
                .fold(0.0, f64::max);
            edge(p) * (CURVATURE / bend.max(1e-3)).sqrt().clamp(FINEST, COARSEST)
        };
        let count = self.points.len() as u32;
        self.size = (0..count).into_par_iter().map(local).collect();
        for _ in 0..3 {
            let graded = |i: u32| {
                let ring = self.neighbours(i);
                let sum: f64 = ring.iter().map(|&n| self.size[n as usize]).sum();
                let own = self.size[i as usize];
                own.min(0.5 * own + 0.5 * sum / ring.len().max(1) as f64)
            };
            self.size = (0..count).into_par_iter().map(graded).collect();
        }
    }

    /// Wanted length of edge a-b, mm.
    fn wanted(&self, a: u32, b: u32) -> f64 {
        0.5 * (self.size[a as usize] + self.size[b as usize])
    }

    /// Splits edges that are too long at their middle, put onto the surface.
    fn split_long(&mut self, field: &Field) {
        let long: Vec<(u32, u32, DVec3)> = self
            .edges()
            .into_par_iter()
            .filter_map(|(a, b)| {
                let (p, q) = (self.at(a), self.at(b));
                let mid = (p + q) * 0.5;
                let wanted = self.wanted(a, b);
                (p.distance(q) > LONG * wanted)
                    .then(|| (a, b, settle(field, mid, 2, 0.15 * wanted)))
            })
            .collect();
        for (a, b, mid) in long {
            let Some([(left, c), (right, d)]) = self.wings(a, b) else {
                continue;
            };
            let m = self.points.len() as u32;
            self.points.push(mid);
            self.around.push(Vec::new());
            self.size.push(self.wanted(a, b));
            self.replace(left, [a, m, c]);
            self.push([m, b, c]);
            self.replace(right, [b, m, d]);
            self.push([m, a, d]);
        }
    }

    /// Collapses edges that are too short, shortest first, where topology and orientation allow it.
    fn collapse_short(&mut self, field: &Field) {
        let mut short: Vec<(f64, u32, u32, DVec3)> = self
            .edges()
            .into_par_iter()
            .filter_map(|(a, b)| {
                let (p, q) = (self.at(a), self.at(b));
                let mid = (p + q) * 0.5;
                let wanted = self.wanted(a, b);
                let ratio = p.distance(q) / wanted;
                (ratio < SHORT).then(|| (ratio, a, b, settle(field, mid, 2, 0.15 * wanted)))
            })
            .collect();
        short.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        let mut moved = vec![false; self.points.len()];
        for (_, a, b, mid) in short {
            if moved[a as usize] || moved[b as usize] || !self.may_collapse(a, b, mid) {
                continue;
            }
            self.collapse(a, b, mid);
            moved[a as usize] = true;
            moved[b as usize] = true;
        }
    }

    /// Whether edge a-b may shrink to `mid`: the link condition holds, no face turns over, no edge becomes too long.
    fn may_collapse(&self, a: u32, b: u32, mid: DVec3) -> bool {
        let Some([(left, c), (right, d)]) = self.wings(a, b) else {
            return false;
        };
        let near_a = self.neighbours(a);
        let near_b = self.neighbours(b);
        let shared = near_a.iter().filter(|&n| near_b.contains(n)).count();
        let valence = |i: u32| self.around[i as usize].len();
        if shared != 2 || valence(c) <= 3 || valence(d) <= 3 || near_a.len() + near_b.len() > 14 {
            return false;
        }
        let longest = LONG * self.wanted(a, b);
        let all = near_a.iter().chain(&near_b).filter(|&&n| n != a && n != b);
        if all.clone().any(|&n| self.at(n).distance(mid) > longest) {
            return false;
        }
        [a, b].iter().all(|&end| {
            self.around[end as usize]
                .iter()
                .filter(|&&i| i != left && i != right)
                .all(|&i| {
                    let f = self.faces[i as usize];
                    let [p, q, r] = f.map(|c| if c == end { mid } else { self.at(c) });
                    let (old, new) = (self.cross(f), (q - p).cross(r - p));
                    old.dot(new) > 0.6 * old.length() * new.length()
                })
        })
    }

    fn collapse(&mut self, a: u32, b: u32, mid: DVec3) {
        self.points[a as usize] = mid;
        self.size[a as usize] = self.wanted(a, b);
        for i in self.around[b as usize].clone() {
            let f = self.faces[i as usize];
            if f.contains(&a) {
                self.replace(i, DEAD);
            } else {
                self.replace(i, f.map(|c| if c == b { a } else { c }));
            }
        }
    }

    fn neighbours(&self, a: u32) -> Vec<u32> {
        let ring = self.around[a as usize].iter().map(|&i| {
            let f = self.faces[i as usize];
            let k = f.iter().position(|&c| c == a).unwrap_or(0);
            f[(k + 1) % 3]
        });
        ring.collect()
    }

    /// Flips edges where that makes the worse of the two triangles better and keeps the surface unfolded.
    fn flip_edges(&mut self) {
        for _ in 0..3 {
            for (a, b) in self.edges() {
                let Some([(left, c), (right, d)]) = self.wings(a, b) else {
                    continue;
                };
                if c == d
                    || self.neighbours(c).contains(&d)
                    || self.around[a as usize].len() <= 4
                    || self.around[b as usize].len() <= 4
                {
                    continue;
                }
                let (old_l, old_r) = (self.faces[left as usize], self.faces[right as usize]);
                let (new_l, new_r) = ([a, d, c], [d, b, c]);
                let before = self.shape(old_l).min(self.shape(old_r));
                let after = self.shape(new_l).min(self.shape(new_r));
                let facing = (self.cross(old_l).normalize_or_zero()
                    + self.cross(old_r).normalize_or_zero())
                .normalize_or_zero();
                let flat = |f| self.cross(f).normalize_or_zero().dot(facing) > 0.75;
                if after > before + 1e-3 && flat(new_l) && flat(new_r) && flat(old_l) {
                    self.replace(left, new_l);
                    self.replace(right, new_r);
                }
            }
        }
    }

    /// Flips edges that run across ridges and grooves so that they run along them: the two faces shall differ as little
    /// as possible from the surface's own normals. Triangles keep a shape of at least [`PLAIN`].
    fn align(&mut self, field: &Field) {
        for _ in 0..4 {
            let mut gains: Vec<(f64, u32, u32)> = self
                .edges()
                .into_par_iter()
                .filter_map(|(a, b)| self.gain(a, b, field).map(|g| (g, a, b)))
                .collect();
            gains.sort_by(|x, y| y.0.total_cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));
            let mut touched = vec![false; self.faces.len()];
            for (_, a, b) in gains {
                let Some([(left, c), (right, d)]) = self.wings(a, b) else {
                    continue;
                };
                let free = !touched[left as usize] && !touched[right as usize];
                if free && !self.neighbours(c).contains(&d) {
                    self.replace(left, [a, d, c]);
                    self.replace(right, [d, b, c]);
                    touched[left as usize] = true;
                    touched[right as usize] = true;
                }
            }
        }
    }

    /// How much nearer to the surface's normals a flip of edge a-b would bring its two faces; `None` if it is not worth
    /// it or would spoil them.
    fn gain(&self, a: u32, b: u32, field: &Field) -> Option<f64> {
        let [(left, c), (right, d)] = self.wings(a, b)?;
        let valence = |i: u32| self.around[i as usize].len();
        let taken = c == d || valence(a) <= 4 || valence(b) <= 4 || self.neighbours(c).contains(&d);
        let (new_l, new_r) = ([a, d, c], [d, b, c]);
        if taken || self.shape(new_l).min(self.shape(new_r)) < PLAIN {
            return None;
        }
        let error = |f: [u32; 3]| {
            let middle = f.iter().map(|&i| self.at(i)).sum::<DVec3>() / 3.0;
            let cross = self.cross(f);
            cross.length() - cross.dot(gradient(field, middle).normalize_or_zero())
        };
        let facing = |f: [u32; 3]| self.cross(f).normalize_or_zero();
        if facing(new_l).dot(facing(new_r)) < 0.2 {
            return None;
        }
        let before = error(self.faces[left as usize]) + error(self.faces[right as usize]);
        let gain = before - error(new_l) - error(new_r);
        (gain > 0.05 * before).then_some(gain)
    }

    /// Moves every vertex towards the middle of its neighbours along the surface, then back onto it.
    fn relax(&mut self, field: &Field) {
        let moved: Vec<DVec3> = (0..self.points.len() as u32)
            .into_par_iter()
            .map(|i| {
                let p = self.at(i);
                let ring = self.neighbours(i);
                if ring.is_empty() {
                    return p;
                }
                let middle = ring.iter().map(|&n| self.at(n)).sum::<DVec3>() / ring.len() as f64;
                let normal = gradient(field, p).normalize_or_zero();
                let slide = (middle - p) - normal * (middle - p).dot(normal);
                settle(field, p + slide * 0.6, 2, 0.15 * self.size[i as usize])
            })
            .collect();
        self.adopt(moved);
    }

    fn settle_all(&mut self, field: &Field, steps: usize) {
        let moved = self
            .points
            .par_iter()
            .map(|&p| settle(field, p, steps, 0.05))
            .collect();
        self.adopt(moved);
    }

    /// Takes over new positions except where a face would turn over or shrink to less than half.
    fn adopt(&mut self, moved: Vec<DVec3>) {
        for (i, new) in moved.into_iter().enumerate() {
            let crosses = |editor: &Editor| -> Vec<DVec3> {
                editor.around[i]
                    .iter()
                    .map(|&f| editor.cross(editor.faces[f as usize]))
                    .collect()
            };
            let before = crosses(self);
            let old = std::mem::replace(&mut self.points[i], new);
            let spoilt = crosses(self).into_iter().zip(before).any(|(now, was)| {
                now.dot(was) <= 0.5 * now.length() * was.length()
                    || now.length() < 0.4 * was.length()
            });
            if spoilt {
                self.points[i] = old;
            }
        }
    }

    /// The mesh without dead faces and unused vertices, in order of first use.
    fn finish(self) -> Mesh {
        let mut number = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        let mut faces = Vec::new();
        for f in self.faces.iter().filter(|f| **f != DEAD) {
            faces.push(f.map(|c| {
                let n = &mut number[c as usize];
                if *n == u32::MAX {
                    *n = points.len() as u32;
                    points.push(self.points[c as usize]);
                }
                *n
            }));
        }
        Mesh { points, faces }
    }
}
