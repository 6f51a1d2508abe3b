//! Programs as plain text that any solver's user can read.

use pillarforest::mimic::Program;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes the files of one program; see the bench.
pub(crate) fn write(
    folder: &Path,
    program: &Program,
    seconds: f64,
    objective: f64,
) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let n = program.variables;
    let upper = program.quadratic.iter().map(|(v, (i, j))| (i, j, *v));
    matrix(&folder.join("P.mtx"), (n, n), upper.collect())?;
    let equalities = program.equalities.iter().map(|(terms, _)| terms);
    let lines = equalities.chain(program.rows.iter().map(|r| &r.terms));
    let entries = lines
        .enumerate()
        .flat_map(|(i, terms)| terms.iter().map(move |(j, v)| (i, *j, *v)));
    let height = program.equalities.len() + program.rows.len();
    matrix(&folder.join("A.mtx"), (height, n), entries.collect())?;
    let values = program.equalities.iter().map(|(_, value)| *value);
    let limits = program.rows.iter().map(|r| r.limit);
    let without = program.rows.iter().map(|_| f64::NEG_INFINITY);
    numbers(&folder.join("q.txt"), program.linear.iter().copied())?;
    numbers(&folder.join("l.txt"), values.clone().chain(without))?;
    numbers(&folder.join("u.txt"), values.chain(limits))?;
    let ours = format!("{{\"seconds\": {seconds}, \"objective\": {objective}}}\n");
    fs::write(folder.join("ours.json"), ours)
}

fn matrix(path: &Path, size: (usize, usize), entries: Vec<(usize, usize, f64)>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "%%MatrixMarket matrix coordinate real general")?;
    writeln!(file, "{} {} {}", size.0, size.1, entries.len())?;
    for (i, j, v) in entries {
        writeln!(file, "{} {} {v:e}", i + 1, j + 1)?;
    }
    file.flush()
}

fn numbers(path: &Path, values: impl Iterator<Item = f64>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for v in values {
        writeln!(file, "{v:e}")?;
    }
    file.flush()
}
