//! Which pillar of one frame is which of the next.
//!
//! Layouts of a search do not say: pillars come, go and change places in the list. Nearest ones of the same view and shape are taken
//! for the same, each once.

use crate::planner::{Frame, Pillar};
use glam::DVec2;

/// One pillar through all frames.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track {
    /// As it is where it stands first.
    pub pillar: Pillar,
    /// Index: frame; `None` where it does not stand.
    pub at: Vec<Option<DVec2>>,
}

impl Track {
    /// Where to draw it at a frame: where it stood last or will stand first if it does not stand.
    pub(crate) fn place(&self, frame: usize) -> DVec2 {
        let before = self.at[..=frame].iter().rev().flatten().next();
        let after = || self.at[frame..].iter().flatten().next();
        *before.or_else(after).unwrap_or(&self.pillar.at)
    }
}

/// The tracks through some frames, in order of appearance.
pub(crate) fn tracks(frames: &[&Frame]) -> Vec<Track> {
    let mut tracks: Vec<Track> = Vec::new();
    for (k, frame) in frames.iter().enumerate() {
        let matched = matches(&tracks, k, &frame.pillars);
        for (pillar, track) in frame.pillars.iter().zip(matched) {
            match track {
                Some(t) => tracks[t].at[k] = Some(pillar.at),
                None => {
                    let mut at = vec![None; frames.len()];
                    at[k] = Some(pillar.at);
                    tracks.push(Track {
                        pillar: *pillar,
                        at,
                    });
                }
            }
        }
    }
    tracks
}

/// For every pillar of frame `k` the track that goes on with it: nearest pairs first, earlier ones of equals.
fn matches(tracks: &[Track], k: usize, pillars: &[Pillar]) -> Vec<Option<usize>> {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (t, track) in tracks.iter().enumerate() {
        let Some(last) = k.checked_sub(1).and_then(|j| track.at[j]) else {
            continue;
        };
        let kind = |p: &Pillar| (p.owner, p.shape, p.fixed);
        let alike = pillars.iter().enumerate();
        let alike = alike.filter(|(_, p)| kind(p) == kind(&track.pillar));
        pairs.extend(alike.map(|(i, p)| (last.distance_squared(p.at), t, i)));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut found = vec![None; pillars.len()];
    let mut used = vec![false; tracks.len()];
    for (_, t, i) in pairs {
        if !used[t] && found[i].is_none() {
            (used[t], found[i]) = (true, Some(t));
        }
    }
    found
}
