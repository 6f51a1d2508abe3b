//! The README keeps its word: its scene resolves, its files and pictures exist, its commands are the program's.

use pillarforest::diag::Diagnostic;
use pillarforest::scene;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// Contents of the fenced blocks of one language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    text.split(&fence)
        .skip(1)
        .map(|rest| rest[..rest.find("```").expect("a closing fence")].to_owned())
        .collect()
}

#[test]
fn the_scenes_in_the_readme_resolve_without_a_word() {
    let scenes = blocks(&text("README.md"), "ron");
    assert_eq!(scenes.len(), 3);
    let read = |file: &str| {
        fs::read(root().join("scenes").join(file))
            .map_err(|e| Diagnostic::error(format!("{file}: {e}")))
    };
    for (text, views) in scenes.iter().zip([2, 1, 1]) {
        let done = scene::resolve(text, &read).unwrap_or_else(|problems| panic!("{problems:?}"));
        assert!(done.warnings.is_empty(), "{:?}", done.warnings);
        assert_eq!(done.value.views.len(), views);
    }
}

#[test]
fn links_and_pictures_lead_to_files() {
    for page in ["README.md", "CHANGELOG.md", "scenes/models/README.md"] {
        let text = text(page);
        let folder = root().join(Path::new(page).parent().unwrap());
        for rest in text.split("](").skip(1) {
            let link = &rest[..rest.find(')').unwrap()];
            if !link.starts_with("http") && !link.starts_with('#') {
                assert!(folder.join(link).exists(), "{page}: {link}");
            }
        }
    }
}

#[test]
fn commands_name_scenes_that_exist() {
    let readme = text("README.md");
    for word in readme.split(|c: char| c.is_whitespace() || "`()".contains(c)) {
        if word.starts_with("scenes/") && word.ends_with(".ron") {
            assert!(root().join(word).exists(), "{word}");
        }
    }
    for command in [
        "cargo run --release -- build scenes/four-creatures.ron",
        "cargo test --release",
    ] {
        assert!(readme.contains(command), "{command}");
    }
}

#[test]
fn the_version_is_in_the_changelog() {
    let heading = format!("## {}", env!("CARGO_PKG_VERSION"));
    assert!(text("CHANGELOG.md").contains(&heading), "{heading}");
}

#[test]
fn the_table_of_errors_is_that_of_the_golden_builds() {
    let readme = text("README.md");
    let mut count = 0;
    for entry in fs::read_dir(root().join("tests/golden")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "json") {
            continue;
        }
        let scene = path.file_stem().unwrap().to_str().unwrap();
        let figures: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
        for view in figures["views"].as_array().unwrap() {
            let error = &view["mean_median_p90_deg"];
            let [mean, median, p90] = [0, 1, 2].map(|k| error[k].as_f64().unwrap());
            let name = view["name"].as_str().unwrap();
            let row = format!("| {scene} | {name} | {mean:.1} | {median:.1} | {p90:.1} |");
            assert!(readme.contains(&row), "the README wants this row:\n  {row}");
            count += 1;
        }
    }
    assert!(count >= 5, "{count}");
}

#[test]
fn the_table_of_thicknesses_is_that_of_the_saved_rows() {
    let readme = text("README.md");
    let rows = text("benches/thickness/rows.csv");
    let rows: Vec<Vec<&str>> = rows.lines().map(|l| l.split(',').collect()).collect();
    let table = readme
        .lines()
        .filter(|l| l.starts_with("| ") && l.contains(": `"));
    let mut count = 0;
    for line in table {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let (surface, _) = cells[1].split_once(": `").unwrap();
        for (mm, cell) in ["1", "2", "4", "7", "12"].iter().zip(&cells[2..]) {
            let of = |r: &&Vec<&str>| r[..3] == [cells[0], surface, mm];
            let views: Vec<&Vec<&str>> = rows.iter().filter(of).collect();
            let complete = views
                .first()
                .is_some_and(|r| r[4] == views.len().to_string());
            let sum: f64 = views.iter().map(|r| r[5].parse::<f64>().unwrap()).sum();
            let mean = sum / views.len() as f64;
            match cell.parse::<f64>() {
                Ok(found) => assert!(
                    complete && (found - mean).abs() < 0.0501,
                    "{line}: {mm} mm: {mean}"
                ),
                Err(_) => assert!(*cell == "-" && !complete, "{line}: {mm} mm: {mean}"),
            }
            count += 1;
        }
    }
    assert_eq!(count, 40);
}
