//! Files of a folder import each other in one direction: what a file needs, never what needs it.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// Rust files below a folder by module path (`depth_maps::fit::views`), without their tests.
struct Modules {
    texts: BTreeMap<String, String>,
}

impl Modules {
    /// `root` is the crate's `src`.
    fn read(root: &Path) -> Self {
        let mut texts = BTreeMap::new();
        read_below(root, "", &mut texts);
        Self { texts }
    }

    /// What a file imports: `use` items and paths in its code that start with `crate` or `super`.
    fn imports(&self, module: &str) -> BTreeSet<String> {
        let text = &self.texts[module];
        let found = uses(text).into_iter().map(|(path, _)| path).chain(inline_paths(text));
        let absolute = found.filter_map(|path| self.absolute(module, &path));
        absolute.filter_map(|path| self.defined_in(&path, 8)).filter(|to| to != module).collect()
    }

    /// From a path as `module` writes it to one from the crate's root.
    fn absolute(&self, module: &str, path: &str) -> Option<String> {
        let mut base: Vec<&str> = module.split("::").filter(|part| !part.is_empty()).collect();
        let parts: Vec<&str> = path.split("::").collect();
        let rest = match parts[0] {
            "crate" => {
                base.clear();
                &parts[1..]
            }
            "self" => &parts[1..],
            "super" => {
                let ups = parts.iter().take_while(|part| **part == "super").count();
                base.truncate(base.len().checked_sub(ups)?);
                &parts[ups..]
            }
            // Modules of its own.
            first if self.texts.contains_key(&joined(module, first)) => &parts[..],
            _ => return None,
        };
        base.extend(rest);
        Some(base.join("::"))
    }

    /// The file that defines what a path names, through at most so many re-exports.
    fn defined_in(&self, path: &str, through: u32) -> Option<String> {
        let (mut module, mut rest) = (String::new(), path);
        while !rest.is_empty() {
            let (first, after) = rest.split_once("::").unwrap_or((rest, ""));
            let inner = joined(&module, first);
            if !self.texts.contains_key(&inner) {
                let exported = uses(&self.texts[&module]).into_iter().find(|(_, name)| name == first);
                return match exported.and_then(|(path, _)| self.absolute(&module, &path)) {
                    Some(original) if through > 0 => self.defined_in(&original, through - 1),
                    _ => Some(module),
                };
            }
            (module, rest) = (inner, after);
        }
        // A whole module is named, and what is taken from it comes later.
        Some(module)
    }

    /// Files below `folder` that import each other, as a way from one back to itself.
    fn cycle_in(&self, folder: &str) -> Option<Vec<String>> {
        let prefix = joined(folder, "");
        let inside = |name: &String| name == folder || name.starts_with(&prefix);
        let files: Vec<&String> = self.texts.keys().filter(|name| inside(name)).collect();
        assert!(!files.is_empty(), "there is a module {folder}");
        let imports: BTreeMap<_, BTreeSet<_>> = files
            .iter()
            .map(|name| ((*name).clone(), self.imports(name).into_iter().filter(&inside).collect()))
            .collect();
        files.iter().find_map(|start| way_back(&imports, start))
    }
}

fn way_back(imports: &BTreeMap<String, BTreeSet<String>>, start: &str) -> Option<Vec<String>> {
    let mut waiting = vec![vec![start.to_string()]];
    let mut seen = BTreeSet::new();
    while let Some(way) = waiting.pop() {
        for next in &imports[&way[way.len() - 1]] {
            if next == start {
                return Some(way);
            }
            if seen.insert(next.clone()) {
                waiting.push(way.iter().chain([next]).cloned().collect());
            }
        }
    }
    None
}

fn joined(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_string() } else { format!("{module}::{name}") }
}

fn read_below(folder: &Path, module: &str, texts: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).expect("a folder of sources").flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if path.is_dir() {
            read_below(&path, &joined(module, &name), texts);
        } else if let Some(stem) = name.strip_suffix(".rs") {
            let of_folder = matches!(stem, "mod" | "lib" | "main");
            let module = if of_folder { module.to_string() } else { joined(module, stem) };
            texts.insert(module, without_comments_and_tests(&fs::read_to_string(path).expect("UTF-8")));
        }
    }
}

