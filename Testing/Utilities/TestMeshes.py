# SPDX-License-Identifier: BSD-3-Clause
"""TestMeshes.py kinds | script : the meshes of Benchmarks/Meshes/make_mesh.py, and meshes.sh on tiny ones."""

import collections
import csv
import os
import subprocess
import sys
import tempfile

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
BENCHMARKS = os.path.join(HERE, "..", "..", "Benchmarks")
sys.path.append(os.path.join(BENCHMARKS, "Meshes"))
import make_mesh  # noqa: E402 (its folder had to be named first)

BUILD = os.environ["BANYAN_BUILD_DIR"]
# Corners of faces, seen from outside: of a tetrahedron, hexahedron, wedge and pyramid.
FACES = {
    10: ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    12: ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    13: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    14: ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
}
CELLS = {("hexahedra", 3): {12: 27}, ("tetrahedra", 3): {10: 162},
         ("mixed", 5): {12: 25, 14: 250, 13: 50, 10: 250}}


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def cells_of(mesh):
    """The type and the ids of each cell."""
    for cell, number in enumerate(mesh["types"]):
        yield int(number), mesh["ids"][mesh["offsets"][cell]:mesh["offsets"][cell + 1]]


def outward(points, face):
    """Twice the area of a face along its normal, and its middle."""
    corners = points[face]
    rest = corners[1:] - corners[0]
    return sum(numpy.cross(a, b) for a, b in zip(rest[:-1], rest[1:])), corners.mean(axis=0)


def check_kind(kind, n):
    points, mesh = make_mesh.cut(kind, n, make_mesh.lattice(n))
    found = collections.Counter(number for number, _ in cells_of(mesh))
    check(found == CELLS[kind, n], f"{kind}: {dict(found)}")
    owners, volume = collections.Counter(), 0.0
    for number, ids in cells_of(mesh):
        own = 0.0
        for corners in FACES[number]:
            face = ids[list(corners)]
            normal, middle = outward(points, face)
            own += normal @ middle / 6.0
            owners[tuple(sorted(face))] += 1
        check(own > 1e-6, f"{kind}: a cell of the type {number} has the volume {own}")
        volume += own
    check(abs(volume - 1.0) < 1e-9, f"{kind}: the cells fill {volume} of the cube")
    check(max(owners.values()) == 2, f"{kind}: a face has {max(owners.values())} cells")
    for face, count in owners.items():
        outside = numpy.isclose(points[list(face)], 0.0).all(axis=0) | numpy.isclose(points[list(face)], 1.0).all(axis=0)
        check((count == 1) == outside.any(), f"{kind}: a face of {count} cells is at {points[list(face)]}")


def check_warp():
    """Points move, but not far, and neighbours do not move alike."""
    flat, n = make_mesh.lattice(8), 8
    moved = make_mesh.warped(flat, n) - flat
    largest = make_mesh.BEND + make_mesh.SHAKE / n
    check(abs(moved).max() <= largest, f"a point moved by {abs(moved).max()}")
    shaken = [make_mesh.random_numbers(len(flat), axis) for axis in range(3)]
    for numbers in shaken:
        check(abs(numbers).max() <= 1 and numbers.std() > 0.5 and abs(numbers.mean()) < 0.1, "the numbers are not random")
    together = numpy.corrcoef(shaken)[numpy.triu_indices(3, 1)]
    check(abs(together).max() < 0.2, f"axes move together: {together}")
    cubes, grid = make_mesh.made("hexahedra", n), make_mesh.made("curvilinear", n)
    check(all((cubes[name] == grid[name]).all() for name in ("points", "values")), "the structured grid is another mesh")


def check_field(folder):
    """The values of the generator, at the points of a lattice."""
    raw, n = os.path.join(folder, "field.raw"), 15
    subprocess.run([os.path.join(BUILD, "bin", "banyan-generate"), "--series", "standard", "--size", str(n + 1), "--raw", raw],
                   check=True, timeout=60)
    off = abs(make_mesh.standard_field(make_mesh.lattice(n)) - numpy.fromfile(raw, "<f4")).max()
    check(off < 1e-6, f"the field is off by {off}")


def run(folder, *arguments):
    """The exit status, the rows of the table, and what was said."""
    done = subprocess.run([os.path.join(BENCHMARKS, "meshes.sh"), "--output", folder, "--work", os.path.join(folder, "work"),
                           *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=280, check=False)
    rows = []
    if os.path.exists(os.path.join(folder, "meshes.csv")):
        with open(os.path.join(folder, "meshes.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    return done.returncode, rows, done.stdout


def check_script(folder):
    tiny = ("--meshes", "hexahedra-6", "--pixels", "64")
    status, _, said = run(folder, "--meshes", "octahedra-6")
    check(status == 1 and "there is no mesh 'octahedra-6'" in said, said)
    status, rows, said = run(folder, *tiny, "--renderers", "banyan,paraview-projected-tetra", "--tolerances", "0,4")
    check(status == 0, said)
    names = [(row["mesh"], row["cells"], row["renderer"], row["tolerance"]) for row in rows]
    check(names == [("hexahedra-6", "216", "banyan", "0"), ("hexahedra-6", "216", "banyan", "4"),
                    ("hexahedra-6", "216", "paraview-projected-tetra", "")], f"{names}\n{said}")
    for row in rows:
        check(float(row["psnr_db"]) > 30 and 0 <= int(row["max_error"]) <= 64, f"another picture: {row}\n{said}")
        check(float(row["ms_per_frame"]) > 0 and float(row["memory_mb"]) > 0, f"{row}\n{said}")
        check(abs(float(row["first_frame_s"]) - float(row["setup_s"]) - 1e-3 * float(row["ms_per_frame"])) < 1e-3
              or float(row["setup_s"]) == 0, f"{row}\n{said}")
    check(os.path.getsize(os.path.join(folder, "meshes.png")) > 0 and "| hexahedra-6 | 216 |" in said, said)
    # Neither is enough for ParaView; rows that lack numbers have a note.
    for option, note in (("--limit", "more than 1 s"), ("--memory", "failed with 1 GB: ")):
        status, rows, said = run(folder, *tiny, "--renderers", "paraview-bunyk", option, "1")
        check(status == 0 and len(rows) == 1 and rows[0]["renderer"] == "paraview-bunyk", f"{rows}\n{said}")
        check(rows[0]["ms_per_frame"] == rows[0]["psnr_db"] == "" and rows[0]["cells"] == "216", f"{rows}\n{said}")
        check(note in said, said)


with tempfile.TemporaryDirectory() as scratch:
    if sys.argv[1] == "kinds":
        for named in CELLS:
            check_kind(*named)
        check_warp()
        check_field(scratch)
        print("the meshes are what they are said to be")
    else:
        check_script(scratch)
        print("there is a row for each picture, or a note")
