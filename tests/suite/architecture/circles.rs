//! No circles: files and folders side by side import each other in one direction only, and so does a folder's own file (`mod.rs`, or
//! `tolerance.rs` beside `tolerance/`) and what lies in the folder.
//!
//! An import counts for the file in which a name is *defined*, through however many re-exports. A folder's own file that declares its
//! children (`mod`) or passes their names on (`pub use`) does not depend on them for that; it does if its code uses them.

use super::paths::{Contents, Path, Role, contents};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// `["scene", "text"]`.
type Module = Vec<String>;

struct Room {
    file: String,
    /// Names that a `use` brings, and from where; no name: all of them.
    imports: Vec<(Option<String>, Vec<String>)>,
    items: BTreeSet<String>,
}

/// All modules of a crate, inline ones too.
struct House {
    rooms: BTreeMap<Module, Room>,
    files: Vec<(Module, Contents)>,
    /// Modules with files of others below them.
    folders: BTreeSet<Module>,
}

/// Where a name is defined.
struct Target {
    module: Module,
    /// The name is the module itself, not something in it.
    bare: bool,
}

/// A dependency between two that lie side by side in `folder`.
struct Edge {
    folder: Module,
    from: String,
    to: String,
    /// `scene/views.rs:4 names super::checks::Eye`
    why: String,
}

impl House {
    /// Of files by their path below the crate's root, with `/`.
    fn new<'a>(sources: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let (mut rooms, mut files) = (BTreeMap::new(), Vec::new());
        let mut folders = BTreeSet::new();
        for (path, text) in sources {
            let (module, contents) = (module_of(path), contents(text));
            let inline = contents.inline.iter();
            for inside in inline.cloned().chain([Vec::new()]) {
                let imports = contents.paths.iter().filter(|p| p.inside == inside);
                let room = Room {
                    file: path.to_string(),
                    imports: imports.filter_map(import).collect(),
                    items: contents.items.clone(),
                };
                rooms.insert([module.clone(), inside].concat(), room);
            }
            folders.extend((0..module.len()).map(|n| module[..n].to_vec()));
            files.push((module, contents));
        }
        Self {
            rooms,
            files,
            folders,
        }
    }

    /// Where the names of a path that stands in module `at` are defined; several if it names a module and a function of one name.
    /// Nowhere if it leads out of the crate.
    fn targets(&self, at: &[String], path: &[String], deep: usize) -> Vec<Target> {
        let mut from = at.to_vec();
        let mut rest = path;
        match path.first().map_or("", String::as_str) {
            "crate" => (from, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {}
            first => {
                let known = self.rooms.contains_key(&joined(at, first))
                    || self.imported(at, first).next().is_some();
                if !known {
                    return Vec::new();
                }
            }
        }
        while let Some((_, after)) = rest.split_first().filter(|(s, _)| *s == "super") {
            from.pop();
            rest = after;
        }
        self.walk(from, rest, deep)
    }

    fn walk(&self, at: Module, rest: &[String], deep: usize) -> Vec<Target> {
        // An import can only lead back to itself if its name is one of another crate.
        if deep > 32 {
            return Vec::new();
        }
        let Some((name, after)) = rest.split_first() else {
            let (module, bare) = (at, true);
            return vec![Target { module, bare }];
        };
        let child = joined(&at, name);
        let is_module = self.rooms.contains_key(&child);
        let mut found = Vec::new();
        if is_module {
            found.extend(self.walk(child, after, deep + 1));
        }
        if !is_module || after.is_empty() {
            let mut imported = self.imported(&at, name).peekable();
            let known = imported.peek().is_some();
            for path in imported {
                let whole = [path, after].concat();
                found.extend(self.targets(&at, &whole, deep + 1));
            }
            if !known && !is_module {
                found.extend(self.through_globs(&at, rest, deep));
            }
            if known || !found.is_empty() {
                return found;
            }
        }
        if found.is_empty() && !is_module {
            let (module, bare) = (at, false);
            found.push(Target { module, bare });
        }
        found
    }

    fn imported<'a>(&'a self, at: &[String], name: &str) -> impl Iterator<Item = &'a [String]> {
        let imports = self.rooms.get(at).into_iter().flat_map(|r| &r.imports);
        let named = imports.filter(move |(n, _)| n.as_deref() == Some(name));
        named.map(|(_, path)| path.as_slice())
    }

    /// The name's place if a module whose names are all imported defines it.
    fn through_globs(&self, at: &[String], rest: &[String], deep: usize) -> Vec<Target> {
        let room = self.rooms.get(at);
        if room.is_none_or(|r| r.items.contains(&rest[0])) {
            return Vec::new();
        }
        let globs = room.into_iter().flat_map(|r| &r.imports);
        let globs = globs.filter(|(name, _)| name.is_none());
        let modules = globs.flat_map(|(_, path)| self.targets(at, path, deep + 1));
        let holds =
            |t: &Target| t.bare && t.module != at && self.rooms[&t.module].items.contains(&rest[0]);
        let mut holding = modules.filter(holds);
        let target = holding.next();
        target.map_or(Vec::new(), |t| self.walk(t.module, rest, deep + 1))
    }

    fn edges(&self) -> Vec<Edge> {
        let mut edges = Vec::new();
        for (module, contents) in &self.files {
            for path in &contents.paths {
                let at = [module.clone(), path.inside.clone()].concat();
                let passed_on = passed_on(path, contents);
                for target in self.targets(&at, &path.segments, 0) {
                    let Some(home) = self.home(&target.module) else {
                        continue;
                    };
                    let inner = home.len() > module.len() && home.starts_with(module);
                    // A folder named for what lies in it; all of its names are its own too.
                    let outer = target.bare && module.starts_with(&home) && !is_glob(path);
                    if !(passed_on && inner || outer) {
                        edges.extend(self.edge(module, &home, path));
                    }
                }
            }
        }
        edges
    }

    /// The module whose file holds a module.
    fn home(&self, module: &[String]) -> Option<Module> {
        self.rooms.get(module).map(|room| module_of(&room.file))
    }

    fn edge(&self, from: &Module, to: &Module, path: &Path) -> Option<Edge> {
        let [a, b] = [from, to].map(|m| self.place(m));
        let same = a.iter().zip(&b).take_while(|(a, b)| a == b).count();
        Some(Edge {
            folder: a[..same].to_vec(),
            from: a.get(same)?.clone(),
            to: b.get(same)?.clone(),
            why: format!(
                "{}:{} names {}",
                self.rooms[from].file,
                path.line,
                path.segments.join("::")
            ),
        })
    }

    /// Folders and file of a module: a folder's own file lies in the folder.
    fn place(&self, module: &Module) -> Vec<String> {
        match self.folders.contains(module) {
            true => joined(module, OWN),
            false => module.clone(),
        }
    }
}

