# SPDX-License-Identifier: BSD-3-Clause
"""TestDocuments.py links | example | blocks: what the documents promise must be there, run and show."""

import fractions
import glob
import itertools
import os
import re
import subprocess
import sys
import tempfile

import numpy

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
HOWTO = os.path.join("Documentation", "howto", "draw-in-parallel.md")
sys.path.insert(0, os.path.join(ROOT, "Testing", "PvBatch"))

import pictures  # noqa: E402  the folder comes first


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def documents():
    patterns = ("*.md", "Documentation/**/*.md", "*/README.md", "Core/**/README.md", "Testing/**/README.md")
    return sorted({path for pattern in patterns
                   for path in glob.glob(os.path.join(ROOT, pattern), recursive=True)})


def anchors(path):
    """The headings of a document as links name them."""
    prose = re.sub(r"```.*?```", "", read(path), flags=re.S)
    titles = re.findall(r"^#+ +(.+?) *$", prose, re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def rows_of(header):
    """Name and words of each row of a table that is a macro: Kind(word, word, ..., "sentence")."""
    text = read(os.path.join(ROOT, "Rendering", header))
    table = re.search(r"#define BANYAN_\w+\((?:\w+, )*\w+\) *\\\n((?:.*\\\n)+.*)", text)
    for kind, text in re.findall(r"\b([A-Z][a-z]+)\(([^\"()]*),[ \\\n]*\"", table.group(1)):
        words = re.split(r", *", text)
        yield words[1 if kind == "Number" else 0], kind, words


def number(text):
    return {"off": 0, "on": 1, "false": 0, "true": 1}.get(text) if text.isalpha() else fractions.Fraction(text)


def check_tables():
    """Statistics and settings have a row in the how-to, settings with the default that they have."""
    rows = re.findall(r"^\| (`.*?`) \| (?:(.*?) \| )?.* \|$", read(os.path.join(ROOT, HOWTO)), re.M)
    told = {name: value for names, values in rows
            for name, value in itertools.zip_longest(names.replace("`", "").split(", "), values.split(", "))}
    problems = []
    default_at = {"Real": 2, "Whole": 2, "Switch": 1}
    for header, least in (("vtkBanyanFrameStatistics.h", 20), ("vtkBanyanVolumeMapper.h", 10)):
        found = list(rows_of(header))
        if len(found) < least:
            problems.append(f"{header} has hardly any rows; has the table's form changed?")
        for name, kind, words in found:
            if name not in told:
                problems.append(f"{HOWTO} has no row for {name}, which {header} has")
            elif kind in default_at and number(told[name]) != number(words[default_at[kind]]):
                default = words[default_at[kind]]
                problems.append(f"{HOWTO}: the default of {name} is {told[name]}, in {header} {default}")
    return problems


def check_links():
    """Links lead to a file and a heading; papers.md and the how-to's tables name what exists."""
    problems = []
    for path in documents():
        for target, heading in re.findall(r"\]\(([^)#:\s]*)(?:#([^)\s]+))?\)", read(path)):
            file = os.path.join(os.path.dirname(path), target) if target else path
            if not os.path.exists(file):
                problems.append(f"{path}: the link {target} leads nowhere")
            elif heading and heading not in anchors(file):
                problems.append(f"{path}: {target or 'the document'} has no heading {heading}")
    names = 0
    for line in read(os.path.join(ROOT, "Documentation", "papers.md")).splitlines():
        source = None
        for word in re.findall(r"`([^`]+)`", line):
            if "/" in word:
                source = os.path.join(ROOT, word)
                if not os.path.isfile(source):
                    problems.append(f"papers.md: there is no file {word}")
                    source = None
            elif source and not re.search(rf"\b{word.split('::')[-1]}\b", read(source)):
                problems.append(f"papers.md: {source} has no {word}")
            names += 1
    if names < 20:
        problems.append("papers.md names hardly anything; has its form changed?")
    problems += check_tables()
    sys.exit("\n".join(problems) or 0)


def python_blocks(path):
    return re.findall(r"```python\n(.*?)```", read(path), re.S)


def run_ranks(ranks, script, folder):
    """Runs a script as the README says, on so many ranks."""
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_btl_vader_single_copy_mechanism="none")
    subprocess.run([os.path.join(ROOT, "Utilities", "with-display.sh"), "mpiexec", "--oversubscribe",
                    "-n", str(ranks), "pvbatch", script], cwd=folder, check=True, timeout=200,
                   env=environment)


def generate(folder, *arguments):
    """The build of this test beside what banyan-generate makes, as the documents have it."""
    if not os.path.exists(os.path.join(folder, "build")):
        os.symlink(os.environ["BANYAN_BUILD_DIR"], os.path.join(folder, "build"))
    subprocess.run(["build/bin/banyan-generate", *arguments], cwd=folder, check=True, timeout=60)


