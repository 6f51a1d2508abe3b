//! How much work a run of a scene is to be, whatever the scene says itself.

use crate::scene::defaults;
use crate::scene::text::set::{set, value};

/// How much work a run is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Models of few vertices, small pictures, neither lights nor camouflage.
    Draft,
    /// As the scene is written.
    Normal,
    /// As it is written, with large pictures.
    Final,
}

/// The scene text at a quality. What no scene can be read from stays as it is: reading tells what is wrong.
pub fn at_quality(text: &str, quality: Quality) -> String {
    let changes: &[(&str, String)] = match quality {
        Quality::Draft => &[
            ("detail", at_most(text, "detail", defaults::DRAFT_DETAIL)),
            (
                "output.picture_size",
                at_most(text, "output.picture_size", defaults::DRAFT_PICTURE_SIZE),
            ),
            ("output.lights", "false".into()),
            ("output.camouflage", "false".into()),
        ],
        Quality::Normal => &[],
        Quality::Final => {
            let size = defaults::FINAL_PICTURE_SIZE;
            let written = number(text, "output.picture_size").unwrap_or(0);
            &[("output.picture_size", size.max(written).to_string())]
        }
    };
    changes.iter().fold(text.to_owned(), |text, (path, new)| {
        set(&text, &format!("{path}={new}")).unwrap_or(text)
    })
}

/// What the scene says, if that is less.
fn at_most(text: &str, path: &str, most: u32) -> String {
    number(text, path).map_or(most, |n| n.min(most)).to_string()
}

fn number(text: &str, path: &str) -> Option<u32> {
    value(text, path)?.trim().parse().ok()
}
