//! What may name what: the order of the modules, no circles among files, the crates each module owns, and what the library keeps its
//! hands off.

mod circles;
mod paths;

use std::fs;
use std::path::{Path, PathBuf};

/// Crates that only the listed files or folders of `src` may name.
const OWNERS: [(&str, &[&str]); 17] = [
    ("alum", &["mesh/simplify.rs"]),
    ("obvhs", &["bvh.rs"]),
    ("spade", &["viewmap/arrange.rs"]),
    ("clarabel", &["mimic/solve.rs"]),
    ("faer", &["mimic/factor.rs"]),
    ("manifold_rust", &["carve/boolean.rs"]),
    ("i_overlay", &["geom/rings.rs"]),
    ("tobj", &["formats/read_obj.rs"]),
    ("zip", &["formats/"]),
    ("quick_xml", &["formats/"]),
    ("gltf_json", &["formats/"]),
    ("clap", &["cli/"]),
    ("signal_hook", &["cli/signals.rs"]),
    ("exmex", &["scene/supports/bodies/heights.rs"]),
    ("png", &["scene/supports/bodies/image.rs"]),
    ("rand", &["planner/"]),
    ("rand_pcg", &["planner/"]),
];

/// What belongs to the binary: terminal, files, clock, surroundings.
const BINARY_ONLY: [&str; 12] = [
    "println!",
    "print!",
    "dbg!",
    "std::fs",
    "File::open",
    "std::env::",
    "env::var",
    "Instant",
    "SystemTime",
    "std::process",
    "stdout",
    "stderr",
];

pub(crate) struct Source {
    /// Relative to `src`, with `/`.
    pub(crate) path: String,
    /// Without comments; lines as in the file.
    code: Vec<String>,
    pub(crate) lines: Vec<String>,
}

impl Source {
    /// The module at the top of the library that the file belongs to.
    fn module(&self) -> &str {
        self.path.split(['/', '.']).next().unwrap()
    }

    fn is_binary(&self) -> bool {
        matches!(self.module(), "main" | "cli")
    }

