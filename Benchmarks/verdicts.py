# SPDX-License-Identifier: BSD-3-Clause
"""verdicts.py TABLE.csv... : prints whether what was measured keeps the design's goals. Tables are those
of raycast.sh --scaling, hexmesh.sh and hexmesh.sh --scaling; which is which is told by its columns."""

import sys

from tables import read

WORDS = {"renderer", "mesh", "note", "scene", "source"}
TIMES_TETRAHEDRA = 60.0  # faster than projected tetrahedra, a million cells
SETUP_SECONDS = 3.0  # of eight million cells
SETUP_MB = 500.0
SETUP_CELLS = 8e6
FIRST_FRAME_SECONDS = 5.0  # of 1024^3 samples, from a cold start
TIMES_LARGER = 2.0  # what 1024^3 samples may take of the time of 256^3
LARGE, SMALL = 1024, 256


def verdict(met):
    return "met" if met else "missed"


def row_of(what, measured, goal, met):
    return f"| {what} | {measured} | {goal} | {verdict(met)} |"


def hexahedra(rows):
    """hexmesh.csv: frames of each mesh against projected tetrahedra."""
    for cells in dict.fromkeys(row["cells"] for row in rows):
        times = {row["renderer"]: row["ms_per_frame"] for row in rows if row["cells"] == cells}
        peer = times.get("vtk-projected-tetrahedra")
        for name in ("banyan", "banyan-full"):
            if peer and times.get(name):
                ratio = peer / times[name]
                yield row_of(f"{cells:,.0f} hexahedra, {name}, times faster than projected tetrahedra",
                             f"{ratio:.0f}", f"{TIMES_TETRAHEDRA:.0f}", ratio >= TIMES_TETRAHEDRA)


def set_up(rows):
    """hexmesh-scaling.csv: meshes of eight million cells and more, by what their cells are more."""
    for row in rows:
        if row["cells"] >= SETUP_CELLS:
            seconds = row["find_s"] + row["bricks_s"] + row["values_s"]
            more = row["cells"] / SETUP_CELLS
            name = f"{row['cells']:,.0f} hexahedra ({row['mesh']}), set-up"
            yield row_of(f"{name}, s", f"{seconds:.2f}", f"below {SETUP_SECONDS * more:.1f}",
                         seconds < SETUP_SECONDS * more)
            yield row_of(f"{name}, MB", f"{row['memory_mb']:.0f}", f"below {SETUP_MB * more:.0f}",
                         row["memory_mb"] < SETUP_MB * more)


def volumes(rows):
    """raycast-scaling.csv: the largest series, and what it takes of the time of a small one."""
    sizes = {id(row): int(row["scene"].split("-")[1]) for row in rows}
    for row in rows:
        if sizes[id(row)] != LARGE:
            continue
        sampling = f"error {row['tolerance']:g}/255" if row["tolerance"] else "one sample per voxel"
        name = f"{LARGE}^3, {row['source']}, {row['threads']:g} thread(s), {sampling}"
        if row["source"] == "series":
            seconds = 1e-3 * row["first_frame_ms"]
            yield row_of(f"{name}: first frame, s", f"{seconds:.2f}", f"below {FIRST_FRAME_SECONDS:g}",
                         seconds < FIRST_FRAME_SECONDS)
        small = [other["ms_per_frame"] for other in rows if sizes[id(other)] == SMALL and all(
            other[key] == row[key] for key in ("source", "threads", "tolerance"))]
        if small and row["tolerance"]:
            ratio = row["ms_per_frame"] / small[0]
            yield row_of(f"{name}: later frames, times those of {SMALL}^3", f"{ratio:.2f}",
                         f"at most {TIMES_LARGER:g}", ratio <= TIMES_LARGER)


def lines_of(rows):
    """The verdicts of a table that read() gave."""
    if not rows:
        return []
    columns = rows[0].keys()
    judges = {"find_s": set_up, "setup_s": hexahedra, "budget_mib": volumes}
    return [line for column, judge in judges.items() if column in columns for line in judge(rows)]


def show(lines):
    """Prints a table, if there is anything in it."""
    if lines:
        print("\n".join(["| what | measured | goal | |", "|---|---|---|---|", *lines]))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    show([line for path in sys.argv[1:] for line in lines_of(read(path, WORDS))])
