//! `--set path=value`: scene text with one value replaced or added.
//!
//! A path is field names and list places: `pillars[0].height`, `views[front].eye`, `output.picture_size`. A list place is a
//! number from 0 or the `name` of the item. Works on the text, so that messages about the new value show it in place.

use super::tree::{self, Member};
use super::wording::nearest;
use crate::diag::{Diagnostic, escaped};

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
enum PathStep {
    Field(String),
    Item(String),
}

/// The scene text with `assignment` ("path=value") carried out.
///
/// # Errors
/// A path that is malformed or leads nowhere.
pub fn set(text: &str, assignment: &str) -> Result<String, Diagnostic> {
    let shown = escaped(assignment);
    let wrong = |why: &str| {
        Diagnostic::error(format!("--set \"{shown}\": {why}"))
            .help("write it like: --set pillars[0].height=80")
    };
    let (path, value) = assignment
        .split_once('=')
        .ok_or_else(|| wrong("there is no `=`"))?;
    let steps = steps(path).ok_or_else(|| wrong("the path is malformed"))?;
    if value.trim().is_empty() {
        return Err(wrong("there is no value after `=`"));
    }
    let (mut start, mut end) = (0, text.len());
    for (depth, step) in steps.iter().enumerate() {
        let inside = &text[start..end];
        let members = tree::members(inside);
        if let Some(member) = find(inside, &members, step) {
            (start, end) = (start + member.value.start, start + member.value.end);
            continue;
        }
        return match step {
            PathStep::Field(_) => {
                let at = tree::inner_end(inside)
                    .map(|at| start + at)
                    .ok_or_else(|| wrong("the scene has no fields there"))?;
                insert(text, start, at, &members, &steps[depth..], value)
                    .ok_or_else(|| wrong("a list item cannot be added"))
            }
            PathStep::Item(item) => Err(no_item(
                wrong(&format!("there is no item [{item}]")),
                inside,
                &members,
                item,
            )),
        };
    }
    Ok(format!(
        "{}{}{}",
        &text[..start],
        value.trim(),
        &text[end..]
    ))
}

/// The text of the value that a path leads to.
pub(crate) fn value<'a>(text: &'a str, path: &str) -> Option<&'a str> {
    steps(path)?.iter().try_fold(text, |inside, step| {
        let member = find(inside, &tree::members(inside), step)?;
        Some(&inside[member.value])
    })
}

fn steps(path: &str) -> Option<Vec<PathStep>> {
    let mut steps = Vec::new();
    for part in path.trim().split('.') {
        let (name, mut items) = part.split_at(part.find('[').unwrap_or(part.len()));
        if name.is_empty() || !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
            return None;
        }
        steps.push(PathStep::Field(name.to_string()));
        while let Some(rest) = items.strip_prefix('[') {
            let (item, after) = rest.split_once(']')?;
            steps.push(PathStep::Item(item.to_string()));
            items = after;
        }
        if !items.is_empty() {
            return None;
        }
    }
    Some(steps)
}

fn find(inside: &str, members: &[Member], step: &PathStep) -> Option<Member> {
    let found = match step {
        PathStep::Field(name) => members
            .iter()
            .find(|e| e.name.as_ref().is_some_and(|n| &inside[n.clone()] == name)),
        PathStep::Item(item) => match item.parse::<usize>() {
            Ok(index) => members.get(index),
            Err(_) => members
                .iter()
                .find(|e| name_of(&inside[e.value.clone()]).as_deref() == Some(item)),
        },
    };
    found.cloned()
}

/// The text of a struct's `name` field without its quotes.
fn name_of(value: &str) -> Option<String> {
    let member = tree::members(value)
        .into_iter()
        .find(|e| e.name.as_ref().is_some_and(|n| &value[n.clone()] == "name"))?;
    Some(value[member.value].trim_matches('"').to_string())
}

fn no_item(problem: Diagnostic, inside: &str, members: &[Member], item: &str) -> Diagnostic {
    let names: Vec<String> = members
        .iter()
        .filter_map(|e| name_of(&inside[e.value.clone()]))
        .collect();
    match nearest(item, names.iter().map(String::as_str)) {
        Some(guess) => problem.help(format!("did you mean [{}]?", escaped(guess))),
        None => problem.help(format!(
            "the list has {} items, counted from 0",
            members.len()
        )),
    }
}

/// Adds the fields that are missing, nested as the path wants it.
fn insert(
    text: &str,
    start: usize,
    at: usize,
    members: &[Member],
    steps: &[PathStep],
    value: &str,
) -> Option<String> {
    let mut added = value.trim().to_string();
    for (i, step) in steps.iter().enumerate().rev() {
        let PathStep::Field(name) = step else {
            return None;
        };
        added = if i == 0 {
            format!("{name}: {added}")
        } else {
            format!("({name}: {added})")
        };
    }
    // A comma right after the last value: a comment may follow it, so not at the bracket.
    match members.last() {
        None => Some(format!("{}{added}{}", &text[..at], &text[at..])),
        Some(last) => {
            let after = start + last.value.end;
            Some(format!("{}, {added}{}", &text[..after], &text[after..]))
        }
    }
}
