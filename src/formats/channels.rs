//! Numbers that a PLY file has for every vertex besides its place: colours, texture points, and anything else by its name.
//!
//! Nothing here can make a file unreadable: what cannot be used is left out with a warning.

use crate::diag::{Diagnostic, Place};
use crate::formats::text::excerpt;
use crate::index::VertexId;
use crate::mesh::{Attributes, Uvs, VertexScalar};
use glam::DVec2;

/// Real files have up to some twenty; what is more costs memory only.
const MOST: usize = 48;

/// Names that stand for the same channel.
const COLOURS: [&[&str]; 4] = [
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];
const TEXTURE: [&[&str]; 2] = [&["s", "u", "texture_u"], &["t", "v", "texture_v"]];
/// Normals follow from the surface.
const NORMALS: [&str; 3] = ["nx", "ny", "nz"];

struct Channel {
    name: String,
    /// The value that means 1 as a colour, if the type says so.
    one: Option<f64>,
    values: Vec<f64>,
}

/// See the module.
#[derive(Default)]
pub(super) struct Channels {
    kept: Vec<Channel>,
    /// Properties for which there is no place: named before, or too many.
    refused: Vec<String>,
}

impl Channels {
    /// The channel for a property; `None` if its values are not to be kept.
    pub(super) fn place(&mut self, name: &str, one: Option<f64>) -> Option<usize> {
        if NORMALS.contains(&name) {
            return None;
        }
        if self.kept.len() == MOST || self.kept.iter().any(|c| c.name == name) {
            self.refused.push(name.to_owned());
            return None;
        }
        self.kept.push(Channel {
            name: name.to_owned(),
            one,
            values: Vec::new(),
        });
        Some(self.kept.len() - 1)
    }

    pub(super) fn push(&mut self, channel: usize, value: f64) {
        self.kept[channel].values.push(value);
    }

    /// Drops the values of vertices not marked true.
    pub(super) fn keep(&mut self, kept: &[bool]) {
        for channel in &mut self.kept {
            let mut keep = kept.iter();
            channel.values.retain(|_| keep.next() != Some(&false));
        }
    }

    /// The attributes of `count` vertices with these faces, and a warning for each that is of no use.
    pub(super) fn finish(
        mut self,
        file: &str,
        count: usize,
        faces: &[[VertexId; 3]],
    ) -> (Attributes, Vec<Diagnostic>) {
        let mut warnings = Vec::new();
        let mut warn = |name: &str, why: String| {
            let name = excerpt(name.as_bytes());
            let message = format!("the vertex property `{name}` is not used: {why}");
            warnings.push(Diagnostic::warning(message).at(Place::File(file.to_owned())));
        };
        for name in &self.refused {
            let why = format!("its name stands there twice, or there are more than {MOST}");
            warn(name, why);
        }
        self.kept.retain(|c| match c.flaw(count) {
            Some(why) => {
                warn(&c.name, why);
                false
            }
            None => true,
        });
        let colours = self.colours(count).unwrap_or_else(|why| {
            warn("red", why);
            Vec::new()
        });
        let points = self.pair(TEXTURE);
        let uvs = points.map(|points| Uvs {
            points,
            corners: faces.iter().map(|f| f.map(|v| v.0)).collect(),
        });
        let scalars = self.kept.into_iter().map(|c| VertexScalar {
            name: c.name,
            values: c.values,
        });
        let attributes = Attributes {
            colours,
            uvs,
            scalars: scalars.collect(),
        };
        (attributes, warnings)
    }

    fn take(&mut self, names: &[&str]) -> Option<Channel> {
        let at = self.kept.iter().position(|c| names.contains(&&*c.name))?;
        Some(self.kept.remove(at))
    }

    fn has(&self, names: &[&str]) -> bool {
        self.kept.iter().any(|c| names.contains(&&*c.name))
    }

    /// Red, green and blue, if all three are there.
    fn colours(&mut self, count: usize) -> Result<Vec<[f64; 4]>, String> {
        if !COLOURS[..3].iter().all(|names| self.has(names)) {
            return Ok(Vec::new());
        }
        let mut channels = COLOURS.map(|names| self.take(names));
        let most = channels[..3].iter().flatten().flat_map(|c| &c.values);
        let most = most.fold(0.0, |m: f64, v| m.max(*v));
        let mut colours = vec![[1.0; 4]; count];
        for (k, channel) in channels.iter_mut().enumerate() {
            let Some(channel) = channel else { continue };
            let guess = if most > 1.0 { 255.0 } else { 1.0 };
            let one = channel.one.unwrap_or(guess);
            for (colour, value) in colours.iter_mut().zip(&channel.values) {
                colour[k] = value / one;
                if !(0.0..=1.0).contains(&colour[k]) {
                    return Err(format!("a colour is {value}, not from 0 to {one}"));
                }
            }
        }
        Ok(colours)
    }

    /// Both coordinates of a pair, if both are there.
    fn pair(&mut self, names: [&[&str]; 2]) -> Option<Vec<DVec2>> {
        if !names.iter().all(|n| self.has(n)) {
            return None;
        }
        let [x, y] = names.map(|n| self.take(n).map_or_else(Vec::new, |c| c.values));
        Some(x.iter().zip(y).map(|(x, y)| DVec2::new(*x, y)).collect())
    }
}

impl Channel {
    /// Why the values are of no use, if so.
    fn flaw(&self, count: usize) -> Option<String> {
        if self.values.len() != count {
            return Some(format!("{} values for {count} vertices", self.values.len()));
        }
        let wrong = |v: &f64| !v.is_finite();
        let first = self.values.iter().position(wrong)?;
        let all = self.values.iter().filter(|v| wrong(v)).count();
        Some(format!(
            "{all} of its values are not finite numbers, the first at vertex {first}"
        ))
    }
}
