//! Depth groups and depth bounds: which parts of the image may move on their own, and how far.
//!
//! Takes a view map, its target and the supports. Gives the groups (connected image regions of one part of a support and one mesh
//! component, each with a scale `mu_g` of its own, paper Eq 11) and for every point where the map's lines meet inside a group
//! the relative depths `s = lambda / lambda0` allowed there. Because `1/lambda` is affine on a face and on a plane, bounds at
//! all corners of all cells bound the relief everywhere: a layer is flat, or follows a surface that is flat in every cell.
//! Points that any free vertex has a share in have no bounds.

use crate::diag::Diagnostic;
use crate::geom::barycentric;
use crate::mesh::face_components;
use crate::support::{Datum, Hits, Slab};
use crate::viewmap::{SupportField, Target, ViewMap};
use glam::DVec2;

/// Points nearer to a side of a face than this, in the image, lie on it: 0.1 micrometre at 250 mm, above all rounding and
/// snapping, below the thinnest cell by twenty times.
const ON_SIDE: f64 = 4e-7;

/// Relative depths (of an eye at infinity: `focal` times these) and weights that differ by less are the same: a thousandth of what
/// bounds promise.
const SAME: f64 = 1e-12;

/// A connected region of the image on one part of a support, of one mesh component.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub support: u32,
    /// Of the support's surface; see [`Support::part`](crate::support::Support::part).
    pub part: u32,
    pub component: u32,
    /// Cells of the view map, rising.
    pub cells: Vec<u32>,
    pub solid_angle_sr: f64,
}

/// A point of the target surface as a mix of its vertices: `1 / s = sum of weight / s_vertex`, weights positive with sum 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    pub vertices: [u32; 3],
    pub weights: [f64; 3],
}

impl Anchor {
    /// The vertices that matter with their weights.
    pub fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        let (vertices, weights) = (self.vertices, self.weights);
        (0..3)
            .filter(move |k| weights[*k] > 0.0)
            .map(move |k| (vertices[k] as usize, weights[k]))
    }

    /// Whether a free vertex has a share in the point: then it has no bounds.
    pub fn is_free(&self, target: &Target) -> bool {
        !target.free.is_empty() && self.terms().any(|(v, _)| target.is_free(v as u32))
    }

    /// Relative depth of the point from those of all vertices (design: harmonic, because `1/lambda` is linear in the image).
    pub fn relative_depth(&self, s: &[f64]) -> f64 {
        1.0 / self.terms().map(|(v, w)| w / s[v]).sum::<f64>()
    }
}

/// `lower <= s / mu_g <= upper` at one point; `lower` may be 0: no near limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    pub group: u32,
    pub anchor: Anchor,
    pub lower: f64,
    pub upper: f64,
    /// Whether it draws an outline onto the support: then it is narrower than those around it.
    pub drawn: bool,
}

