//! `figures.json`: the rows for scripts.

use super::figure::Done;
use super::findings::Case;
use serde_json::{Map, Value, json};

/// One object with `rows` (a case each: `figure`, `case`, `scene`, `set`, `measured` by names that tell the units, `ok`) and
/// `figures` (what was claimed of them, and whether it holds).
pub fn json(done: &[Done]) -> String {
    let rows: Vec<Value> = done.iter().flat_map(rows).collect();
    let figures: Vec<Value> = done.iter().map(figure).collect();
    let all = json!({
        "program": { "name": env!("CARGO_PKG_NAME"), "version": env!("CARGO_PKG_VERSION") },
        "figures": figures,
        "rows": rows,
    });
    format!("{all:#}\n")
}

fn rows(done: &Done) -> Vec<Value> {
    let row = |case: &Case| {
        let measured: Map<String, Value> = case
            .measured
            .iter()
            .map(|(name, value)| ((*name).to_owned(), json!(value)))
            .collect();
        json!({
            "figure": done.figure.name,
            "case": case.name,
            "scene": case.scene,
            "set": case.sets,
            "measured": measured,
            "ok": case.ok,
        })
    };
    done.findings.cases.iter().map(row).collect()
}

fn figure(done: &Done) -> Value {
    let claims: Vec<Value> = done
        .findings
        .claims
        .iter()
        .map(|c| json!({ "claim": c.text, "holds": c.holds }))
        .collect();
    json!({
        "figure": done.figure.name,
        "paper": done.figure.paper,
        "title": done.figure.title,
        "statement": done.figure.statement,
        "claims": claims,
        "notes": done.findings.notes,
        "failure": done.failure,
        "ok": done.ok(),
    })
}
