# SPDX-License-Identifier: BSD-3-Clause
"""Moves the mouse in ParaView's window, and measures how long a user waits for its pictures.

Runs inside `paraview`, where start_window.py puts it:

    --plugin Banyan.so --info banyan-info --scene S1|S2|ramp --name NAME --series FILE.banyan --mode MODE
        --output DIR --pixels N [--paths LIST] [--film DIR] [--server HOST:PORT] [--counts FILE] [--step N]

Appends a row for each path to DIR/interaction.csv, and to DIR/interaction-quality.csv a row for each picture that
follows a single move. README.md explains the columns. The script returns at once; a timer of the view's interactor
then resumes it, so that the window's own loop turns between moves. --film keeps the pictures of an orbit in a folder.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import struct
import sys
import time
import traceback

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

benchmarks = pathlib.Path(__file__).resolve().parent.parent
sys.path += [str(benchmarks / "Balance"), str(benchmarks / "Playback")]
import paraview_frames  # noqa: E402 (its folder had to be named first)
import paraview_playback  # noqa: E402

MOVES = 75
MOVES_PER_SECOND = 25
GRABBED = 8  # moving pictures of a path
TICK_MS = 5
QUIET_S = 0.3  # without a picture: the next one takes long, or none comes
TRUTH_S = 20  # for still pictures that moving ones of a path are compared with
PATIENCE_S = 120  # for the exact picture
MOST_OFF = 0.05  # of the view's edge
JUMP = 5.0 / 360.0  # of the window's width: an orbit of 5 degrees
# Button, whether Shift is held, and the mouse's place in parts of the window, where t goes from 0 to 1.
PATHS = {
    "orbit": ("Left", 0, lambda t: (0.35 + 0.25 * t, 0.5 + 0.03 * math.sin(2 * math.pi * t))),  # 30 degrees a second
    "dolly": ("Right", 0, lambda t: (0.5, 0.6 - 0.2 * t)),  # towards the volume
    "pan": ("Middle", 0, lambda t: (0.45 + 0.15 * t, 0.5 + 0.1 * t)),
    "roll": ("Left", 1, lambda t: (0.5 + 0.3 * math.cos(0.5 * math.pi * t), 0.5 + 0.3 * math.sin(0.5 * math.pi * t))),
}
OPACITY_SHIFT = 0.05  # of the range, in a path


def psnr(picture, exact):
    error = numpy.mean((picture.astype(float) - exact) ** 2)
    return 10 * math.log10(255.0 ** 2 / error) if error > 0 else math.inf


class Window:
    """The view, what is shown in it, and when its pictures were complete."""

    def __init__(self, arguments):
        self.view = simple.GetActiveViewOrCreate("RenderView")
        self.interactor = self.view.GetInteractor()
        self.window = self.view.GetRenderWindow()
        self.counts = arguments.counts
        self.display = show(arguments, self.view)
        self.opacity = self.display.ScalarOpacityFunction
        self.first_points = list(self.opacity.Points)
        self.ours = not arguments.mode.endswith("-volume")
        self.decoupled = self.ours and not arguments.mode.endswith("-off")
        self.ends = []  # times
        self.watch = None  # called with the time of each picture; costs time itself
        self.move = 0  # the last one of a path that began
        self.window.AddObserver("EndEvent", self.ended)

    def ended(self, *_):
        self.ends.append(time.perf_counter())
        if self.watch:
            self.watch(self.ends[-1])

    def decouple(self, wanted):
        if self.ours:
            self.display.Decoupled = int(wanted and self.decoupled)

    def is_exact(self):
        """Whether Banyan's picture is; None for ParaView's Volume, which does not say."""
        if not self.ours:
            return None
        self.display.UpdatePropertyInformation()
        return bool(self.display.GetPropertyValue("PictureIsExact"))

    def grab(self):
        """What the window shows, [y][x][3] from below."""
        reader = vtkWindowToImageFilter()
        reader.SetInput(self.window)
        reader.ShouldRerenderOff()
        reader.ReadFrontBufferOff()
        reader.Update()
        image = reader.GetOutput()
        width, height, _ = image.GetDimensions()
        return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 3).copy()

    def bytes_passed(self):
        """Through the relay, up and down."""
        if not self.counts:
            return None, None
        with open(self.counts, "rb") as file:
            return struct.unpack("<QQ", file.read(16))

    def pose(self):
        camera = self.view.GetActiveCamera()
        return (*(list(get()) for get in (camera.GetPosition, camera.GetFocalPoint, camera.GetViewUp)),
                list(self.opacity.Points))

    def take_pose(self, pose):
        self.view.CameraPosition, self.view.CameraFocalPoint, self.view.CameraViewUp = pose[:3]
        if list(self.opacity.Points) != pose[3]:
            self.opacity.Points = pose[3]
        if not numpy.allclose(self.pose()[:3], pose[:3], rtol=1e-6, atol=1e-9):
            raise RuntimeError("ParaView has not taken the camera that it was given.")

    def mouse(self, event, place, shift=0):
        width, height = self.window.GetSize()
        self.interactor.SetEventInformation(round(place[0] * width), round(place[1] * height), 0, shift, chr(0), 0, None)
        self.interactor.InvokeEvent(event)

    def shift_opacities(self, part):
        """All points but both ends go up by a part of the range, and the picture is drawn as after a drag in the editor."""
        low, high = self.first_points[0], self.first_points[-4]
        points = list(self.first_points)
        for at in range(4, len(points) - 4, 4):
            points[at] = min(points[at] + part * OPACITY_SHIFT * (high - low), high)
        self.opacity.Points = points
        simple.Render(self.view)


def show(arguments, view):
    """The display of the scene in a view whose camera is that of the scene."""
    reader = simple.OpenDataFile(arguments.series)
    display = simple.Show(reader, view)
    if arguments.step:
        scene = simple.GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        scene.AnimationTime = reader.TimestepValues[arguments.step]
    array = reader.PointData.keys()[0]
    bounds = reader.GetDataInformation().GetBounds()
    if arguments.scene == "ramp":
        vectors, low, high = paraview_playback.range_of(arguments)
        simple.ColorBy(display, ("POINTS", array, "Magnitude") if vectors else ("POINTS", array))
        display.LookupTable, display.ScalarOpacityFunction = paraview_playback.functions(array, low, high)
        display.ScalarOpacityUnitDistance = max(bounds[1::2][axis] - bounds[::2][axis] for axis in range(3)) / 32
        paraview_playback.look_from_afar(view, bounds)
    else:
        simple.ColorBy(display, ("POINTS", array))
        paraview_frames.take_functions(display, array, arguments.scene)
        display.ScalarOpacityUnitDistance = bounds[1] / (paraview_frames.SIZE - 1)
        paraview_frames.look(view, bounds[1])
    display.SetRepresentationType("Volume" if arguments.mode.endswith("-volume") else "Banyan Volume")
    display.SetScalarBarVisibility(view, False)
    view.CenterOfRotation = list(view.CameraFocalPoint)
    if "-remote" in arguments.mode:
        simple.Show(simple.Sphere(Center=list(view.CameraFocalPoint), Radius=0.05 * bounds[1]), view)
        view.RemoteRenderThreshold = 1e-3  # more data than this are left to the server
    return display


def pause(seconds):
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        yield


def exact_picture(window, begin):
    """Waits until a picture that came after `begin` is exact, and no other follows it. Returns its time."""
    asked = 0  # pictures when it was asked last
    while time.perf_counter() < begin + PATIENCE_S:
        yield
        last = window.ends[-1] if window.ends else 0.0
        if last > begin and len(window.ends) > asked and time.perf_counter() > last + QUIET_S:
            asked = len(window.ends)
            if window.is_exact() is not False:
                return last
    raise RuntimeError(f"There was no exact picture {PATIENCE_S} s after the mouse was at rest.")


def begin_at(window, pose):
    """The window at rest with the exact picture of a pose."""
    window.decouple(True)
    window.take_pose(pose)
    began = time.perf_counter()
    simple.Render(window.view)
    yield from exact_picture(window, began)


def farther(pose, factor):
    """Another camera, for which Banyan has kept no picture."""
    place, centre = (numpy.array(point) for point in pose[:2])
    return (list(centre + factor * (place - centre)), *pose[1:])


def draw_synchronously(window, pose):
    """The milliseconds of a still picture that is waited for. It is not one that was drawn before."""
    window.decouple(False)
    window.take_pose(pose)
    began = time.perf_counter()
    simple.Render(window.view)
    return 1e3 * (time.perf_counter() - began)


def synchronous_ms(window, pose):
    """Median of three, from places a little farther away each."""
    return statistics.median(draw_synchronously(window, farther(pose, 1 + 1e-3 * number)) for number in (1, 2, 3))


def replay(window, path, after_move):
    """Replays a path in real time: a move that comes too late is left out, as a window does. `after_move` gets the number
    of a move and when it began and returned. Returns when the mouse was released, or the last opacity changed."""
    button, shift, place = PATHS.get(path, ("", 0, None))
    if place:
        window.mouse(button + "ButtonPressEvent", place(0.0), shift)
        yield
    first, done = time.perf_counter(), 0
    while done < MOVES:
        move = min(MOVES, int((time.perf_counter() - first) * MOVES_PER_SECOND))
        if move > done:
            window.move = move
            began = time.perf_counter()
            if place:
                window.mouse("MouseMoveEvent", place(move / MOVES), shift)
            else:
                window.shift_opacities(move / MOVES)
            after_move(move, began, time.perf_counter())
            done = move
        yield
    if not place:
        return began
    released = time.perf_counter()
    window.mouse(button + "ButtonReleaseEvent", place(1.0), shift)
    return released


def measure(window, path, start):
    """A row of interaction.csv."""
    yield from begin_at(window, start)
    bytes_before = window.bytes_passed()
    moves, grabbed = [], []

    def after_move(move, began, returned):
        moves.append((began, returned))
        if move * GRABBED // MOVES > len(grabbed) or move == MOVES:
            grabbed.append((window.grab(), window.pose()))

    released = yield from replay(window, path, after_move)
    exact = yield from exact_picture(window, released)
    bytes_after = window.bytes_passed()
    ends = list(window.ends)
    shown = [next(end for end in ends if end > began) for began, _ in moves]
    waits = [1e3 * (max(end, returned) - began) for end, (began, returned) in zip(shown, moves)]
    pose = window.pose()
    if pose == start:
        raise RuntimeError(f"The mouse has moved nothing along the path '{path}'.")
    row = {"path": path, "move_ms_p50": statistics.median(waits), "move_ms_p95": float(numpy.percentile(waits, 95)),
           "move_ms_worst": max(waits), "first_true_ms": 1e3 * (shown[-1] - moves[-1][0]),
           "exact_ms": 1e3 * (exact - released), "synchronous_ms": synchronous_ms(window, pose)}
    for name, before, after in zip(("bytes_up", "bytes_down"), bytes_before, bytes_after):
        row[name] = None if before is None else after - before
    row["psnr_moving_p50"] = quality(window, grabbed)
    return row


def quality(window, grabbed):
    """Median PSNR of pictures with their poses, to still ones; of some spread over them where those would take too long."""
    qualities, end = [], time.perf_counter() + TRUTH_S
    for number in sorted(range(len(grabbed)), key=lambda number: (number % 3 != 1, number)):
        if len(qualities) < 3 or time.perf_counter() < end:
            draw_synchronously(window, grabbed[number][1])
            qualities.append(psnr(grabbed[number][0], window.grab()))
    return statistics.median(qualities)


def follow_moves(window, start):
    """What the window shows after a single move and a release: (milliseconds, PSNR in dB) of each picture. It is the
    quickest of three: a machine that does something else only makes a picture later."""
    tried = []
    for number in (1, 2, 3):
        tried.append((yield from follow_a_move(window, farther(start, 1 + 3e-3 * number))))
    return min(tried, key=lambda pictures: pictures[-1][0])


def follow_a_move(window, start):
    yield from begin_at(window, start)
    pictures = [(0.0, window.grab())]
    window.mouse("LeftButtonPressEvent", (0.5, 0.5))
    yield from pause(0.2)
    began = time.perf_counter()
    window.watch = lambda end: pictures.append((1e3 * (end - began), window.grab()))
    window.mouse("MouseMoveEvent", (0.5 + JUMP, 0.5))
    yield
    released = time.perf_counter()
    window.mouse("LeftButtonReleaseEvent", (0.5 + JUMP, 0.5))
    yield from exact_picture(window, released)
    window.watch = None
    draw_synchronously(window, window.pose())
    exact = window.grab()
    return [(ms, psnr(picture, exact)) for ms, picture in pictures]


def film(window, start, folder):
    """Keeps the pictures of an orbit in a folder, and in film.json when each came and the number of the move that it shows.
    Seconds count from the orbit's begin."""
    yield from begin_at(window, farther(start, 1.01))
    window.move = 0
    pictures = [(-math.inf, window.move, window.is_exact(), window.grab())]
    window.watch = lambda end: pictures.append((end, window.move, window.is_exact(), window.grab()))
    began = time.perf_counter()
    released = yield from replay(window, "orbit", lambda *_: None)
    yield from exact_picture(window, released)
    window.watch = None
    os.makedirs(folder, exist_ok=True)
    for number, picture in enumerate(pictures):
        save(picture[3], os.path.join(folder, f"{number}.png"))
    place = PATHS["orbit"][2]
    with open(os.path.join(folder, "film.json"), "w", encoding="utf-8") as file:
        json.dump({"pictures": [[max(0.0, end - began), move, exact] for end, move, exact, _ in pictures],
                   "mouse": [place(move / MOVES) for move in range(MOVES + 1)], "moves_per_second": MOVES_PER_SECOND,
                   "released": released - began}, file)