    /// `(path:line, line)` of all code lines.
    fn located(&self) -> impl Iterator<Item = (String, &str)> {
        let place = |i: usize| format!("src/{}:{}", self.path, i + 1);
        self.code
            .iter()
            .enumerate()
            .map(move |(i, line)| (place(i), line.as_str()))
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All files of `src`, sorted.
pub(crate) fn sources() -> Vec<Source> {
    let (root, mut folders, mut paths) = (root(), vec![root()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    let source = |path: &PathBuf| {
        let text = fs::read_to_string(path).unwrap();
        let relative = path.strip_prefix(&root).unwrap().to_str().unwrap();
        Source {
            path: relative.replace('\\', "/"),
            code: text.lines().map(without_comment).collect(),
            lines: text.lines().map(str::to_owned).collect(),
        }
    };
    paths.iter().map(source).collect()
}

/// Cut at `//` outside of a string.
fn without_comment(line: &str) -> String {
    let (mut quoted, mut escaped, mut last) = (false, false, ' ');
    for (i, c) in line.char_indices() {
        match c {
            '"' if !escaped && last != '\'' => quoted = !quoted,
            '/' if last == '/' && !quoted => return line[..i - 1].to_owned(),
            _ => {}
        }
        escaped = c == '\\' && !escaped;
        last = c;
    }
    line.to_owned()
}

/// Modules in the order of the library's root.
fn order() -> Vec<String> {
    let text = fs::read_to_string(root().join("lib.rs")).unwrap();
    let name = |line: &str| {
        Some(
            line.trim()
                .strip_prefix("pub mod ")?
                .strip_suffix(';')?
                .to_owned(),
        )
    };
    text.lines().filter_map(name).collect()
}

/// Whether `word` stands in `line` as a whole path segment or macro, not as part of a longer name.
fn names(line: &str, word: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).any(|(i, _)| {
        let before = line[..i].chars().next_back();
        let after = line[i + word.len()..].chars().next();
        !before.is_some_and(part_of_name)
            && (!word.ends_with(char::is_alphanumeric) || !after.is_some_and(part_of_name))
    })
}

fn assert_none(wrong: Vec<String>, rule: &str) {
    assert!(wrong.is_empty(), "{rule}:\n{}", wrong.join("\n"));
}

#[test]
fn a_module_names_only_earlier_modules() {
    let order = order();
    let rank = |module: &str| order.iter().position(|m| m == module);
    let mut wrong = Vec::new();
    for source in sources()
        .iter()
        .filter(|s| !s.is_binary() && s.path != "lib.rs")
    {
        let own = rank(source.module())
            .unwrap_or_else(|| panic!("src/{} is no module of lib.rs", source.path));
        for (place, line) in source.located() {
            for rest in line.split("crate::").skip(1) {
                let end = rest
                    .find(|c: char| !c.is_alphanumeric() && c != '_')
                    .unwrap_or(rest.len());
                if rank(&rest[..end]).is_none_or(|r| r > own) {
                    wrong.push(format!("{place}: {}", line.trim()));
                }
            }
        }
    }
    assert_none(
        wrong,
        "names a module that lib.rs lists later, or several at once",
    );
}

#[test]
fn the_binary_names_the_library_and_its_own_parts() {
    for source in sources() {
        for (place, line) in source.located() {
            let allowed = source.is_binary() || !names(line, "pillarforest::");
            assert!(allowed, "{place}: the library names itself from outside");
            assert!(
                !(source.is_binary() && names(line, "crate::")),
                "{place}: the binary has no modules to share"
            );
        }
    }
}

#[test]
fn every_foreign_crate_has_its_place() {
    let mut wrong = Vec::new();
    for source in sources() {
        for (place, line) in source.located() {
            let foreign = OWNERS.iter().filter(|(name, owners)| {
                names(line, &format!("{name}::"))
                    && !owners.iter().any(|o| source.path.starts_with(o))
            });
            wrong.extend(
                foreign.map(|(name, owners)| format!("{place}: {name}, not in {owners:?}")),
            );
        }
    }
    assert_none(wrong, "a crate named outside its place");
}

#[test]
fn every_owner_still_names_its_crate() {
    let sources = sources();
    for (name, owners) in OWNERS {
        let used = |s: &&Source| {
            owners.iter().any(|o| s.path.starts_with(o))
                && s.code.iter().any(|l| names(l, &format!("{name}::")))
        };
        assert!(sources.iter().any(|s| used(&s)), "{name} is not used");
    }
}

#[test]
fn no_hash_order_reaches_a_result() {
    let mut wrong = Vec::new();
    for source in sources() {
        for (i, (place, line)) in source.located().enumerate() {
            let hashed = ["HashMap", "HashSet"].iter().any(|w| names(line, w));
            let explained = i > 0 && source.lines[i - 1].contains("never iterated");
            if hashed && !line.starts_with("use ") && !explained {
                wrong.push(format!("{place}: {}", line.trim()));
            }
        }
    }
    assert_none(
        wrong,
        "a hash table without the comment \"never iterated\" above it",
    );
}

#[test]
fn the_library_leaves_files_clock_and_terminal_alone() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|s| !s.is_binary()) {
        for (place, line) in source.located() {
            let outward = BINARY_ONLY
                .iter()
                .chain(&["eprintln!", "eprint!"])
                .any(|w| names(line, w));
            if outward {
                wrong.push(format!("{place}: {}", line.trim()));
            }
        }
    }
    assert_none(wrong, "belongs to the binary");
}

/// They panic where standard output or error is closed or full.
#[test]
fn nobody_prints_with_macros_that_panic() {
    let mut wrong = Vec::new();
    for source in sources() {
        for (place, line) in source.located() {
            let macros = ["println!", "print!", "eprintln!", "eprint!"];
            if macros.iter().any(|w| names(line, w)) {
                wrong.push(format!("{place}: {}", line.trim()));
            }
        }
    }
    assert_none(wrong, "prints by `say` or `tell` of the binary");
}

#[test]
fn nothing_is_left_unfinished() {
    let words = ["todo!", "unimplemented!", "TODO", "FIXME", "XXX"];
    let mut wrong = Vec::new();
    for source in sources() {
        for (i, line) in source.lines.iter().enumerate() {
            if words.iter().any(|w| names(line, w)) {
                wrong.push(format!("src/{}:{}: {}", source.path, i + 1, line.trim()));
            }
        }
    }
    assert_none(wrong, "unfinished");
}

#[test]
fn unsafe_code_is_forbidden() {
    for file in ["lib.rs", "main.rs"] {
        let text = fs::read_to_string(root().join(file)).unwrap();
        assert!(text.contains("#![forbid(unsafe_code)]"), "{file}");
    }
}
