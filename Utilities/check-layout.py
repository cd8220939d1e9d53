#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the layout of the sources: lines per file, function and class, sources per folder, and that
a page names each header. The limits are those of CONTRIBUTING.md.

  check-layout.py [--list]     --list prints the largest of each kind, too
"""
import collections
import os
import re
import subprocess
import sys

MOST_IN_FILE, MOST_IN_FUNCTION, MOST_IN_CLASS, MOST_IN_FOLDER = 450, 60, 400, 45
FOLDERS = ["Core", "Inputs", "Filters", "Readers", "Rendering", "Representations", "Programs"]
# A line that opens no function, and those that end what stands before one.
NO_FUNCTION = re.compile(r"\b(class|struct|union|enum|namespace)\b[^()]*$|^#|=$")


def functions(lines):
    """Yields (signature, lines) of each function whose braces stand alone at the same column."""
    at = 0
    while at < len(lines):
        opening = re.match(r"( {0,2})\{$", lines[at])
        first = at
        while opening and first > 0 and re.match(r"[^#}\s].*|\s+\S.*", lines[first - 1]):
            first -= 1
        code = [line for line in lines[first:at] if not re.match(r"\s*(//|/\*|\*)", line)]
        signature = " ".join(line.strip() for line in code)
        if opening and ")" in signature and not NO_FUNCTION.search(signature):
            closing = at
            while closing < len(lines) and lines[closing] != opening.group(1) + "}":
                closing += 1
            yield signature, closing - at + 1 + len(code)
            at = closing
        at += 1


def pages_of(folder):
    """Yields the README.md of a folder, and those of the folders above it."""
    while folder:
        if os.path.exists(os.path.join(folder, "README.md")):
            yield os.path.join(folder, "README.md")
        folder = os.path.dirname(folder)


def names_it(page, name):
    with open(page, encoding="utf-8") as text:
        return re.sub(r"(-inl)?\.h$", "", os.path.basename(name)) in text.read()


def main():
    listed = subprocess.run(["git", "ls-files", *FOLDERS], check=True, capture_output=True, text=True)
    names = [name for name in listed.stdout.split() if name.endswith((".h", ".cxx"))]
    per_file, per_function = collections.Counter(), collections.Counter()
    per_class, per_folder = collections.Counter(), collections.Counter()
    unnamed = []
    for name in names:
        with open(name, encoding="utf-8") as source:
            lines = source.read().split("\n")
        per_file[name] = len(lines) - 1
        per_folder[os.path.dirname(name)] += 1
        for signature, count in functions(lines):
            per_function[f"{name}: {signature[:70]}"] = count
            owner = re.search(r"(\w+)::~?\w+\s*\(", signature)
            if owner and name.endswith(".cxx"):
                per_class[owner.group(1)] += count
        pages = list(pages_of(os.path.dirname(name)))
        if name.endswith(".h") and not any(names_it(page, name) for page in pages):
            unnamed.append(f"{name} is in the table of no README.md of its folders.")
    del per_class["std"]
    faults = unnamed
    for counts, most, what in [(per_file, MOST_IN_FILE, "lines"),
                               (per_function, MOST_IN_FUNCTION, "lines"),
                               (per_class, MOST_IN_CLASS, "lines in its functions"),
                               (per_folder, MOST_IN_FOLDER, "sources")]:
        if "--list" in sys.argv:
            print(*(f"{count:6} {what}: {name}" for name, count in counts.most_common(5)), sep="\n")
        faults += [f"{name} has {count} {what}; at most {most} are allowed."
                   for name, count in counts.items() if count > most]
    print(*faults, sep="\n", end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
