//! Runs targets on kept inputs and on mutants of them.
//!
//! No instrumented build is needed: what a target answers, its messages without their numbers, stands for the way it took through the
//! program. An input with a new answer joins those that mutants are made of. `tests/fuzz` has the same targets for libFuzzer, which
//! sees every branch and takes a build of its own.

use super::mutate::mutant;
use super::targets::Target;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::any::Any;
use std::collections::HashSet;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Seek, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::str::FromStr;
use std::time::{Duration, Instant, SystemTime};

/// An input of some kilobytes that takes longer hangs, seconds.
const HANGS: u64 = 10;
/// What a process may ask of the system, kilobytes: inputs are small, and no picture is made.
#[cfg(unix)]
const MOST_MEMORY: u32 = 4 << 20;
/// Inputs that mutants are made of, at most: with more of them the kept ones get too few.
const POOL: usize = 4096;

/// An input that broke a promise, and how.
pub(super) struct Failure {
    path: PathBuf,
    why: String,
}

pub(super) fn told(failures: &[Failure]) -> String {
    let one = |f: &Failure| format!("{}: {}\n", f.path.display(), f.why);
    let list: String = failures.iter().map(one).collect();
    format!(
        "{list}These inputs are in the corpus now; see them again with\n    \
         cargo test --release --test suite fuzz::kept\nand keep them, with the fix."
    )
}

/// A number that the surroundings give.
pub(crate) fn asked<T: FromStr>(name: &str) -> Option<T> {
    let text = std::env::var(name).ok()?;
    let number = text.parse().ok();
    assert!(
        number.is_some(),
        "{name}: a whole number was wanted, not {text}"
    );
    number
}

pub(super) fn random_seed() -> u64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(1, |d| d.as_nanos() as u64)
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder(target: &Target) -> PathBuf {
    root().join("tests/corpus").join(target.name)
}

/// Kept inputs, by name.
fn kept(target: &Target) -> Vec<(PathBuf, Vec<u8>)> {
    let mut inputs = files(&folder(target));
    if let Some(of_case) = target.of_case {
        let cases = files(&root().join("tests/cases"));
        inputs.extend(cases.into_iter().map(|(path, text)| (path, of_case(&text))));
    }
    inputs
}

/// All files of a folder, by name.
pub(crate) fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
    paths.sort();
    let read = |p: PathBuf| {
        let bytes = fs::read(&p).expect("a file");
        (p, bytes)
    };
    paths.into_iter().map(read).collect()
}

fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string))
        .unwrap_or_default()
}

pub(super) fn replayed(target: &Target) -> Vec<Failure> {
    let inputs = kept(target);
    assert!(!inputs.is_empty(), "no kept inputs for {}", target.name);
    let failed = |(path, bytes): (PathBuf, Vec<u8>)| {
        let begun = Instant::now();
        let run = catch_unwind(AssertUnwindSafe(|| (target.run)(&bytes)));
        let why = match run {
            Err(panic) => said(&*panic),
            Ok(_) if begun.elapsed() > Duration::from_secs(HANGS) => {
                format!("took {:?}", begun.elapsed())
            }
            Ok(_) => return None,
        };
        Some(Failure { path, why })
    };
    inputs.into_iter().filter_map(failed).collect()
}

