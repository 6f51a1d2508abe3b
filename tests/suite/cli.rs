//! The command: exit codes, messages, file access, what is written and what is not.

use super::shapes::{ball, obj};
use assert_cmd::Command;
use glam::DVec3;
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

/// Runs a line of the shell in which `pillarforest` is the program.
#[cfg(unix)]
pub(crate) fn shell(folder: &Path, line: &str) -> (i32, String, String) {
    let program = Command::cargo_bin("pillarforest").unwrap();
    let program = Path::new(program.get_program()).parent().unwrap();
    let path = std::env::var("PATH").unwrap_or_default();
    let output = Command::new("bash")
        .current_dir(folder)
        .env_remove("PILLARFOREST_MODELS")
        .env("PATH", format!("{}:{path}", program.display()))
        .args(["-c", line])
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8 output");
    (
        output.status.code().unwrap_or(-1),
        text(output.stdout),
        text(output.stderr),
    )
}

/// A scene with a warning before and a line of progress in its build.
#[cfg(target_os = "linux")]
#[test]
fn a_closed_or_full_standard_error_stops_no_build() {
    for line in [
        "pillarforest view -v -o made 2>/dev/full",
        "pillarforest view -v -o made 2>&1 >/dev/null | true; exit ${PIPESTATUS[0]}",
        "pillarforest view -v -o made 2>&-",
        "pillarforest view -v --timings -o made 2>/dev/full",
    ] {
        let folder = folder(&PLAIN.replace("\"front\"", "\"CON\""));
        let (code, _, err) = shell(folder.path(), line);
        assert_eq!(code, 0, "{line}: {err}");
        assert!(folder.path().join("made/plan.svg").exists(), "{line}");
    }
    let wrong = folder("(");
    assert_eq!(shell(wrong.path(), "pillarforest check 2>/dev/full").0, 1);
    assert_eq!(shell(wrong.path(), "pillarforest bild 2>/dev/full").0, 2);
}

#[cfg(target_os = "linux")]
#[test]
fn what_does_not_reach_standard_output_is_told() {
    for command in [
        "inspect --json cube.obj",
        "inspect cube.obj",
        "schema",
        "check",
        "completions bash",
        "--help",
        "init fresh.ron",
        "view -o made",
        "figures --list",
    ] {
        let folder = folder(PLAIN);
        let (code, _, err) = shell(
            folder.path(),
            &format!("pillarforest {command} > /dev/full"),
        );
        assert_eq!(code, 4, "{command}: {err}");
        assert!(err.contains("standard output"), "{command}: {err}");
    }
    // A reader that has had enough is no failure.
    let line = "pillarforest schema | head -1 > /dev/null; exit ${PIPESTATUS[0]}";
    assert_eq!(shell(folder("").path(), line).0, 0);
}

#[test]
fn messages_without_a_place_have_no_empty_frame() {
    let folder = folder(PLAIN);
    for args in [
        &["check", "none.ron"][..],
        &["inspect", "none.stl"],
        &["view", "-o", "a.pdf"],
        &["view", "--models", "nowhere"],
        &["init"],
    ] {
        let (_, _, err) = run(folder.path(), args);
        assert!(
            err.contains("error: ") || err.contains("warning: "),
            "{err}"
        );
        let bare = |l: &str| l.trim() == "|";
        assert!(!err.lines().any(bare), "{args:?}\n{err}");
    }
}

