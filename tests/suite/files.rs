//! Which files are read and written: models only from where the user lets them come from, outputs only where they belong.

use crate::cli::{CUBE, PLAIN, folder, run, shell};
use assert_cmd::cargo::CommandCargoExt;
use std::fs;
use std::path::{Path, PathBuf};

/// A scene in `scene/`, and a cube outside of it in `elsewhere/secret.obj`.
fn apart(file: &str) -> (tempfile::TempDir, PathBuf) {
    let top = tempfile::tempdir().unwrap();
    let inside = top.path().join("scene");
    fs::create_dir(&inside).unwrap();
    fs::create_dir(top.path().join("elsewhere")).unwrap();
    fs::write(top.path().join("elsewhere/secret.obj"), CUBE).unwrap();
    let file = file.replace("TOP", top.path().to_str().unwrap());
    fs::write(inside.join("scene.ron"), PLAIN.replace("cube.obj", &file)).unwrap();
    (top, inside)
}

const OUTSIDE: [&str; 5] = [
    "../elsewhere/secret.obj",
    "TOP/elsewhere/secret.obj",
    "models/../../elsewhere/secret.obj",
    "link.obj",
    "linked/secret.obj",
];

/// A scene that names a file outside of its folder, by name or by links.
fn leading_out(file: &str) -> (tempfile::TempDir, PathBuf) {
    let (top, inside) = apart(file);
    fs::create_dir(inside.join("models")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("../elsewhere/secret.obj", inside.join("link.obj")).unwrap();
        symlink("../elsewhere", inside.join("linked")).unwrap();
    }
    (top, inside)
}

#[cfg(unix)]
#[test]
fn models_outside_of_the_scenes_folder_are_refused() {
    for file in OUTSIDE {
        let (top, inside) = leading_out(file);
        let (code, _, err) = run(&inside, &["check"]);
        assert_eq!(code, 1, "{file}: {err}");
        for part in [
            "outside the scene's folder",
            "--models DIR",
            "--allow-outside",
            "scene.ron:3:",
        ] {
            assert!(err.contains(part), "{file}: `{part}` wanted\n{err}");
        }
        // The same from elsewhere, by a longer path.
        let (code, _, err) = run(top.path(), &["check", "scene/scene.ron"]);
        assert!(
            code == 1 && err.contains("outside the scene's folder"),
            "{err}"
        );
    }
}

#[cfg(unix)]
#[test]
fn models_outside_are_read_if_the_user_says_so() {
    for file in OUTSIDE {
        let (_top, inside) = leading_out(file);
        let (code, _, err) = run(&inside, &["check", "--allow-outside"]);
        assert_eq!(code, 0, "{file}: {err}");
        let (code, _, err) = run(&inside, &["check", "--models", "../elsewhere"]);
        assert_eq!(code, i32::from(file == "link.obj"), "{file}: {err}");
    }
    let (_top, inside) = apart("/dev/zero");
    let (code, _, err) = run(&inside, &["check", "--allow-outside"]);
    assert!(code == 1 && err.contains("not a regular file"), "{err}");
}

#[cfg(unix)]
#[test]
fn no_message_tells_what_lies_outside() {
    for file in [
        "../elsewhere/none.obj",
        "TOP/elsewhere/none.obj",
        "linked/secrets.obj",
    ] {
        let (_top, inside) = leading_out(file);
        let (code, _, err) = run(&inside, &["check"]);
        assert!(code == 1 && !err.contains("secret.obj"), "{file}: {err}");
    }
}

#[cfg(unix)]
#[test]
fn paths_and_links_that_stay_inside_are_fine() {
    use std::os::unix::fs::symlink;
    for file in ["models/../cube.obj", "./cube.obj", "models/link.obj"] {
        let (top, inside) = apart(file);
        fs::create_dir(inside.join("models")).unwrap();
        fs::write(inside.join("cube.obj"), CUBE).unwrap();
        symlink("../cube.obj", inside.join("models/link.obj")).unwrap();
        let (code, _, err) = run(&inside, &["check"]);
        assert_eq!(code, 0, "{file}: {err}");
        // The scene's folder may itself be reached by a link.
        symlink("scene", top.path().join("way")).unwrap();
        let (code, _, err) = run(top.path(), &["check", "way/scene.ron"]);
        assert_eq!(code, 0, "{file}: {err}");
    }
}