/// What a folder's own file is called in a loop.
const OWN: &str = "mod.rs";

fn joined(module: &[String], name: &str) -> Module {
    [module, &[name.to_string()]].concat()
}

fn module_of(file: &str) -> Module {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let segments = stem.split('/').map(str::to_string);
    let mut module: Module = segments.collect();
    if matches!(module.last().map(String::as_str), Some("mod" | "lib")) {
        module.pop();
    }
    module
}

fn import(path: &Path) -> Option<(Option<String>, Vec<String>)> {
    match &path.role {
        Role::Import { name, .. } => Some((name.clone(), path.segments.clone())),
        Role::Code => None,
    }
}

fn is_glob(path: &Path) -> bool {
    matches!(path.role, Role::Import { name: None, .. })
}

/// Whether the path is a `pub use` of something that the file's own code does not name.
fn passed_on(path: &Path, contents: &Contents) -> bool {
    match &path.role {
        Role::Import { name, shared } => {
            *shared && name.as_ref().is_none_or(|n| !contents.words.contains(n))
        }
        Role::Code => false,
    }
}

/// A loop: `folder: its files and folders in the loop`, and the way round.
struct Loop {
    key: String,
    spelled: String,
}

/// Who names whom, and where.
type Graph = BTreeMap<String, BTreeMap<String, String>>;

