# SPDX-License-Identifier: BSD-3-Clause
"""Meshes and hyper trees have the options of work on many ranks, and each of them gives the same picture.

    test_mesh_options.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
"""
import os

from paraview import simple

import pictures
import session
from random_trees import random_trees

SIZE = (200, 160)
BALANCING = ("Off", "Measured cost")
FIGURES = ("BytesMoved", "CacheHits", "CacheMisses", "CacheHitsAhead", "MessagesComposited",
           "BytesComposited", "BricksDrawn", "MeshBytes")
FRAMES = 3


def trees():
    return random_trees((4, 3, 3))


def mesh():
    """Of all ranks: the filter alone counts levels from the smallest cell of each piece."""
    return simple.BanyanHexOctree(Input=trees())


def show(make):
    source = make()
    source.UpdatePipeline()
    view = session.new_view(SIZE, CameraPosition=[9, 6, 8], CameraFocalPoint=[2, 1.5, 1.5],
                            CameraViewUp=[0, 1, 0])
    display = simple.Show(source, view)
    simple.ColorBy(display, ("CELLS", "Depth"))
    display.SetRepresentationType(session.REPRESENTATION)
    display.ScalarOpacityUnitDistance = 0.5
    display.SampleDistanceVoxels = 0.5  # not as errors are estimated
    return view, display


def draw(view, path):
    for _ in range(FRAMES):  # balancing goes by the frames before
        simple.Render(view)
    simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
    return pictures.load(path)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    for make in (trees, mesh):
        view, display = show(make)
        display.MaxElementsPerPixel = 0
        display.CompositeInFewBits = 0
        first = None
        for balancing in BALANCING:
            display.LoadBalancing = balancing
            name = f"{make.__name__}.{balancing}.png".replace(" ", "")
            picture = draw(view, os.path.join(arguments.out, name))
            if picture is None:  # of another rank than the root
                continue
            first = picture if first is None else first
            error = int(pictures.difference(first, picture).max())
            session.require(error <= 1, f"{name} differs by {error}")
            if arguments.reference:
                pictures.require_near(os.path.join(arguments.out, name),
                                      os.path.join(arguments.reference, name))
        display.UpdatePropertyInformation()
        figures = {name: display.GetPropertyValue(name) for name in FIGURES}
        print(make.__name__, figures, flush=True)
        for name, figure in figures.items():
            session.require(figure is not None, f"{name} is not told of {make.__name__}")
        session.require(figures["BricksDrawn"] > 0 and figures["MeshBytes"] > 0, "nothing was drawn")
        session.require(first is None or int(abs(first - first[0, 0]).max()) > 40, "an empty picture")
        session.clear()


main()
