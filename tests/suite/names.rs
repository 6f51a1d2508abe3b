//! One name for one thing: types, functions written twice, and the compiler that the packages ask for.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files of `src` with their text, sorted.
fn sources() -> Vec<(String, String)> {
    let sources = crate::architecture::sources().into_iter();
    let text = |s: crate::architecture::Source| (format!("src/{}", s.path), s.lines.join("\n"));
    sources.map(text).collect()
}

/// The word after a keyword at the start of a line, behind `pub` and the like.
fn defined<'a>(line: &'a str, keywords: &[&str]) -> Option<&'a str> {
    let mut words = line
        .split([' ', '<', '(', '{', ';', ':'])
        .filter(|w| !w.is_empty());
    let mut word = words.next()?;
    while ["pub", "crate)", "super)", "const", "async"].contains(&word) {
        word = words.next()?;
    }
    keywords.contains(&word).then(|| words.next())?
}

/// Where every name is defined, of those that are defined more than once.
fn doubles(places: impl IntoIterator<Item = (String, String)>) -> BTreeMap<String, Vec<String>> {
    let mut all: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (name, place) in places {
        all.entry(name).or_default().push(place);
    }
    all.retain(|_, places| places.len() > 1);
    all
}

fn assert_none(found: &BTreeMap<String, Vec<String>>, rule: &str) {
    let told = found.iter();
    let told: Vec<String> = told
        .map(|(name, places)| format!("{name}: {}", places.join(", ")))
        .collect();
    assert!(told.is_empty(), "{rule}:\n{}", told.join("\n"));
}

#[test]
fn a_type_name_means_one_thing() {
    let mut places = Vec::new();
    for (path, text) in sources() {
        let mut block = "";
        for (i, line) in text.lines().enumerate() {
            if line.starts_with(|c: char| c.is_alphabetic()) {
                block = line;
            }
            // A `type` in one of these belongs to a trait.
            let of_trait = ["impl", "trait ", "pub trait ", "macro_rules!"]
                .iter()
                .any(|start| block.starts_with(start));
            let keywords = ["struct", "enum", "union", "trait", "type"];
            let keywords = &keywords[..keywords.len() - usize::from(of_trait)];
            let name = defined(line.trim_start(), keywords);
            // Macros define by a variable.
            if let Some(name) = name.filter(|n| !n.starts_with('$')) {
                places.push((name.to_owned(), format!("{path}:{}", i + 1)));
            }
        }
    }
    assert_none(&doubles(places), "a type name is defined more than once");
}

/// Name and body of every function of a formatted file, without indentation.
fn functions(text: &str) -> Vec<(&str, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let indent = &line[..line.len() - line.trim_start().len()];
        let Some(name) = defined(line.trim_start(), &["fn"]) else {
            continue;
        };
        let end = format!("{indent}}}");
        // Without a body, or on one line.
        let rest = &lines[i..];
        let Some(open) = rest
            .iter()
            .position(|l| l.ends_with('{') || l.ends_with(';'))
        else {
            continue;
        };
        let close = rest.iter().position(|l| *l == end);
        if let (true, Some(close)) = (rest[open].ends_with('{'), close) {
            let body: Vec<&str> = rest[open + 1..close].iter().map(|l| l.trim()).collect();
            found.push((name, body.join("\n")));
        }
    }
    found
}

/// Whether a body only gives a field: what every implementor of a trait that asks for it has to write.
fn gives_a_field(body: &str) -> bool {
    let path = body.strip_prefix('&').unwrap_or(body);
    path.starts_with("self.")
        && path
            .chars()
            .all(|c| c.is_alphanumeric() || "._".contains(c))
}

#[test]
fn a_function_is_written_once() {
    let sources = sources();
    let mut places = Vec::new();
    for (path, text) in &sources {
        for (name, body) in functions(text)
            .into_iter()
            .filter(|(_, b)| !gives_a_field(b))
        {
            places.push(((name, body), path.clone()));
        }
    }
    places.sort();
    places.dedup();
    let named =
        |((name, body), place): ((&str, String), String)| (format!("{name} {{\n{body}\n}}"), place);
    let twins = doubles(places.into_iter().map(named));
    let name = |key: &String| key.split(' ').next().unwrap_or_default().to_owned();
    let twins: BTreeMap<_, _> = twins.iter().map(|(k, v)| (name(k), v.clone())).collect();
    assert_none(&twins, "a function is written in several files");
}

/// Major and minor.
fn version(text: &str) -> (u32, u32) {
    let mut parts = text.split('.').map(|p| p.parse().expect("a number"));
    (parts.next().unwrap_or(0), parts.next().unwrap_or(0))
}

/// What a program writes.
fn told(program: &str, arguments: &[&str]) -> Vec<u8> {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(root())
        .output();
    let output = output.expect("the program runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    output.stdout
}

#[test]
fn the_compiler_is_as_new_as_every_package_asks() {
    // Only the packages of this platform: others may not be there without a network.
    let host = told("rustc", &["--print", "host-tuple"]);
    let host = String::from_utf8(host).expect("text");
    let arguments = "metadata --locked --offline --format-version 1 --filter-platform";
    let arguments: Vec<&str> = arguments.split(' ').chain([host.trim()]).collect();
    let all = told(env!("CARGO"), &arguments);
    let all: serde_json::Value = serde_json::from_slice(&all).expect("JSON");
    let packages = all["packages"].as_array().expect("packages");
    let asked = |p: &serde_json::Value| p["rust_version"].as_str().map(version);
    let own = packages.iter().find(|p| p["name"] == "pillarforest");
    let own = own.and_then(asked).expect("a rust-version of our own");
    let newest = packages.iter().max_by_key(|p| asked(p)).expect("packages");
    assert!(
        asked(newest) <= Some(own),
        "{} asks for Rust {}, we for {own:?}",
        newest["name"],
        newest["rust_version"]
    );
}