/// All that hangs together in circles is one loop; its shortest way round is spelled out.
fn loops(house: &House) -> Vec<Loop> {
    let mut folders = BTreeMap::<Module, Graph>::new();
    for edge in house.edges() {
        let graph = folders.entry(edge.folder).or_default();
        let from = graph.entry(edge.from).or_default();
        from.entry(edge.to).or_insert(edge.why);
    }
    let mut found = Vec::new();
    for (folder, graph) in &folders {
        let mut seen = BTreeSet::new();
        for start in graph.keys() {
            let Some(round) = way(graph, start, start).filter(|_| !seen.contains(start)) else {
                continue;
            };
            let in_circle =
                |m: &&String| way(graph, start, m).is_some() && way(graph, m, start).is_some();
            let members: Vec<&String> = graph.keys().filter(in_circle).collect();
            seen.extend(members.iter().copied());
            found.push(told(folder, &members, &round, graph));
        }
    }
    found
}

/// The shortest way along edges, both ends included; never the empty one.
fn way(graph: &Graph, start: &str, end: &str) -> Option<Vec<String>> {
    let mut ways = VecDeque::from([vec![start.to_string()]]);
    let mut seen = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        let last = way.last().and_then(|last| graph.get(last));
        for next in last.into_iter().flat_map(BTreeMap::keys) {
            let longer = joined(&way, next);
            if next == end {
                return Some(longer);
            }
            if seen.insert(next.clone()) {
                ways.push_back(longer);
            }
        }
    }
    None
}

fn told(folder: &Module, members: &[&String], round: &[String], graph: &Graph) -> Loop {
    let folder = [&["src".to_string()], folder.as_slice()].concat().join("/");
    let members: Vec<&str> = members.iter().map(|m| m.as_str()).collect();
    let steps = round.windows(2).map(|step| {
        let why = &graph[&step[0]][&step[1]];
        format!("    {} -> {}: {why}", step[0], step[1])
    });
    let steps: Vec<String> = steps.collect();
    let key = format!("{folder}: {}", members.join(" "));
    Loop {
        spelled: format!("{key}\n{}", steps.join("\n")),
        key,
    }
}

/// The sources, with `added` at the end of the file at `path`.
fn house(path: &str, added: &str) -> House {
    let sources = super::sources();
    let text = |source: &super::Source| {
        let more = if source.path == path { added } else { "" };
        format!("{}\n{more}", source.lines.join("\n"))
    };
    let texts: Vec<String> = sources.iter().map(text).collect();
    let paths = sources.iter().map(|s| s.path.as_str());
    House::new(paths.zip(texts.iter().map(String::as_str)))
}

#[test]
fn files_side_by_side_import_without_loops() {
    let found = loops(&house("", ""));
    let told: Vec<&str> = found.iter().map(|l| l.spelled.as_str()).collect();
    assert!(told.is_empty(), "import loops:\n{}", told.join("\n"));
}

/// Of a folder whose file lists its modules in another order than the alphabet's: which of them name a later one.
fn out_of_order(house: &House) -> Vec<String> {
    let orders: BTreeMap<&Module, &Vec<String>> = house
        .files
        .iter()
        .map(|(module, contents)| (module, &contents.children))
        .filter(|(_, children)| !children.is_sorted())
        .collect();
    let wrong = house.edges().into_iter().filter(|edge| {
        let place = |name: &String| orders.get(&edge.folder)?.iter().position(|m| m == name);
        place(&edge.from).is_some_and(|from| place(&edge.to).is_some_and(|to| from < to))
    });
    wrong.map(|edge| edge.why).collect()
}

