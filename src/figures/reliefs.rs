//! Reliefs on supports of all kinds: Figs 3, 4, 12 to 17.

use super::figure::Figure;
use super::findings::{Findings, Number};
use super::made::Made;
use super::workshop::{LEAN, Workshop, with};

/// What a certificate may be off by for rounding, millimetres.
const EXACT_MM: f64 = 1e-6;
/// Of a model's solid angle: what hairs at the edges of reliefs may cost.
const WHOLE: f64 = 0.999;

pub(crate) const STAIRS: Figure = Figure {
    name: "fig03",
    paper: "Fig 3",
    title: "An owl on a staircase",
    statement: "An owl is embedded into the steps of a staircase. The layer is so thin that the stairs can be used as before.",
    make: stairs,
};

fn stairs(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let torn = shop.build("with steps", "fig03-stairs", &[])?;
    let never = with(&["energy=Normal(steps: Never)"], &LEAN);
    let unbroken = shop.build("in one piece", "fig03-stairs", &never)?;
    for (name, made) in [("with steps", &torn), ("in one piece", &unbroken)] {
        let groups = made.groups()?;
        found.case(name, made, &[("groups", groups), layer(made)?.0])?;
    }
    within(found, &torn, 8.0, 0.0)?;
    let groups = torn.groups()?;
    found.claim(
        groups >= 5.0,
        format!("{groups} groups lie on the treads and risers of six steps"),
    );
    appears(found, &torn)?;
    found.note("Steps are ours: the surface tears where the eye cannot see it. In one piece is what the paper's constraints allow.");
    Ok(())
}

pub(crate) const GROOVE: Figure = Figure {
    name: "fig04",
    paper: "Fig 4",
    title: "A dragon's head carved into a V",
    statement: "A dragon's head is carved up to 6 mm into a V-shaped volume and stands out of it by no more than 1 mm; both bounds are hard.",
    make: groove,
};

fn groove(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let made = shop.build("carved", "fig04-groove", &[])?;
    let (front, back) = layer(&made)?;
    found.case("carved", &made, &[front, back])?;
    within(found, &made, 1.0, 6.0)?;
    appears(found, &made)?;
    Ok(())
}

pub(crate) const FREE: Figure = Figure {
    name: "fig12",
    paper: "Fig 12",
    title: "An imp whose arm and ear are free: no height field",
    statement: "Only the vertices of the visual hull are held on the baseplate, one arm and one ear are not held at all. What comes out is no height field, which shows when the eye moves.",
    make: free,
};

fn free(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let made = shop.build("arm and ear free", "fig12-free", &[])?;
    let inversions = made.sum(|c| c.order_inversions as f64)?;
    let crossings = made.self_intersections()?;
    let parts = made.solid()?.parts as f64;
    found.case(
        "arm and ear free",
        &made,
        &[
            ("order_inversions", inversions),
            ("self_intersections", crossings),
            ("parts", parts),
            layer(&made)?.0,
        ],
    )?;
    found.picture(
        "from the side to the other side",
        made.file("turntable.png", |f| f == "turntable.png")?,
    );
    found.claim(
        inversions == 0.0 && crossings == 0.0,
        format!("front, back and what is hidden keep their order: {inversions} inversions, {crossings} faces through each other"),
    );
    let off = made.most(|c| c.relief_front_mm)?;
    found.claim(
        off > 5.0,
        format!(
            "what is held stays within 5 mm of the plate, the free arm stands {off:.1} mm off it"
        ),
    );
    found.claim(
        parts == 1.0 && made.keeps_promises(),
        format!("a closed solid of {parts} part, free of self-intersection"),
    );
    appears(found, &made)?;
    Ok(())
}

pub(crate) const WAVE: Figure = Figure {
    name: "fig13",
    paper: "Fig 13",
    title: "A fish in a wavy sea",
    statement: "A fish stays in a layer of 4 mm of a wavy surface. From its eye it is surprisingly close to the model, from elsewhere the illusion is gone.",
    make: wave,
};

fn wave(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let unbroken = shop.build("in one piece", "fig13-wave", &[])?;
    let allowed = with(&["energy=Normal(steps: Allowed())"], &LEAN);
    let torn = shop.build("with steps", "fig13-wave", &allowed)?;
    for (name, made) in [("in one piece", &unbroken), ("with steps", &torn)] {
        let (front, back) = layer(made)?;
        found.case(name, made, &[front, back])?;
    }
    within(found, &unbroken, 2.0, 2.0)?;
    appears(found, &unbroken)?;
    Ok(())
}

