# SPDX-License-Identifier: BSD-3-Clause
"""Volumes that share space: plain data, a series and meshes, mixed along each ray.

    test_mixed_volumes.py --plugin PLUGIN --data FOLDER --out OUT [--reference OUT_OF_ONE_RANK]

Without a reference, pictures are compared with what nothing is mixed for: one volume of the whole density,
single pictures blended by depth, a formula. With one, pictures must be those of it: on any number of ranks.
"""
import os
from random import Random

import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import picture_scenes
import pictures
import session
from placed_volumes import SIZE, Pictures, Stage, blended, shown, unit, window_of

ARRANGEMENTS = 9
BOX = [-8, 8, -7, 7, -6, 6]
SERVED = "BANYAN_TEST_SERVER" in os.environ


class Told:
    """Keeps messages of ParaView."""

    def __enter__(self):
        told = vtkStringOutputWindow()
        self.before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(told)
        return told

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)


def mingle(stage, rng, there, inside):
    """Puts volumes on top of each other; others are hidden."""
    for volume in stage.volumes:
        volume.display.Visibility = int(volume in there)
    for volume in there:
        volume.place(rng, rng.uniform(9, 14))
        volume.move(unit(rng) * rng.uniform(0, 5))
    view = stage.view
    eye = unit(rng) * (rng.uniform(0, 4) if inside else rng.choice([40, 55, 70]))
    view.CameraPosition = list(eye)
    view.CameraFocalPoint = list(eye + unit(rng) if inside else [rng.uniform(-3, 3) for _ in range(3)])
    view.CameraViewUp = list(unit(rng))
    view.CameraViewAngle = 70 if inside else 30
    view.CameraParallelProjection = int(not inside and rng.random() < 0.4)
    view.CameraParallelScale = 16


