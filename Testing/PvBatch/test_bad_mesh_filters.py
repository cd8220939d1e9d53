# SPDX-License-Identifier: BSD-3-Clause
"""Broken meshes in the filters and the writer: a sentence that says what is wrong and where, or a result; never a crash.

    test_bad_mesh_filters.py --plugin Banyan.so --out FOLDER
"""
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import bad_meshes
import session

# Fewer than a mesh, beside those of bad_meshes.
EMPTY = {
    "no_cells": ("del cells[:]", 0, None),
    "nothing": ("del cells[:]; del places[:]; del values[:]", 0, None),
}
# What octrees are refused with, where samples at boxes are not, or with something else.
NO_OCTREE = {"mixed": "Cell 7 is of the type vtkTetra", "mixed_bent": "Cell 7 is of the type vtkTetra",
             "nan_bent": "not finite", "infinite": "not finite", "twice": "Cells 5 and 36 overlap",
             "other_twice": "Cells 30 and 36 overlap"}
# What series cannot keep.
IMPOSSIBLE = ("out", "out_bent", "negative")


def said_by(work):
    window = vtkStringOutputWindow()
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        work()
        raised = ""
    except RuntimeError as error:  # ParaView's writers raise what they say
        raised = str(error)
    finally:
        vtkOutputWindow.SetInstance(before)
    return window.GetOutput() + raised


def check(what, said, expected):
    """@param expected a sentence, several, or None: nothing is said"""
    if expected is None:
        session.require(said == "", f"{what}: {said}")
    for sentence in [expected] if isinstance(expected, str) else expected or []:
        session.require(sentence in said, f"{what}: '{sentence}' was not said, but '{said}'")


def of_octrees(name, bent, said):
    if name in NO_OCTREE:
        return NO_OCTREE[name]
    return "Cell 0 is not an axis-aligned box" if bent else said


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.empty_folder(arguments.out)
    session.begin(arguments)
    for name, (broken, bent, said) in {**bad_meshes.CASES, **EMPTY}.items():
        source = bad_meshes.source(broken, bent)
        source.UpdatePipeline()
        path = os.path.join(arguments.out, name + ".banyan")
        octree = simple.BanyanHexOctree(Input=source)
        boxes = simple.BanyanHexOctree(Input=source, SampleGeneralMeshes=1)
        waves = simple.BanyanTemporalEnhancement(Input=source, Array=["POINTS", "value"])
        expected = of_octrees(name, bent, said)
        answer = said_by(octree.UpdatePipeline)
        check(f"{name}, octree", answer, expected)
        session.require(name != "flat" or "Sample General" not in answer, f"a way that is none: {answer}")
        check(f"{name}, boxes", said_by(boxes.UpdatePipeline), said)
        # Values are looked at alone, whatever the mesh is.
        check(f"{name}, waves", said_by(waves.UpdatePipeline), None)
        # Series keep any mesh as it is.
        expected = "The mesh has no cells" if name in EMPTY else said if name in IMPOSSIBLE else None
        check(f"{name}, series", said_by(lambda: simple.SaveData(path, proxy=source)), expected)
        session.require(os.path.exists(path) == (expected is None), f"{name}: there is a file, or none")
        session.clear()


main()
