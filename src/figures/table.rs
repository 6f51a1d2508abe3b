//! `figures.md`: what the paper says beside what was measured, as a table.

use super::figure::Done;
use super::findings::Case;
use std::fmt::Write as _;

/// A table of figures, then one of cases for each.
pub fn table(done: &[Done]) -> String {
    let mut text = String::from(
        "# The paper's figures, made again\n\n| figure | the paper | here | holds |\n|---|---|---|---|\n",
    );
    for d in done {
        let here: Vec<&str> = d.findings.claims.iter().map(|c| c.text.as_str()).collect();
        let here = d
            .failure
            .as_deref()
            .map_or(here.join("; "), |why| format!("not made: {why}"));
        _ = writeln!(
            text,
            "| {}: {} | {} | {} | {} |",
            d.figure.paper,
            d.figure.title,
            cell(d.figure.statement),
            cell(&here),
            if d.ok() { "yes" } else { "no" }
        );
    }
    for d in done {
        _ = write!(text, "\n## {}: {}\n\n", d.figure.paper, d.figure.title);
        text.push_str(&cases(&d.findings.cases));
        for note in &d.findings.notes {
            _ = writeln!(text, "\n{note}");
        }
    }
    text
}

/// One line a case, with a column for every number that any of them has.
fn cases(cases: &[Case]) -> String {
    let names = names(cases);
    let mut text = format!("| case | {} |\n", names.join(" | "));
    text += &format!("|---|{}\n", "---:|".repeat(names.len()));
    for case in cases {
        let numbers: Vec<String> = names.iter().map(|n| number(case, n)).collect();
        _ = writeln!(text, "| {} | {} |", cell(&case.name), numbers.join(" | "));
    }
    text
}

/// Names of all numbers in the order in which they come.
pub(crate) fn names(cases: &[Case]) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = Vec::new();
    for (name, _) in cases.iter().flat_map(|c| &c.measured) {
        if !names.contains(name) {
            names.push(name);
        }
    }
    names
}

/// As people read it; a dash where the case has none.
pub(crate) fn number(case: &Case, name: &str) -> String {
    let Some((_, value)) = case.measured.iter().find(|m| m.0 == name) else {
        return "\u{2013}".to_owned();
    };
    let integral = value.fract() == 0.0 && value.abs() < 1e9;
    match value.abs() {
        _ if integral => format!("{value}"),
        x if x >= 100.0 => format!("{value:.0}"),
        x if x >= 10.0 => format!("{value:.1}"),
        x if x >= 0.01 => format!("{value:.3}"),
        _ => format!("{value:.2e}"),
    }
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