/// One target for some seconds, in a process of its own. What it failed on is in the corpus afterwards.
pub(super) fn fuzzed(target: &Target, seed: u64, seconds: u64) -> Option<Failure> {
    let scratch = tempfile::tempdir().expect("a folder");
    let at = scratch.path().join("input");
    let mut process = alone()
        .env("FUZZ_TARGET", target.name)
        .env("FUZZ_SEED", seed.to_string())
        .env("FUZZ_SECONDS", seconds.to_string())
        .env("FUZZ_INPUT", &at)
        .stderr(fs::File::create(scratch.path().join("said")).expect("a file"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("this program once more");
    let end = ended(&mut process, &at);
    let said = fs::read(scratch.path().join("said")).unwrap_or_default();
    let said = String::from_utf8_lossy(&said);
    let said: String = said.trim().chars().take(2000).collect();
    println!("{}, FUZZ_SEED={seed}, {seconds} s: {said}", target.name);
    let why = match end {
        Some(status) if status.success() => return None,
        Some(status) => format!("{status}: {said}"),
        None => format!("took more than {HANGS} s"),
    };
    let bytes = fs::read(&at).unwrap_or_default();
    let path = folder(target).join(format!("crash-{:016x}", hash(&bytes)));
    fs::write(&path, bytes).expect("a kept input");
    Some(Failure { path, why })
}

/// This program, to run one target.
fn alone() -> Command {
    let this = std::env::current_exe().expect("this program");
    #[cfg(unix)]
    let mut command = {
        let mut shell = Command::new("sh");
        shell
            .args([
                "-c",
                &format!("ulimit -v {MOST_MEMORY}; exec \"$0\" \"$@\""),
            ])
            .arg(this);
        shell
    };
    #[cfg(not(unix))]
    let mut command = Command::new(this);
    command.args(["fuzz::one_target_alone", "--exact", "--nocapture"]);
    command
}

/// How the process ended; `None`: it hung at one input and was stopped.
fn ended(process: &mut Child, input: &Path) -> Option<ExitStatus> {
    let mut changed = (None, Instant::now());
    loop {
        if let Some(status) = process.try_wait().expect("a process of ours") {
            return Some(status);
        }
        let time = fs::metadata(input).and_then(|m| m.modified()).ok();
        if time != changed.0 {
            changed = (time, Instant::now());
        }
        if changed.1.elapsed() > Duration::from_secs(HANGS) {
            process.kill().expect("a process of ours");
            process.wait().expect("a process of ours");
            return None;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// The other side of `fuzzed`: a panic ends it, and the input is where `FUZZ_INPUT` says.
pub(super) fn run_if_asked(targets: &[Target]) {
    let (Ok(name), Some(input)) = (std::env::var("FUZZ_TARGET"), std::env::var_os("FUZZ_INPUT"))
    else {
        return;
    };
    let target = targets
        .iter()
        .find(|t| t.name == name)
        .expect("a target of this name");
    let seconds = asked("FUZZ_SECONDS").unwrap_or(1);
    let mut rng = Pcg64Mcg::seed_from_u64(asked("FUZZ_SEED").unwrap_or(1));
    let mut pool: Vec<Vec<u8>> = kept(target).into_iter().map(|(_, bytes)| bytes).collect();
    let mut input = fs::File::create(input).expect("the place for inputs");
    let mut answered = |bytes: &[u8]| {
        note(&mut input, bytes).expect("the place for inputs");
        answer(target, bytes)
    };
    let mut answers: HashSet<u64> = pool.iter().map(|bytes| answered(bytes)).collect();
    let (begun, own, mut tried) = (Instant::now(), pool.len(), 0u64);
    while begun.elapsed() < Duration::from_secs(seconds) {
        let bytes = mutant(&mut rng, &pool);
        tried += 1;
        if answers.insert(answered(&bytes)) {
            if pool.len() < POOL {
                pool.push(bytes);
            } else {
                let place = rng.random_range(own..POOL);
                pool[place] = bytes;
            }
        }
    }
    eprintln!("{tried} inputs, {} different answers", answers.len());
}

/// Leaves an input where the other process finds it. (To make the file anew would wait for the disk every time.)
fn note(file: &mut fs::File, bytes: &[u8]) -> io::Result<()> {
    file.set_len(bytes.len() as u64)?;
    file.rewind()?;
    file.write_all(bytes)
}

/// What a target answers, without what is between quotes and without numbers.
fn answer(target: &Target, bytes: &[u8]) -> u64 {
    let (mut text, mut quote) = (String::new(), None);
    for c in (target.run)(bytes).chars() {
        match quote {
            Some(q) if c == q || c == '\n' => quote = None,
            Some(_) => {}
            None if c == '"' || c == '`' => quote = Some(c),
            None if c.is_ascii_digit() => {}
            None => text.push(c),
        }
    }
    hash(text.as_bytes())
}

pub(crate) fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish()
}
