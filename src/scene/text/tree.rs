//! Walking RON text by path without knowing its types: which fields a value has and where they stand.

use super::lexer::{self, Token, TokenKind};
use std::ops::Range;

/// One item of a list or one field of a struct, byte ranges of the text it was found in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Member {
    /// The field's name; `None` in lists and tuples.
    pub name: Option<Range<usize>>,
    pub value: Range<usize>,
}

/// The direct members of the first bracketed value of `text`; none if it is not bracketed.
pub(crate) fn members(text: &str) -> Vec<Member> {
    let tokens = skip_attribute(text);
    let Some(open) = tokens
        .iter()
        .position(|t| matches!(t.kind, TokenKind::Open(_)))
    else {
        return Vec::new();
    };
    let mut list = Vec::new();
    let mut depth = 0usize;
    let mut first = open + 1;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        let ends = match token.kind {
            TokenKind::Open(_) => {
                depth += 1;
                false
            }
            TokenKind::Close(_) => {
                depth -= 1;
                depth == 0
            }
            TokenKind::Mark(b',') => depth == 1,
            _ => false,
        };
        if ends {
            list.extend(member(&tokens[first..i]));
            first = i + 1;
        }
        if depth == 0 {
            break;
        }
    }
    list
}

/// The range inside the first bracket of `text` where one more member can be put: just before its end.
pub(crate) fn inner_end(text: &str) -> Option<usize> {
    let tokens = skip_attribute(text);
    let mut depth = 0usize;
    for token in tokens {
        match token.kind {
            TokenKind::Open(_) => depth += 1,
            TokenKind::Close(_) if depth == 1 => return Some(token.span.start),
            TokenKind::Close(_) => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    None
}

/// The text with the field whose name starts at byte `name` overwritten by spaces, comma included: same length, same offsets.
pub(crate) fn without_field(text: &str, name: usize) -> String {
    let tokens = lexer::tokens(text).unwrap_or_default();
    let mut depth = 0usize;
    let mut end = name;
    for token in tokens.iter().filter(|t| t.span.start >= name) {
        match token.kind {
            TokenKind::Open(_) => depth += 1,
            TokenKind::Close(_) if depth == 0 => break,
            TokenKind::Close(_) => depth -= 1,
            _ => {}
        }
        end = token.span.end;
        if depth == 0 && token.kind == TokenKind::Mark(b',') {
            break;
        }
    }
    format!(
        "{}{}{}",
        &text[..name],
        " ".repeat(end - name),
        &text[end..]
    )
}

fn member(tokens: &[Token]) -> Option<Member> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    let named = first.kind == TokenKind::Word
        && tokens
            .get(1)
            .is_some_and(|t| t.kind == TokenKind::Mark(b':'));
    let value = if named {
        tokens.get(2)?.span.start
    } else {
        first.span.start
    };
    Some(Member {
        name: named.then(|| first.span.clone()),
        value: value..last.span.end,
    })
}

/// Tokens of the text after `#![...]` lines.
pub(crate) fn skip_attribute(text: &str) -> Vec<Token> {
    let mut tokens = lexer::tokens(text).unwrap_or_default();
    while tokens
        .first()
        .is_some_and(|t| text[t.span.clone()].starts_with('#'))
    {
        let end = tokens
            .iter()
            .position(|t| t.kind == TokenKind::Close(b']'))
            .map_or(tokens.len(), |i| i + 1);
        tokens.drain(..end);
    }
    tokens
}
