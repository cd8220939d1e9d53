# SPDX-License-Identifier: BSD-3-Clause
"""Broken meshes at default options end in a sentence, or in the picture of what is sound in them: never in a crash.

    test_bad_meshes.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
"""
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import bad_meshes
import pictures
import session

# Of these the picture is that of a sound mesh.
LIKE = {"inverted": "good", "tangled": "good", "duplicate": "good", "other_twice": "twice",
        "inverted_bent": "good_bent", "twice_bent": "good_bent", "duplicate_bent": "good_bent", "unused": "good_bent"}
EMPTY = ("no_values",)
# A filter refuses these, but what is sound in them is drawn, and this is said beside the picture.
SAID = {"nan": "coordinates are not finite", "nan_bent": "coordinates are not finite",
        "infinite": "coordinates are not finite", "flat": "all corners lie in a plane",
        "flat_bent": "all corners lie in a plane",
        "twice": "1 cell has the corners of another one", "twice_bent": "1 cell has the corners of another one",
        "other_twice": "1 cell has the corners of another one", "tangled_bent": "folded over at a corner",
        "mixed": "of the type vtkVertex", "mixed_bent": "of the type vtkVertex"}


def draw(broken, bent, path):
    """@return what was said meanwhile"""
    source = bad_meshes.source(broken, bent)
    window = vtkStringOutputWindow()
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        view = session.new_view((200, 200))
        display = simple.Show(source, view)
        simple.ColorBy(display, ("POINTS", "value"))
        display.SetRepresentationType(session.REPRESENTATION)
        simple.GetColorTransferFunction("value").RescaleTransferFunction(0, 15)
        simple.GetOpacityTransferFunction("value").RescaleTransferFunction(0, 15)
        display.ScalarOpacityUnitDistance = 2.0
        view.CameraPosition, view.CameraFocalPoint = [9, -6, 7], [2, 1.5, 1.5]
        view.StillRender()  # simple.Render moves the camera of the first view
        simple.SaveScreenshot(path, view)
    finally:
        vtkOutputWindow.SetInstance(before)
    session.clear()
    return window.GetOutput()


def check(name, said, path):
    expected = [SAID[name]] if name in SAID else bad_meshes.CASES[name][2]
    refused = isinstance(expected, str)
    picture = pictures.load(path).astype(int)
    empty = abs(picture - picture[0, 0]).max() == 0
    session.require(("was not drawn" in said) == refused, f"{name}: {said}")
    session.require(empty == (refused or name in EMPTY), f"{name}: empty is {empty}")
    for sentence in [expected] if refused else expected or []:
        session.require(sentence in said, f"{name}: '{sentence}' was not said, but '{said}'")
    session.require("Rank 0: Rank" not in said, f"{name}: ranks are named twice: {said}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    for name, (broken, bent, _) in bad_meshes.CASES.items():
        path = os.path.join(arguments.out, name + ".png")
        said = draw(broken, bent, path)
        print(f"{name}: {said}", flush=True)
        check(name, said, path)
        if name in LIKE:
            pictures.require_near(path, os.path.join(arguments.out, LIKE[name] + ".png"))
        if arguments.reference:
            pictures.require_near(path, os.path.join(arguments.reference, name + ".png"))


main()
