//! The words of RON text, without its meaning: strings, brackets, words, punctuation.
//!
//! Takes text, gives tokens with byte ranges. Serves three ends the RON parser cannot: pointing at the *opening* of
//! whatever is never closed, finding where a value starts and ends, and replacing values by path (`--set`).
//! Not recursive: nesting costs no stack.

use std::ops::Range;

/// Deepest nesting of brackets a scene may have; real ones need about eight.
pub(crate) const DEEPEST: usize = 64;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// One of `( [ {`.
    Open(u8),
    /// One of `) ] }`.
    Close(u8),
    /// A string of either sort, quotes included.
    Text,
    /// A run of anything else between spaces and punctuation: names and numbers.
    Word,
    /// `,` or `:`.
    Mark(u8),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub kind: TokenKind,
    pub span: Range<usize>,
}

/// What keeps text from falling into words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Broken {
    /// A string is not closed before the end; `span` is the most likely culprit.
    OpenString(Range<usize>),
    OpenComment(Range<usize>),
    SmartQuote(Range<usize>),
    /// A bracket without its partner, and the bracket that closes it wrongly, if any.
    OpenBracket {
        open: Range<usize>,
        closed_by: Option<Range<usize>>,
    },
    StrayBracket(Range<usize>),
    TooDeep(Range<usize>),
}

/// Cuts `text` into tokens; comments and spaces vanish.
///
/// # Errors
/// The first thing that is not closed, or a typographic quote outside strings.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token>, Broken> {
    let bytes = text.as_bytes();
    let mut list = Vec::new();
    let mut many_lined: Option<Range<usize>> = None;
    let mut at = 0;
    while at < bytes.len() {
        let rest = &text[at..];
        let (kind, length) = match bytes[at] {
            b' ' | b'\t' | b'\r' | b'\n' => {
                at += 1;
                continue;
            }
            b'/' if rest.starts_with("//") => {
                at += rest.find('\n').unwrap_or(rest.len());
                continue;
            }
            b'/' if rest.starts_with("/*") => {
                at += comment(rest).ok_or(Broken::OpenComment(at..at + 2))?;
                continue;
            }
            b @ (b'(' | b'[' | b'{') => (TokenKind::Open(b), 1),
            b @ (b')' | b']' | b'}') => (TokenKind::Close(b), 1),
            b @ (b',' | b':') => (TokenKind::Mark(b), 1),
            b'"' => (
                TokenKind::Text,
                string(rest).ok_or(Broken::OpenString(many_lined.clone().unwrap_or(at..at + 1)))?,
            ),
            b'r' if raw_hashes(rest).is_some() => (
                TokenKind::Text,
                raw_string(rest).ok_or(Broken::OpenString(at..at + 2))?,
            ),
            _ => (TokenKind::Word, word(rest)),
        };
        let span = at..at + length;
        if kind == TokenKind::Text && many_lined.is_none() && rest[..length].contains('\n') {
            let line = rest.find('\n').unwrap_or(length);
            many_lined = Some(at..at + line);
        }
        if let Some((i, c)) = (kind == TokenKind::Word)
            .then(|| smart_quote(&rest[..length]))
            .flatten()
        {
            return Err(Broken::SmartQuote(at + i..at + i + c.len_utf8()));
        }
        list.push(Token { kind, span });
        at += length;
    }
    Ok(list)
}

/// Whether every bracket has its partner and nesting stays sane.
///
/// # Errors
/// The innermost bracket that is not closed, or the first stray one.
pub(crate) fn balanced(tokens: &[Token]) -> Result<(), Broken> {
    let mut open: Vec<(u8, Range<usize>)> = Vec::new();
    for token in tokens {
        match token.kind {
            TokenKind::Open(b) => open.push((b, token.span.clone())),
            TokenKind::Close(b) => match open.pop() {
                None => return Err(Broken::StrayBracket(token.span.clone())),
                Some((o, span)) if partner(o) != b => {
                    return Err(Broken::OpenBracket {
                        open: span,
                        closed_by: Some(token.span.clone()),
                    });
                }
                Some(_) => {}
            },
            _ => {}
        }
        if open.len() > DEEPEST {
            return Err(Broken::TooDeep(token.span.clone()));
        }
    }
    match open.pop() {
        Some((_, span)) => Err(Broken::OpenBracket {
            open: span,
            closed_by: None,
        }),
        None => Ok(()),
    }
}

/// The closing bracket that belongs to an opening one.
pub(crate) fn partner(open: u8) -> u8 {
    match open {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

/// The range from the first token to the last, i.e. `text` without the spaces and comments around it.
pub(crate) fn trimmed(text: &str) -> Range<usize> {
    match tokens(text) {
        Ok(list) => match (list.first(), list.last()) {
            (Some(first), Some(last)) => first.span.start..last.span.end,
            _ => 0..text.len(),
        },
        Err(_) => 0..text.len(),
    }
}

/// Length of the block comment at the start; RON's comments nest.
fn comment(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0usize, 0);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => {
                depth += 1;
                at += 2;
            }
            b"*/" => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => at += 1,
        }
    }
    None
}

/// Length of the quoted string at the start.
fn string(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = 1;
    while at < bytes.len() {
        match bytes[at] {
            b'"' => return Some(at + 1),
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    None
}

/// Number of hashes if a raw string starts here.
fn raw_hashes(text: &str) -> Option<usize> {
    let hashes = text[1..].bytes().take_while(|b| *b == b'#').count();
    (text.as_bytes().get(1 + hashes) == Some(&b'"')).then_some(hashes)
}

/// Length of the raw string at the start.
fn raw_string(text: &str) -> Option<usize> {
    let hashes = raw_hashes(text)?;
    let end = format!("\"{}", "#".repeat(hashes));
    let body = hashes + 2;
    text[body..].find(&end).map(|i| body + i + end.len())
}

/// Length of the word at the start, at least one character.
fn word(text: &str) -> usize {
    let stop = |c: char| c.is_whitespace() || "()[]{},:\"".contains(c);
    let run = &text[..text.find(stop).unwrap_or(text.len())];
    let comment = run.find("//").into_iter().chain(run.find("/*")).min();
    let length = comment.unwrap_or(run.len());
    if length > 0 {
        length
    } else {
        text.chars().next().map_or(1, char::len_utf8)
    }
}

fn smart_quote(word: &str) -> Option<(usize, char)> {
    word.char_indices()
        .find(|(_, c)| "\u{201c}\u{201d}\u{201e}\u{2018}\u{2019}\u{00ab}\u{00bb}".contains(*c))
}
