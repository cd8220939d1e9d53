# SPDX-License-Identifier: BSD-3-Clause
"""Displays of ranks show what one rank's picture shows there: tiles of a wall, and walls of a CAVE.

    test_walls.py --plugin PLUGIN --data FOLDER --out DIR (--tiles X,Y [--mullions X,Y] | --cave FILE)
        [--reference] [--changes N]

With --reference one rank draws whole pictures into DIR, each as large as the wall. Otherwise it is the client of a
server with displays; their pictures are saved to DIR, too, and are compared with the whole ones: they may differ by
1 of 255, and surfaces more while the camera moves. Each display has as many pixels as PV_SHARED_WINDOW_SIZE says.
Before that, N random changes are drawn: ranks that are called differently must not wait for each other.
"""
import itertools
import os
import random
import xml.etree.ElementTree

import numpy
from paraview import simple
from vtkmodules.vtkRenderingCore import vtkCamera

import draw_interactive
import picture_scenes
import pictures
import session

DISPLAY = tuple(int(number) for number in os.environ["PV_SHARED_WINDOW_SIZE"].split("x"))


GLASS = ("glass", (-29, 17, 5), 5, (0.9, 0.4, 0.9))


class Scene:
    """A volume, an encoded one beside it, and spheres on the ranks, one of them of glass."""

    def __init__(self):
        self.view = session.new_view(DISPLAY, **picture_scenes.CAMERA)
        self.view.RemoteRenderThreshold = 0
        self.spheres = picture_scenes.spheres(self.view)
        self.first = picture_scenes.wavelet(self.view)
        self.second = picture_scenes.encoded(self.view)
        session.move_to(self.second, [60, 0, 0])
        # Of few cells: ParaView redistributes all surfaces, through XML, which Debian's parser cuts off.
        self.coarse = picture_scenes.spheres(self.view, resolution=6)
        nothing = ("nothing", (0, 0, 0), 0, (0, 0, 0))
        self.glass = picture_scenes.spheres(self.view, (nothing, GLASS), 6, 0.5)
        for display in (self.second, self.coarse, self.glass):
            display.Visibility = 0


def poses(scene, wall):
    """Changes the scene again and again; gives a name each time."""
    view = scene.view
    wall.look(view, wall.eye, [0, 0, 0])
    yield "whole"
    view.CameraViewAngle = 12  # all displays show a part
    yield "near"
    view.CameraViewAngle = 30
    wall.look(view, wall.eye, [25, 14, 0])  # all is in one corner
    yield "corner"
    wall.look(view, wall.eye, [0, 0, 0])
    scene.second.Visibility = 1
    yield "two"
    scene.first.Visibility = 0
    view.ViewTime = 1.0
    yield "step"
    wall.look(view, [0, 0, 200], [0, 0, 400])  # nobody sees it
    yield "away"
    wall.look(view, wall.eye, [0, 0, 0])
    scene.first.Visibility = 1
    scene.spheres.Visibility = 0
    yield "volumes"
    if not wall.off:  # ParaView shrinks surfaces beside gaps, one rank's more than another's
        scene.second.Visibility = 0
        scene.coarse.Visibility = scene.glass.Visibility = 1
        scene.first.MixVolumes = 0  # walls do not mix surfaces
        yield "translucent"
        scene.first.MixVolumes = 1
        scene.second.Visibility = 1
        scene.coarse.Visibility = scene.glass.Visibility = 0
    view.StereoRender = 1
    view.StereoType = "Red-Blue"
    yield "stereo"


