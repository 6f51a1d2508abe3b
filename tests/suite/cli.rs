//! The command: exit codes, messages, file access, what is written and what is not.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

pub(crate) const PLAIN: &str = include_str!("../cases/ok.ron");
pub(crate) const CUBE: &str = "v -10 -10 -10\nv 10 -10 -10\nv 10 10 -10\nv -10 10 -10\nv -10 -10 10\nv 10 -10 10\nv 10 10 10\nv -10 10 10\n\
f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

/// A fresh directory with a cube and a scene of the given text.
pub(crate) fn folder(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    fs::write(folder.path().join("scene.ron"), scene).unwrap();
    folder
}

/// Runs the program; gives exit code, standard output and standard error.
pub(crate) fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("pillarforest")
        .unwrap()
        .current_dir(folder)
        .env_remove("PILLARFOREST_MODELS")
        .args(args)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8 output");
    (
        output.status.code().expect("no signal"),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn check_accepts_a_sound_scene_and_writes_nothing() {
    let folder = folder(PLAIN);
    let (code, out, err) = run(folder.path(), &["check"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("2 views, 64 pillars"), "{out}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn messages_show_line_excerpt_mark_and_help() {
    let folder = folder(&PLAIN.replace("pitch: 5", "pich: 5"));
    let (code, _, err) = run(folder.path(), &["build"]);
    assert_eq!(code, 1);
    for part in [
        "error: unknown field `pich`, did you mean `pitch`?",
        "scene.ron:14:13",
        "pich: 5",
        "^^^^",
        "1 error. Nothing was written.",
    ] {
        assert!(err.contains(part), "{part}\n{err}");
    }
    assert!(!folder.path().join("out").exists());
    let (_, _, short) = run(folder.path(), &["check", "--diagnostics", "short"]);
    assert!(
        short.starts_with("scene.ron:14:13: error: unknown field `pich`"),
        "{short}"
    );
    let (_, _, json) = run(folder.path(), &["check", "--diagnostics", "json"]);
    let value: serde_json::Value = serde_json::from_str(json.lines().next().unwrap()).unwrap();
    assert_eq!(
        (value["line"].as_u64(), value["severity"].as_str()),
        (Some(14), Some("error"))
    );
}

#[test]
fn nothing_dangerous_reaches_the_terminal() {
    let folder = folder(
        &PLAIN
            .replace("\"front\"", "\"\u{1b}[31mred\u{202e}\"")
            .replace("pitch: 5", "pitch: \"\u{1b}]0;x\u{7}\""),
    );
    for style in ["human", "short", "json"] {
        let (_, out, err) = run(
            folder.path(),
            &["check", "--diagnostics", style, "--color", "never"],
        );
        let bad = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert!(!out.contains(bad) && !err.contains(bad), "{style}: {err:?}");
    }
}

#[test]
fn warnings_can_be_denied() {
    let folder = folder(&PLAIN.replace("\"front\"", "\"CON\""));
    assert_eq!(run(folder.path(), &["check"]).0, 0);
    let (code, _, err) = run(folder.path(), &["check", "--deny", "warnings"]);
    assert_eq!(code, 1);
    assert!(err.contains("Warnings are denied."), "{err}");
}

#[test]
fn model_files_are_read_only_from_where_they_may_be() {
    let text = |file: &str| PLAIN.replace("cube.obj", file);
    for (file, said) in [
        ("nope.obj", "there is no file"),
        ("../../../etc/passwd", "outside the scene's folder"),
        ("/dev/zero", "outside the scene's folder"),
        ("sub", "is a directory"),
        ("\\\\\\\\host\\\\share\\\\a.stl", "network share"),
        ("sub\\\\cube.obj", "backslashes"),
        ("https://example.org/a.stl", "from the network"),
        ("", "is empty"),
    ] {
        let folder = folder(&text(file));
        fs::create_dir(folder.path().join("sub")).unwrap();
        let (code, _, err) = run(folder.path(), &["check"]);
        assert_eq!(code, 1, "{file}");
        assert!(
            err.contains(said) && err.contains("scene.ron:3:"),
            "{file}\n{err}"
        );
        assert!(!err.contains("root:"), "{err}");
    }
    let near = folder(&text("cubes.obj"));
    assert!(
        run(near.path(), &["check"])
            .2
            .contains("did you mean \"cube.obj\"?")
    );
}

#[test]
fn a_models_folder_is_looked_in_first_by_file_name() {
    let library = folder("");
    let dir = library.path().to_str().unwrap();
    let scene = tempfile::tempdir().unwrap();
    fs::write(
        scene.path().join("scene.ron"),
        PLAIN.replace("cube.obj", "../elsewhere/cube.obj"),
    )
    .unwrap();
    assert_eq!(run(scene.path(), &["check"]).0, 1);
    assert_eq!(run(scene.path(), &["check", "--models", dir]).0, 0);
    let mut command = Command::cargo_bin("pillarforest").unwrap();
    command
        .current_dir(scene.path())
        .env("PILLARFOREST_MODELS", dir)
        .arg("check")
        .assert()
        .success();
}

#[test]
fn a_scene_that_is_no_text_names_the_byte() {
    let folder = folder("");
    fs::write(folder.path().join("scene.ron"), b"(\n  title: \"\xff\"\n)").unwrap();
    let (code, _, err) = run(folder.path(), &["check"]);
    assert_eq!(code, 1);
    assert!(err.contains("byte 12"), "{err}");
    let (code, _, err) = run(folder.path(), &["check", "none.ron"]);
    assert_eq!(code, 1);
    assert!(
        err.contains("there is no scene \"none.ron\"") && err.contains("pillarforest init"),
        "{err}"
    );
}

#[test]
fn usage_errors_exit_with_two() {
    let folder = folder(PLAIN);
    for args in [
        &["bild"][..],
        &["check", "-j", "0"],
        &["build", "-o", "scene.ron"],
        &["view", "-o", "plan.stl"],
        &["build", "-o", "cube.obj/x"],
    ] {
        let (code, _, err) = run(folder.path(), args);
        assert_eq!(code, 2, "{args:?}: {err}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn set_changes_the_scene_for_one_run() {
    let folder = folder(PLAIN);
    let (code, out, _) = run(
        folder.path(),
        &["check", "--set", "pillars[0].places=At([(0, 0), (9, 9)])"],
    );
    assert_eq!(code, 0);
    assert!(out.contains("2 pillars"), "{out}");
    let (code, _, err) = run(folder.path(), &["check", "--set", "pillars[0].height=-3"]);
    assert_eq!(code, 1);
    assert!(
        err.contains("(with --set)") && err.contains("`height` is -3 mm"),
        "{err}"
    );
}

#[test]
fn init_writes_a_scene_that_checks_and_overwrites_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, err) = run(folder.path(), &["init"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("next: pillarforest build"), "{out}");
    let (code, out, err) = run(folder.path(), &["check", "--deny", "warnings"]);
    assert_eq!(code, 0, "{out}{err}");
    fs::write(folder.path().join("scene.ron"), "mine").unwrap();
    let (code, _, err) = run(folder.path(), &["init"]);
    assert_eq!(code, 1);
    assert!(
        err.contains("exists already") && err.contains("--force"),
        "{err}"
    );
    assert_eq!(
        fs::read_to_string(folder.path().join("scene.ron")).unwrap(),
        "mine"
    );
}

#[test]
fn schema_help_and_completions_print() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(folder.path(), &["schema"]).1.contains("look_at"));
    assert!(
        run(folder.path(), &["completions", "bash"])
            .1
            .contains("pillarforest")
    );
    let (code, help, _) = run(folder.path(), &["--help"]);
    assert_eq!(code, 0);
    for command in [
        "init",
        "check",
        "build",
        "plan",
        "repair",
        "view",
        "render",
        "inspect",
        "schema",
        "completions",
        "Exit codes",
    ] {
        assert!(help.contains(command), "{command}");
    }
}

#[test]
fn inspect_refuses_what_it_cannot_read() {
    let folder = folder("");
    fs::write(folder.path().join("junk.obj"), "this is no mesh\n").unwrap();
    assert_eq!(run(folder.path(), &["inspect", "junk.obj"]).0, 1);
    assert_eq!(run(folder.path(), &["inspect", "none.stl"]).0, 1);
    assert_eq!(run(folder.path(), &["inspect", "cube.obj"]).0, 0);
    assert_eq!(run(folder.path(), &["inspect"]).0, 2);
}

/// One pillar that is narrower than the cube before it.
const TOO_NARROW: &str = r#"(
    models: [(name: "cube", file: "cube.obj", place: Fit(height: 10, at: (0, 0, 8)))],
    views: [(name: "front", eye: (0, -150, 13), models: ["cube"])],
    pillars: [(shape: Round(radius: 4), height: 30, places: At([(0, 0)]))],
    output: (forest_glb: false, plan: false, views: false, lights: false, camouflage: false),
)"#;

/// What another machine or a slicer's supports may solve is told, and no failure.
#[test]
fn matters_of_the_machine_are_warnings() {
    let wide = TOO_NARROW.replace("radius: 4", "radius: 9");
    let folder = folder(&wide);
    let small_bed = [
        "build",
        "-o",
        "made",
        "--set",
        "printer=(bed: (20, 20, 20))",
    ];
    let (code, _, err) = run(folder.path(), &small_bed);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("warning: print check `bed`"), "{err}");
    let (code, _, err) = run(
        folder.path(),
        &[
            "build",
            "-o",
            "made",
            "--set",
            "make=Printed(overhang: 0.1)",
        ],
    );
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("warning: print check `overhang`"), "{err}");
    let built = ["build", "-q", "-o", "built", "--set", "make=Built()"];
    let (code, _, err) = run(folder.path(), &built);
    assert_eq!((code, err.as_str()), (0, ""));
    let report = fs::read_to_string(folder.path().join("built/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let checks = report["print"].as_array().expect("checks");
    let names: Vec<&str> = checks.iter().filter_map(|c| c["check"].as_str()).collect();
    assert_eq!(names, ["part", "cavity", "core"]);
}

/// Pillars without a base stand each for itself, in a board drilled for them.
#[test]
fn pillars_without_a_base_are_no_loose_parts() {
    let two = TOO_NARROW
        .replace("radius: 4", "radius: 7")
        .replace("At([(0, 0)])", "At([(0, 0), (0, 30)])")
        .replace("output:", "base: None, output:");
    let folder = folder(&two);
    let (code, _, err) = run(folder.path(), &["build", "-q", "-o", "made"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let report = fs::read_to_string(folder.path().join("made/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["solid"]["parts"], 2);
}

#[test]
fn what_does_not_hold_is_told_and_written_only_by_force() {
    let folder = folder(TOO_NARROW);
    let (code, out, err) = run(folder.path(), &["build", "-o", "made"]);
    assert_eq!((code, out.as_str()), (3, ""), "{err}");
    for part in [
        "error: view \"front\" misses",
        "no pillar stands there",
        "add a pillar there",
        "1 error. Nothing was written; `--force` writes it all the same.",
    ] {
        assert!(err.contains(part), "{part}\n{err}");
    }
    assert!(!folder.path().join("made").exists());
    let (code, out, err) = run(folder.path(), &["build", "-o", "made", "--force"]);
    assert_eq!(code, 3, "{err}");
    assert!(out.starts_with("wrote made"), "{out}");
    let report = fs::read_to_string(folder.path().join("made/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["ok"], false);
    assert_eq!(report["failures"].as_array().map(Vec::len), Some(1));
    let gaps = report["views"][0]["certificate"]["gaps"].as_array();
    assert!(gaps.is_some_and(|g| g.iter().all(|g| g["cause"] == "no_pillar")));
    assert!(folder.path().join("made/forest.stl").exists());
}
