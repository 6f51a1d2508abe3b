//! `index.html`: all figures on one page, the paper's statement beside the measurement.

use super::figure::Done;
use super::findings::{Case, Conclusion};
use super::table::{names, number};
use crate::formats::markup::escaped;
use std::fmt::Write as _;

const STYLE: &str = include_str!("page.css");
/// What browsers may load for the page: pictures beside it and its own style.
const POLICY: &str = "default-src 'none'; img-src 'self' file:; style-src 'unsafe-inline'";

/// The page; pictures are files beside it.
pub fn page(done: &[Done]) -> String {
    let well = done.iter().filter(|d| d.ok()).count();
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en-GB\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>The paper's figures, made again</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <h1>The paper's figures, made again</h1>\n\
         <p class=\"lead\">Schueller, Panozzo and Sorkine-Hornung, <i>Appearance-Mimicking Surfaces</i>, SIGGRAPH Asia 2014. \
         Left what the paper says, right what {} {} measured with its own models. {well} of {} hold.</p>\n<nav><ul>\n",
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
        done.len()
    );
    for d in done {
        let (sign, class) = sign(d.ok());
        _ = writeln!(
            html,
            "<li><a href=\"#{0}\">{1}</a> {2} <span class=\"{class}\">{sign}</span></li>",
            d.figure.name,
            escaped(d.figure.paper),
            escaped(d.figure.title)
        );
    }
    html.push_str("</ul></nav>\n<main>\n");
    done.iter().for_each(|d| html.push_str(&section(d)));
    html.push_str("</main>\n<footer>Every number stands in figures.json, in full.</footer>\n</body>\n</html>\n");
    html
}

fn sign(holds: bool) -> (&'static str, &'static str) {
    match holds {
        true => ("holds", "holds"),
        false => ("does not hold", "off"),
    }
}

fn section(done: &Done) -> String {
    let (figure, findings) = (&done.figure, &done.findings);
    let mut html = format!(
        "<section id=\"{}\">\n<h2>{}: {}</h2>\n<div class=\"pair\">\n<div><h3>The paper</h3><p>{}</p></div>\n<div><h3>Here</h3>\n",
        figure.name,
        escaped(figure.paper),
        escaped(figure.title),
        escaped(figure.statement)
    );
    if let Some(why) = &done.failure {
        _ = writeln!(
            html,
            "<p class=\"off\">It could not be made: {}</p>",
            escaped(why)
        );
    }
    html.push_str("<ul>\n");
    findings
        .claims
        .iter()
        .for_each(|c| html.push_str(&claim(c)));
    html.push_str("</ul>\n");
    for note in &findings.notes {
        _ = writeln!(html, "<p class=\"quiet\">{}</p>", escaped(note));
    }
    html.push_str("</div>\n</div>\n");
    html.push_str(&cases(&findings.cases));
    html.push_str("<div class=\"pictures\">\n");
    for picture in &findings.pictures {
        _ = writeln!(
            html,
            "<figure><a href=\"{0}\"><img loading=\"lazy\" src=\"{0}\" alt=\"{1}\"></a><figcaption>{1}</figcaption></figure>",
            escaped(&picture.path),
            escaped(&picture.caption)
        );
    }
    html.push_str("</div>\n</section>\n");
    html
}

fn claim(claim: &Conclusion) -> String {
    let (sign, class) = sign(claim.holds);
    format!(
        "<li>{} <span class=\"{class}\">({sign})</span></li>\n",
        escaped(&claim.text)
    )
}

fn cases(cases: &[Case]) -> String {
    if cases.is_empty() {
        return String::new();
    }
    let names = names(cases);
    let mut html = String::from("<div class=\"scroll\"><table>\n<tr><th>case</th>");
    names
        .iter()
        .for_each(|n| _ = write!(html, "<th>{}</th>", n.replace('_', " ")));
    html.push_str("<th>scene</th></tr>\n");
    for case in cases {
        _ = write!(html, "<tr><td>{}</td>", escaped(&case.name));
        names
            .iter()
            .for_each(|n| _ = write!(html, "<td class=\"number\">{}</td>", number(case, n)));
        let sets: Vec<String> = case.sets.iter().map(|s| format!("--set \"{s}\"")).collect();
        _ = writeln!(
            html,
            "<td><code title=\"{}\">{}</code></td></tr>",
            escaped(&sets.join(" ")),
            escaped(&case.scene)
        );
    }
    html.push_str("</table></div>\n");
    html
}
