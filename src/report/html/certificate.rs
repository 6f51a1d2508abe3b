//! One view's certificate in words: what was measured, whether it holds, and what it means to somebody who looks or prints.

use super::text::{DASH, count, mark, measure, measure_or, percent, place, table_if_any, tiny};
use crate::certify::conflicts::Trouble;
use crate::certify::coverage::{Cause, Gap};
use crate::certify::tolerance::{Confirmed, EYES_MM, ONE_PICTURE_RAD, Rotation, Way, WorstCut};
use crate::formats::markup::escaped;
use crate::geom::READING_MM;
use crate::kinds::Crossings;
use crate::report::certificate::{CertificateReport, OPTIMAL, Proof};
use crate::steps::UNSEEN_RAD;
use std::fmt::Write as _;

const ARCMIN2: &str = "arcmin²";
/// Where no cut ever opens.
const ALWAYS: &str = "as far as it likes";

/// What was asked, what was found, whether it holds (if that is a question), and what it means.
struct Answer(&'static str, String, Option<bool>, String);

/// The certificate's tables; `name` is the view's.
pub(crate) fn certificate(name: &str, found: &CertificateReport) -> String {
    let mut html = format!(
        "<div class=\"scroll\"><table class=\"certificate\">\n<caption>Certificate of {}</caption>\n\
         <thead><tr><th scope=\"col\">what</th><th scope=\"col\">found</th><th scope=\"col\">holds</th>\
         <th scope=\"col\">what it means</th></tr></thead>\n",
        escaped(name)
    );
    for (head, rows) in [
        ("The surface", surface(found)),
        ("What reaches the viewer", reaching(found)),
        ("Room to move", room(found)),
    ] {
        _ = write!(
            html,
            "<tbody>\n<tr><th colspan=\"4\" scope=\"rowgroup\">{head}</th></tr>\n"
        );
        for Answer(what, found, holds, words) in rows {
            let holds = holds.map_or("", mark);
            _ = writeln!(
                html,
                "<tr><th scope=\"row\">{what}</th><td>{found}</td><td>{holds}</td><td>{words}</td></tr>"
            );
        }
        html.push_str("</tbody>\n");
    }
    html.push_str("</table></div>\n");
    html + &lists(found)
}

fn surface(c: &CertificateReport) -> Vec<Answer> {
    let mut rows = within_layer(c);
    rows.push(Answer(
        "Order turned round",
        format!("{} places", count(c.order_inversions)),
        Some(c.order_inversions == 0),
        "Places where a farther part of the model comes before a nearer one.".into(),
    ));
    rows.extend(c.crossings.iter().flat_map(before_cutting));
    rows.extend(c.proof.iter().flat_map(proof));
    rows.extend(c.not_an_optimum.iter().map(|what| {
        Answer(
            "Best possible depths",
            "not claimed".into(),
            None,
            format!("{}.", escaped(what)),
        )
    }));
    rows
}

fn within_layer(c: &CertificateReport) -> Vec<Answer> {
    let holds = |mm: f64| Some(mm <= c.nothing_mm);
    [
        (
            "Outside its layer",
            c.bound_violation_mm,
            holds(c.bound_violation_mm),
            "How far the relief leaves the layer its supports offer, anywhere.",
        ),
        (
            "Pushed back into it",
            c.clamp_mm,
            holds(c.clamp_mm),
            "How far points had to be moved along their rays to stay within the layer.",
        ),
        (
            "Nothing, of both",
            c.nothing_mm,
            None,
            "What is less than this, at this distance from the eye, is rounding.",
        ),
        (
            "Before its support",
            c.relief_front_mm,
            None,
            "How far the relief comes before the surface or plane that its layer is measured from.",
        ),
        (
            "Into its support",
            c.relief_back_mm,
            None,
            "How far it goes behind that.",
        ),
    ]
    .map(|(what, mm, holds, words)| Answer(what, measure(mm, 3, "mm"), holds, words.into()))
    .into_iter()
    .chain([Answer(
        "Flat at a limit of its layer",
        percent(c.at_limit),
        None,
        "How much of the relief has no room left: what stands out there is cut off.".into(),
    )])
    .collect()
}

/// What crosses in the surface as it was optimised.
fn before_cutting(found: &Crossings) -> [Answer; 2] {
    let before = "Before it is cut, with what nobody sees:";
    [
        Answer(
            "Order turned round in all of the surface",
            format!("{} places", count(found.order_inversions)),
            None,
            format!("{before} places where a farther sheet comes before a nearer one."),
        ),
        Answer(
            "Faces through each other",
            format!("{} pairs", count(found.self_intersections)),
            None,
            format!(
                "{before} pairs of faces that cross. In the model: {}.",
                count(found.in_model)
            ),
        ),
    ]
}

fn proof(p: &Proof) -> [Answer; 3] {
    let proof = "Proof that no other depths keep the normals better; zero but for rounding.";
    [
        Answer(
            "Duality gap",
            tiny(p.duality_gap_rel),
            Some(p.duality_gap_rel <= OPTIMAL),
            proof.into(),
        ),
        Answer(
            "Bounds and order kept to",
            tiny(p.primal_residual),
            Some(p.primal_residual <= OPTIMAL),
            "Largest breach of a condition in the solver's own units (primal residual).".into(),
        ),
        Answer(
            "Forces in balance to",
            tiny(p.dual_residual),
            Some(p.dual_residual <= OPTIMAL),
            "What is left of the gradient at the optimum (dual residual).".into(),
        ),
    ]
}

fn reaching(c: &CertificateReport) -> Vec<Answer> {
    let mut rows = vec![
        Answer(
            "Carried",
            percent(c.coverage),
            Some(c.gaps.is_empty()),
            format!(
                "Share of what the eye should see that a support carries. Gaps: {} worth telling, and {} at outlines with {} \
                 together.",
                count(c.gaps.len()),
                count(c.small_gaps),
                measure(c.small_gaps_arcmin2, 1, ARCMIN2)
            ),
        ),
        Answer(
            "Seen in the end",
            percent(c.reaching),
            Some(c.conflicts.is_empty()),
            format!(
                "The same, tested by {} rays at the finished forest. Hairs at edges take {}, {} show a filled corner.",
                count(c.rays),
                measure(c.small_conflicts_arcmin2, 1, ARCMIN2),
                measure(c.filled_arcmin2, 1, ARCMIN2)
            ),
        ),
        Answer(
            "Still contested",
            measure(c.contested_left_arcmin2, 1, ARCMIN2),
            Some(c.contested_left_arcmin2 == 0.0),
            format!(
                "Surface that two views want at once. {} were settled before solving.",
                count(c.contests.len())
            ),
        ),
    ];
    for model in &c.models {
        rows.push(Answer(
            "Model",
            escaped(&model.name),
            None,
            format!(
                "{} carried, {} seen, of {} (all around is 12.57{}sr).",
                percent(model.coverage),
                percent(model.reaching),
                measure(model.solid_angle_sr, 4, "sr"),
                '\u{202F}'
            ),
        ));
    }
    rows
}

fn room(c: &CertificateReport) -> Vec<Answer> {
    if let (Some(unseen), Some(one)) =
        (&c.tolerance.eye_tolerance_deg, &c.tolerance.one_picture_deg)
    {
        return turns(c, unseen, one);
    }
    let (unseen, one) = (&c.tolerance.eye_tolerance_mm, &c.tolerance.one_picture_mm);
    let minutes = |angle: f64| format!("{:.0} arc-minutes", angle.to_degrees() * 60.0);
    let way = |what, unseen, one, how: &str| {
        Answer(
            what,
            both(unseen, one, 1, "mm"),
            None,
            format!(
                "{how} until the worst cut opens by {} (nobody sees it) / {} (still one picture).",
                minutes(UNSEEN_RAD),
                minutes(ONE_PICTURE_RAD)
            ),
        )
    };
    vec![
        way(
            "Sideways",
            unseen.side,
            one.side,
            "How far the eye may move to either side",
        ),
        way(
            "Up and down",
            unseen.up,
            one.up,
            "How far it may rise or sink",
        ),
        way(
            "To and fro",
            unseen.fore,
            one.fore,
            "How far it may come nearer or step back",
        ),
        Answer(
            "Two eyes from",
            measure_or(c.tolerance.stereo_distance_mm, 0, "mm", "anywhere"),
            None,
            format!(
                "From there on two eyes {EYES_MM:.0}{}mm apart see one object, if the forest is made for that distance.",
                '\u{202F}'
            ),
        ),
    ]
}

/// How far until a cut opens unseen, and until the picture falls apart.
fn both(unseen: Option<f64>, one: Option<f64>, digits: usize, unit: &str) -> String {
    let measured = [unseen, one].map(|value| measure_or(value, digits, unit, ALWAYS));
    measured.join(" / ")
}

/// The same for an eye at infinity.
fn turns(c: &CertificateReport, unseen: &Rotation, one: &Rotation) -> Vec<Answer> {
    let way = |what, unseen, one| {
        Answer(
            what,
            both(unseen, one, 2, "°"),
            None,
            format!(
                "How far the direction may turn until the worst cut opens by {:.0} (nobody sees it) / {:.0} (still one picture) \
                 arc-minutes, as seen from {READING_MM:.0}{}mm.",
                UNSEEN_RAD.to_degrees() * 60.0,
                ONE_PICTURE_RAD.to_degrees() * 60.0,
                '\u{202F}'
            ),
        )
    };
    vec![
        way("Sideways", unseen.side, one.side),
        way("Up and down", unseen.up, one.up),
        Answer(
            "One picture from",
            measure_or(c.tolerance.one_picture_from_mm, 0, "mm", "anywhere"),
            None,
            "From there on an eye that is not at infinity sees one picture.".to_owned(),
        ),
    ]
}

/// What there is to list.
fn lists(c: &CertificateReport) -> String {
    let name = |n: &Option<String>| n.as_deref().map_or_else(|| DASH.into(), escaped);
    let gaps: Vec<_> = c.gaps.iter().map(gap).collect();
    let contests = c.contests.iter().map(|k| {
        [
            escaped(&k.with_view),
            escaped(&k.support),
            escaped(&k.with_support),
            measure(k.arcmin2, 1, ARCMIN2),
            place(k.place_mm),
            escaped(&k.lost_by),
        ]
    });
    let conflicts = c.conflicts.iter().map(|k| {
        let trouble = match k.trouble {
            Trouble::Blocked => "something stands before the relief",
            Trouble::Missing => "nothing is where the relief should be",
        };
        [
            trouble.to_owned(),
            measure(k.arcmin2, 1, ARCMIN2),
            place(k.place_mm),
            name(&k.with_view),
            name(&k.support),
        ]
    });
    let cuts: Vec<_> = c.tolerance.worst_cuts.iter().map(worst_cut).collect();
    table_if_any(
        "Gaps: what of the models nothing carries",
        [
            "cause",
            "size",
            "place",
            "from the line of sight",
            "support",
            "view",
            "lacking",
        ],
        &gaps,
    ) + &table_if_any(
        "Contests: surface that two views wanted",
        ["with view", "on", "against", "size", "place", "gave way"],
        &contests.collect::<Vec<_>>(),
    ) + &table_if_any(
        "Conflicts: what rays found amiss at the finished forest",
        ["what", "size", "place", "relief of", "at"],
        &conflicts.collect::<Vec<_>>(),
    ) + &table_if_any(
        "The cuts that open first when the eye moves",
        [
            "movement", "by", "opens", "place", "between", "gap", "overlap",
        ],
        &cuts,
    )
}

fn gap(g: &Gap) -> [String; 7] {
    let cause = match g.cause {
        Cause::NoPillar => "no support there",
        Cause::PillarTooShort => "the pillar is too short",
        Cause::OtherView => "another view needs the place",
        Cause::Hidden => "something else stands there",
        Cause::Infeasible => "no relief could be made there",
    };
    let name = |n: &Option<String>| n.as_deref().map_or_else(|| DASH.into(), escaped);
    [
        cause.to_owned(),
        measure(g.arcmin2, 1, ARCMIN2),
        place(g.place_mm),
        format!(
            "{} right, {} up",
            measure(g.right_deg, 2, "°"),
            measure(g.up_deg, 2, "°")
        ),
        name(&g.support),
        name(&g.view),
        measure_or(g.wanted_mm, 2, "mm", DASH),
    ]
}

fn worst_cut(cut: &WorstCut) -> [String; 7] {
    let way = match cut.movement {
        Way::Side => "sideways",
        Way::Up => "up and down",
        Way::Fore => "to and fro",
    };
    let [a, b] = &cut.supports;
    let between = if a == b {
        format!("a step on {}", escaped(a))
    } else {
        format!("{} and {}", escaped(a), escaped(b))
    };
    let angle = |c: &Option<Confirmed>| {
        c.map_or_else(
            || DASH.into(),
            |c| {
                let [worked_out, measured] =
                    [c.predicted_arcmin, c.measured_arcmin].map(|x| measure(x, 2, "′"));
                format!("{worked_out} worked out, {measured} measured")
            },
        )
    };
    [
        way.to_owned(),
        measure(cut.moved_mm, 2, "mm"),
        measure(cut.angle_arcmin, 0, "′"),
        place(cut.place_mm),
        between,
        angle(&cut.gap),
        angle(&cut.overlap),
    ]
}