fn without_comments_and_tests(text: &str) -> String {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    code.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// All `use` items as pairs of a full path and the name that it has here.
fn uses(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let starts = text.match_indices("use ").filter(|(at, _)| {
        let before = text[..*at].trim_end_matches(' ');
        before.is_empty() || before.ends_with(['\n', ')', '{', ';']) || before.ends_with("pub")
    });
    for (at, word) in starts {
        let tree: String = text[at + word.len()..].chars().take_while(|c| *c != ';').collect();
        unfold("", &tree.split_whitespace().collect::<Vec<_>>().join(" "), &mut found);
    }
    found
}

fn unfold(prefix: &str, tree: &str, found: &mut Vec<(String, String)>) {
    let tree = tree.trim();
    if let Some((before, inner)) = tree.split_once('{') {
        let prefix = format!("{prefix}{before}");
        let inner = inner.rsplit_once('}').map_or(inner, |(inner, _)| inner);
        let (mut depth, mut start) = (0, 0);
        for (at, c) in inner.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    unfold(&prefix, &inner[start..at], found);
                    start = at + 1;
                }
                _ => {}
            }
        }
        unfold(&prefix, &inner[start..], found);
    } else if !tree.is_empty() {
        let (path, name) = tree.split_once(" as ").unwrap_or((tree, tree.rsplit("::").next().unwrap_or(tree)));
        let path = if path == "self" { prefix.trim_end_matches("::").to_string() } else { format!("{prefix}{path}") };
        let name =
            if name == "self" { path.rsplit("::").next().unwrap_or(&path).to_string() } else { name.to_string() };
        found.push((path, name));
    }
}

/// Paths in code, outside of `use`.
fn inline_paths(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in text.match_indices(start) {
            let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
            let before = &text[..at];
            let path: String = text[at..].chars().take_while(|c| is_path(*c)).collect();
            // Neither the middle of a path nor one of a macro's, nor a visibility.
            let is_start = !before.ends_with(is_path) && !before.ends_with('$') && !before.ends_with("in ");
            if is_start && !path.ends_with(':') {
                found.push(path);
            }
        }
    }
    found
}

fn source(krate: &str) -> Modules {
    Modules::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates").join(krate).join("src"))
}

/// Folders of the library whose files import each other in one direction.
const FOLDERS: [&str; 11] = [
    "casters",
    "depth_maps",
    "moment_maps",
    "silhouettes",
    "area_light",
    "receivers",
    "shader",
    "settings",
    "techniques::light_mask",
    "techniques::volume",
    "techniques::wedges",
];

#[test]
fn no_cycle_between_files() {
    let (library, report) = (source("umbrage"), source("umbrage-report"));
    let folders = FOLDERS.map(|folder| (&library, folder));
    for (modules, folder) in folders.into_iter().chain([(&report, "")]) {
        let cycle = modules.cycle_in(folder).map(|way| way.join(" → "));
        assert_eq!(cycle, None, "files of {folder} import each other");
    }
}

#[test]
fn a_cycle_is_found_through_re_exports_and_inline_paths() {
    let texts = [
        ("", "mod a;"),
        ("a", "mod b; mod c; pub(crate) use b::{B, Other as Another}; use crate::elsewhere;"),
        ("a::b", "use std::fmt; pub struct B; fn f() { super::c::g(); }"),
        ("a::c", "use super::Another; pub fn g() {}"),
    ];
    let mut modules = Modules { texts: texts.map(|(name, text)| (name.to_string(), text.to_string())).into() };
    assert_eq!(modules.cycle_in("a"), Some(vec!["a::b".to_string(), "a::c".to_string()]));
    let harmless = "pub struct B; // super::c::g\n#[cfg(test)] mod t { use super::super::c; }";
    modules.texts.insert("a::b".into(), without_comments_and_tests(harmless));
    assert_eq!(modules.cycle_in("a"), None);
}