#[test]
fn outputs_that_no_command_writes_say_what_to_type() {
    let folder = folder(PLAIN);
    for (command, output, help) in [
        ("build", "x.obj", "-o forest.3mf"),
        ("build", "x.PLY", "surface: true"),
        ("build", "x.html", "give a folder"),
        ("build", "x.pdf", "-o plan.svg"),
        ("view", "x.pdf", "-o plan.svg"),
        ("plan", "x.html", "give a folder"),
        ("render", "x.png", "give a folder"),
    ] {
        let (code, _, err) = run(folder.path(), &[command, "-o", output]);
        assert_eq!(code, 2, "{command} {output}: {err}");
        assert!(err.contains(output) && err.contains(help), "{err}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn terminals_without_colours_get_none() {
    let coloured = |variable: &str, value: &str| {
        let folder = folder("(");
        let mut command = Command::new("script");
        let program = Command::cargo_bin("pillarforest").unwrap();
        let line = format!("{} check", program.get_program().to_string_lossy());
        command.current_dir(folder.path());
        command.env_remove("NO_COLOR").env("TERM", "xterm");
        command.env(variable, value);
        let output = command.args(["-qec", &line, "/dev/null"]).output();
        output.ok().map(|o| o.stdout.contains(&0x1b))
    };
    // Without `script` there is no terminal to try.
    if coloured("TERM", "xterm") == Some(true) {
        assert_eq!(coloured("TERM", "dumb"), Some(false));
        assert_eq!(coloured("NO_COLOR", "1"), Some(false));
    }
}

#[test]
fn models_that_nobody_sees_and_folders_that_are_not_there_are_warned_of() {
    let unseen = PLAIN.replace(
        "models: [(name: \"cube\",",
        "models: [(name: \"spare\", file: \"cube.obj\", place: Fit(height: 9)), (name: \"cube\",",
    );
    let scene = folder(&unseen);
    let (code, _, err) = run(scene.path(), &["check"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        err.contains("model \"spare\" is in no view") && err.contains("scene.ron:3:"),
        "{err}"
    );
    let scene = folder(PLAIN);
    let (code, _, err) = run(scene.path(), &["check", "--models", "nowhere"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        err.contains("\"nowhere\"") && err.contains("does not exist"),
        "{err}"
    );
    let args = ["check", "--models", "nowhere", "--deny", "warnings"];
    assert_eq!(run(scene.path(), &args).0, 1);
}

#[test]
fn more_threads_than_help_are_not_started() {
    let folder = folder(PLAIN);
    let (code, _, err) = run(folder.path(), &["check", "-j", "1000"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        err.contains("`-j 1000`") && err.contains("goes on with"),
        "{err}"
    );
    let (code, _, err) = run(folder.path(), &["check", "-j", "2"]);
    assert!(code == 0 && !err.contains("`-j"), "{err}");
}

/// Where the address space ends before the stacks of all threads have room.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_start_are_done_without() {
    let folder = folder(PLAIN);
    let line = "ulimit -v 200000; RUST_MIN_STACK=100000000 pillarforest check -j 8";
    let (code, _, err) = shell(folder.path(), line);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("the system starts no more than"), "{err}");
}

/// Loading is part of what takes time, and of what is told.
#[test]
fn loading_is_part_of_the_timings() {
    let folder = folder(PLAIN);
    let (code, _, err) = run(folder.path(), &["check", "--timings"]);
    assert_eq!(code, 0, "{err}");
    for stage in [
        "  models",
        "  scene",
        "  view maps",
        "  contested surface",
        "  in all",
    ] {
        assert!(err.contains(stage), "{stage}\n{err}");
    }
    let (_, _, err) = run(folder.path(), &["check", "--timings", "--quality", "draft"]);
    assert!(!err.contains("simplifying"), "nothing to simplify\n{err}");
    let ball = obj(&ball(DVec3::ZERO, 0.5, 40));
    fs::write(folder.path().join("cube.obj"), ball).unwrap();
    let args = ["check", "--timings", "--set", "detail=500"];
    let (_, _, err) = run(folder.path(), &args);
    assert!(err.contains("  simplifying models"), "{err}");
    let (_, _, err) = run(folder.path(), &["check", "-v"]);
    assert!(
        err.contains(" models\n") && err.contains(" view maps\n"),
        "{err}"
    );
}

fn bundled(model: &str) -> std::path::PathBuf {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/models");
    models.join(model)
}

/// With models of one's own `init` writes a scene that checks without an error, whatever lies where.
#[test]
fn init_takes_models_of_ones_own() {
    let folder = folder("");
    fs::remove_file(folder.path().join("scene.ron")).unwrap();
    let hare = bundled("hare.ply");
    let args = ["init", "cube.obj", hare.to_str().unwrap()];
    let (code, out, err) = run(folder.path(), &args);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("wrote scene.ron") && out.contains("models/hare.ply"),
        "{out}"
    );
    for part in [
        "up: \"y\", front: \"z\"",
        "up: \"z\", front: \"-y\"",
        "inspect --views cube.obj",
    ] {
        assert!(err.contains(part), "{part}\n{err}");
    }
    let scene = fs::read_to_string(folder.path().join("scene.ron")).unwrap();
    for part in [
        "pillars: Auto(",
        "file: \"cube.obj\"",
        "// Written by: pillarforest init cube.obj",
    ] {
        assert!(scene.contains(part), "{part}\n{scene}");
    }
    let (code, out, err) = run(folder.path(), &["check", "--deny", "warnings"]);
    assert_eq!(code, 0, "{out}{err}");
    // Once more is no overwriting; another scene is.
    assert_eq!(run(folder.path(), &args).0, 0);
    assert_eq!(run(folder.path(), &["init", "cube.obj"]).0, 1);
    assert_eq!(run(folder.path(), &["init", "cube.obj", "my.ron"]).0, 0);
    assert!(folder.path().join("my.ron").exists());
    assert_eq!(run(folder.path(), &["init", "a.ron", "b.ron"]).0, 2);
    let (code, _, err) = run(folder.path(), &["init", "none.obj", "gone.stl"]);
    assert_eq!(code, 1);
    assert!(
        err.contains("none.obj") && err.contains("gone.stl"),
        "{err}"
    );
}

#[test]
fn a_scene_of_ones_own_model_builds_as_it_stands() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(bundled("fish.ply"), folder.path().join("fish.ply")).unwrap();
    assert_eq!(run(folder.path(), &["init", "fish.ply"]).0, 0);
    let (code, out, err) = run(folder.path(), &["build", "--quality", "draft", "-q"]);
    assert_eq!(code, 0, "{out}{err}");
    assert!(folder.path().join("out/scene/forest.3mf").exists());
}

#[test]
fn the_sides_of_a_model_are_drawn_with_the_words_to_write() {
    let folder = folder("");
    let (code, out, err) = run(folder.path(), &["inspect", "--views", "cube.obj"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let drawn = fs::read(folder.path().join("out/cube-obj-sides.png")).unwrap();
    assert!(drawn.starts_with(b"\x89PNG"));
    assert!(out.contains("out/cube-obj-sides.png"), "{out}");
    assert_eq!(run(folder.path(), &["inspect", "--views", "none.obj"]).0, 1);
}

#[test]
fn what_builds_take_is_measured() {
    let folder = folder("");
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/paper");
    let scenes = scenes.to_str().expect("a path");
    let args = ["bench", "growth", "--most", "10000", "--json"];
    let (code, out, err) = run(folder.path(), &[&args[..], &["--scenes", scenes]].concat());
    assert_eq!(code, 0, "{err}");
    let told: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    let scaling = told["scaling"].as_array().expect("a list");
    assert_eq!(scaling.len(), 3);
    for way in scaling {
        let builds = way["builds"].as_array().expect("a list");
        assert_eq!(builds.len(), 1);
        assert_eq!(builds[0]["vertices"], 10_242.0);
        let [whole, program] = ["seconds", "program_seconds"].map(|s| builds[0][s].as_f64());
        assert!(0.0 < program.unwrap() && program < whole, "{way}");
        assert!(way["exponent"].is_null(), "of one size");
    }
    assert!(told["forest"].is_null());
    let (code, _, err) = run(folder.path(), &["bench", "growth", "--most", "5"]);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("10000"), "{err}");
    let (code, _, err) = run(folder.path(), &["bench", "stages"]);
    assert_eq!(code, 1, "{err}");
    assert!(
        err.contains("scenes/paper") && err.contains("--scenes"),
        "{err}"
    );
}
