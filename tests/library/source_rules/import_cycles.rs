//! Cycles of imports between the children of a folder.

use std::collections::{BTreeMap, BTreeSet};

use super::imports::Module;

/// Children of one folder that import each other in a cycle.
#[derive(Debug)]
pub struct Cycle {
    /// The folder and the children.
    pub name: String,
    /// The imports that form the cycle.
    pub imports: Vec<String>,
}

type Import = (Module, Module);

/// Returns all cycles that contain a folder; cycles of files alone do not count.
pub fn import_cycles(imports: &BTreeSet<Import>) -> Vec<Cycle> {
    let all = imports.iter().flat_map(|(from, to)| [from, to]);
    let folders: BTreeSet<&[String]> =
        all.clone().flat_map(|module| (0..module.len()).map(|end| &module[..end])).collect();
    let mut found = Vec::new();
    for folder in &folders {
        let between = imports_between_children(folder, imports);
        let mut left: BTreeSet<&str> = between.keys().copied().collect();
        while let Some(child) = left.pop_first() {
            let reachable = reachable(child, &between);
            let cycle: Vec<&str> =
                reachable.iter().copied().filter(|other| self::reachable(other, &between).contains(child)).collect();
            left.retain(|other| !cycle.contains(other));
            let is_folder = |name: &str| folders.contains(&[folder, &[name.to_owned()][..]].concat()[..]);
            if cycle.iter().any(|name| is_folder(name)) {
                found.push(describe_cycle(folder, &cycle, &between));
            }
        }
    }
    found
}

/// Returns which child of a folder imports which other child.
fn imports_between_children<'a>(
    folder: &[String],
    imports: &'a BTreeSet<Import>,
) -> BTreeMap<&'a str, BTreeMap<&'a str, Vec<&'a Import>>> {
    let mut found: BTreeMap<_, BTreeMap<_, Vec<_>>> = BTreeMap::new();
    for import in imports {
        let child = |module: &'a Module| module.strip_prefix(folder)?.first().map(String::as_str);
        if let (Some(one), Some(other)) = (child(&import.0), child(&import.1))
            && one != other
        {
            found.entry(one).or_default().entry(other).or_default().push(import);
        }
    }
    found
}

/// Returns all modules that a child imports, directly or indirectly.
fn reachable<'a>(child: &'a str, between: &BTreeMap<&'a str, BTreeMap<&'a str, Vec<&Import>>>) -> BTreeSet<&'a str> {
    let (mut found, mut open) = (BTreeSet::new(), vec![child]);
    while let Some(child) = open.pop() {
        let next = between.get(child).into_iter().flat_map(BTreeMap::keys);
        open.extend(next.filter(|next| found.insert(**next)));
    }
    found
}

fn describe_cycle(folder: &[String], cycle: &[&str], between: &BTreeMap<&str, BTreeMap<&str, Vec<&Import>>>) -> Cycle {
    let inside = |from: &&str| between[*from].iter().filter(|(to, _)| cycle.contains(*to)).flat_map(|(_, all)| all);
    let folder = if folder.is_empty() { "src".to_owned() } else { folder.join("/") };
    Cycle {
        name: format!("{folder}: {}", cycle.join(", ")),
        imports: cycle
            .iter()
            .flat_map(inside)
            .map(|(from, to)| format!("{} imports {}", from.join("/"), to.join("/")))
            .collect(),
    }
}

#[test]
fn cycles_that_contain_a_folder_are_found() {
    let module = |name: &str| name.split('/').map(str::to_owned).collect::<Module>();
    let import_cycles = |imports: &[(&str, &str)]| {
        import_cycles(&imports.iter().map(|(from, to)| (module(from), module(to))).collect())
    };
    let found =
        import_cycles(&[("a/x", "b"), ("b", "c/y"), ("c/z", "a/w"), ("a/w", "d"), ("e", "a"), ("f", "g"), ("g", "f")]);
    assert_eq!(found.len(), 1, "f and g are files: {found:?}");
    assert_eq!((found[0].name.as_str(), found[0].imports.len()), ("src: a, b, c", 3));
    assert!(import_cycles(&[("a/x", "b"), ("b", "c"), ("a/x", "c")]).is_empty());
    assert_eq!(import_cycles(&[("a/b/x", "a/c"), ("a/c", "a/b")])[0].name, "a: b, c");
}
