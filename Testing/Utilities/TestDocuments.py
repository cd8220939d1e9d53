"""TestDocuments.py links | example: what the documents promise must be there, and must run."""

import glob
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def documents():
    return [path for pattern in ("*.md", "Documentation/**/*.md", "*/README.md")
            for path in glob.glob(os.path.join(ROOT, pattern), recursive=True)]


def check_links():
    """Links to files lead somewhere, and papers.md names files and functions that exist."""
    problems = []
    for path in documents():
        for target in re.findall(r"\]\(([^)#:]+)\)", read(path)):
            if not os.path.exists(os.path.join(os.path.dirname(path), target)):
                problems.append(f"{path}: the link {target} leads nowhere")
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
    sys.exit("\n".join(problems) or 0)


def run_example():
    """The README's example, word by word, on two ranks."""
    build = os.environ["BANYAN_BUILD_DIR"]
    example = re.findall(r"```python\n(.*?)```", read(os.path.join(ROOT, "README.md")), re.S)
    if len(example) != 1:
        sys.exit(f"README.md has {len(example)} examples, 1 was expected")
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(build, os.path.join(folder, "build"))
        with open(os.path.join(folder, "example.py"), "w", encoding="utf-8") as file:
            file.write(example[0])
        subprocess.run(["build/bin/banyan-generate", "--output", "flow", "--size", "24", "--steps",
                        "3"], cwd=folder, check=True, timeout=60)
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                           OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                           OMPI_MCA_rmaps_base_oversubscribe="1",
                           OMPI_MCA_btl_vader_single_copy_mechanism="none")
        subprocess.run([os.path.join(ROOT, "Utilities", "with-display.sh"), "mpiexec", "-n", "2",
                        "pvbatch", "example.py"], cwd=folder, check=True, timeout=200,
                       env=environment)
        made = sorted(os.listdir(folder))
        wanted = ["flow.banyan", "flow.banyan.d", "frame.0000.png", "frame.0001.png",
                  "frame.0002.png"]
        if not set(wanted) <= set(made):
            sys.exit(f"the example left {made}, and {wanted} were expected")


{"links": check_links, "example": run_example}[sys.argv[1]]()
