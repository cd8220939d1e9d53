# SPDX-License-Identifier: BSD-3-Clause
"""Several volumes in one view: plain data, a series and a mesh in random places, apart from each other.

    test_several_volumes.py --plugin PLUGIN --data FOLDER --out OUT [--reference OUT_OF_ONE_RANK]

Without a reference each pixel is compared with what the volumes show alone, blended in order of depth.
With one, pictures must be those of it: on any number of ranks. One volume is hidden now and then. At
last come both eyes, a transparent picture, frames while the camera moves, and warnings: each once.
"""
import os
from random import Random

import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import picture_scenes
import pictures
import session
from placed_volumes import SIZE, Pictures, Stage, blended, shown, window_of

ARRANGEMENTS = 16
COMPARED_WITH_SINGLE_ONES = 6  # of them, on one rank
ROUNDING = 4  # of 255: several rounded pictures are multiplied
STEREO = ("No stereo", "Left Eye Only", "Right Eye Only", "Red-Blue", "Interlaced", "Anaglyph",
          "Checkerboard", "Side-by-Side Horizontal", "Dresden")


def arrangements(stage, keep):
    rng = Random(27)
    mattered = 0
    for number in range(ARRANGEMENTS):
        stage.view.BackgroundColorMode = rng.choice(["Single Color", "Gradient"])
        stage.view.Background2 = [0.7, 0.6, 0.2]
        along, there = stage.arrange(rng)
        picture = shown(stage.view)
        keep.take(f"arrangement{number}", picture)
        if keep.reference or number >= COMPARED_WITH_SINGLE_ONES:
            continue
        stage.view.BackgroundColorMode = "Single Color"
        picture = shown(stage.view)
        order = stage.far_to_near(along, there)
        behind, single = stage.single_pictures(order)
        # Clipping planes are other ones there, and move the rims of spheres.
        sure = ~pictures.rim(behind, width=2)
        error = numpy.abs(picture - blended(behind, single, order))[sure].max()
        session.require(error <= ROUNDING, f"arrangement {number} is off by {error} from single pictures")
        mattered += numpy.abs(picture - blended(behind, single, order[::-1]))[sure].max() > 20
    session.require(keep.reference or mattered >= COMPARED_WITH_SINGLE_ONES // 3,
                    f"the order matters in {mattered} pictures")


def other_pictures(stage, keep):
    """Both eyes, a picture without background, one larger than the window, and moving cameras."""
    stage.view.BackgroundColorMode = "Single Color"
    stage.arrange(Random(5))
    stage.view.CameraParallelProjection = 0
    stage.spheres.set("Visibility", 1)
    drawn = {}
    for mode in STEREO:
        # Rims of two eyes are in places that only these know.
        stage.spheres.set("Visibility", int(mode in STEREO[:3]))
        path = os.path.join(keep.folder, "screenshot.png")
        simple.SaveScreenshot(path, stage.view, ImageResolution=list(SIZE), StereoMode=mode)
        drawn[mode] = pictures.load(path)
        # It adds up channels of 8 bits each, and rounds once more.
        keep.take("stereo " + mode, drawn[mode], allowed=2 if mode == "Anaglyph" else 1)
    stage.spheres.set("Visibility", 1)
    path = os.path.join(keep.folder, "eyes.png")
    simple.SaveScreenshot(path, stage.view, ImageResolution=list(SIZE), StereoMode="Both Eyes")
    for eye in ("Left", "Right"):
        both = pictures.load(path.replace(".png", f"_{eye.lower()}.png"))
        session.require(pictures.difference(both, drawn[eye + " Eye Only"]).max() <= 1,
                        f"{eye}: one of both eyes")
        session.require((pictures.difference(both, drawn["No stereo"]) > 5).sum() > 200,
                        f"{eye}: not the picture between the eyes")
    for name, size, options in (("transparent", SIZE, {"TransparentBackground": 1}),
                                ("large", (2 * SIZE[0], 2 * SIZE[1]), {}),
                                ("large eye", (2 * SIZE[0], 2 * SIZE[1]), {"StereoMode": "Left Eye Only"})):
        simple.SaveScreenshot(path, stage.view, ImageResolution=list(size), **options)
        keep.take(name, pictures.load(path))
    stage.view.ImageReductionFactor = 1
    for volume in stage.volumes:
        volume.display.InteractiveFrameSeconds = 0.0
    stage.view.SMProxy.InteractiveRender()
    keep.take("moving", window_of(stage.view))
    simple.Render(stage.view)


