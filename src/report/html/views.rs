//! The page's section on one view: target against forest, errors, lights, figures.

use super::certificate::certificate;
use super::exhibits::ViewExhibit;
use super::text::{
    self, DASH, count, measure, measure_or, percent, picture, place, table, table_if_any, tiny,
};
use crate::formats::markup::escaped;
use crate::mimic::{Ending, Iterated};
use crate::render::{HEAT, SCALE_END_DEG, ViewPictures};
use crate::report::view::{ProgramReport, ViewReport};
use crate::steps::StepSummary;
use std::fmt::Write as _;

/// The section of the view with this number.
pub(crate) fn view(number: usize, found: &ViewReport, shown: Option<&ViewExhibit>) -> String {
    let name = escaped(&found.name);
    let swatch = shown.map_or_else(String::new, |s| {
        let [r, g, b] = s.colour;
        format!("<i class=\"swatch\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></i> ")
    });
    let files: Vec<String> = found.models.iter().map(|m| escaped(&m.file)).collect();
    let mut html = format!(
        "<section id=\"view-{number}\">\n<h2>{swatch}{name}</h2>\n<p class=\"lead\">{} {}, looking at {}.</p>\n",
        files.join(", "),
        standpoint(found),
        place(found.look_at)
    );
    if let Some(pictures) = shown.and_then(|s| s.pictures) {
        html.push_str(&panels(&found.name, found, pictures));
    }
    html.push_str(&facts(found));
    if let Some(c) = &found.certificate {
        _ = write!(
            html,
            "<h3>Certificate</h3>\n{}",
            certificate(&found.name, c)
        );
    }
    html.push_str(&lights(found, shown));
    html.push_str(&inner(found));
    html.push_str("</section>\n");
    html
}

/// From where a view is seen.
fn standpoint(found: &ViewReport) -> String {
    match found.from {
        Some(from) => {
            let [x, y, z] = from.map(|c| measure(c, 2, ""));
            format!("by parallel rays from the direction ({x}, {y}, {z})")
        }
        None => format!("from an eye at {}", place(found.eye)),
    }
}

/// The slider, with the errors beside it. Without scripts the slider's two pictures stand side by side.
fn panels(name: &str, found: &ViewReport, pictures: &ViewPictures) -> String {
    let [target, forest, error] = &pictures.panels;
    let error_text = found.normal_error_deg.map_or_else(String::new, |e| {
        format!(
            ": mean {}, median {}, nine tenths below {}",
            measure(e.mean, 2, "°"),
            measure(e.median, 2, "°"),
            measure(e.p90, 2, "°")
        )
    });
    let torn = found
        .steps
        .map_or("", |_| " Lines are steps in the surface.");
    format!(
        "<div class=\"panels\">\n<figure class=\"wipe\">\n<div class=\"pair\">\n<div class=\"target\">{}<span>model</span></div>\n\
         <div class=\"forest\">{}<span>forest</span></div>\n</div>\n\
         <input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"1\" aria-label=\"How much of the model is shown before \
         the forest\">\n<figcaption>What the eye should see, and what it sees of the finished forest.</figcaption>\n</figure>\n\
         <figure class=\"error\">\n{}\n{}<figcaption>Error of the normals{error_text}.{torn}</figcaption>\n</figure>\n</div>\n",
        picture(target, &format!("{name}: the model")),
        picture(forest, &format!("{name}: the forest from its eye")),
        picture(error, &format!("{name}: error of the normals")),
        scale()
    )
}

/// The colours of the error picture, as its own scale has them.
fn scale() -> String {
    let colours: Vec<String> = HEAT
        .iter()
        .map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"))
        .collect();
    format!(
        "<div class=\"heat\"><i style=\"background:linear-gradient(90deg,{})\"></i><span>0°</span><span>{:.0}° and \
         more</span></div>\n",
        colours.join(","),
        SCALE_END_DEG
    )
}

fn facts(v: &ViewReport) -> String {
    let mut facts = vec![
        ("vertices of the models", count(v.vertices)),
        ("faces", count(v.faces)),
    ];
    let mut add = |what, found: Option<String>| facts.extend(found.map(|f| (what, f)));
    add(
        "size as seen",
        v.solid_angle_sr.map(|x| measure(x, 4, "sr")),
    );
    add("rays that meet the forest", v.hit_share.map(percent));
    add("of so many rays", v.rays.map(count));
    add("pieces on supports", v.groups.map(count));
    add("triangles of the view map", v.cells.map(count));
    text::facts(&facts)
}