def check_frame(frame, name):
    """The volume is there, whole and in the middle."""
    height, width, _ = frame.shape
    seen = pictures.difference(frame, numpy.broadcast_to(frame[-1, -1], frame.shape)) > 8
    seen[:height // 5, :width // 8] = False  # the orientation axes
    rows, columns = numpy.flatnonzero(seen.any(axis=1)), numpy.flatnonzero(seen.any(axis=0))
    if len(rows) == 0:
        sys.exit(f"{name} is blank")
    for low, high, size in ((rows[0], rows[-1], height), (columns[0], columns[-1], width)):
        if low < size // 50 or high >= size - size // 50:
            sys.exit(f"{name} is cut: what is seen goes from {low} to {high} of {size}")
        if abs(low + high - size) > size // 10:
            sys.exit(f"{name} is not in the middle: {low} to {high} of {size}")
    if rows[-1] - rows[0] < height // 3:
        sys.exit(f"{name} shows hardly anything: rows {rows[0]} to {rows[-1]} of {height}")


def run_example():
    """The README's example, word by word, on one rank and on three; its frames show the volume."""
    example = python_blocks(os.path.join(ROOT, "README.md"))
    if len(example) != 1:
        sys.exit(f"README.md has {len(example)} examples, 1 was expected")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "example.py"), "w", encoding="utf-8") as file:
            file.write(example[0])
        generate(folder, "--output", "flow", "--size", "24", "--steps", "3")
        names = ["frame.0000.png", "frame.0001.png", "frame.0002.png"]
        frames = []
        for ranks in (1, 3):
            run_ranks(ranks, "example.py", folder)
            made = sorted(os.listdir(folder))
            if not {"flow.banyan", "flow.banyan.d", *names} <= set(made):
                sys.exit(f"the example left {made} on {ranks} rank(s)")
            frames.append([pictures.load(os.path.join(folder, name)) for name in names])
            for name, frame in zip(names, frames[-1]):
                check_frame(frame, f"{name} of {ranks} rank(s)")
                os.remove(os.path.join(folder, name))
            if (pictures.difference(frames[-1][0], frames[-1][2]) > 8).sum() < 500:
                sys.exit("the first frame and the last one are the same")
        for name, one, three in zip(names, *frames):
            # ParaView smooths edges that it finds by thresholds: single pixels may differ.
            if (pictures.difference(one, three) > 1).sum() > 20:
                sys.exit(f"{name} of three ranks is not that of one")


BEFORE_BLOCKS = """
import os
from paraview.simple import *
LoadPlugin(os.path.abspath("build/lib/Banyan/Banyan.so"), ns=globals())
source = OpenDataFile("flow/flow.vti.series")
SaveData("name.banyan", proxy=source, WriteTimeSteps=1)
series = OpenDataFile("name.banyan")
"""


def run_blocks():
    """Each Python block of the how-tos as it stands, with no more than a source and a series before it."""
    script = ["import paraview.simple as harness", "before = {}", f"exec({BEFORE_BLOCKS!r}, before)"]
    for path in sorted(glob.glob(os.path.join(ROOT, "Documentation", "howto", "*.md"))):
        for number, block in enumerate(python_blocks(path)):
            place = f"{os.path.basename(path)}, block {number}"
            script += [f"print({place!r}, flush=True)", "space = dict(before)",
                       f"exec(compile({block!r}, {place!r}, 'exec'), space)"]
            if "Show(" in block:
                script += [f"harness.SaveScreenshot({place + '.png'!r}, harness.GetActiveView())",
                           "for view in harness.GetRenderViews(): harness.Delete(view)"]
    if len(script) < 5 * 4:
        sys.exit("the how-tos have hardly any blocks; has their form changed?")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "blocks.py"), "w", encoding="utf-8") as file:
            file.write("\n".join(script))
        generate(folder, "--output", "flow", "--size", "16", "--steps", "3")
        generate(folder, "--series", "earthquake", "--cells", "1000", "--steps", "3", "--output", "quake")
        os.rename(glob.glob(os.path.join(folder, "quake", "*.exo"))[0], os.path.join(folder, "quake.exo"))
        run_ranks(1, "blocks.py", folder)
        shown = glob.glob(os.path.join(folder, "*, block *.png"))
        if not shown:
            sys.exit("no block shows anything")
        for path in shown:
            check_frame(pictures.load(path), os.path.basename(path))


{"links": check_links, "example": run_example, "blocks": run_blocks}[sys.argv[1]]()
