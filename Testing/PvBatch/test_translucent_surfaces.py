# SPDX-License-Identifier: BSD-3-Clause
"""Translucent surfaces through a volume, whose pieces are on all ranks, with an opaque sphere between.

    test_translucent_surfaces.py --plugin PLUGIN --out OUT [--reference OUT_OF_ONE_RANK]

Without a reference pictures are seen to have what is before a surface and behind it. With one, they
must be those of it: on any number of ranks.
"""
import os

import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import pictures
import session
from placed_volumes import shown

SIZE = (300, 240)
ALLOWED = 2  # of 255
RIM = 0.0005  # of pixels: a part of a mesh has its rims a part of a pixel from those of the whole


def surface(source, view, color, opacity):
    display = simple.Show(source, view)
    display.ColorArrayName = [None, ""]
    display.SetRepresentationType("Surface")
    display.DiffuseColor = display.AmbientColor = color
    display.Opacity = opacity
    display.Visibility = 0
    return display


class Stage:
    def __init__(self):
        self.view = session.new_view(SIZE)
        wave = simple.Wavelet()
        wave.UpdatePipeline()
        self.volume = simple.Show(wave, self.view)
        simple.ColorBy(self.volume, ("POINTS", "RTData"))
        self.volume.SetRepresentationType("Banyan Volume")
        opacity = simple.GetOpacityTransferFunction("RTData")
        opacity.Points = [37, 0.0, 0.5, 0, 150, 0.02, 0.5, 0, 277, 0.25, 0.5, 0]
        cut = simple.Slice(Input=wave)
        cut.SliceType.Normal = [0.3, 0.5, 1.0]
        self.surfaces = {
            "slice": surface(cut, self.view, [0.1, 0.9, 0.2], 0.5),
            "sphere": surface(simple.Sphere(Radius=7, ThetaResolution=40, PhiResolution=40), self.view,
                              [0.2, 0.4, 1.0], 0.4),
            "round": surface(simple.Sphere(Radius=19, ThetaResolution=40, PhiResolution=40), self.view,
                             [1.0, 1.0, 0.3], 0.3),
            "contour": surface(simple.Contour(Input=wave, ContourBy=["POINTS", "RTData"], Isosurfaces=[160]),
                               self.view, [0.9, 0.9, 0.9], 0.6),
            "opaque": surface(simple.Sphere(Center=[4, 3, 2], Radius=3), self.view, [0.9, 0.3, 0.8], 1.0),
        }
        self.view.CameraPosition = [25, 30, 60]
        self.view.CameraFocalPoint = [0, 0, 0]
        self.view.CameraViewUp = [0, 1, 0]

    def draw(self, *names):
        for name, display in self.surfaces.items():
            display.Visibility = int(name in names)
        return shown(self.view)


def compare(path, picture):
    error = pictures.difference(pictures.load(path), picture)
    off = (error > ALLOWED).mean()
    session.require(off <= RIM, f"{path} differs in {100 * off:.3f} % of pixels, by up to {error.max()}")


def draw_all(arguments, told):
    stage = Stage()
    drawn = {}
    for names in ((), ("slice",), ("sphere",), ("round",), ("contour",), ("sphere", "opaque"),
                  ("slice", "sphere", "round", "contour", "opaque")):
        for background in ("Single Color", "Gradient"):
            stage.view.BackgroundColorMode = background
            stage.view.Background2 = [0.8, 0.7, 0.3]
            stage.view.CameraParallelProjection = int(background == "Gradient")
            name = " and ".join(names or ["alone"]) + " " + background
            drawn[name] = stage.draw(*names)
            pictures.save(os.path.join(arguments.out, name + ".png"), drawn[name])
            if arguments.reference:
                compare(os.path.join(arguments.reference, name + ".png"), drawn[name])
    for name, size, options in (("transparent", SIZE, {"TransparentBackground": 1}),
                                ("large", (2 * SIZE[0], 2 * SIZE[1]), {}),
                                ("eye", SIZE, {"StereoMode": "Left Eye Only"})):
        path = os.path.join(arguments.out, name + ".png")
        simple.SaveScreenshot(path, stage.view, ImageResolution=list(size), **options)
        drawn[name] = pictures.load(path)
        if arguments.reference:
            compare(os.path.join(arguments.reference, name + ".png"), drawn[name])
    session.require("Banyan" not in told.GetOutput(), "there is nothing to tell: " + told.GetOutput())
    # A surface behind shows less than one before, and each shows something.
    alone = drawn["alone Single Color"]
    for name in ("slice", "sphere", "round", "contour"):
        changed = numpy.abs(drawn[name + " Single Color"] - alone).max(axis=2)
        session.require((changed > 20).mean() > 0.02, f"{name} is not seen")
    stage.volume.MixVolumes = 0
    apart = stage.draw("sphere")
    session.require(told.GetOutput().count("translucent surface") == 1,
                    "what is not mixed is told of once: " + told.GetOutput())
    session.require(numpy.abs(apart - drawn["sphere Gradient"]).max() > 10, "it is drawn as if it were behind")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference", help="pictures of one rank")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    told = vtkStringOutputWindow()
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(told)
    try:
        draw_all(arguments, told)
    finally:
        vtkOutputWindow.SetInstance(before)
    print("ok: translucent surfaces")


if __name__ == "__main__":
    main()
