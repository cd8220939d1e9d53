#!/usr/bin/env bash
# Checks the sentences of the documents: none has over 40 words, and none starts with "Of", "Those",
# "What" or "As". Code, headings and Documentation/measurements/ are left out; a question may start with "What".
#   check-prose.sh [FILES]           all documents when none are given
#   check-prose.sh --count [FILES]   prints words, sentences and words per sentence, and checks nothing
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

if [[ "${1:-}" == --help ]]; then
  sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
options=()
if [[ "${1:-}" == --count ]]; then
  options=(--count)
  shift
fi
files=("$@")
if [[ ${#files[@]} == 0 ]]; then
  cd "$RepositoryRoot"
  mapfile -t files < <(git ls-files --cached --others --exclude-standard '*.md' |
    grep -v '^Documentation/measurements/')
fi

python3 - "${options[@]}" "${files[@]}" <<'PYTHON'
import re
import sys

LONGEST = 40
FORBIDDEN = re.compile(r"(Of|Those|What|As)\b")
ABBREVIATIONS = re.compile(r"\b(e\.g|i\.e|cf|vs|etc|al|Fig|Figs|Eq|Sec|Vol|No|pp?|approx|St)\.(?=\s)")
LIST_ITEM = re.compile(r"\s*([-*+]|\d+[.)])\s+")
TABLE_RULE = re.compile(r"\s*\|?[\s:|-]*-[\s:|-]*\|[\s:|-]*$")


def plain(text):
    """Without marks: an image is nothing, a link is its text, code and an address are one word each."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"``.+?``|`[^`]*`", "Code", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"<[^>]+>|https?://\S+", "Address", text)
    return ABBREVIATIONS.sub(r"\1", text.replace("*", "").replace("_", " "))


def cells(line):
    """The cells of a row of a table; a bar inside code or behind a backslash is part of a cell."""
    line = re.sub(r"`[^`]*`", lambda code: code[0].replace("|", " "), line).replace("\\|", " ")
    return line.strip().strip("|").split("|")


def paragraphs(lines):
    """Yields the number of the first line and the text of each paragraph, list item and table cell."""
    start, parts, fence, in_list = 0, [], None, False
    for number, line in enumerate(lines + [""], 1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        bare = re.sub(r"^\s*>\s?", "", line)
        item = LIST_ITEM.match(bare)
        code = line.startswith("    ") and not parts and not item and not in_list
        is_break = fence or mark or code or item or not bare.strip() or bare.lstrip().startswith(("#", "|", "<!--"))
        if is_break and parts:
            yield start, " ".join(parts)
            parts = []
        if mark:
            fence = None if fence else mark[1]
        elif fence or code:
            pass
        elif item:
            start, parts, in_list = number, [bare[item.end():]], True
        elif bare.lstrip().startswith("|"):
            following = lines[number] if number < len(lines) else ""
            if not TABLE_RULE.match(bare) and not TABLE_RULE.match(following):
                for cell in cells(bare):
                    yield number, cell
        elif not is_break:
            if not parts:
                start, in_list = number, in_list and line.startswith(" ")
            parts.append(bare.strip())


def sentences(text):
    return re.split(r"(?<=[.!?])[)\"']*\s+(?=[(\"'\[]*[A-Z0-9])", plain(text).strip())


counting = sys.argv[1] == "--count"
faults = 0
for path in sys.argv[1 + counting:]:
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    lengths = []
    for number, text in paragraphs(lines):
        for sentence in sentences(text):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            lengths.append(len(words))
            begin = re.sub(r"^\W+", "", sentence)
            if counting or not words:
                continue
            shown = " ".join(words[:12])
            if len(words) > LONGEST:
                print(f"{path}:{number}: a sentence of {len(words)} words: {shown} ...")
                faults += 1
            if FORBIDDEN.match(begin) and not sentence.rstrip(")\"'").endswith("?"):
                print(f"{path}:{number}: a sentence starts with \"{FORBIDDEN.match(begin)[1]}\": {shown} ...")
                faults += 1
    if counting:
        full = [length for length in lengths if length > 3]
        print(f"{sum(lengths):7} words {len(full):5} sentences {sum(full) / max(1, len(full)):5.1f} words each  {path}")
sys.exit(1 if faults else 0)
PYTHON
