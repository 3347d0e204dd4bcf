#!/usr/bin/env python3
"""Writes the licences of everything that is in the program: names, versions, licences and their texts, each text once.

Use: licences.py > FILE. It needs cargo and the sources of the dependencies, which cargo fetches.
"""

import json
import pathlib
import subprocess
import sys

# What files with a licence's text are called.
TEXTS = ("LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE")

# Data of others that the program holds.
FILMED = pathlib.Path("tests/data/filmed")


def linked(metadata):
    """The packages that the program links, on any system: no tools of the build, no derivations, not the program itself."""
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    root = metadata["resolve"]["root"]
    seen, left = {root}, [root]
    while left:
        for dependency in nodes[left.pop()]["deps"]:
            name = dependency["pkg"]
            is_linked = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            is_derivation = any("proc-macro" in target["kind"] for target in packages[name]["targets"])
            if is_linked and not is_derivation and name not in seen:
                seen.add(name)
                left.append(name)
    return sorted((packages[name] for name in seen - {root}), key=lambda package: (package["name"], package["version"]))


def texts(folder):
    """The texts of the licences in a folder, those of C sources that a package brings along too."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name.upper().startswith(TEXTS) and path.suffix.lower() in ("", ".md", ".txt"):
            yield path.read_text(errors="replace").replace("\r\n", "\n").strip()


def main():
    sys.stdout.reconfigure(encoding="utf-8", newline="\n")
    command = ["cargo", "metadata", "--locked", "--format-version", "1"]
    packages = linked(json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout))
    print("carom is made of these, and of Rust's standard library (MIT OR Apache-2.0); static programs for Linux of musl (MIT), too.\n")
    of_text = {}
    for package in packages:
        name = f"{package['name']} {package['version']}"
        print(f"{name}: {package['license']}")
        for text in texts(pathlib.Path(package["manifest_path"]).parent):
            of_text.setdefault(text, []).append(name)
        if not package["license"]:
            sys.exit(f"{name} names no licence")
    print(f"the filmed shots of {FILMED}: Apache-2.0")
    for text in texts(FILMED):
        of_text.setdefault(text, []).append("the filmed shots")
    for text, names in of_text.items():
        print(f"\n{'=' * 80}\n{', '.join(dict.fromkeys(names))}\n{'=' * 80}\n\n{text}")


main()
