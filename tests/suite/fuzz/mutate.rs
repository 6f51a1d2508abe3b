//! New inputs from kept ones: for bytes and for texts alike, as files of either kind have both.

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};
use std::ops::Range;

/// Longest input, bytes: larger ones only take longer.
const LONGEST: usize = 16 << 10;

/// Numbers at which readers break.
const NUMBERS: [&str; 20] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "256",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551616",
    "0.1",
    "1e-30",
    "1e15",
    "1e39",
    "-1e308",
    "nan",
    "inf",
];

/// The same in binary files.
const WORDS: [u32; 12] = [
    0,
    1,
    2,
    255,
    65536,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_fffe,
    0xffff_ffff,
    0x7f80_0000,
    0x7fc0_0000,
    0x0000_0001,
];

/// One of `inputs`, changed in one to eight ways.
pub(super) fn mutant(rng: &mut impl Rng, inputs: &[Vec<u8>]) -> Vec<u8> {
    let one = |rng: &mut _| inputs.choose(rng).cloned().unwrap_or_default();
    let mut bytes = one(rng);
    for _ in 0..1 << rng.random_range(0..4) {
        change(rng, &mut bytes, &one);
        bytes.truncate(LONGEST);
    }
    bytes
}

fn change<R: Rng>(rng: &mut R, bytes: &mut Vec<u8>, other: &impl Fn(&mut R) -> Vec<u8>) {
    match rng.random_range(0..11) {
        0 => {
            if let Some(at) = place(rng, bytes) {
                bytes[at] ^= 1 << rng.random_range(0..8);
            }
        }
        1 => {
            if let Some(at) = place(rng, bytes) {
                bytes[at] = rng.random();
            }
        }
        2 => {
            let word = WORDS.choose(rng).copied().unwrap_or_default();
            let word = if rng.random() {
                word.to_le_bytes()
            } else {
                word.to_be_bytes()
            };
            let at = place(rng, bytes).unwrap_or(0);
            let end = (at + 4).min(bytes.len());
            bytes.splice(at..end, word);
        }
        3 | 4 => {
            let at = number(rng, bytes);
            let number = NUMBERS.choose(rng).copied().unwrap_or_default();
            bytes.splice(at, number.bytes());
        }
        5 => {
            let gone = some(rng, bytes);
            bytes.drain(gone);
        }
        6 => {
            let copied = some(rng, bytes);
            let copied = bytes[copied].to_vec();
            insert(rng, bytes, copied);
        }
        7 => {
            let other = other(rng);
            let part = some(rng, &other);
            insert(rng, bytes, other[part].to_vec());
        }
        8 => {
            let (one, two) = (line(rng, bytes), line(rng, bytes));
            let copied = bytes[one].to_vec();
            bytes.splice(two, copied);
        }
        9 => {
            let gone = line(rng, bytes);
            bytes.drain(gone);
        }
        _ => {
            let length = place(rng, bytes).unwrap_or(0);
            bytes.truncate(length);
        }
    }
}

fn place(rng: &mut impl Rng, bytes: &[u8]) -> Option<usize> {
    (!bytes.is_empty()).then(|| rng.random_range(0..bytes.len()))
}

fn insert(rng: &mut impl Rng, bytes: &mut Vec<u8>, part: Vec<u8>) {
    let at = rng.random_range(0..=bytes.len());
    bytes.splice(at..at, part);
}

/// Some bytes, mostly few.
fn some(rng: &mut impl Rng, bytes: &[u8]) -> Range<usize> {
    let start = place(rng, bytes).unwrap_or(0);
    let most = 1 << rng.random_range(0..10);
    let length = rng.random_range(0..=most);
    start..(start + length).min(bytes.len())
}

/// The word of digits and the like at or behind some place; empty if there is none.
fn number(rng: &mut impl Rng, bytes: &[u8]) -> Range<usize> {
    let of_number = |b: &u8| b.is_ascii_digit() || b"+-.".contains(b);
    let from = place(rng, bytes).unwrap_or(0);
    let start = from + bytes[from..].iter().take_while(|b| !of_number(b)).count();
    let length = bytes[start..].iter().take_while(|b| of_number(b)).count();
    start..start + length
}

/// The line at some place, with its end.
fn line(rng: &mut impl Rng, bytes: &[u8]) -> Range<usize> {
    let at = place(rng, bytes).unwrap_or(0);
    let end = |b: &u8| *b == b'\n';
    let start = bytes[..at].iter().rposition(end).map_or(0, |e| e + 1);
    let length = bytes[start..]
        .iter()
        .position(end)
        .map_or(bytes.len() - start, |e| e + 1);
    start..start + length
}