def warnings(stage):
    """What is not exact is said once, in words for users."""
    told = vtkStringOutputWindow()
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(told)
    try:
        for volume in stage.volumes:
            volume.display.Visibility = int(volume in stage.volumes[:2])
        stage.view.CameraPosition = [5, 3, 90]
        stage.view.CameraFocalPoint = [0, 0, 0]
        for number, volume in enumerate(stage.volumes[:2]):
            volume.place(Random(number), 8.0)
            volume.move(numpy.array([0, 0, 30.0 * number]))
        stage.spheres.set("Opacity", 1.0)
        shown(stage.view)
        session.require("Banyan" not in told.GetOutput(), "nothing to tell: " + told.GetOutput())
        stage.volumes[1].move(numpy.array([0, 0, 4.0]))
        shown(stage.view)
        session.require("Banyan" not in told.GetOutput(), "mixed volumes are told of: " + told.GetOutput())
        stage.volumes[1].display.MixVolumes = 0
        for x in range(3):
            stage.view.CameraPosition = [5 + x, 3, 90]
            shown(stage.view)
        session.require(told.GetOutput().count("share a part of space") == 1,
                        "overlapping volumes are told of once: " + told.GetOutput())
        stage.spheres.set("Visibility", 1)
        stage.spheres.set("Opacity", 0.0)
        shown(stage.view)
        session.require("translucent surface" not in told.GetOutput(), "one that nobody sees is told of")
        stage.spheres.set("Opacity", 0.5)
        for x in range(3):
            stage.view.CameraPosition = [5 + x, 3, 90]
            shown(stage.view)
        session.require(told.GetOutput().count("translucent surface") == 1,
                        "translucent surfaces are told of once: " + told.GetOutput())
        stage.spheres.set("Visibility", 0)
        for volume in stage.volumes[:2]:
            volume.display.Visibility = 0
        alone = stage.volumes[2]
        alone.place(Random(2), 8.0)
        alone.display.Visibility = 1
        text = simple.Text(Text="Before the volume")
        label = simple.Show(text, stage.view)
        label.TextPropMode = "Billboard 3D Text"
        for z in (-30, 30, 31):
            label.BillboardPosition = [0, 0, z]
            shown(stage.view)
            session.require(told.GetOutput().count("text in space") == (0 if z < 0 else 1),
                            "a text before a volume is told of once: " + told.GetOutput())
        simple.Delete(text)
        # Nothing is wrong where the eye is on a face and looks away.
        alone.turn, alone.scale = [0, 0, 0], numpy.ones(3)
        alone.move(numpy.zeros(3))
        stage.view.LockBounds = 0
        stage.view.CameraPosition = [alone.half[0], 0, 0]
        stage.view.CameraFocalPoint = [2 * alone.half[0], 0, 0]
        stage.view.CameraViewUp = [0, 1, 0]
        shown(stage.view)
        session.require("not drawn" not in told.GetOutput(), told.GetOutput())
    finally:
        vtkOutputWindow.SetInstance(before)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", required=True, help="folder with the encoded series")
    parser.add_argument("--reference", help="pictures of one rank")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    picture_scenes.Settings.data = arguments.data
    session.begin(arguments)
    keep = Pictures(arguments)
    stage = Stage()
    arrangements(stage, keep)
    other_pictures(stage, keep)
    warnings(stage)
    print("ok: several volumes")


if __name__ == "__main__":
    main()
