//! A shader's WGSL as a part of another module: names get a prefix, overrides become constants, and
//! bind groups and bindings are those of the host.

use std::collections::HashSet;
use std::fmt::Write;

/// How a shader is to be put into another one.
pub(super) struct Into<'a> {
    /// What names of the module begin with, an underscore after it.
    pub prefix: &'a str,
    /// Values of overrides.
    pub constants: &'a [(&'static str, f64)],
    /// The host's bind group.
    pub group: u32,
    /// The binding there of what the shader declares with this group and number.
    pub binding: &'a dyn Fn((u32, u32)) -> u32,
}

/// Rewrites the text of a whole shader.
pub(super) fn rewritten(text: &str, into: &Into<'_>) -> String {
    let tokens = tokens(text);
    let names = names(&tokens);
    let mut out = String::with_capacity(text.len());
    let mut i = 0;
    let mut place = Place::default();
    while i < tokens.len() {
        let token = tokens[i];
        if let Some((at, next)) = bound_at(&tokens, i) {
            let _ = write!(out, "@group({}) @binding({})", into.group, (into.binding)(at));
            i = next;
            continue;
        }
        if token == "override" && place.depth == 0 {
            place.pass(token);
            let constant = constant_of(&tokens, i, into);
            let (text, next) = constant.unwrap_or_else(|| ("const".into(), i + 1));
            out.push_str(&text);
            i = next;
            continue;
        }
        if names.contains(token) && !place.is_member(&tokens, i) {
            let _ = write!(out, "{}_{token}", into.prefix);
        } else {
            out.push_str(token);
        }
        place.pass(token);
        i += 1;
    }
    out
}

/// Words, numbers, blank runs and single characters; comments are left out.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        if rest.starts_with("//") {
            rest = rest.split_once('\n').map_or("", |(comment, _)| &rest[comment.len()..]);
            continue;
        }
        if rest.starts_with("/*") {
            rest = rest.split_once("*/").map_or("", |(_, after)| after);
            continue;
        }
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let end = if is_word(first) {
            rest.find(|c| !is_word(c))
        } else if first.is_whitespace() {
            rest.find(|c: char| !c.is_whitespace())
        } else {
            Some(first.len_utf8())
        };
        let (token, after) = rest.split_at(end.unwrap_or(rest.len()));
        tokens.push(token);
        rest = after;
    }
    tokens
}

fn is_blank(token: &str) -> bool {
    token.chars().all(char::is_whitespace)
}

/// The token after `i` and blanks, and where it is.
fn next_of<'a>(tokens: &[&'a str], i: usize) -> Option<(usize, &'a str)> {
    let at = (i + 1..tokens.len()).find(|at| !is_blank(tokens[*at]))?;
    Some((at, tokens[at]))
}

/// All that the module declares.
fn names<'a>(tokens: &[&'a str]) -> HashSet<&'a str> {
    let mut names = HashSet::new();
    let mut depth = 0_i32;
    for (i, token) in tokens.iter().enumerate() {
        match *token {
            "{" | "(" => depth += 1,
            "}" | ")" => depth -= 1,
            "fn" | "struct" | "const" | "override" | "alias" | "var" if depth == 0 => {
                let mut next = next_of(tokens, i);
                // An address space stands between `var` and its name.
                if next.is_some_and(|(_, token)| token == "<") {
                    let end = (i..tokens.len()).find(|at| tokens[*at] == ">");
                    next = end.and_then(|end| next_of(tokens, end));
                }
                names.extend(next.map(|(_, name)| name));
            }
            _ => {}
        }
    }
    names
}

/// Where in the module a token is.
#[derive(Default)]
struct Place<'a> {
    depth: usize,
    /// The last declaration at the outermost level was a struct.
    in_struct: bool,
    last: &'a str,
}

impl<'a> Place<'a> {
    /// The token is done.
    fn pass(&mut self, token: &'a str) {
        match token {
            "{" | "(" => self.depth += 1,
            "}" | ")" => self.depth = self.depth.saturating_sub(1),
            "struct" if self.depth == 0 => self.in_struct = true,
            "fn" | "const" | "override" | "alias" | "var" if self.depth == 0 => self.in_struct = false,
            _ => {}
        }
        if !is_blank(token) {
            self.last = token;
        }
    }