pub(crate) const FOREST: Figure = Figure {
    name: "fig15",
    paper: "Figs 14 and 15",
    title: "Four models in a forest of pillars",
    statement: "Four models are hidden in a forest of pillars: each appears from one viewpoint, from anywhere else nothing is recognised. A plan shows the range of pillars that each viewpoint sees.",
    make: forest,
};

fn forest(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let made = shop.build("forest", "../four-creatures", &[])?;
    let halves = made.report.camouflage.iter();
    let half = halves
        .filter_map(|c| c.half_likeness_deg)
        .fold(0.0, f64::max);
    let groups = made.groups()?;
    let coverage = made.mean(|c| c.coverage)?;
    found.case(
        "forest",
        &made,
        &[
            ("groups", groups),
            ("coverage_share", coverage),
            ("half_likeness_most_deg", half),
        ],
    )?;
    found.picture("plan", made.file("plan.png", |f| f == "plan.png")?);
    found.picture(
        "from elsewhere",
        made.file("camouflage.png", |f| f == "camouflage.png")?,
    );
    appears(found, &made)?;
    found.claim(
        0.0 < half && half < 20.0,
        format!("half of every likeness is lost within {half:.1} degrees"),
    );
    Ok(())
}

pub(crate) const STRIPS: Figure = Figure {
    name: "fig16",
    paper: "Fig 16",
    title: "One head on five strips",
    statement: "Five views of one head (80k vertices), turned by 22.5 degrees from one to the next, on five plane strips, each no thicker than 2 mm.",
    make: strips,
};

fn strips(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let made = shop.build("five heads", "fig16-strips", &[])?;
    let groups = made.groups()?;
    let vertices = made.sizes().0;
    let (front, back) = layer(&made)?;
    found.case(
        "five heads",
        &made,
        &[("groups", groups), ("vertices", vertices), front, back],
    )?;
    within(found, &made, 2.0, 0.0)?;
    found.claim(groups == 5.0, format!("{groups} groups, one a strip"));
    appears(found, &made)?;
    Ok(())
}

pub(crate) const HERD: Figure = Figure {
    name: "fig17",
    paper: "Fig 17",
    title: "A herd on one plate",
    statement: "A scene of several separate objects becomes one thin relief; the visual hull of every cow lies on the baseplate.",
    make: herd,
};

fn herd(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let made = shop.build("herd", "fig17-herd", &[])?;
    let groups = made.groups()?;
    let (front, back) = layer(&made)?;
    found.case("herd", &made, &[("groups", groups), front, back])?;
    found.claim(
        made.outside_mm()? <= EXACT_MM,
        "every outline lies on the plate to 0.05 mm, wherever it is seen against it",
    );
    found.claim(groups >= 5.0, format!("{groups} groups of five cows"));
    appears(found, &made)?;
    Ok(())
}

/// How far reliefs come before their datum and go behind it.
pub(crate) fn layer(made: &Made) -> Result<(Number, Number), String> {
    let front = made.most(|c| c.relief_front_mm)?;
    let back = made.most(|c| c.relief_back_mm)?;
    Ok((("relief_front_mm", front), ("relief_back_mm", back)))
}

fn within(found: &mut Findings, made: &Made, front: f64, back: f64) -> Result<(), String> {
    let ((_, out), (_, inside)) = layer(made)?;
    let outside = made.outside_mm()?;
    let holds = outside <= EXACT_MM && out <= front + EXACT_MM;
    // Reliefs that only stand on their support begin a little inside.
    let bedded = back.max(crate::support::SUNK_MM);
    found.claim(
        holds && inside <= bedded + EXACT_MM,
        format!("the relief comes {out:.3} mm before its support (allowed: {front}) and goes {inside:.3} mm into it (allowed: {bedded})"),
    );
    Ok(())
}

/// That every eye sees its models, whole.
fn appears(found: &mut Findings, made: &Made) -> Result<(), String> {
    let coverage = made.mean(|c| c.reaching)?;
    let error = made.error_deg()?;
    let views = made.report.views.len();
    let eyes = match views {
        1 => "the eye sees".to_owned(),
        n => format!("{n} eyes see"),
    };
    found.claim(
        made.keeps_promises() && coverage >= WHOLE,
        format!(
            "{eyes} {:.2} % of the models, with normals off by {error:.1} degrees on average",
            100.0 * coverage
        ),
    );
    Ok(())
}
