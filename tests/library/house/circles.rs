//! Cycles of imports between the children of a folder.

use std::collections::{BTreeMap, BTreeSet};

use super::imports::Module;

/// Children of one folder that import each other in a cycle.
#[derive(Debug)]
pub struct Circle {
    /// The folder and the children.
    pub name: String,
    /// The imports that form the cycle.
    pub imports: Vec<String>,
}

type Import = (Module, Module);

/// Returns all cycles that contain a folder; cycles of files alone do not count.
pub fn circles(imports: &BTreeSet<Import>) -> Vec<Circle> {
    let all = imports.iter().flat_map(|(from, to)| [from, to]);
    let folders: BTreeSet<&[String]> =
        all.clone().flat_map(|module| (0..module.len()).map(|end| &module[..end])).collect();
    let mut found = Vec::new();
    for folder in &folders {
        let between = between(folder, imports);
        let mut left: BTreeSet<&str> = between.keys().copied().collect();
        while let Some(child) = left.pop_first() {
            let reached = reached(child, &between);
            let circle: Vec<&str> =
                reached.iter().copied().filter(|other| self::reached(other, &between).contains(child)).collect();
            left.retain(|other| !circle.contains(other));
            let is_folder = |name: &str| folders.contains(&[folder, &[name.to_owned()][..]].concat()[..]);
            if circle.iter().any(|name| is_folder(name)) {
                found.push(told(folder, &circle, &between));
            }
        }
    }
    found
}

/// Returns which child of a folder imports which other child.
fn between<'a>(
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
fn reached<'a>(child: &'a str, between: &BTreeMap<&'a str, BTreeMap<&'a str, Vec<&Import>>>) -> BTreeSet<&'a str> {
    let (mut found, mut open) = (BTreeSet::new(), vec![child]);
    while let Some(child) = open.pop() {
        let next = between.get(child).into_iter().flat_map(BTreeMap::keys);
        open.extend(next.filter(|next| found.insert(**next)));
    }
    found
}

fn told(folder: &[String], circle: &[&str], between: &BTreeMap<&str, BTreeMap<&str, Vec<&Import>>>) -> Circle {
    let inside = |from: &&str| between[*from].iter().filter(|(to, _)| circle.contains(*to)).flat_map(|(_, all)| all);
    let folder = if folder.is_empty() { "src".to_owned() } else { folder.join("/") };
    Circle {
        name: format!("{folder}: {}", circle.join(", ")),
        imports: circle
            .iter()
            .flat_map(inside)
            .map(|(from, to)| format!("{} imports {}", from.join("/"), to.join("/")))
            .collect(),
    }
}

#[test]
fn a_circle_is_found_where_a_folder_is_in_it() {
    let module = |name: &str| name.split('/').map(str::to_owned).collect::<Module>();
    let circles =
        |imports: &[(&str, &str)]| circles(&imports.iter().map(|(from, to)| (module(from), module(to))).collect());
    let found =
        circles(&[("a/x", "b"), ("b", "c/y"), ("c/z", "a/w"), ("a/w", "d"), ("e", "a"), ("f", "g"), ("g", "f")]);
    assert_eq!(found.len(), 1, "f and g are files: {found:?}");
    assert_eq!((found[0].name.as_str(), found[0].imports.len()), ("src: a, b, c", 3));
    assert!(circles(&[("a/x", "b"), ("b", "c"), ("a/x", "c")]).is_empty());
    assert_eq!(circles(&[("a/b/x", "a/c"), ("a/c", "a/b")])[0].name, "a: b, c");
}
