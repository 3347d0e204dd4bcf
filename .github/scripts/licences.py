#!/usr/bin/env python3
"""Writes the licences of all components of the program: names, versions, licences and their texts, each text once.

Usage: licences.py > FILE. It needs cargo and the sources of the dependencies, which cargo fetches.
"""

import json
import pathlib
import subprocess
import sys

# Names of files that contain a licence text.
TEXTS = ("LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE")

# Data of others that the program contains.
FILMED = pathlib.Path("tests/data/filmed")


def linked(metadata):
    """Returns the packages that the program links on any system: no build tools, no derive macros, not the program itself."""
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
    """Yields the licence texts in a folder, including those of bundled C sources."""
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
