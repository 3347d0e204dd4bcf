//! The imports of each module, read from the text of its file.

use std::collections::{BTreeMap, BTreeSet};

/// A module, as its path from the crate root.
pub type Module = Vec<String>;

/// Returns which module imports which, without imports of tests. A re-export counts as an import of the original module.
pub fn imports(sources: &BTreeMap<Module, String>) -> BTreeSet<(Module, Module)> {
    let codes: BTreeMap<&Module, String> = sources
        .iter()
        .filter(|(module, _)| !module.iter().any(|name| name == "tests"))
        .map(|(module, text)| (module, strip_comments_and_tests(text)))
        .collect();
    let re_exported: BTreeMap<Module, Module> =
        codes.iter().flat_map(|(module, code)| re_exports(module, code)).collect();
    let origin = |mut path: Module| loop {
        let known = (0..=path.len()).rev().find(|length| codes.contains_key(&path[..*length].to_vec())).unwrap_or(0);
        match re_exported.get(path.get(..=known).unwrap_or_default()) {
            Some(further) if further[..] != path[..=known] => path = further.clone(),
            _ => break path[..known].to_vec(),
        }
    };
    let mut found = BTreeSet::new();
    for (module, code) in &codes {
        let all = paths(code).into_iter().map(|path| origin(absolute(module, &path)));
        found.extend(all.filter(|other| other != *module).map(|other| ((*module).clone(), other)));
    }
    found
}

/// Returns the text without comments and without the tests at its end.
fn strip_comments_and_tests(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.take_while(|line| !line.ends_with("mod tests {")).collect::<Vec<_>>().join("\n")
}

/// Returns the re-exported names of a module, with their origins.
fn re_exports(module: &Module, code: &str) -> Vec<(Module, Module)> {
    let mut found = Vec::new();
    for (start, _) in code.match_indices("use ") {
        let line = &code[code[..start].rfind('\n').map_or(0, |end| end + 1)..start];
        if line.starts_with("pub") {
            parse_tree(&code[start + 4..], &[], &mut found);
        }
    }
    let name = |path: &[&str]| [&module[..], &[(*path.last().unwrap_or(&"")).to_owned()]].concat();
    found.into_iter().map(|path| (name(&path), absolute(module, &path))).collect()
}

/// Returns all paths that start with the crate, the module or a parent module: in imports and inside the code.
fn paths(code: &str) -> Vec<Vec<&str>> {
    let mut found = Vec::new();
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(start) {
            if !code[..at].ends_with(|before: char| is_identifier_char(before) || before == ':') {
                parse_tree(&code[at..], &[], &mut found);
            }
        }
    }
    found
}

/// Parses the paths of a tree such as `a::{b, c::{self, d}}` from the start of a text, each prefixed with `start`, and returns the rest of
/// the text.
fn parse_tree<'a>(text: &'a str, start: &[&'a str], found: &mut Vec<Vec<&'a str>>) -> &'a str {
    let text = text.trim_start();
    if let Some(mut rest) = text.strip_prefix('{') {
        loop {
            rest = parse_tree(rest, start, found).trim_start_matches(|next| !matches!(next, ',' | '}'));
            match rest.strip_prefix(',') {
                Some(more) => rest = more,
                None => return rest.get(1..).unwrap_or_default(),
            }
        }
    }
    let (name, rest) = text.split_at(text.find(|next| !is_identifier_char(next)).unwrap_or(text.len()));
    let path = [start, &[name]].concat();
    if let Some(rest) = rest.strip_prefix("::") {
        return parse_tree(rest, &path, found);
    }
    // Nothing follows the last comma.
    if !name.is_empty() || !rest.starts_with('}') {
        found.push(path);
    }
    rest
}

fn is_identifier_char(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

/// Converts a path in `module` to one from the crate root.
fn absolute(module: &Module, path: &[&str]) -> Module {
    let mut base = module.clone();
    for name in path {
        match *name {
            "crate" => base.clear(),
            "super" => drop(base.pop()),
            // A star stands for no name.
            "self" | "" => {}
            name => base.push(name.to_owned()),
        }
    }
    base
}

#[test]
fn imports_are_found_except_in_comments_and_tests() {
    let sources = [
        ("", "pub use low::Kept;"),
        ("low", "pub struct Kept;"),
        ("low/inside", "//! crate::high\nuse super::{other::{self, Part as Piece}, *};\n"),
        (
            "low/other",
            "fn f() { self::inside(); crate::high::call::<u8>() }\n#[cfg(test)]\nmod tests {\nuse crate::top;\n}",
        ),
        ("high", "use crate::{\n    Kept,\n    top::{A, B},\n};"),
        ("high/tests", "use crate::top;"),
        ("top", "#[cfg(test)]\nmod tests;\n\nuse std::fs;"),
    ];
    let module = |name: &str| name.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect::<Module>();
    let sources = sources.map(|(name, text)| (module(name), text.to_owned())).into();
    let found: Vec<String> =
        imports(&sources).iter().map(|(from, to)| format!("{} > {}", from.join("/"), to.join("/"))).collect();
    let wanted = ["high > low", "high > top", "low/inside > low", "low/inside > low/other", "low/other > high"];
    assert_eq!(found, wanted);
}
