# SPDX-License-Identifier: BSD-3-Clause
"""TestInspect.py info | verify: runs Utilities/info.sh and verify.sh from outside."""

import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPTS = os.path.join(HERE, "..", "..", "Utilities")


def run(script, *arguments):
    """Runs a script; returns its exit status, output and messages."""
    done = subprocess.run([os.path.join(SCRIPTS, script), *arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=120, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def expect(status, sentence, script, *arguments):
    """The script must end with a status and say a sentence, on either output."""
    found, output, messages = run(script, *arguments)
    check(found == status, f"{script} {arguments}: status {found}, {status} was expected:\n"
                           f"{output}{messages}")
    check(sentence in output + messages,
          f'{script} {arguments} did not say "{sentence}":\n{output}{messages}')


def make_cases(folder):
    environment = dict(os.environ, BANYAN_PLUGIN=os.path.join(
        os.environ["BANYAN_BUILD_DIR"], "lib", "Banyan", "Banyan.so"))
    subprocess.run(["pvpython", os.path.join(HERE, "make_verify_cases.py"), folder],
                   env=environment, timeout=120, check=True)


def test_verify(folder):
    def path(name):
        return os.path.join(folder, name)

    series, source = path("series.banyan"), [path(f"step_{step}.vti") for step in range(3)]
    expect(0, "PROVEN", "verify.sh", series, "--against", *source)
    expect(0, "PROVEN", "verify.sh", series, "--against", series)
    expect(0, "PROVEN", "verify.sh", path("hiding.banyan"), "--against", path("hiding_0.vti"),
           path("hiding_1.vti"))
    for name, mention in (("bits", "Worst: step 1 (time 1), i j k = 2 3 3, original 1.00000002e+20, decoded"),
                          ("cells", "vtkGhostType of cells: 1 value out of bound"),
                          ("bare", "vtkGhostType: 1 value out of bound")):
        expect(1, mention, "verify.sh", path("hiding.banyan"), "--against", path("hiding_0.vti"),
               path(f"hiding_{name}.vti"))
    expect(2, "the source has hidden points, and the series does not say which", "verify.sh", series, "--array", "heat",
           "--against", path("hiding_0.vti"))
    for kind in (".vts", ".vtr"):
        grid, grids = path(f"grid{kind}.banyan"), [path(f"grid_{step}{kind}") for step in range(3)]
        expect(0, "PROVEN", "verify.sh", grid, "--against", *grids)
        expect(0, "PROVEN", "verify.sh", grid, "--against", grid)
        expect(2, "At step 1 the points of the source differ from those of the series", "verify.sh", grid,
               "--against", grids[0], path("moved" + kind), grids[2])
        expect(2, "the source is an image, and the series is one of a", "verify.sh", grid, "--array", "heat",
               "--against", *source)
    status, output, messages = run("verify.sh", series, "--json", "--opacity", "0:0,10:1",
                                   "--against", *source)
    check(status == 0, messages)
    report = json.loads(output)
    names = [component["name"] for component in report["components"]]
    check(names == ["heat", "wind[0]", "wind[1]", "wind[2]"], names)
    heat = report["components"][0]
    check(heat["all"]["nonFinite"] == 3 and 0 < heat["all"]["maxError"] <= heat["bound"], heat)
    check(0 < heat["all"]["equation2"] < heat["all"]["equation1"], heat)

    def with_second(name):
        return [source[0], path(name), source[2]]

    # Point 55 of 12 x 11 x 6 is (7, 4, 0), in an extent that begins at (-2, 0, 3).
    expect(1, "heat: 1 value out of bound. Worst: step 1 (time 1), i j k = 5 4 3, original 400,",
           "verify.sh", series, "--against", *with_second("changed.vti"))
    expect(1, "Worst: step 1 (time 1), i j k = 3 1 3, original 0, decoded NaN", "verify.sh", series,
           "--against", *with_second("filled.vti"))
    expect(2, "The source ends after 2 time steps, and the series has 3", "verify.sh", series,
           "--against", *source[:2])
    expect(2, 'At step 0 the source has no array "wind"', "verify.sh", series, "--against",
           path("fewer.vti"))
    expect(2, 'The series has no array "cold"', "verify.sh", series, "--array", "cold", "--against",
           *source)
    expect(0, "PROVEN", "verify.sh", series, "--array", "heat", "--against", *source)
    expect(2, "does not exist", "verify.sh", series, "--against", path("none.vti"))
    expect(2, "--against is needed", "verify.sh", series)
    check(run("verify.sh", "--help")[0] == 0, "--help failed")


def test_verify_cells(folder):
    """A mesh of any cells, whose points move: the source, other points, and other cells."""
    series = os.path.join(folder, "mesh.vtu.banyan")
    meshes = [os.path.join(folder, f"mesh_{step}.vtu") for step in range(3)]
    expect(0, "PROVEN", "verify.sh", series, "--against", *meshes)
    for name, mention in (("moved", "coordinates of points"), ("turned", "corners of cells")):
        expect(2, f"At step 1 the {mention} of the source differ from the series", "verify.sh", series, "--against",
               meshes[0], os.path.join(folder, name + ".vtu"), meshes[2])


def test_info(folder):
    series = os.path.join(folder, "series.banyan")
    expect(0, "12 x 11 x 6 samples, 3 steps", "info.sh", series)
    status, output, messages = run("info.sh", series, "--json", "--step", "1")
    check(status == 0, messages)
    check(json.loads(output)["size"]["values"] == 12 * 11 * 6 * 3 * 4, output)
    expect(0, "the mesh, of cells of any type: ", "info.sh", os.path.join(folder, "mesh.vtu.banyan"))
    expect(0, "new at 1 step", "info.sh", os.path.join(folder, "mesh.vtu.banyan"))
    expect(0, "points of a curvilinear grid: ", "info.sh", os.path.join(folder, "grid.vts.banyan"))
    expect(0, "new at 2 steps", "info.sh", os.path.join(folder, "grid.vtr.banyan"))
    for kind, start in {"png": b"\x89PNG", "svg": b"<?xml", "csv": b"array,step,"}.items():
        figure = os.path.join(folder, "figure." + kind)
        status, _output, messages = run("info.sh", series, "--figure", figure)
        check(status == 0, messages)
        with open(figure, "rb") as file:
            check(file.read(len(start)) == start, f"{figure} is no {kind}")
    expect(1, "--figure writes", "info.sh", series, "--figure", "figure.bmp")
    expect(1, "--figure needs", "info.sh", series, "--figure")
    expect(1, "none.banyan", "info.sh", os.path.join(folder, "none.banyan"))
    check(run("info.sh", "--help")[0] == 0, "--help failed")


def main():
    cases = {"info": test_info, "verify": test_verify, "cells": test_verify_cells}
    with tempfile.TemporaryDirectory() as folder:
        make_cases(folder)
        cases[sys.argv[1]](folder)


main()