impl Bound {
    /// Whether two bounds at mixes of the same vertices differ by rounding only.
    fn agrees(&self, other: &Bound, focal: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= SAME;
        let level = |a: f64, b: f64| (a - b).abs() <= SAME / focal;
        let weight = |v: usize| other.anchor.terms().find(|t| t.0 == v).map_or(0.0, |t| t.1);
        level(self.lower, other.lower)
            && level(self.upper, other.upper)
            && self.anchor.terms().all(|(v, w)| near(w, weight(v)))
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Groups {
    pub groups: Vec<Group>,
    /// Group of every cell of the map.
    pub of_cell: Vec<Option<u32>>,
    /// The bounds at all corners of all cells; those from `needed` on follow from the others, but for rounding.
    pub bounds: Vec<Bound>,
    pub needed: usize,
    /// The layer of every support from this eye.
    pub slabs: Vec<Option<Slab>>,
    /// Whether the mesh is deformed as a whole (see `whole`): then hidden faces take part, and all sheets keep their order.
    pub whole: bool,
}

/// A vertex itself as an anchor.
pub fn vertex_anchor(vertex: u32) -> Anchor {
    Anchor {
        vertices: [vertex; 3],
        weights: [1.0, 0.0, 0.0],
    }
}

/// The point `q` of the image on a face as an anchor, with its depth in the model. Points a little outside are drawn in.
pub fn anchor(target: &Target, face: usize, q: DVec2) -> (Anchor, f64) {
    let [a, b, c] = target.image_of(face);
    let vertices = target.mesh.faces[face];
    let area = (b - a).perp_dot(c - a).abs();
    let heights = [b.distance(c), c.distance(a), a.distance(b)].map(|side| area / side);
    let mut beta = barycentric(a, b, c, q).to_array();
    (0..3).for_each(|k| {
        beta[k] = if beta[k] * heights[k] > ON_SIDE {
            beta[k]
        } else {
            0.0
        }
    });
    if !beta.iter().sum::<f64>().is_normal() {
        beta = [1.0, 0.0, 0.0];
    }
    let sum: f64 = beta.iter().sum();
    let inverse = [0, 1, 2].map(|k| beta[k] / sum / target.depth[vertices[k] as usize]);
    let total: f64 = inverse.iter().sum();
    (
        Anchor {
            vertices,
            weights: inverse.map(|w| w / total),
        },
        1.0 / total,
    )
}

/// Groups and bounds of a view.
///
/// # Errors
/// Supports whose layer reaches through them or leaves less than their minimum core, as this eye sees them.
pub fn groups(
    view: &str,
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
) -> Result<Groups, Vec<Diagnostic>> {
    let slabs: Vec<Option<Slab>> = field
        .supports
        .iter()
        .map(|s| Slab::new(s, map.plane.eye))
        .collect();
    let component = face_components(&target.mesh);
    let carries = |c: usize| {
        let cell = map.cells[c];
        let support = cell.support.filter(|s| slabs[*s as usize].is_some())?;
        let part = cell.facet.map_or(0, |f| field.part(f));
        Some((support, part, component[cell.face? as usize]))
    };
    let labels: Vec<Option<Label>> = (0..map.cells.len()).map(carries).collect();
    let (groups, of_cell) = regions(map, &labels);
    check_layers(view, &groups, map, field, &slabs)?;
    let (bounds, needed) = bounds(map, target, field, &groups, &of_cell, &slabs);
    Ok(Groups {
        groups,
        of_cell,
        bounds,
        needed,
        slabs,
        whole: false,
    })
}

/// The same groups with bounds for another mesh of the same surface: `map` and `target` are those of the cut surface.
pub fn with_bounds(
    groups: &Groups,
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
) -> Groups {
    let (bounds, needed) = bounds(
        map,
        target,
        field,
        &groups.groups,
        &groups.of_cell,
        &groups.slabs,
    );
    Groups {
        bounds,
        needed,
        ..groups.clone()
    }
}

/// The groups without some cells (rising), which are given up: what is left of them falls into connected regions anew.
pub fn without(
    groups: &Groups,
    lost: &[u32],
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
) -> Groups {
    let label = |c: usize| {
        let kept = lost.binary_search(&(c as u32)).is_err();
        let group = groups.of_cell[c].filter(|_| kept)?;
        let group = &groups.groups[group as usize];
        Some((group.support, group.part, group.component))
    };
    let labels: Vec<Option<Label>> = (0..map.cells.len()).map(label).collect();
    let (found, of_cell) = regions(map, &labels);
    let left = Groups {
        groups: found,
        of_cell,
        bounds: Vec::new(),
        needed: 0,
        slabs: groups.slabs.clone(),
        whole: groups.whole,
    };
    with_bounds(&left, map, target, field)
}

/// Support, part of it, component of the model.
type Label = (u32, u32, u32);

/// Flood fill over equal labels.
fn regions(map: &ViewMap, labels: &[Option<Label>]) -> (Vec<Group>, Vec<Option<u32>>) {
    let mut of_cell = vec![None; labels.len()];
    let mut groups = Vec::new();
    for seed in 0..labels.len() {
        let Some((support, part, component)) = labels[seed].filter(|_| of_cell[seed].is_none())
        else {
            continue;
        };
        let id = groups.len() as u32;
        let mut cells = Vec::new();
        let mut stack = vec![seed as u32];
        of_cell[seed] = Some(id);
        while let Some(c) = stack.pop() {
            cells.push(c);
            for n in map.neighbours[c as usize].iter().flatten() {
                if of_cell[*n as usize].is_none() && labels[*n as usize] == labels[seed] {
                    of_cell[*n as usize] = Some(id);
                    stack.push(*n);
                }
            }
        }
        cells.sort_unstable();
        let solid_angle_sr = cells.iter().map(|c| map.solid_angle(*c as usize)).sum();
        groups.push(Group {
            support,
            part,
            component,
            cells,
            solid_angle_sr,
        });
    }
    (groups, of_cell)
}

fn check_layers(
    view: &str,
    groups: &[Group],
    map: &ViewMap,
    field: &SupportField,
    slabs: &[Option<Slab>],
) -> Result<(), Vec<Diagnostic>> {
    let mut used: Vec<u32> = groups.iter().map(|g| g.support).collect();
    used.sort_unstable();
    used.dedup();
    let mut errors = Vec::new();
    for s in used {
        let support = &field.supports[s as usize];
        let (Some(slab), Some(layer)) = (slabs[s as usize], support.layer) else {
            continue;
        };
        // Through walls a layer leaves its core by itself.
        if !slab.is_carved() || slab.goes_through() {
            continue;
        }
        let behind = if slab.is_shell() {
            let on = groups.iter().filter(|g| g.support == s);
            let cells = on.flat_map(|g| &g.cells);
            behind(map, field, &slab, s, cells)
        } else {
            slab.behind()
        };
        if behind < layer.core {
            errors.push(
                Diagnostic::error(format!(
                    "{} leaves {behind:.2} mm behind its layer as seen from view \"{view}\", but the minimum core is {:.2} mm",
                    support.name,
                    layer.core
                ))
                .help(format!("lower the layer's back from {:.2} to {:.2} mm, or make the {} thicker", layer.back, layer.back - layer.core + behind, if support.is_body() { "support" } else { "pillar" })),
            );
        }
    }
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// Material left behind a shell's back where it is thinnest, millimetres along rays through the cells' centres.
fn behind<'a>(
    map: &ViewMap,
    field: &SupportField,
    slab: &Slab,
    support: u32,
    cells: impl Iterator<Item = &'a u32>,
) -> f64 {
    let left = |c: &u32| {
        let q = map.points_mean(map.cells[*c as usize].corners);
        let direction = map.plane.direction(q);
        let surface = surface_in(map, field, slab, *c as usize, q);
        let thickness = field.thickness(support, map.plane.eye, direction);
        (surface.first + thickness - slab.bounds(direction, surface).1) * direction.length()
    };
    cells.map(left).fold(f64::INFINITY, f64::min)
}

fn bounds(
    map: &ViewMap,
    target: &Target,
    field: &SupportField,
    groups: &[Group],
    of_cell: &[Option<u32>],
    slabs: &[Option<Slab>],
) -> (Vec<Bound>, usize) {
    // One bound for each group, plane of the layer, point and set of vertices: cells that share a corner on a mesh vertex or
    // edge agree there.
    type Key = (u32, [Option<u32>; 2], u32, [u32; 3]);
    let mut keyed: Vec<(Key, Bound)> = Vec::new();
    for (c, cell) in map.cells.iter().enumerate() {
        let (Some(group), Some(face), Some(support)) = (of_cell[c], cell.face, cell.support) else {
            continue;
        };
        let Some(slab) = slabs[support as usize] else {
            continue;
        };
        for (k, p) in cell.corners.into_iter().enumerate() {
            let q = map.points[p as usize];
            let (anchor, depth) = anchor(target, face as usize, q);
            if anchor.is_free(target) {
                continue;
            }
            let (near, far) = layer_in(map, field, &slab, c, k);
            let mut key = [0, 1, 2].map(|k| {
                if anchor.weights[k] > 0.0 {
                    anchor.vertices[k]
                } else {
                    u32::MAX
                }
            });
            key.sort_unstable();
            let planes = [cell.facet, cell.leaves].map(|f| f.filter(|_| slab.follows_surface()));
            keyed.push((
                (group, planes, p, key),
                Bound {
                    group,
                    anchor,
                    lower: near / depth,
                    upper: far / depth,
                    drawn: slab.draws() && cell.outline[k],
                },
            ));
        }
    }
    // Cells that share a corner agree there, unless merging thin cells has moved it off their side.
    keyed.sort_by(|(k, a), (l, b)| k.cmp(l).then(a.lower.total_cmp(&b.lower)));
    keyed.dedup_by(|(l, b), (k, a)| k == l && a.agrees(b, map.plane.focal));
    needed_first(keyed.into_iter().map(|x| x.1).collect(), groups, field)
}

/// Bounds, and how many of them come first because they do not follow from others: on a flat layer, those at points between
/// vertices that are all bounded in the same group follow.
fn needed_first(bounds: Vec<Bound>, groups: &[Group], field: &SupportField) -> (Vec<Bound>, usize) {
    let alone = |b: &Bound| b.anchor.terms().count() == 1;
    let vertex = |b: &Bound| b.anchor.terms().map(|t| t.0 as u32).next();
    let mut bounded: Vec<(u32, u32)> = bounds
        .iter()
        .filter(|b| alone(b))
        .filter_map(|b| Some((b.group, vertex(b)?)))
        .collect();
    bounded.sort_unstable();
    let flat = |b: &Bound| {
        let support = groups[b.group as usize].support;
        field.supports[support as usize]
            .layer
            .is_some_and(|l| l.datum == Datum::Plane)
    };
    let follows = |b: &Bound| {
        !alone(b)
            && !b.drawn
            && flat(b)
            && b.anchor
                .terms()
                .all(|(v, _)| bounded.binary_search(&(b.group, v as u32)).is_ok())
    };
    let (follow, mut needed): (Vec<Bound>, Vec<Bound>) = bounds.into_iter().partition(follows);
    let count = needed.len();
    needed.extend(follow);
    (needed, count)
}

/// Smallest and largest depth (along the image plane's forward axis) the layer of `support` allows on the ray `q`.
pub fn layer_at(
    map: &ViewMap,
    field: &SupportField,
    slab: &Slab,
    support: u32,
    q: DVec2,
) -> (f64, f64) {
    let direction = map.plane.direction(q);
    let on_plane = slab.plane(direction, 0.0);
    if !slab.follows_surface() {
        return slab.bounds(direction, Hits::at(on_plane));
    }
    if slab.goes_through()
        && let Some((first, leaves)) = field.wall(support, map.plane.eye, direction)
    {
        let (first, leaves) = (first.t, Some(leaves.t));
        let leaves = leaves.filter(|l| slab.has_room(first, *l));
        return slab.bounds(direction, Hits { first, leaves });
    }
    // At the outline the ray may just miss the support: the datum plane is where a pillar's surface ends there.
    let surface = field
        .hit_of(support, map.plane.eye, direction)
        .unwrap_or(on_plane);
    slab.bounds(direction, Hits::at(surface))
}

/// The same at corner `k` of a cell, whose part of the support is one plane: the inverses of both are affine over the cell. Where an
/// outline of the model is to lie on the support, at its corners there is hardly any room.
pub fn layer_in(
    map: &ViewMap,
    field: &SupportField,
    slab: &Slab,
    cell: usize,
    k: usize,
) -> (f64, f64) {
    let q = map.triangle(cell)[k];
    let direction = map.plane.direction(q);
    let surface = surface_in(map, field, slab, cell, q);
    slab.on_datum(direction, surface)
        .filter(|_| map.cells[cell].outline[k])
        .unwrap_or_else(|| slab.bounds(direction, surface))
}

/// Where the ray `q` meets a layer's datum, in the plane that the support is in a cell; and where it leaves the wall behind, if the
/// layer goes through that and all of the cell has room: over a cell it has if its corners do.
pub fn surface_in(map: &ViewMap, field: &SupportField, slab: &Slab, cell: usize, q: DVec2) -> Hits {
    let at = |f: u32, q: DVec2| field.facet_depth(f, map.plane.eye, map.plane.direction(q));
    let Some(facet) = map.cells[cell].facet.filter(|_| slab.follows_surface()) else {
        return Hits::at(slab.plane(map.plane.direction(q), 0.0));
    };
    let leaves = map.cells[cell].leaves.filter(|_| slab.goes_through());
    let roomy = |f: &u32| {
        let corners = map.triangle(cell);
        corners
            .iter()
            .all(|q| slab.has_room(at(facet, *q), at(*f, *q)))
    };
    Hits {
        first: at(facet, q),
        leaves: leaves.filter(roomy).map(|f| at(f, q)),
    }
}