#[test]
fn modules_in_reading_order_name_earlier_ones() {
    let wrong = out_of_order(&house("", ""));
    assert!(
        wrong.is_empty(),
        "names a later module:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn a_loop_that_is_added_to_the_sources_is_found() {
    for (path, added, key) in [
        (
            "scene/text/spanned.rs",
            "use super::Reader;",
            "src/scene/text: reader spanned",
        ),
        (
            "scene/text/wanted.rs",
            "use super::{super::{request, views}};",
            "src/scene: ",
        ),
        (
            "scene/checks/eyes.rs",
            "fn f() { super::all() }",
            "src/scene/checks: eyes mod.rs",
        ),
    ] {
        let found = loops(&house(path, added));
        let told = found.iter().any(|l| l.key.starts_with(key));
        assert!(told, "{added} in {path}");
    }
}

#[cfg(test)]
mod rules {
    use super::{House, loops, out_of_order};

    fn found(sources: &[(&str, &str)]) -> Vec<String> {
        let loops = loops(&House::new(sources.iter().copied()));
        loops.into_iter().map(|l| l.key).collect()
    }

    #[test]
    fn a_pair_and_a_ring_are_loops_and_a_chain_is_none() {
        let pair = [
            ("f/mod.rs", "mod a; mod b;"),
            ("f/a.rs", "use super::b::B;"),
            ("f/b.rs", "use crate::f::a::A;"),
        ];
        assert_eq!(found(&pair), ["src/f: a b"]);
        let chain = [pair[0], pair[1], ("f/b.rs", "use crate::g::a::A;")];
        assert_eq!(found(&chain), [""; 0]);
        let ring = [
            ("f/mod.rs", "mod a; mod b; mod c; mod d;"),
            ("f/a.rs", "use super::b::B;"),
            ("f/b.rs", "use super::c::C;"),
            ("f/c.rs", "use super::a::A;"),
            ("f/d.rs", "use super::a::A;"),
        ];
        let loops = loops(&House::new(ring));
        assert_eq!(loops.len(), 1);
        let told = "src/f: a b c\n    a -> b: f/a.rs:1 names super::b::B\n    b -> c: f/b.rs:1 names super::c::C\n    c -> a: f/c.rs:1 names super::a::A";
        assert_eq!(loops[0].spelled, told);
    }

    #[test]
    fn an_order_that_is_not_the_alphabets_is_one_to_be_read_in() {
        let children = [("f/a.rs", "use super::b::B;"), ("f/b.rs", "")];
        let wrong =
            |own| out_of_order(&House::new([("f/mod.rs", own)].into_iter().chain(children)));
        assert_eq!(wrong("mod a; pub mod b;"), [""; 0]);
        assert_eq!(wrong("mod b; pub mod a;"), [""; 0]);
        assert_eq!(
            wrong("mod c; mod a; mod b;"),
            ["f/a.rs:1 names super::b::B"]
        );
    }

    #[test]
    fn trees_of_imports_are_read_to_their_leaves() {
        for tree in [
            "use super::b;",
            "use super::b::{self};",
            "use super::{\n    c::{C, D},\n    b::{self, B as Other},\n};",
            "pub use super::{c::*, b::*};",
            "use super::super::f::b::B;",
            "use crate::{f::{c, b::{self as other}}, g};",
            "pub(in crate::f) use self::super::b::B;",
            "fn f() { if true { super::b::f(); } }",
            "fn f(b: super::b::B) {}",
            "use crate::f; fn g() { f::b::f() }",
            "use crate::f as other; fn g() { other::b::f::<u32>() }",
            "mod tests { use super::super::b; }",
            "mod tests { mod deeper { fn f() { crate::f::b::f() } } } use super::c;",
            "fn f<'a>(x: &'a str) -> char { let y = ('\"', '\\'', b'\"'); super::b::f(\"\\\"\") }",
        ] {
            let sources = [
                ("f/mod.rs", "mod a; mod b; mod c;"),
                ("f/a.rs", tree),
                ("f/b.rs", "use super::a::A;"),
                ("f/c.rs", "pub struct C;"),
            ];
            assert_eq!(found(&sources), ["src/f: a b"], "{tree}");
        }
    }

    #[test]
    fn what_is_no_code_names_nothing() {
        for text in [
            "//! [`super::b`]\n// use super::b;",
            "/* use /* nested */ super::b; */",
            "const A: &str = \"use super::b;\";",
            "const A: &str = r#\"use super::b; \" super::b::f()\"#;",
            "fn f(b: u32) { ::b::f() }",
            "fn b() {} fn f() { b() }",
            "use ron::b::B; fn f() { ron::super_b() }",
            "mod tests { use super::b; }  pub fn b() {}",
            "fn f() -> impl Iterator<Item = u32> + use<> { x.b::<u32>() }",
        ] {
            let sources = [
                ("f/mod.rs", "mod a; mod b;"),
                ("f/a.rs", text),
                ("f/b.rs", "use super::a::A;"),
            ];
            assert_eq!(found(&sources), [""; 0], "{text}");
        }
    }

    #[test]
    fn a_name_counts_for_the_file_that_defines_it() {
        let through = [
            ("f/mod.rs", "mod a; mod b; pub use b::B; use b::C as D;"),
            ("f/a.rs", "use super::{B, D};"),
            ("f/b.rs", "pub struct B; pub struct C;"),
        ];
        assert_eq!(found(&through), [""; 0]);
        for back in [
            "use super::A;",
            "use crate::f::A;",
            "use crate::g::A;",
            "use crate::g::Again;",
        ] {
            let sources = [
                ("f/mod.rs", "mod a; mod b; pub use a::*; pub use b::B;"),
                ("f/a.rs", "use super::B; pub struct A;"),
                ("f/b.rs", back),
                ("g.rs", "pub use crate::f::A; pub use crate::f::A as Again;"),
            ];
            let found = found(&sources);
            assert!(
                found.contains(&"src/f: a b".to_string()),
                "{back}: {found:?}"
            );
        }
    }

    #[test]
    fn a_folders_own_file_is_one_of_its_files() {
        let child = ("f/a.rs", "use super::Shared;");
        let grandchild = ("f/g/deep.rs", "use crate::f::Shared;");
        let passing = "mod a; mod g; pub use a::A; pub use g::deep::G; pub struct Shared;";
        assert_eq!(found(&[("f/mod.rs", passing), child, grandchild]), [""; 0]);
        for using in [
            "mod a; use a::A; pub struct Shared;",
            "mod a; pub struct Shared; fn f() { a::f() }",
            "mod a; pub use a::A; pub struct Shared { a: A }",
            "mod a; pub struct Shared { a: self::a::A }",
        ] {
            assert_eq!(
                found(&[("f/mod.rs", using), child]),
                ["src/f: a mod.rs"],
                "{using}"
            );
            // Without anything of its own that a child names, it may use its children.
            assert_eq!(
                found(&[("f/mod.rs", using), ("f/a.rs", "use crate::g::G;")]),
                [""; 0]
            );
        }
        let deep = "mod g; pub struct Shared; fn f() { g::deep::f() }";
        assert_eq!(
            found(&[
                ("f/mod.rs", deep),
                ("f/g/mod.rs", "pub mod deep;"),
                grandchild
            ]),
            ["src/f: g mod.rs"]
        );
        // A file beside its folder is the folder's own.
        let beside = [("f.rs", "mod a; use a::A; pub struct Shared;"), child];
        assert_eq!(found(&beside), ["src/f: a mod.rs"]);
        let all = ("f/a.rs", "use super::*;");
        assert_eq!(
            found(&[("f.rs", "mod a; use a::A;"), all]),
            ["src/f: a mod.rs"]
        );
    }

    #[test]
    fn folders_side_by_side_form_loops_through_any_of_their_files() {
        let sources = [
            ("f/mod.rs", "mod g; mod h;"),
            ("f/g/mod.rs", "pub mod one; pub mod two;"),
            ("f/g/one.rs", "use crate::f::h::one::One;"),
            ("f/g/two.rs", "pub struct Two;"),
            ("f/h/mod.rs", "pub mod one; pub mod two;"),
            ("f/h/one.rs", "pub struct One;"),
            ("f/h/two.rs", "use crate::f::g::two::Two;"),
        ];
        assert_eq!(found(&sources), ["src/f: g h"]);
    }

    #[test]
    fn a_module_and_a_function_of_one_name_are_both_named() {
        let sources = [
            (
                "f/mod.rs",
                "mod a; mod depths; mod solve; pub use solve::depths;",
            ),
            ("f/a.rs", "use super::depths;"),
            ("f/depths.rs", ""),
            ("f/solve.rs", "use super::a::A;"),
        ];
        assert_eq!(found(&sources), ["src/f: a solve"]);
    }
}