/// All files below a folder with their bytes, by path; links as their targets' names.
fn tree(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_symlink() {
                let target = fs::read_link(&path).unwrap();
                found.push((path, target.to_string_lossy().as_bytes().to_vec()));
            } else if path.is_dir() {
                folders.push(path);
            } else {
                found.push((path.clone(), fs::read(path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

/// A plan is the quickest output.
const PLAN: [&str; 2] = ["plan.png", "plan.svg"];

#[test]
fn nothing_is_written_outside_of_the_output_folder() {
    let folder = folder(PLAIN);
    let before = tree(folder.path());
    let (code, _, err) = run(folder.path(), &["view", "-o", "a/b"]);
    assert_eq!(code, 0, "{err}");
    let after = tree(folder.path());
    let fresh: Vec<_> = after.iter().filter(|f| !before.contains(f)).collect();
    let names: Vec<_> = fresh
        .iter()
        .map(|f| f.0.strip_prefix(folder.path()).unwrap())
        .collect();
    assert_eq!(names, PLAN.map(|n| Path::new("a/b").join(n)));
    assert_eq!(after.len(), before.len() + fresh.len());
}

#[test]
fn a_scene_named_by_dots_alone_does_not_write_to_the_folder_above() {
    let folder = folder("");
    fs::write(folder.path().join("...ron"), PLAIN).unwrap();
    let (code, out, err) = run(folder.path(), &["view", "...ron"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("out/scene") && folder.path().join("out/scene/plan.svg").exists(),
        "{out}"
    );
}

#[test]
fn view_names_that_are_paths_are_refused() {
    for name in ["../up", "/tmp/up", "a/b", "..", ".", "a\\\\b"] {
        let folder = folder(&PLAIN.replace("\"front\"", &format!("\"{name}\"")));
        let before = tree(folder.path());
        let (code, _, err) = run(folder.path(), &["render", "-o", "pictures"]);
        assert_eq!(code, 1, "{name}");
        assert!(err.contains("scene.ron:5:"), "{name}: {err}");
        assert_eq!(tree(folder.path()), before, "{name}");
    }
}

#[cfg(unix)]
#[test]
fn links_in_the_output_folder_are_not_followed() {
    use std::os::unix::fs::symlink;
    let folder = folder(PLAIN);
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("precious")).unwrap();
    fs::write(at("precious/kept.svg"), "mine").unwrap();
    fs::create_dir(at("made")).unwrap();
    symlink("../precious/kept.svg", at("made/plan.svg")).unwrap();
    let (code, _, err) = run(folder.path(), &["view", "-o", "made"]);
    assert_eq!(code, 0, "{err}");
    assert_eq!(fs::read_to_string(at("precious/kept.svg")).unwrap(), "mine");
    assert!(!at("made/plan.svg").is_symlink());
    // One file by name as well.
    symlink("precious/kept.svg", at("one.svg")).unwrap();
    assert_eq!(run(folder.path(), &["view", "-o", "one.svg"]).0, 0);
    assert_eq!(fs::read_to_string(at("precious/kept.svg")).unwrap(), "mine");
}

/// A scene quick to render: one little view.
const QUICK: &str = "(
    models: [(name: \"cube\", file: \"cube.obj\", place: Fit(height: 10, at: (0, 0, 4)))],
    views: [(name: \"front\", eye: (0, -150, 10), models: [\"cube\"])],
    pillars: [(shape: Round(radius: 6, facets: 16), height: 20, places: At([(0, 0)]))],
    output: (picture_size: 64),
)";

#[cfg(unix)]
#[test]
fn linked_folders_in_the_output_folder_are_refused() {
    use std::os::unix::fs::symlink;
    let folder = folder(QUICK);
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("precious")).unwrap();
    fs::create_dir(at("made")).unwrap();
    symlink("../precious", at("made/views")).unwrap();
    let before = tree(folder.path());
    let (code, _, err) = run(folder.path(), &["render", "-o", "made"]);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("views\" is a link"), "{err}");
    assert_eq!(tree(folder.path()), before);
    fs::remove_file(at("made/views")).unwrap();
    let (code, _, err) = run(folder.path(), &["render", "-o", "made"]);
    assert_eq!(code, 0, "{err}");
    assert!(at("made/views/front.png").exists());
}

/// How many hidden entries a folder has.
fn hidden(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).unwrap().flatten();
    entries
        .filter(|e| e.file_name().to_string_lossy().starts_with('.'))
        .count()
}

#[cfg(unix)]
#[test]
fn what_is_in_the_way_of_outputs_is_told_before_the_work() {
    use std::os::unix::fs::symlink;
    type Prepared = fn(&Path);
    let cases: [(&str, &str, Prepared, &str); 6] = [
        (
            "render",
            "made",
            |f| fs::write(f.join("made/views"), "mine").unwrap(),
            "made/views",
        ),
        (
            "view",
            "made",
            |f| fs::create_dir(f.join("made/plan.svg")).unwrap(),
            "made/plan.svg",
        ),
        (
            "build",
            "made",
            |f| fs::create_dir(f.join("made/report.json")).unwrap(),
            "made/report.json",
        ),
        (
            "view",
            "loose",
            |f| symlink("nowhere", f.join("loose")).unwrap(),
            "leads nowhere",
        ),
        (
            "view",
            "loose/a",
            |f| symlink("nowhere", f.join("loose")).unwrap(),
            "leads nowhere",
        ),
        ("view", "/proc/made", |_| (), "/proc"),
    ];
    for (command, output, prepare, said) in cases {
        let folder = folder(QUICK);
        fs::create_dir(folder.path().join("made")).unwrap();
        prepare(folder.path());
        let before = tree(folder.path());
        let (code, out, err) = run(folder.path(), &[command, "-v", "-o", output]);
        assert_eq!(code, 2, "{output}: {err}");
        assert!(err.contains(said), "{output}: {err}");
        // No stage of the pipeline has run.
        assert!(
            !err.contains("view maps") && !err.contains(" plan\n"),
            "{err}"
        );
        assert_eq!(out, "");
        assert_eq!(tree(folder.path()), before, "{output}");
    }
}

/// What a build may write is known before it.
#[test]
fn all_files_of_a_build_are_foreseen() {
    use pillarforest::{compile, scene};
    let everything = QUICK.replace(
        "output: (",
        "output: (surface: true, groups: true, turntable: true, split: true, ",
    );
    let folder = folder(&everything);
    let read = |_: &str| Ok(CUBE.as_bytes().to_vec());
    let scene = scene::resolve(&everything, &read).unwrap().value;
    for (command, mut foreseen) in [
        ("build", compile::build_names(&scene)),
        ("view", compile::plan_names(&scene)),
        ("render", compile::picture_names(&scene)),
    ] {
        let (code, _, err) = run(folder.path(), &[command, "-o", command]);
        assert!(code == 0 || code == 3, "{err}");
        if code == 3 {
            run(folder.path(), &[command, "--force", "-o", command]);
        }
        let made = folder.path().join(command);
        let written: Vec<String> = tree(&made)
            .iter()
            .map(|(path, _)| {
                path.strip_prefix(&made)
                    .unwrap()
                    .to_str()
                    .unwrap()
                    .to_string()
            })
            .collect();
        let pieces: Vec<_> = foreseen.extract_if(.., |n| n.ends_with('/')).collect();
        let others = written
            .iter()
            .filter(|w| pieces.iter().all(|p| !w.starts_with(p.as_str())));
        let others: Vec<&String> = others.collect();
        foreseen.sort();
        let mut found = others.clone();
        found.sort();
        assert_eq!(found, foreseen.iter().collect::<Vec<_>>(), "{command}");
    }
}

/// A file beyond the limit of sizes ends a run as a full disk does.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_what_was_there_and_names_the_file() {
    let folder = folder(PLAIN);
    let made = folder.path().join("made");
    let line = "ulimit -f 4; pillarforest view -o made";
    let (code, out, err) = shell(folder.path(), line);
    assert_eq!((code, out.as_str()), (4, ""), "{err}");
    assert!(
        err.contains("cannot write \"made/plan.") && err.contains("Nothing was written"),
        "{err}"
    );
    assert!(!made.exists());
    fs::create_dir(&made).unwrap();
    fs::write(made.join("plan.svg"), "old").unwrap();
    fs::write(made.join("mine.txt"), "mine").unwrap();
    let before = tree(folder.path());
    assert_eq!(shell(folder.path(), line).0, 4);
    assert_eq!(tree(folder.path()), before);
    assert_eq!(hidden(&made), 0);
}

/// A run that is ended at any moment leaves the old files or the new ones.
#[cfg(unix)]
#[test]
fn signals_leave_the_old_files_or_the_new_ones() {
    let folder = folder(PLAIN);
    let made = folder.path().join("made");
    assert_eq!(run(folder.path(), &["view", "-o", "made"]).0, 0);
    let new = tree(&made);
    let start = std::time::Instant::now();
    assert_eq!(run(folder.path(), &["view", "-o", "made"]).0, 0);
    let whole = start.elapsed();
    let (mut olds, mut news) = (0, 0);
    for step in 0..24 {
        for file in PLAN {
            fs::write(made.join(file), "old").unwrap();
        }
        let old = tree(&made);
        let mut child = std::process::Command::cargo_bin("pillarforest").unwrap();
        child
            .current_dir(folder.path())
            .args(["view", "-q", "-o", "made"]);
        child.stdout(std::process::Stdio::null());
        let mut child = child.spawn().unwrap();
        // From half of a run's time to a little after its end.
        std::thread::sleep(whole * (12 + step) / 28);
        let signal = ["TERM", "INT"][step as usize % 2];
        let kill = format!("kill -{signal} {}", child.id());
        let _ = std::process::Command::new("sh")
            .args(["-c", &kill])
            .output();
        child.wait().unwrap();
        let found = tree(&made);
        assert!(found == old || found == new, "a mixture at step {step}");
        assert_eq!(hidden(&made), 0, "step {step}");
        olds += usize::from(found == old);
        news += usize::from(found == new);
    }
    assert_eq!(olds + news, 24);
}

/// What a killed run left is finished if it was complete, and removed if not.
#[cfg(target_os = "linux")]
#[test]
fn the_next_run_tidies_after_one_that_was_killed() {
    let folder = folder(PLAIN);
    let made = folder.path().join("made");
    let at = |name: &str| made.join(name);
    fs::create_dir_all(at(".pillarforest-half/making/views")).unwrap();
    fs::write(at(".pillarforest-half/making/views/front.png"), "half").unwrap();
    fs::create_dir_all(at(".pillarforest-ready/ready/views")).unwrap();
    fs::write(at(".pillarforest-ready/ready/views/front.png"), "whole").unwrap();
    fs::create_dir_all(at(".pillarforest-ready/replaced")).unwrap();
    fs::write(at(".pillarforest-ready/replaced/report.json"), "old").unwrap();
    fs::write(at("report.json"), "new").unwrap();
    // One whose run lives.
    fs::create_dir_all(at(".pillarforest-alive/making")).unwrap();
    let alive = fs::File::open(at(".pillarforest-alive")).unwrap();
    alive.try_lock().unwrap();
    let (code, _, err) = run(folder.path(), &["view", "-o", "made"]);
    assert_eq!(code, 0, "{err}");
    let text = |name: &str| fs::read_to_string(at(name)).unwrap();
    assert_eq!(text("views/front.png"), "whole");
    assert_eq!(text("report.json"), "new");
    assert_eq!(hidden(&made), 1);
    drop(alive);
    assert_eq!(run(folder.path(), &["view", "-o", "made"]).0, 0);
    assert_eq!(hidden(&made), 0);
}
