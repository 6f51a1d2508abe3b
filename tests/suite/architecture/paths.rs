//! What a source file names, read as text.
//!
//! Takes the text of a file. Gives its `use` trees spread out into single imports, the paths in its code, its inline modules and the
//! words of its code. Comments and literals name nothing. Macros are read as they are written, not as they expand.

use std::collections::BTreeSet;

/// A path somewhere in a file.
#[derive(Debug)]
pub(crate) struct Path {
    /// The inline modules it stands in, outermost first.
    pub inside: Vec<String>,
    /// `["super", "reader", "Span"]`; a path from the extern prelude (`::ron`) begins with an empty segment.
    pub segments: Vec<String>,
    pub role: Role,
    /// From 1.
    pub line: usize,
}

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// `use`, under the path's last name or the one behind `as`; `None`: all that the path holds (`*`). `shared`: others may import
    /// it from here (`pub use`).
    Import {
        name: Option<String>,
        shared: bool,
    },
    Code,
}

#[derive(Debug, Default)]
pub(crate) struct Contents {
    pub paths: Vec<Path>,
    /// Inline modules, each with those it stands in before it.
    pub inline: Vec<Vec<String>>,
    /// Modules that have files of their own, in the order of their declarations.
    pub children: Vec<String>,
    /// Names of items, wherever in the file.
    pub items: BTreeSet<String>,
    /// All words of the code, those of `use` and `mod` declarations left out.
    pub words: BTreeSet<String>,
}

struct Token {
    text: String,
    line: usize,
}

