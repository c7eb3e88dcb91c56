//! The prose of the project: links that work, words that a reader of the field knows, comments that
//! fit on a page.

use std::{collections::HashSet, fs, path::Path, path::PathBuf};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Path from the workspace and text of all files with one of the endings, without what is built.
fn files(endings: &[&str]) -> Vec<(String, String)> {
    fn collect(folder: &Path, endings: &[&str], found: &mut Vec<(String, String)>) {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
            if path.is_dir() && name != "target" && name != "out" && !name.starts_with('.') {
                collect(&path, endings, found);
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
                let from_workspace = path.strip_prefix(workspace()).expect("a path below the workspace");
                found.push((from_workspace.to_string_lossy().into_owned(), text));
            }
        }
    }
    let mut found = Vec::new();
    collect(&workspace(), endings, &mut found);
    assert!(found.len() > 5, "there are files that end with {endings:?}");
    found
}

// Links.

/// The lines of a Markdown text outside of code blocks, without inline code.
fn text_lines(markdown: &str) -> impl Iterator<Item = String> + '_ {
    let mut in_code = false;
    markdown.lines().filter_map(move |line| {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
            return None;
        }
        let outside = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        (!in_code && !line.starts_with("    ")).then_some(outside)
    })
}

/// What a line links to.
fn links(line: &str) -> impl Iterator<Item = &str> {
    line.split("](").skip(1).filter_map(|rest| rest.split(')').next())
}

/// The anchors of a text's headings, as web pages of repositories make them.
fn anchors(markdown: &str) -> HashSet<String> {
    let mut in_code = false;
    let headings = markdown.lines().filter(move |line| {
        in_code ^= line.starts_with("```");
        !in_code && line.starts_with('#')
    });
    let kept = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    let anchor = |heading: &str| {
        let title = heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        title.chars().filter(|c| kept(*c)).collect::<String>()
    };
    headings.map(anchor).collect()
}

/// Why a link of a file leads nowhere.
fn broken(file: &Path, link: &str) -> Option<&'static str> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
    let target = if path.is_empty() { file.to_path_buf() } else { file.parent()?.join(path) };
    if !target.exists() {
        return Some("no such file");
    }
    let anchor = anchor?;
    let there = fs::read_to_string(&target).is_ok_and(|text| anchors(&text).contains(anchor));
    (!there).then_some("no such heading")
}

#[test]
fn every_link_works() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (name, text) in files(&[".md"]) {
        for line in text_lines(&text) {
            for link in links(&line) {
                count += 1;
                wrong.extend(broken(&workspace().join(&name), link).map(|why| format!("{name}: {link}: {why}")));
            }
        }
    }
    assert!(count > 50, "only {count} links were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn broken_links_are_found() {
    let readme = workspace().join("README.md");
    assert_eq!(broken(&readme, "docs/guide.md#scenes"), None);
    assert_eq!(broken(&readme, "docs/guide.md#no-such"), Some("no such heading"));
    assert_eq!(broken(&readme, "docs/no-such.md"), Some("no such file"));
    assert_eq!(text_lines("a `](x)`\n```\n](y)\n```\n").collect::<Vec<_>>(), ["a `"]);
    assert!(anchors("## `scale` and `budget-ms`\n").contains("scale-and-budget-ms"));
}

// Words.

/// Phrases that mean something here that readers would have to guess, and what to say in their
/// place.
const BANNED: &[(&str, &str)] = &[
    ("ball", "sphere, sphere light or bounding sphere"),
    ("balls", "spheres"),
    ("go on", "continue, extend"),
    ("goes on", "continues, extends"),
    ("went on", "continued, extended"),
    ("give way", "be followed by, be blended with"),
    ("gives way", "is followed by, is blended with"),
    ("gave way", "was followed by"),
    ("come to", "amount to, reach"),
    ("comes to", "amounts to, reaches"),
    ("came to", "amounted to, reached"),
    ("throw", "cast"),
    ("throws", "casts"),
    ("thrown", "cast"),
    ("aslant", "oblique"),
    ("strike out", "remove"),
    ("strikes out", "removes"),
];

/// File, phrase, and why it may stand there.
const ALLOWED: &[(&str, &str, &str)] = &[
    ("xtask/tests/prose.rs", "", "this list"),
    ("crates/umbrage-core/src/sampling/hard_lights.rs", "ball", "the solid, not its surface, which is a sphere"),
    ("ARCHITECTURE.md", "ball", "the solid, not its surface, which is a sphere"),
];

/// What ends the string that a line of code begins in; `None` in code.
type Inside = Option<String>;

