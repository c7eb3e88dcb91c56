//! Modules of WGSL and what they need: the first line of a file names other modules, and a shader
//! is all of them in order.

/// Plain WGSL that others need by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Module {
    /// What `// needs:` calls it.
    pub name: &'static str,
    /// Its text.
    pub source: &'static str,
}

/// Why a shader can't be put together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unresolved {
    /// No module has this name.
    #[error("`{by}` needs `{need}`, and no module is called that")]
    Unknown {
        /// The module or shader that needs it.
        by: &'static str,
        /// What it needs.
        need: &'static str,
    },
    /// Each of these needs the next one, and the last one the first.
    #[error("modules need each other: {}", .0.join(", "))]
    Cycle(Vec<&'static str>),
}

/// What the first line of a source asks for.
fn needs_of(source: &'static str) -> impl Iterator<Item = &'static str> {
    let first = source.lines().next().and_then(|line| line.strip_prefix("// needs:"));
    first.into_iter().flat_map(|list| list.split(',').map(str::trim))
}

/// The modules of a shader, each after those that it needs itself. Needs are looked for in `known`,
/// from the front.
pub(super) fn resolve(
    name: &'static str,
    source: &'static str,
    known: &[&[Module]],
) -> Result<Vec<Module>, Unresolved> {
    let mut search = Search { known, found: Vec::new(), under_way: Vec::new() };
    search.add_needs(Module { name, source })?;
    Ok(search.found)
}

struct Search<'a> {
    known: &'a [&'a [Module]],
    found: Vec<Module>,
    /// Modules whose needs are being looked for, each needed by the one before.
    under_way: Vec<&'static str>,
}

impl Search<'_> {
    fn add_needs(&mut self, of: Module) -> Result<(), Unresolved> {
        for need in needs_of(of.source) {
            if self.found.iter().any(|module| module.name == need) {
                continue;
            }
            if let Some(start) = self.under_way.iter().position(|name| *name == need) {
                return Err(Unresolved::Cycle(self.under_way[start..].to_vec()));
            }
            let known = self.known.iter().copied().flatten().find(|module| module.name == need);
            let module = *known.ok_or(Unresolved::Unknown { by: of.name, need })?;
            self.under_way.push(need);
            self.add_needs(module)?;
            self.under_way.pop();
            self.found.push(module);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::library::LIBRARY;
    use super::*;

    const fn module(name: &'static str, source: &'static str) -> Module {
        Module { name, source }
    }

    fn names(source: &'static str, own: &[Module]) -> Result<Vec<&'static str>, Unresolved> {
        resolve("test", source, &[own, LIBRARY]).map(|found| found.iter().map(|module| module.name).collect())
    }

    #[test]
    fn modules_come_once_and_after_their_needs() {
        let own = [module("a", "// needs: b, c"), module("b", "// needs: c"), module("c", "const C = 1;")];
        assert_eq!(names("// needs: a, b", &own), Ok(vec!["c", "b", "a"]));
        assert_eq!(names("const ALONE = 1;\n// needs: a", &own), Ok(vec![]), "only the first line counts");
    }

    #[test]
    fn own_modules_go_before_the_library() {
        let own = [module("fullscreen", "// needs: mine"), module("mine", "")];
        assert_eq!(names("// needs: fullscreen", &own), Ok(vec!["mine", "fullscreen"]));
        assert_eq!(names("// needs: fullscreen", &[]), Ok(vec!["fullscreen"]));
    }

    #[test]
    fn unknown_and_cyclic_needs_are_errors() {
        let own = [module("a", "// needs: b"), module("b", "// needs: a")];
        assert_eq!(names("// needs: nothing", &own), Err(Unresolved::Unknown { by: "test", need: "nothing" }));
        assert_eq!(names("// needs: a", &own), Err(Unresolved::Cycle(vec!["a", "b"])));
    }
}