class Tiles:
    """ParaView shrinks what it shows of a wall with gaps: a picture of all pixels of tiles is cut in parts that have
    the gaps between them. Numbers have to be such that parts have whole pixels."""

    eye = [45, 40, 100]
    reduces = True

    def __init__(self, counts, mullions):
        # Pixels that may differ by more than 1 where there are surfaces.
        self.off = 4000 if any(mullions) else 0
        # A reduced picture shows another part of the wall there: ParaView reduces tiles, and leaves gaps as they are.
        self.compares_moving = not any(mullions)
        self.counts = counts
        self.size = tuple(n * d for n, d in zip(counts, DISPLAY))
        whole = [n * (d + m) - m for n, d, m in zip(counts, DISPLAY, mullions)]
        self.shown, self.step = ([length * size // all_of for length, size, all_of in zip(lengths, self.size, whole)]
                                 for lengths in (DISPLAY, [d + m for d, m in zip(DISPLAY, mullions)]))

    def look(self, view, eye, focus):
        view.CameraPosition, view.CameraFocalPoint = eye, focus

    def names(self):
        return [""]

    def place(self, view, _):
        view.ViewSize = list(self.size)

    def ranks(self):
        return self.counts[0] * self.counts[1]

    def part(self, whole, rank):
        """What a rank shows of the whole picture; the first one is at the top left."""
        column, row = rank % self.counts[0], rank // self.counts[0]
        left = column * self.step[0]
        top = self.size[1] - row * self.step[1]
        return whole[""][top - self.shown[1]:top, left:left + self.shown[0]]


class Cave:
    eye = [15, 13, 33]
    off = 0
    reduces, compares_moving = False, True

    def __init__(self, file):
        root = xml.etree.ElementTree.parse(file).getroot()
        machines = root.iter("Machine")
        self.separation = float(next(root.iter("EyeSeparation")).get("Value"))
        self.corners = [[[float(number) for number in machine.get(corner).split()]
                         for corner in ("LowerLeft", "LowerRight", "UpperRight")] for machine in machines]

    def look(self, view, eye, focus):
        """Moves the world into the room: since VTK 9.3 a camera with a screen heeds no position and focal point."""
        wanted = vtkCamera()
        wanted.SetPosition(eye)
        wanted.SetFocalPoint(focus)
        view.CameraPosition, view.CameraFocalPoint = [0, 0, 0], [0, 0, -1]
        view.GetActiveCamera().SetModelTransformMatrix(wanted.GetViewTransformMatrix())

    def names(self):
        return [str(number) for number in range(len(self.corners))]

    def place(self, view, name):
        camera = view.GetActiveCamera()
        low, right, top = self.corners[int(name)]
        view.ViewSize = list(DISPLAY)
        camera.SetScreenBottomLeft(low)
        camera.SetScreenBottomRight(right)
        camera.SetScreenTopRight(top)
        camera.SetEyeSeparation(self.separation)  # a picture without stereo is that of the left eye
        camera.SetUseOffAxisProjection(True)

    def ranks(self):
        return len(self.corners)

    def part(self, whole, rank):
        return whole[str(rank)]


def moves(scene, wall):
    """Turns the camera as somebody does who holds the mouse; gives a name each time."""
    for display in (scene.first, scene.second):
        display.InteractiveFrameSeconds = 0.0  # what is drawn depends on no clock
        display.ReuseFrames = 0  # the first picture would be the still one
    scene.view.StereoRender = 0
    scene.spheres.Visibility = 0
    yield "moving-volumes"
    scene.spheres.Visibility = 1
    for number, eye in enumerate(([60, 25, 90], [20, 70, 80])):
        wall.look(scene.view, [part * wall.eye[2] / 100 for part in eye], [0, 0, 0])
        yield f"moving-{number}"


def draw_whole(wall, out):
    for name in wall.names():
        scene = Scene()  # since VTK 9.3 a camera keeps the orientation of its first screen
        for pose in poses(scene, wall):
            wall.place(scene.view, name)
            simple.Render(scene.view)
            simple.SaveScreenshot(os.path.join(out, f"whole-{pose}{name}.png"), scene.view)
        for pose in moves(scene, wall):
            wall.place(scene.view, name)
            scene.view.SMProxy.InteractiveRender()
            draw_interactive.shown(scene.view, os.path.join(out, f"whole-{pose}{name}.png"))
        session.clear()


def draw_displays(wall, out, changes):
    scene = Scene()
    simple.AssignViewToLayout(scene.view)
    layout = simple.GetLayout(scene.view).SMProxy
    layout.ShowViewsOnTileDisplay()
    change(scene, wall, changes)

    def displays(pose):
        """What displays show, what they should, and the name of each."""
        whole = {name: pictures.load(os.path.join(out, f"whole-{pose}{name}.png")) for name in wall.names()}
        for rank in range(wall.ranks()):
            path = os.path.join(out, f"display-{pose}{rank}.png")
            layout.SaveAsPNG(rank, path)
            yield pictures.load(path), wall.part(whole, rank), f"{pose}, display {rank}"

    for pose in poses(scene, wall):
        scene.view.SMProxy.InteractiveRender()
        simple.Render(scene.view)
        allowed = 5 if pose in ("volumes", "stereo") and wall.off else wall.off
        for shown, wanted, name in displays(pose):
            compare(shown, wanted, allowed, name)
        if pose == "whole":
            find_box(scene, os.path.join(out, "client"), isinstance(wall, Tiles))
    for pose in moves(scene, wall):
        scene.view.SMProxy.InteractiveRender()
        for shown, wanted, name in displays(pose) if wall.compares_moving else ():
            if wall.reduces and pose != "moving-volumes":
                compare_reduced(shown, wanted, name)
            else:
                compare(shown, wanted, 0, name)


def find_box(scene, path, before):
    """The client's own window shows the box of the volume: lines that reach as far as the corners do, if it is before
    the viewer."""
    view, without = scene.view, path + "-without.png"
    scene.spheres.Visibility = 0
    simple.SaveScreenshot(path + ".png", view)
    scene.first.Visibility = 0
    simple.SaveScreenshot(without, view)
    scene.first.Visibility = scene.spheres.Visibility = 1
    off = pictures.difference(pictures.load(path + ".png"), pictures.load(without)) > 8
    renderer, corners = view.GetRenderer(), []
    for place in itertools.product((-20, 20), (-16, 16), (-14, 14)):
        renderer.SetWorldPoint(*place, 1)
        renderer.WorldToDisplay()
        corners.append(renderer.GetDisplayPoint()[:2])
    size = off.shape[::-1]
    low, high = numpy.clip([numpy.min(corners, axis=0), numpy.max(corners, axis=0)], 0, numpy.array(size) - 1)
    session.require(0 < off.sum() < 0.1 * off.size, f"lines of a box have {off.sum()} pixels")
    if not before:
        return
    rows, columns = numpy.nonzero(off)
    found = numpy.array([[columns.min(), rows.min()], [columns.max(), rows.max()]])
    session.require(numpy.abs(found - [low, high]).max() < 2.5, "the box is not where the volume is")


def change(scene, wall, count):
    """Random changes, each of which is drawn."""
    view, dice = scene.view, random.Random(count)
    displays = (scene.first, scene.second, scene.spheres)
    eye, focus = list(wall.eye), [0, 0, 0]

    def turn():
        eye[:] = [dice.uniform(-120, 120) for _ in range(3)]
        wall.look(view, eye, focus)

    def zoom():
        view.CameraViewAngle = dice.choice((5, 12, 30, 60))

    def hide():
        display = dice.choice(displays)
        display.Visibility = 1 - display.Visibility

    def look_away():
        focus[:] = [dice.choice((0, 0, 300)) for _ in range(3)]
        wall.look(view, eye, focus)

    def make_translucent():
        scene.spheres.Opacity = dice.choice((0.5, 1.0))

    def select():
        simple.SelectSurfacePoints([0, 0, DISPLAY[0], DISPLAY[1]], View=view)
        simple.ClearSelection()

    def step():
        view.ViewTime = dice.choice((0.0, 1.0, 2.0))

    def move():
        session.move_to(dice.choice(displays), [dice.uniform(-40, 40) for _ in range(3)])

    def reduce():
        view.ImageReductionFactor = dice.choice((1, 2, 5))

    changes = (turn, turn, turn, zoom, reduce, hide, look_away, make_translucent, select, step, move)
    for number in range(count):
        chosen = dice.choice(changes)
        print(f"{number}: {chosen.__name__}", flush=True)
        chosen()
        if dice.random() < 0.5:
            view.SMProxy.InteractiveRender()
        simple.Render(view)
    for display in displays:
        display.Visibility = 1 if display is not scene.second else 0
        session.move_to(display, [60, 0, 0] if display is scene.second else [0, 0, 0])
    for source in simple.GetSources().values():
        simple.ClearSelection(source)
    scene.spheres.Opacity = 1.0
    view.ViewTime = 0.0
    view.CameraViewAngle = 30
    view.ImageReductionFactor = 2


def compare(shown, wanted, allowed, what):
    """What is shown may be less than the display has pixels: it is at the lower left."""
    shown = shown[:wanted.shape[0], :wanted.shape[1]]
    off = pictures.difference(shown, wanted)
    colours = len(numpy.unique(shown.reshape(-1, 3), axis=0))
    print(f"{what}: off by {off.max()} of 255, {int((off > 1).sum())} pixels by more than 1, {colours} colours")
    session.require((off > 1).sum() <= allowed, f"{what}: pixels are off by up to {off.max()} of 255")
    return off.max()


def compare_reduced(shown, wanted, what):
    """While the camera moves ParaView draws surfaces in a quarter of the pixels; volumes have all theirs."""
    off = pictures.difference(shown, wanted)
    rim = pictures.rim(wanted, 3)
    inside = off[~rim]
    print(f"{what}: {int((off > 8).sum())} pixels off by more than 8 of 255, {int((inside > 8).sum())} of them within "
          f"surfaces, by {inside.max()}")
    session.require((off > 8).sum() <= 0.02 * off.size, f"{what}: surfaces are not where they should be")
    session.require((inside > 8).sum() <= 200 and inside.max() <= 80, f"{what}: surfaces have other colours")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--data", required=True, help="folder with the encoded series")
    parser.add_argument("--out", required=True)
    parser.add_argument("--tiles")
    parser.add_argument("--mullions", default="0,0")
    parser.add_argument("--cave")
    parser.add_argument("--reference", action="store_true")
    parser.add_argument("--changes", type=int, default=0)
    arguments = parser.parse_args()
    picture_scenes.Settings.data = arguments.data
    os.makedirs(arguments.out, exist_ok=True)
    numbers = [[int(number) for number in text.split(",")] for text in (arguments.tiles or "1,1", arguments.mullions)]
    wall = Cave(arguments.cave) if arguments.cave else Tiles(*numbers)
    session.begin(arguments)
    simple._DisableFirstRenderCameraReset()
    if arguments.reference:
        draw_whole(wall, arguments.out)
    else:
        draw_displays(wall, arguments.out, arguments.changes)
    print("ok: pictures on displays")


if __name__ == "__main__":
    main()