def arrangements(stage, keep):
    """Each picture is mixed: in one that is not, something looks different."""
    rng = Random(91)
    mattered = 0
    for number in range(ARRANGEMENTS):
        there = rng.sample(stage.volumes, rng.randint(2, 4))
        mingle(stage, rng, there, inside=number % 3 == 2)
        stage.spheres.set("Visibility", int(rng.random() < 0.7))
        for volume in stage.volumes:
            volume.display.Shade = int(rng.random() < 0.3)
        picture = shown(stage.view)
        keep.take(f"mixed{number}", picture)
        if keep.reference:
            continue
        with Told():
            for volume in there:
                volume.display.MixVolumes = 0
            mattered += pictures.difference(shown(stage.view), picture).max() > 10
            for volume in there:
                volume.display.MixVolumes = 1
    session.require(keep.reference or mattered >= ARRANGEMENTS // 2, f"mixing matters in {mattered} pictures")


def options(stage, keep):
    """Cropping, nearest samples, a time, a volume hidden and shown again, and cameras that move."""
    view, (plain, series, mesh, _) = stage.view, stage.volumes
    mingle(stage, Random(5), (plain, series, mesh), inside=False)
    view.CameraParallelProjection = 0
    stage.spheres.set("Visibility", 1)
    for volume in stage.volumes:
        volume.display.Shade = 0
    first = shown(view)
    keep.take("first", first)

    def changed(name):
        picture = shown(view)
        keep.take(name, picture)
        seen = (pictures.difference(picture, first) > 4).sum()
        session.require(seen > 100, f"{name}: {seen} pixels differ")

    series.display.UseCropping = 1
    series.display.CroppingScale = [0.5, 0.6, 0.7]
    changed("cropped")
    series.display.UseCropping = 0
    view.ViewTime = 2.0
    changed("later")
    view.ViewTime = 0.0
    for name, volume in (("plain", plain), ("series", series), ("mesh", mesh)):
        volume.display.Visibility = 0
        changed("without_" + name)
        volume.display.Visibility = 1
        session.require((shown(view) == first).all(), "shown again, it is as before")
    view.SMProxy.InteractiveRender()
    session.require((shown(view) == first).all(), "still, after a frame while the camera moves")
    view.ImageReductionFactor = 1
    for volume in stage.volumes:
        volume.display.InteractiveFrameSeconds = 0.0
    view.SMProxy.InteractiveRender()
    if not SERVED:  # ParaView sends a client such frames in 5 bits per channel
        keep.take("moving", window_of(view))
    session.require((shown(view) == first).all(), "still again")
    return first


def screenshots(stage, keep, first):
    view = stage.view
    path = os.path.join(keep.folder, "screenshot.png")
    for name, size, wanted in (("transparent", SIZE, {"TransparentBackground": 1}),
                               ("large", (2 * SIZE[0], 2 * SIZE[1]), {}),
                               ("tiny", (1, 1), {})):
        simple.SaveScreenshot(path, view, ImageResolution=list(size), **wanted)
        picture = pictures.load(path)
        session.require(picture.shape[:2] == size[::-1], f"{name} has the size {picture.shape}")
        keep.take(name, picture)
    stage.spheres.set("Visibility", 0)
    middle = shown(view)
    simple.SaveScreenshot(path, view, ImageResolution=list(SIZE), StereoMode="Both Eyes")
    for eye in ("left", "right"):
        picture = pictures.load(path.replace(".png", f"_{eye}.png"))
        keep.take(eye, picture)
        session.require((pictures.difference(picture, middle) > 1).sum() > 100, eye + " is no middle eye")
    stage.spheres.set("Visibility", 1)
    session.require((shown(view) == first).all(), "as before all screenshots")


def ramp(name, formula):
    wavelet = simple.Wavelet(WholeExtent=BOX)
    return simple.Calculator(Input=wavelet, ResultArrayName=name, Function=formula)


def display_of(view, source, array, colors, opacities):
    """A volume with functions of its own over [0, 1]."""
    display = simple.Show(source, view)
    display.SetRepresentationType(session.REPRESENTATION)
    display.ColorArrayName = ["POINTS", array]
    display.LookupTable = simple.CreateLookupTable(RGBPoints=colors, ColorSpace="RGB")
    count = len(opacities) - 1
    display.ScalarOpacityFunction = simple.CreatePiecewiseFunction(
        Points=[number for i, value in enumerate(opacities) for number in (i / count, value, 0.5, 0.0)])
    display.ScalarOpacityUnitDistance = 1.0
    return display


RAINBOW = [0.0, 0.1, 0.2, 0.9, 0.5, 0.3, 0.9, 0.3, 1.0, 0.9, 0.2, 0.1]
RED, BLUE = [0.9, 0.2, 0.1], [0.1, 0.3, 0.8]


def constant(color):
    return [0.0] + color + [1.0] + color


def single_pictures(view, displays):
    """Of each display what it shows alone over black and over white."""
    shown_before = [display.Visibility for display in displays]
    background = list(view.Background)
    result = {}
    for display in displays:
        for other in displays:
            other.Visibility = int(other is display)
        result[display] = []
        for grey in (0.0, 1.0):
            view.Background = [grey] * 3
            result[display].append(shown(view))
    view.Background = background
    for display, visible in zip(displays, shown_before):
        display.Visibility = visible
    return result


def require_near(name, picture, expected, allowed):
    error = numpy.abs(picture - expected).max()
    print(f"{name}: {error:.2f} of 255", flush=True)
    session.require(error <= allowed, f"{name} is off by {error}")


def halves(keep, make, name):
    """Twice the same data, each of half the density, look like the data once."""
    view = session.new_view(SIZE, CameraPosition=[25, 18, 40], CameraFocalPoint=[0, 0, 0],
                            CameraViewAngle=30)
    whole = [0.3 * max(0.0, 2.0 * i / 64 - 0.6) for i in range(65)]
    half = [1.0 - numpy.sqrt(1.0 - value) for value in whole]
    displays = [display_of(view, make(), "values", RAINBOW, opacities)
                for opacities in (half, half, whole)]
    for shade in (0, 1):
        for eye in ([25, 18, 40], [2, 1, 3]):
            view.CameraPosition = eye
            for display, visible in zip(displays, (0, 0, 1)):
                display.Visibility, display.Shade = visible, shade
            expected = shown(view)
            seen = (pictures.difference(expected, expected[:1, :1]) > 20).sum()
            session.require(seen > 4000, f"{name}: {seen} pixels are seen")
            for display, visible in zip(displays, (1, 1, 0)):
                display.Visibility = visible
            picture = shown(view)
            which = f"{name} shade {shade} from {eye[0]}"
            require_near(which, picture, expected, 2)
            keep.take(which.replace(" ", "_"), picture)
    session.clear()


def beside(keep):
    """In one box, but where one is seen the other one is not: as blended by order."""
    view = session.new_view(SIZE, CameraPosition=[60, 9, 14], CameraFocalPoint=[0, 0, 0],
                            CameraParallelProjection=1, CameraParallelScale=12)
    left = [0.5 * max(0.0, 0.4 - i / 64) for i in range(65)]
    right = left[::-1]
    displays = [display_of(view, ramp("values", "(coordsX+8)/16"), "values", constant(color), opacities)
                for color, opacities in ((RED, left), (BLUE, right))]
    for display in displays:
        display.Visibility = 0
    behind = shown(view)
    for x, order in ((60, displays), (-60, displays[::-1])):
        view.CameraPosition = [x, 9, 14]
        for display in displays:
            display.Visibility = 1
        picture = shown(view)
        single = single_pictures(view, displays)
        require_near(f"beside from {x}", picture, blended(behind, single, order), 3)
        wrong = numpy.abs(picture - blended(behind, single, order[::-1])).max()
        session.require(wrong > 20, f"the other order is only off by {wrong}")
        keep.take(f"beside_{x}", picture)
    session.clear()


def one_inside_another(keep):
    """Two boxes of one value each, whose densities are per lengths of their own: a formula."""
    view = session.new_view(SIZE, CameraPosition=[0, 0, 50], CameraFocalPoint=[0, 0, 0],
                            CameraParallelProjection=1, CameraParallelScale=8)
    opacity = {"outer": 0.05, "inner": 0.2}
    outer = display_of(view, ramp("outer", "coordsX-coordsX+0.5"), "outer", constant(RED),
                       [opacity["outer"]] * 2)
    inner = display_of(view, ramp("inner", "coordsX-coordsX+0.5"), "inner", constant(BLUE),
                       [opacity["inner"]] * 2)
    height, width, _ = shown(view).shape
    view.CameraPosition, view.CameraParallelScale = [0, 0, 50], 8
    red, blue = (-numpy.log(1.0 - opacity[name]) for name in ("outer", "inner"))

    def expected(*parts):
        """Of lengths along a ray, and densities of the inner one there."""
        through, color = 1.0, numpy.zeros(3)
        for length, thick in parts:
            part = numpy.exp(-(red + thick) * length)
            color += through * (1 - part) * (red * numpy.array(RED) + thick * numpy.array(BLUE)) / (red + thick)
            through *= part
        return 255 * (color + through * numpy.array(view.Background))

    for parallel in (1, 0):
        view.CameraParallelProjection = parallel
        for scale in (0.25, 0.5):
            inner.Scale = [0.5, 0.6, scale]
            for z in (-2.5, 0, 2.5):
                session.move_to(inner, [0, 0, z])
                picture = shown(view)
                keep.take(f"inside_{parallel}_{scale}_{z}", picture)
                thick, behind = 12 * scale, 6 - 6 * scale
                require_near(f"in the middle, {parallel} {scale} {z}", picture[height // 2, width // 2],
                             expected((behind - z, 0), (thick, blue / scale), (behind + z, 0)), 2)
    view.CameraParallelProjection = 1
    require_near("at the side", shown(view)[height // 2, width // 2 + int(6 * height / 16)],
                 expected((12, 0)), 2)
    session.clear()


def tetrahedra():
    """The same ones on any number of ranks, which Tetrahedralize does not make of a grid."""
    cells = simple.UnstructuredCellTypes(CellType="Tet", BlocksDimensions=[8, 7, 6])
    cells = simple.Transform(Input=cells)
    cells.Transform.Translate = BOX[::2]
    cells.Transform.Scale = [2, 2, 2]
    return simple.Calculator(Input=cells, ResultArrayName="values",
                             Function="0.5+0.5*cos(coordsX*0.6)*cos(coordsY*0.5)")


def grid():
    return ramp("values", "0.5+0.5*cos(coordsX*0.6)*cos(coordsY*0.5)*cos(coordsZ*0.4)")


def cells_through_a_grid(keep):
    view = session.new_view(SIZE, CameraPosition=[25, 18, 40], CameraFocalPoint=[0, 0, 0],
                            CameraViewAngle=30)
    rising = [0.0, 0.02, 0.05, 0.1, 0.3]
    display_of(view, tetrahedra(), "values", constant(RED), rising)
    moved = display_of(view, grid(), "values", constant(BLUE), rising)
    moved.Orientation = [30, 20, 10]
    session.move_to(moved, [3, 2, 1])
    for eye in ([25, 18, 40], [1, 1, 2]):
        view.CameraPosition = eye
        keep.take(f"cells_{eye[0]}", shown(view))
    session.clear()


def warnings(keep):
    """A volume that shares space and is not to be mixed is told of once, whatever moves."""
    for name, value in (("Projection", "Maximum Intensity"), ("MixVolumes", 0)):
        view = session.new_view(SIZE, CameraPosition=[25, 18, 40], CameraFocalPoint=[0, 0, 0],
                                CameraViewAngle=30)
        rising = [0.0, 0.02, 0.05, 0.1, 0.3]
        displays = [display_of(view, grid(), "values", constant(color), rising) for color in (RED, BLUE)]
        session.move_to(displays[1], [3, 2, 5])
        words = "share a part of space"
        with Told() as told:
            mixed = shown(view)
            session.require(words not in told.GetOutput(), "mixed volumes are told of: " + told.GetOutput())
            setattr(displays[1], name, value)
            for x in (27, 26, 25):
                view.CameraPosition = [x, 18, 40]
                picture = shown(view)
            count = told.GetOutput().count(words)
        # A server tells where it runs.
        session.require(count == (0 if SERVED else 1) or keep.reference and count <= 1,
                        f"{name}: told of {count} times")
        keep.take("not_mixed_" + name, picture)
        session.require((pictures.difference(picture, mixed) > 10).sum() > 300, f"{name}: not mixed")
        session.clear()


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
    simple.Render(session.new_view(SIZE))  # the first one of all resets its camera
    session.clear()
    one_inside_another(keep)
    beside(keep)
    halves(keep, grid, "grids")
    halves(keep, tetrahedra, "tetrahedra")
    cells_through_a_grid(keep)
    warnings(keep)
    stage = Stage()
    # One is seen through another one.
    for volume, color, distance in zip(
            stage.volumes, (RED, BLUE, [0.2, 0.8, 0.2], [0.9, 0.9, 0.9]), (0.2, 5.0, 5.0, 0.2)):
        volume.display.ScalarOpacityUnitDistance = distance
        volume.display.LookupTable = simple.CreateLookupTable(RGBPoints=constant(color), ColorSpace="RGB")
    arrangements(stage, keep)
    screenshots(stage, keep, options(stage, keep))
    print("ok: mixed volumes")


if __name__ == "__main__":
    main()
