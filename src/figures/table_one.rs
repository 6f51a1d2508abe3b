//! Table 1: sizes and times of all examples.

use super::workshop::{LEAN, Workshop, with};
use super::{Figure, Findings};

/// Vertices of a model at its interactive size, as in the paper.
const INTERACTIVE: &str = "detail=10000";

/// Names and scenes, as in the paper's table.
const SCENES: [(&str, &str); 9] = [
    ("Owl", "fig03-stairs"),
    ("Dragon head", "fig04-groove"),
    ("Dragon", "fig11-gradients"),
    ("Hare", "fig10-depths"),
    ("Imp", "fig12-free"),
    ("Fish", "fig13-wave"),
    ("Face", "fig16-strips"),
    ("Cow herd", "fig17-herd"),
    ("Pillar forest", "../four-creatures"),
];

pub const TIMES: Figure = Figure {
    name: "table1",
    paper: "Table 1",
    title: "Sizes and times",
    statement: "At interactive sizes (10k to 41k vertices) an optimisation takes 8 to 55 s, at final sizes (40k to 444k) 85 to 2961 s, on a quad-core at 3.4 GHz with a commercial conic solver.",
    make: times,
};

fn times(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let mut slowest = 0.0f64;
    for (name, scene) in SCENES {
        for (size, sets) in [
            ("interactive", with(&[INTERACTIVE], &LEAN)),
            ("final", LEAN.to_vec()),
        ] {
            let case = format!("{name}, {size}");
            let made = shop.build(&case, scene, &sets)?;
            let solving = made.stage_seconds("quadratic programs");
            let measured = [
                ("vertices", made.sum("/vertices")?),
                ("faces", made.sum("/faces")?),
                ("groups", made.sum("/groups")?),
                ("error_mean_deg", made.error_deg()?),
                ("program_seconds", solving),
            ];
            found.row(&case, &made, &measured, made.keeps_promises());
            slowest = slowest.max(solving);
        }
    }
    found.claim(
        slowest < 2961.0,
        format!("the slowest optimisation takes {slowest:.1} s"),
    );
    found.note("Times are of the energy that each scene names. `seconds` is the whole run with solids, pictures and certificates; peak memory is that of the whole program.");
    Ok(())
}