impl Token {
    fn is_word(&self) -> bool {
        self.text
            .starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

pub(crate) fn contents(text: &str) -> Contents {
    let tokens = tokens(text);
    let at = |i: usize| tokens.get(i).map_or("", |t| t.text.as_str());
    let word = |i: usize| tokens.get(i).is_some_and(Token::is_word);
    let mut found = Contents::default();
    // Inline modules with the depth of brackets around them.
    let (mut open, mut depth) = (Vec::<(String, usize)>::new(), 0usize);
    let mut i = 0;
    while i < tokens.len() {
        let inside = || {
            open.iter()
                .map(|(name, _)| name.clone())
                .collect::<Vec<_>>()
        };
        let line = tokens[i].line;
        match at(i) {
            "{" => depth += 1,
            "}" => {
                depth = depth.saturating_sub(1);
                open.pop_if(|(_, around)| *around == depth);
            }
            "mod" if word(i + 1) => {
                if at(i + 2) == "{" {
                    open.push((at(i + 1).to_string(), depth));
                    let inside = open.iter().map(|(name, _)| name.clone());
                    found.inline.push(inside.collect());
                } else {
                    found.children.push(at(i + 1).to_string());
                }
                i += 1;
            }
            "use" if at(i + 1) != "<" => {
                let shared = i > 0 && matches!(at(i - 1), "pub" | ")");
                let mut leaves = Vec::new();
                i += 1;
                spread(&tokens, &mut i, Vec::new(), &mut leaves);
                found
                    .paths
                    .extend(leaves.into_iter().map(|(segments, name)| Path {
                        inside: inside(),
                        segments,
                        role: Role::Import { name, shared },
                        line,
                    }));
                continue;
            }
            _ if word(i) => {
                found.words.insert(at(i).to_string());
                if i > 0 && ITEMS.contains(&at(i - 1)) {
                    found.items.insert(at(i).to_string());
                }
                let starts = i == 0 || !matches!(at(i - 1), "::" | ".");
                let rooted =
                    i > 0 && at(i - 1) == "::" && (i == 1 || !word(i - 2) && at(i - 2) != ">");
                let mut segments = vec![at(i).to_string()];
                while at(i + 1) == "::" && word(i + 2) {
                    segments.push(at(i + 2).to_string());
                    found.words.insert(at(i + 2).to_string());
                    i += 2;
                }
                if starts && !rooted && segments.len() > 1 {
                    found.paths.push(Path {
                        inside: inside(),
                        segments,
                        role: Role::Code,
                        line,
                    });
                }
            }
            _ => {}
        }
        i += 1;
    }
    found
}

/// What stands before the name of an item.
const ITEMS: [&str; 8] = [
    "fn", "struct", "enum", "trait", "type", "const", "static", "union",
];

/// The leaves of the `use` tree at token `i`, and the names they go by.
fn spread(
    tokens: &[Token],
    i: &mut usize,
    mut before: Vec<String>,
    leaves: &mut Vec<(Vec<String>, Option<String>)>,
) {
    while let Some(token) = tokens.get(*i) {
        *i += 1;
        let at = |i: usize| tokens.get(i).map_or("", |t| t.text.as_str());
        match token.text.as_str() {
            "::" => before.push(String::new()),
            "*" => return leaves.push((before, None)),
            "{" => {
                while !matches!(at(*i), "}" | "") {
                    spread(tokens, i, before.clone(), leaves);
                    if at(*i) == "," {
                        *i += 1;
                    }
                }
                *i += 1;
                return;
            }
            segment => {
                if segment != "self" || before.is_empty() {
                    before.push(segment.to_string());
                }
                if at(*i) == "::" {
                    *i += 1;
                    continue;
                }
                let mut name = before.last().cloned();
                if at(*i) == "as" {
                    name = Some(at(*i + 1).to_string());
                    *i += 2;
                }
                return leaves.push((before, name));
            }
        }
    }
}

/// Words, `::` and single marks; comments, literals and lifetimes vanish.
fn tokens(text: &str) -> Vec<Token> {
    let (mut rest, mut line) = (text, 1);
    let mut found = Vec::new();
    while let Some(first) = rest.chars().next() {
        let in_word = |c: char| c.is_alphanumeric() || c == '_';
        let word = rest.find(|c| !in_word(c)).unwrap_or(rest.len());
        let length = match first {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => comment(rest),
            '"' => string(rest),
            '\'' => character(rest),
            'r' | 'b' | 'c' if raw_string(rest).is_some() => raw_string(rest).unwrap_or(1),
            'r' if rest.starts_with("r#") => 2,
            ':' if rest.starts_with("::") => 2,
            c if in_word(c) => word,
            c => c.len_utf8(),
        };
        let (piece, after) = rest.split_at(length);
        let named = piece == "::" || piece != "r#" && piece.chars().all(in_word);
        let mark = piece.chars().count() == 1 && !first.is_whitespace();
        if named || mark {
            let text = piece.to_string();
            found.push(Token { text, line });
        }
        line += piece.matches('\n').count();
        rest = after;
    }
    found
}

/// Length of the block comment at the start; they nest.
fn comment(text: &str) -> usize {
    let (mut depth, mut at) = (0usize, 0);
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        match rest {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at.min(text.len())
}

/// Length of the quoted string at the start.
fn string(text: &str) -> usize {
    let (mut at, bytes) = (1, text.as_bytes());
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(text.len())
}

/// Length of the raw string at the start, its prefix included, if there is one.
fn raw_string(text: &str) -> Option<usize> {
    let prefix = ["r", "br", "cr"].iter().find(|p| {
        let hashes = text.strip_prefix(**p).map(|t| t.trim_start_matches('#'));
        hashes.is_some_and(|t| t.starts_with('"'))
    })?;
    let body = &text[prefix.len()..];
    let hashes = body.len() - body.trim_start_matches('#').len();
    let end = format!("\"{}", "#".repeat(hashes));
    let start = prefix.len() + hashes + 1;
    let length = text[start..].find(&end);
    Some(length.map_or(text.len(), |l| start + l + end.len()))
}

/// Length of the character or the lifetime at the start.
fn character(text: &str) -> usize {
    let mut after = text.char_indices().skip(1);
    match (after.next(), after.next()) {
        (Some((_, '\\')), Some((escaped, _))) => {
            let from = escaped + 1;
            text.get(from..)
                .and_then(|t| t.find('\''))
                .map_or(text.len(), |l| from + l + 1)
        }
        (Some(_), Some((end, '\''))) => end + 1,
        _ => {
            let name = |c: char| c.is_alphanumeric() || c == '_';
            1 + text[1..].find(|c| !name(c)).unwrap_or(text.len() - 1)
        }
    }
}