fn lights(v: &ViewReport, shown: Option<&ViewExhibit>) -> String {
    let Some(found) = &v.lights else {
        return String::new();
    };
    let sheet = shown.and_then(|s| s.lights).map_or_else(String::new, |png| {
        format!(
            "<figure class=\"lights\">{}<figcaption>Above the model, below the forest, under the sun at three heights, an \
             overcast sky and a flash beside the model.</figcaption></figure>\n",
            picture(png, &format!("{}: in real light", v.name))
        )
    });
    let rows: Vec<_> = found
        .iter()
        .map(|l| {
            let dash = DASH.to_owned();
            [
                match l.elevation_deg {
                    Some(e) => format!("sun at {}", measure(e, 0, "°")),
                    None if l.light == "flash" => "flash beside it".to_owned(),
                    None => "overcast sky".to_owned(),
                },
                measure(l.rmse, 1, ""),
                measure(l.rmse_unshadowed, 1, ""),
                measure(l.rmse_fitted, 1, ""),
                measure(l.gain, 2, ""),
                measure_or(l.correlation, 2, "", DASH),
                l.false_shadow_share.map_or(dash.clone(), percent),
                l.lost_shadow_share.map_or(dash, percent),
            ]
        })
        .collect();
    let figures = table(
        "Difference of brightness on a scale of 0 to 255, shadows included",
        [
            "light",
            "difference",
            "without shadows",
            "after adapting",
            "by a factor of",
            "correlation",
            "false shadow",
            "lost shadow",
        ],
        &rows,
    );
    format!("<h3>In real light</h3>\n{sheet}{figures}")
}

/// What only those want to know who wonder how it was made.
fn inner(v: &ViewReport) -> String {
    let parts = [
        v.steps.as_ref().map(steps),
        v.program.as_ref().map(program),
        v.iterated.as_ref().map(iterated),
    ];
    let rows: Vec<_> = parts
        .into_iter()
        .flatten()
        .flatten()
        .map(|(what, found)| [what.to_owned(), found])
        .collect();
    let table = table_if_any("Steps and solver", ["what", "found"], &rows);
    if table.is_empty() {
        table
    } else {
        format!("<details>\n<summary>Steps and solver</summary>\n{table}</details>\n")
    }
}

fn steps(s: &StepSummary) -> Vec<(&'static str, String)> {
    let mut rows = vec![
        ("Lines along which the surface is torn", count(s.lines)),
        ("Pieces of surface", count(s.pieces)),
        ("Length of all tears", measure(s.length_mm, 0, "mm")),
        ("Mean height of the steps", measure(s.mean_mm, 2, "mm")),
        ("Highest step", measure(s.highest_mm, 2, "mm")),
        (
            "Strips too narrow to print, given to a neighbour",
            measure(s.absorbed_mm2, 2, "mm²"),
        ),
    ];
    rows.extend(s.lowest_mm.map(|x| ("Lowest step", measure(x, 2, "mm"))));
    let room = |x| {
        (
            "Movement of the eye in any direction until a step opens by two arc-minutes",
            measure(x, 2, "mm"),
        )
    };
    rows.extend(s.tolerance_mm.map(room));
    rows
}

fn program(p: &ProgramReport) -> Vec<(&'static str, String)> {
    vec![
        ("Unknowns of the program", count(p.variables)),
        ("Conditions", count(p.rows)),
        ("Parts solved one by one", count(p.blocks)),
        ("Conditions that hold something back", count(p.active_rows)),
        ("Solved by", escaped(&p.method)),
        ("Iterations", count(p.iterations as usize)),
        ("Energy", tiny(p.objective)),
        (
            "Energy before conditions were added",
            tiny(p.objective_first),
        ),
        ("Rounds of adding conditions", count(p.rounds as usize)),
        ("Conditions added", count(p.rows_added)),
        ("What the energy leaves open", escaped(&p.gauge)),
    ]
}

fn iterated(i: &Iterated) -> Vec<(&'static str, String)> {
    let changes = i.rounds.iter().map(|r| measure(100.0 * r.change, 2, ""));
    let ending = match i.ending {
        Ending::Converged => "converged",
        Ending::Unfinished => "not settled",
        Ending::Diverged => "diverged",
        Ending::Failed => "failed",
    };
    vec![
        (
            "Rounds with the Laplacian of the deformed surface",
            format!("{} of {}, {ending}", i.rounds.len(), i.allowed),
        ),
        (
            "Changes round by round, in hundredths of the layer",
            changes.collect::<Vec<_>>().join(", "),
        ),
        (
            "Turn of the normals, linearised and kept",
            format!(
                "{} and {} (round {})",
                measure(i.linearised_deg, 2, "°"),
                measure(i.kept_deg, 2, "°"),
                i.kept
            ),
        ),
    ]
}