/// The parts of a line of code that people read: comments, and strings of several words.
fn prose<'a>(line: &'a str, inside: &mut Inside) -> Vec<&'a str> {
    let (mut parts, mut rest) = (Vec::new(), line);
    loop {
        if let Some(end) = inside.clone() {
            let at = end_of_string(rest, &end);
            parts.extend(Some(&rest[..at]).filter(|text| text.contains(' ')));
            if at == rest.len() {
                return parts;
            }
            (rest, *inside) = (&rest[at + end.len()..], None);
        }
        let marks = ["//", "\"", "'\"'", "'\\\"'"].iter().filter_map(|mark| Some((rest.find(mark)?, *mark)));
        // Of two marks at one place the longer one.
        match marks.min_by_key(|(at, mark)| (*at, usize::MAX - mark.len())) {
            None => return parts,
            Some((at, "//")) => {
                parts.push(&rest[at + 2..]);
                return parts;
            }
            Some((at, "\"")) => {
                let hashes = rest[..at].len() - rest[..at].trim_end_matches('#').len();
                (rest, *inside) = (&rest[at + 1..], Some(format!("\"{}", "#".repeat(hashes))));
            }
            Some((at, character)) => rest = &rest[at + character.len()..],
        }
    }
}

/// Where a string ends in a line, its length where it does not. Escapes count where the string is
/// not raw.
fn end_of_string(line: &str, end: &str) -> usize {
    let mut escaped = false;
    for (at, c) in line.char_indices() {
        if !escaped && line[at..].starts_with(end) {
            return at;
        }
        escaped = end == "\"" && c == '\\' && !escaped;
    }
    line.len()
}

fn is_in_word(c: char) -> bool {
    c.is_alphanumeric() || "-_'".contains(c)
}

/// Every word of a text that people read, in lower case, with its line; an empty word where prose
/// is interrupted.
fn words(name: &str, text: &str) -> Vec<(usize, String)> {
    let (mut found, mut inside) = (Vec::new(), None);
    for (number, line) in text.lines().enumerate() {
        let parts = if name.ends_with(".md") { vec![line] } else { prose(line, &mut inside) };
        if parts.iter().all(|part| part.trim().is_empty()) {
            found.push((number, String::new()));
        }
        for word in parts.iter().flat_map(|part| part.split(|c| !is_in_word(c)).filter(|w| !w.is_empty())) {
            found.push((number + 1, word.to_lowercase()));
        }
    }
    found
}

fn banned(name: &str, text: &str) -> Vec<String> {
    let words = words(name, text);
    let is_allowed = |phrase: &str| ALLOWED.iter().any(|(file, p, _)| *file == name && (p.is_empty() || *p == phrase));
    let mut wrong = Vec::new();
    for (phrase, better) in BANNED.iter().filter(|(phrase, _)| !is_allowed(phrase)) {
        let parts: Vec<&str> = phrase.split(' ').collect();
        for at in words.windows(parts.len()).filter(|w| w.iter().zip(&parts).all(|(w, p)| w.1 == *p)) {
            wrong.push(format!("{name}:{}: `{phrase}`; say {better}", at[0].0));
        }
    }
    wrong
}

#[test]
fn prose_uses_words_that_readers_know() {
    let wrong: Vec<String> = files(&[".md", ".rs", ".wgsl"]).iter().flat_map(|(n, text)| banned(n, text)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn banned_words_are_found_in_prose_only() {
    assert_eq!(banned("a.rs", "let ball = 1; // give-way\n").len(), 0);
    assert_eq!(banned("a.rs", "let b = 1; // a ball\nx(\"it goes on\")\n").len(), 2);
    assert_eq!(banned("a.rs", "/// it comes\n/// to this\nfn a() {}\n").len(), 1);
    assert_eq!(banned("a.rs", "/// it comes\nfn a() {}\n/// to this\n").len(), 0);
    assert_eq!(banned("a.rs", "x(\"a\\\"ball\", ball(1))\n").len(), 0);
    assert_eq!(banned("a.rs", "x('\"', ball(1), '\"')\n").len(), 0);
    assert_eq!(banned("a.rs", "x(\"first\n it goes\n on\", ball)\n").len(), 1);
    assert_eq!(banned("a.rs", "x(r#\"a \"word\" of a ball\"#, ball)\n").len(), 1);
}

// Width.

const COLUMNS: usize = 100;

#[test]
fn comments_fit_on_a_page() {
    let mut wrong = Vec::new();
    for (name, text) in files(&[".rs", ".wgsl"]) {
        let mut inside = None;
        for (number, line) in text.lines().enumerate() {
            let starts_in_code = inside.is_none();
            let is_end = |part: &&str| line.strip_suffix(part).is_some_and(|head| head.ends_with("//"));
            let parts = prose(line, &mut inside);
            let is_comment = starts_in_code && parts.last().is_some_and(is_end);
            // The row of a table is one line.
            let is_row = line.trim_start_matches(['/', '!', ' ']).starts_with('|');
            if is_comment && !is_row && line.chars().count() > COLUMNS {
                wrong.push(format!("{name}:{}: a comment beyond column {COLUMNS}", number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{} lines\n{}", wrong.len(), wrong.join("\n"));
}