def save(picture, path):
    image = vtkImageData()
    height, width, _ = picture.shape
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(picture.reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetCompressionLevel(1)
    writer.SetInputData(image)
    writer.Write()


def drive(arguments):
    if arguments.server:
        host, port = arguments.server.rsplit(":", 1)
        if not simple.Connect(host, int(port)):
            raise RuntimeError(f"There is no connection to {arguments.server}.")
        simple.LoadPlugin(arguments.plugin, remote=True)
    simple.LoadPlugin(arguments.plugin, remote=False)
    window = Window(arguments)
    yield window.interactor
    yield from pause(1.0)  # the window gets its size
    size = window.window.GetSize()
    if max(abs(pixels - arguments.pixels) for pixels in size) > MOST_OFF * arguments.pixels:
        raise RuntimeError(f"The view has {size[0]} x {size[1]} pixels instead of {arguments.pixels}^2: the screen is too small "
                           "(BANYAN_SCREEN), or AROUND in start_window.py is that of another ParaView.")
    named = {"scene": arguments.name, "mode": arguments.mode}
    start = window.pose()
    yield from begin_at(window, start)
    for path in arguments.paths.split(","):
        row = yield from measure(window, path, start)
        paraview_playback.append(os.path.join(arguments.output, "interaction.csv"), [{**named, **row}])
    rows = yield from follow_moves(window, start)
    paraview_playback.append(os.path.join(arguments.output, "interaction-quality.csv"),
                             [{**named, "ms": ms, "psnr_db": decibels} for ms, decibels in rows])
    if arguments.film:
        yield from film(window, start, arguments.film)


def run(steps):
    """Lets a timer of the interactor, which is the first thing that `steps` yield, do the others, and ends the process."""
    def finish(status):
        sys.stdout.flush()
        os._exit(status)  # ParaView asks no questions then

    def tick(*_):
        if busy:  # pictures may turn the window's loop
            return
        busy.append(True)
        try:
            next(steps)
        except StopIteration:
            finish(0)
        except BaseException:  # nothing else would end the window
            traceback.print_exc()
            finish(1)
        busy.clear()

    busy = []
    try:
        interactor = next(steps)
    except BaseException:
        traceback.print_exc()
        finish(1)
    interactor.AddObserver("TimerEvent", tick)
    interactor.CreateRepeatingTimer(TICK_MS)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("plugin", "name", "series", "mode", "output", "info"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--scene", choices=("S1", "S2", "ramp"), required=True)
    parser.add_argument("--paths", default=",".join([*PATHS, "opacity"]))
    parser.add_argument("--film")
    parser.add_argument("--server")
    parser.add_argument("--counts")
    parser.add_argument("--pixels", type=int, required=True)
    parser.add_argument("--step", type=int, default=0)
    run(drive(parser.parse_args()))