    /// The name of a member or an attribute, which is nobody else's.
    fn is_member(&self, tokens: &[&str], i: usize) -> bool {
        let is_declared =
            self.in_struct && self.depth == 1 && next_of(tokens, i).is_some_and(|(_, token)| token == ":");
        self.last == "." || self.last == "@" || is_declared
    }
}

/// Reads `@group(a) @binding(b)`: both numbers, and where the next token is.
fn bound_at(tokens: &[&str], i: usize) -> Option<((u32, u32), usize)> {
    let number = |i: usize, name: &str| {
        let mut at = i;
        for expected in ["@", name, "("] {
            if *tokens.get(at)? != expected {
                return None;
            }
            at += 1;
        }
        let number: u32 = tokens.get(at)?.trim_end_matches('u').parse().ok()?;
        (*tokens.get(at + 1)? == ")").then_some((number, at + 2))
    };
    let (group, after) = number(i, "group")?;
    let (second, _) = next_of(tokens, after - 1)?;
    let (binding, after) = number(second, "binding")?;
    Some(((group, binding), after))
}

/// Reads `override NAME: type = default;` where it is given a value: the constant in its place, and
/// where the next token is.
fn constant_of(tokens: &[&str], i: usize, into: &Into<'_>) -> Option<(String, usize)> {
    let (at, name) = next_of(tokens, i)?;
    let (_, value) = into.constants.iter().rev().find(|(constant, _)| *constant == name)?;
    let (colon, _) = next_of(tokens, at)?;
    let (of_type, ty) = next_of(tokens, colon)?;
    let end = (of_type..tokens.len()).find(|at| tokens[*at] == ";")?;
    Some((format!("const {}_{name}: {ty} = {};", into.prefix, literal(ty, *value)), end + 1))
}

/// A number as a type spells it.
fn literal(ty: &str, value: f64) -> String {
    match ty {
        "bool" => (value != 0.0).to_string(),
        "f32" => format!("{:?}", value as f32),
        _ => format!("{value:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn into_sun(text: &str) -> String {
        let binding = |(group, number): (u32, u32)| group * 10 + number;
        rewritten(
            text,
            &Into { prefix: "sun", constants: &[("A", 2.0), ("B", 1.0), ("C", 0.5)], group: 3, binding: &binding },
        )
    }

    #[test]
    fn names_of_the_module_get_the_prefix_and_members_do_not() {
        let text = "struct S { size: f32, @align(16) inner: T, }\nstruct T { size: u32, }\nfn size(s: S) -> f32 { let inner = s.inner; return s.size + f32(inner.size); }";
        let expected = "struct sun_S { size: f32, @align(16) inner: sun_T, }\nstruct sun_T { size: u32, }\nfn sun_size(s: sun_S) -> f32 { let inner = s.inner; return s.size + f32(inner.size); }";
        assert_eq!(into_sun(text), expected);
    }

    #[test]
    fn overrides_become_constants_and_bindings_the_hosts() {
        assert_eq!(into_sun("override A: u32 = 7u;"), "const sun_A: u32 = 2;");
        assert_eq!(into_sun("override B: bool = false;"), "const sun_B: bool = true;");
        assert_eq!(into_sun("override C: f32 = 1.0;"), "const sun_C: f32 = 0.5;");
        assert_eq!(
            into_sun("override D: u32 = E;\nconst E: u32 = 4u;"),
            "const sun_D: u32 = sun_E;\nconst sun_E: u32 = 4u;"
        );
        assert_eq!(
            into_sun("@group(2) @binding(1) var<storage, read> taps: array<f32>;"),
            "@group(3) @binding(21) var<storage, read> sun_taps: array<f32>;"
        );
    }

    #[test]
    fn comments_are_left_out() {
        assert_eq!(into_sun("// fn a\nfn b() {} /* fn c */"), "\nfn sun_b() {} ");
    }
}
