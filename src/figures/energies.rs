//! The energy and its variants: Figs 5, 6, 7, 9 and the appendix.

use super::figure::Figure;
use super::findings::Findings;
use super::made::Made;
use super::workshop::{LEAN, Workshop, with};
use crate::mimic::Ending;
use std::rc::Rc;

pub(crate) const SCALE: Figure = Figure {
    name: "fig05",
    paper: "Fig 5",
    title: "What invariance to scale is for",
    statement: "Without the factor lambda / lambda0 of Eq 7 the Laplacian knows the model's size: artefacts appear that are gone with it.",
    make: scale,
};

fn scale(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let on = lean(shop, "with the factor", "fig05-scale", "Curvature()")?;
    let off = "Curvature(scale_invariant: false, group_scales: false)";
    let off = lean(shop, "without it", "fig05-scale", off)?;
    found.case("with the factor", &on, &[])?;
    found.counter_case("without it", &off, &[])?;
    let [a, b] = [on.error_deg()?, off.error_deg()?];
    found.claim(
        b > 1.1 * a,
        format!("normals are off by {b:.1} degrees without the factor and by {a:.1} with it"),
    );
    found.note("The model stands far behind its plate, so that it is less than half as large there. Without the factor bounds are absolute too: a scale for the whole group, as of Eq 11, would make up for its lack, and where both sizes are alike there is little to see.");
    Ok(())
}

pub(crate) const BOX: Figure = Figure {
    name: "fig06",
    paper: "Fig 6",
    title: "Linearised against iterated Laplacian",
    statement: "On a box (1538 vertices) iterating the Laplacian of the deformed surface gives smaller errors where curvature is low; on every other model of the paper it does not converge.",
    make: iterated,
};

fn iterated(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let linear = lean(
        shop,
        "box, linearised",
        "fig06-box",
        "Curvature(hidden_weight: 1)",
    )?;
    let rounds = "Curvature(hidden_weight: 1, iterate: 50)";
    let iterated = lean(shop, "box, iterated", "fig06-box", rounds)?;
    let scan = lean(
        shop,
        "hare, iterated",
        "fig06-scan",
        "Curvature(hidden_weight: 1, iterate: 12)",
    )?;
    found.case("box, linearised", &linear, &[])?;
    for (name, made) in [("box, iterated", &iterated), ("hare, iterated", &scan)] {
        let iterated = made.first_view()?.iterated.as_ref().ok_or("no rounds")?;
        let change = iterated.rounds.last().map_or(f64::NAN, |r| r.change);
        let measured = [
            ("rounds", iterated.rounds.len() as f64),
            ("last_change_of_layer", change),
        ];
        found.counter_case(name, made, &measured)?;
    }
    let [a, b] = [linear.error_deg()?, iterated.error_deg()?];
    found.claim(
        ending(&iterated) == "converged" && b < a,
        format!("on the box the iteration has {}, and normals are off by {b:.2} degrees instead of {a:.2}", ending(&iterated)),
    );
    found.claim(
        ending(&scan) != "converged",
        format!(
            "on the hare it has not converged ({}), which is told and the best round kept",
            ending(&scan)
        ),
    );
    Ok(())
}

/// How the iteration of the first view ended, as the report has it.
fn ending(made: &Made) -> &'static str {
    let iterated = made.report.views.first().and_then(|v| v.iterated.as_ref());
    match iterated.map(|i| i.ending) {
        Some(Ending::Converged) => "converged",
        Some(Ending::Unfinished) => "unfinished",
        Some(Ending::Diverged) => "diverged",
        Some(Ending::Failed) => "failed",
        None => "not run",
    }
}

pub(crate) const MEAN_CURVATURE: Figure = Figure {
    name: "fig07",
    paper: "Fig 7",
    title: "With and without the mean curvature",
    statement: "Leaving the division by the mean curvature out (Eq 9 for Eq 7) hardly changes the result and makes it numerically stable.",
    make: mean_curvature,
};

fn mean_curvature(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let without = lean(
        shop,
        "without (Eq 9)",
        "fig07-mean-curvature",
        "Curvature()",
    )?;
    let kept = "Curvature(mean_curvature: true)";
    let kept = lean(shop, "with (Eq 7)", "fig07-mean-curvature", kept)?;
    found.case("without (Eq 9)", &without, &[])?;
    found.case("with (Eq 7)", &kept, &[])?;
    let [a, b] = [without.error_deg()?, kept.error_deg()?];
    found.claim(
        (a - b).abs() < 0.25 * a.max(b),
        format!("normals are off by {a:.1} degrees without the division and by {b:.1} with it"),
    );
    Ok(())
}

pub(crate) const HIDDEN: Figure = Figure {
    name: "fig09",
    paper: "Fig 9",
    title: "What hidden vertices count",
    statement: "With a weight of 0.1 instead of 1 for hidden vertices the optimisation is freer, and the details of what is seen are kept better.",
    make: hidden,
};

fn hidden(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let all = lean(
        shop,
        "weight 1",
        "fig09-hidden",
        "Curvature(hidden_weight: 1)",
    )?;
    let few = lean(
        shop,
        "weight 0.1",
        "fig09-hidden",
        "Curvature(hidden_weight: 0.1)",
    )?;
    found.case("weight 1", &all, &[])?;
    found.case("weight 0.1", &few, &[])?;
    let [a, b] = [all.error_deg()?, few.error_deg()?];
    found.claim(
        b < a,
        format!("what is seen is off by {b:.1} degrees with 0.1 and by {a:.1} with 1"),
    );
    Ok(())
}

pub(crate) const CONIC: Figure = Figure {
    name: "appendix",
    paper: "Appendix",
    title: "The conic form",
    statement: "The quadratic program is written with a second-order cone; the optimum is the same, and with the paper's solver it comes about five times faster.",
    make: conic,
};

fn conic(shop: &mut Workshop, found: &mut Findings) -> Result<(), String> {
    let quadratic = lean(shop, "quadratic", "appendix-conic", "Curvature()")?;
    let conic = lean(shop, "conic", "appendix-conic", "Curvature(form: Conic)")?;
    let objective = |made: &Made| made.program().map(|p| p.objective);
    let solving = |made: &Made| made.stage_seconds("quadratic programs");
    for (name, made) in [("quadratic", &quadratic), ("conic", &conic)] {
        let measured = [
            ("objective", objective(made)?),
            ("program_seconds", solving(made)),
        ];
        found.case(name, made, &measured)?;
    }
    let [a, b] = [objective(&quadratic)?, objective(&conic)?];
    let apart = (a - b).abs() / a.abs();
    found.claim(
        apart <= 1e-6,
        format!("both optima are the same to {apart:.0e} of their value"),
    );
    found.note(format!(
        "Here the conic form, by an interior point, takes {:.1} times as long as the quadratic one by factorisation and working set: what the paper found holds for its solver.",
        solving(&conic) / solving(&quadratic)
    ));
    Ok(())
}

/// A build for comparisons with this energy.
fn lean(shop: &mut Workshop, case: &str, scene: &str, energy: &str) -> Result<Rc<Made>, String> {
    let energy = format!("energy={energy}");
    shop.build(case, scene, &with(&[&energy], &LEAN))
}
