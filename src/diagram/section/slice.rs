//! What a plane through the eye cuts of a mesh.

use super::plane::SectionPlane;
use crate::index::VertexId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// A line in the section, from one end to the other, or around a piece of the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SlicedOutline {
    pub points: Vec<DVec2>,
    pub closed: bool,
}

/// An edge, its lower vertex first.
type Edge = (VertexId, VertexId);

/// All lines that lie before the eye. A vertex on the plane counts as above it: no triangle is met in a single point.
pub(crate) fn slice(mesh: &TriMesh, cut: &SectionPlane) -> Vec<SlicedOutline> {
    let (sideways, away) = cut.frame();
    let normal = sideways.cross(away);
    let eye = cut.plane.eye;
    let height = |v: VertexId| (mesh.vertices[v] - eye).dot(normal);
    let mut next: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
    let mut entered: BTreeMap<Edge, usize> = BTreeMap::new();
    for face in &mesh.faces {
        let above = face.map(|v| height(v) >= 0.0);
        let edge = |k: usize| {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            (a.min(b), a.max(b))
        };
        // From the edge that goes up to the one that goes down: neighbours agree.
        let turn = |up: bool| (0..3).find(|k| above[*k] != up && above[(k + 1) % 3] == up);
        if let (Some(up), Some(down)) = (turn(true), turn(false)) {
            next.entry(edge(up)).or_default().push(edge(down));
            *entered.entry(edge(down)).or_default() += 1;
        }
    }
    let place = |(a, b): Edge| {
        let [p, q] = [a, b].map(|v| mesh.vertices[v]);
        let (h, g) = (height(a), height(b));
        let at: DVec3 = p.lerp(q, h / (h - g)) - eye;
        DVec2::new(at.dot(sideways), at.dot(away))
    };
    // Open lines first, from where nothing enters.
    let starts: Vec<Edge> = next.keys().copied().collect();
    let open = starts.iter().filter(|e| !entered.contains_key(e));
    let lines = open.chain(&starts).flat_map(|start| {
        let mut found = Vec::new();
        while let Some(line) = walked(*start, &mut next) {
            found.push(line);
        }
        found
    });
    let outlines = lines.map(|line| {
        let closed = line.len() > 2 && line.first() == line.last();
        let kept = if closed { &line[1..] } else { &line[..] };
        SlicedOutline {
            points: kept.iter().map(|e| place(*e)).collect(),
            closed,
        }
    });
    outlines
        .filter(|o| o.points.iter().all(|p| p.y > 0.0))
        .collect()
}

/// Follows a line until it ends or comes back, and takes it away.
fn walked(start: Edge, next: &mut BTreeMap<Edge, Vec<Edge>>) -> Option<Vec<Edge>> {
    let mut line = vec![start];
    let mut at = start;
    while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
        line.push(to);
        at = to;
        if at == start {
            break;
        }
    }
    (line.len() > 1).then_some(line)
}
