# SPDX-License-Identifier: BSD-3-Clause
"""Checks in the window of a client that the camera moves without the server, and that pictures become exact by
themselves: those that a screenshot, which waits, has."""
import ctypes
import os
import signal
import time

import numpy
from paraview import simple
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

import picture_scenes
import pictures
import session

PATIENCE = 60.0  # seconds for what comes by itself
MIDDLE = [200, 200]  # of the window, about: ParaView has widgets in the corners, in 5.12 and 5.13 an unseen one
# Qt of this process, which has no name in Python: QCoreApplication::processEvents of all events.
turn_event_loop = getattr(ctypes.CDLL(None), "_ZN16QCoreApplication13processEventsE6QFlagsIN10QEventLoop17ProcessEventsFlagEE")


def is_server(process, port):
    try:
        with open(f"/proc/{process}/cmdline", encoding="utf-8") as file:
            command = file.read().split("\0")
    except OSError:
        return False  # it has ended
    return os.path.basename(command[0]) == "pvserver" and f"--server-port={port}" in command


def has_mark(picture):
    """Whether anything has the colour of the mark: on ranks of a server it is in the corner of the data."""
    return (numpy.abs(picture - (255.0, 150.0, 0.0)) < 3).all(axis=-1).sum() > 50


class ServedWindow:
    def __init__(self, folder):
        self.folder = folder
        self.view = simple.GetActiveViewOrCreate("RenderView")  # others than the window's own are not drawn
        self.view.UseFXAA = 0
        self.wavelet = simple.Wavelet(WholeExtent=3 * [-60, 60])
        self.display = picture_scenes.volume(self.wavelet, self.view, "RTData")
        self.display.Shade = 1
        self.displays = [self.display]  # that are shown
        self.display.MarkCoarsePictures = 1
        self.interactor = self.view.GetInteractor()
        self.window = self.view.GetRenderWindow()
        self.asked = 0  # pictures that ParaView asks all processes for when the mouse has moved
        self.asked_at_all = 0
        self.moves = False
        self.drawn = 0  # that the window has drawn
        self.view.SMProxy.AddObserver("StartEvent", self.count_asked)
        self.window.AddObserver("EndEvent", self.count_drawn)
        self.place = MIDDLE
        self.worst = 1  # of 255
        self.others = 0  # pixels that may differ more

    def count_asked(self, *_):
        self.asked += self.moves
        self.asked_at_all += 1

    def count_drawn(self, *_):
        self.drawn += 1

    def wait(self, seconds):
        """Turns the window's event loop."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            turn_event_loop(0)
            time.sleep(0.005)

    def mouse(self, event):
        self.interactor.SetEventInformation(*self.place, 0, 0, chr(0), 0, None)
        self.interactor.InvokeEvent(event)

    def press(self):
        self.place = MIDDLE
        self.mouse("LeftButtonPressEvent")

    def move(self, times):
        for _ in range(times):
            self.place = [self.place[0] + 5, self.place[1] + 2]
            self.moves = True
            self.mouse("MouseMoveEvent")
            self.moves = False
            self.wait(0.04)

    def turn(self, times):
        """As a widget does that turns the camera: nobody says when that begins and ends."""
        for _ in range(times):
            self.moves = True
            self.view.GetActiveCamera().Azimuth(3.0)
            self.interactor.Render()
            self.moves = False
            self.wait(0.04)

    def is_exact(self):
        for display in self.displays:
            display.UpdatePropertyInformation()
        return all(display.GetPropertyValue("PictureIsExact") == 1 for display in self.displays)

    def require_exact(self, what):
        end = time.monotonic() + PATIENCE
        while not self.is_exact():
            session.require(time.monotonic() < end, f"{what} becomes exact by itself")
            self.wait(0.1)
        # The window shows it: nothing is drawn any more.
        self.wait(0.2)
        drawn = self.drawn
        self.wait(0.5)
        session.require(self.drawn == drawn, f"{what} stays as it is")

    def shown(self, name):
        """What the window shows, without drawing again."""
        path = os.path.join(self.folder, name + ".png")
        image = vtkWindowToImageFilter()
        image.SetInput(self.window)
        image.ShouldRerenderOff()
        image.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetInputConnection(image.GetOutputPort())
        writer.SetFileName(path)
        writer.Write()
        return pictures.load(path)

    def saved(self, name):
        path = os.path.join(self.folder, name + ".png")
        simple.SaveScreenshot(path, self.view)
        return pictures.load(path)

    def drag(self, what, meanwhile=lambda: None):
        self.press()
        self.move(2)  # the first one after something else may be ParaView's
        asked, drawn = self.asked, self.drawn
        self.move(10)
        session.require(self.asked == asked, f"{what}: no move waits for the server")
        session.require(self.drawn >= drawn + 10, f"{what}: each move is drawn ({self.drawn - drawn} of 10)")
        meanwhile()
        self.move(3)
        moving = self.shown(what + " moving")
        self.mouse("LeftButtonReleaseEvent")
        self.require_exact(what)
        still = self.shown(what)
        self.require_same(what, still)
        session.require(still.std() > 5, f"{what}: the window shows a volume")
        return moving, still

    def turn_by_widget(self):
        simple.Render(self.view)
        self.turn(2)
        asked, drawn = self.asked, self.drawn
        self.turn(10)
        session.require(self.asked == asked, "a camera that a widget turns does not wait for the server")
        session.require(self.drawn >= drawn + 10, f"each turn is drawn ({self.drawn - drawn} of 10)")
        self.require_exact("turned by a widget")
        camera = self.view.GetActiveCamera()
        session.require(list(self.view.CameraPosition) == list(camera.GetPosition()), "ParaView knows the camera")
        self.require_same("turned by a widget", self.shown("turned by a widget"))

    def drag_function(self):
        """As the editor of the window does: the server is told when the drag ends."""
        opacity = self.display.ScalarOpacityFunction
        function = opacity.SMProxy.GetClientSideObject()
        low, high = function.GetRange()
        simple.Render(self.view)  # nobody drags before the window has been drawn after a screenshot
        self.require_exact("a function before its drag")
        before, asked = self.shown("before the function"), self.asked_at_all
        parts = (0.4, 0.3, 0.2)
        for part in parts:
            function.RemoveAllPoints()
            function.AddPoint(low, 0.0)
            function.AddPoint(low + part * (high - low), 0.8)
            function.AddPoint(high, 1.0)
            if part == parts[-1]:
                self.view.SMProxy.StillRender()  # as the editor of ParaView does from 5.12 on, at each change
            self.wait(0.15)
        self.require_exact("a function that is dragged")
        most = 1 if simple.GetParaViewVersion() < (5, 12) else 1 + len(parts)
        session.require(self.asked_at_all - asked <= most, "a function that is dragged does not wait for the server")
        dragged = self.shown("while the function is dragged")
        session.require(pictures.difference(before, dragged).max() > 20, "the window follows a function")
        opacity.Points = [low, 0.0, 0.5, 0.0, low + 0.2 * (high - low), 0.8, 0.5, 0.0, high, 1.0, 0.5, 0.0]
        simple.Render(self.view)
        self.require_exact("another function")
        self.require_same("another function", self.shown("another function"))
        worst = pictures.difference(dragged, self.shown("another function")).max()
        session.require(worst <= 2, f"a function has the same picture before its drag ends ({worst})")

    def busy_server(self):
        """Each move is drawn while the server answers nothing at all."""
        port = os.environ["BANYAN_TEST_SERVER"].rpartition(":")[2]
        servers = [int(process) for process in os.listdir("/proc") if process.isdigit() and is_server(process, port)]
        session.require(servers, "there is a server")

        def signal_all(what):
            for process in servers:
                os.kill(process, what)

        def busy():
            signal_all(signal.SIGSTOP)
            drawn = self.drawn
            self.move(10)
            session.require(self.drawn >= drawn + 10, "each move is drawn while the server is busy")
            signal_all(signal.SIGCONT)

        self.drag("with a busy server", busy)

    def require_same(self, what, shown):
        differences = pictures.difference(shown, self.saved(what + " saved"))
        session.require((differences > self.worst).sum() <= self.others,
                        f"{what}: the window shows what a screenshot has ({differences.max()})")

    def require_waits(self, what):
        simple.Render(self.view)
        asked = self.asked
        self.press()
        self.move(3)
        self.mouse("LeftButtonReleaseEvent")
        session.require(self.asked == asked + 3, f"{what}: the window waits for the server ({self.asked - asked} of 3)")
        self.require_exact(what)
        self.require_same(what, self.shown(what))

    def require_late(self, what):
        """Where the server draws for ParaView, it does not wait for the exact picture either."""
        opacity = self.display.ScalarOpacityFunction
        points = list(opacity.Points)
        opacity.Points = [0.02 * value if i % 4 == 1 else value for i, value in enumerate(points)]
        self.display.SampleDistanceVoxels = 0.05
        self.wavelet.WholeExtent = 3 * [-120, 120]  # with little opacity this takes more than a second
        simple.Render(self.view)
        self.require_exact(what + " first")
        seconds = self.display.GetPropertyValue("TotalSeconds")
        late = seconds > 1.0 or seconds < 0.02  # fast machines wait for it; where it came late, it was there already
        self.press()
        self.move(3)
        asked = self.asked_at_all
        self.mouse("LeftButtonReleaseEvent")
        exact, coarse = self.is_exact(), self.shown(what + " coarse")
        session.require(self.asked_at_all == asked + 1, f"{what}: ParaView asks once ({self.asked_at_all - asked})")
        session.require(exact != late or 0.8 < seconds < 1.25, f"{what}: a coarse picture comes first ({seconds} s, {exact})")
        session.require(has_mark(coarse) != exact, f"{what}: it has a mark")
        self.require_exact(what)
        session.require(self.asked_at_all == asked + (1 if exact else 2), f"{what}: ParaView asks once more")
        still = self.shown(what)
        session.require(not has_mark(still), f"{what}: the exact picture has no mark")
        self.require_same(what, still)
        self.display.SampleDistanceVoxels = 0.0
        self.wavelet.WholeExtent = 3 * [-60, 60]
        opacity.Points = points

    def run(self):
        simple.ResetCamera(self.view)
        simple.Render(self.view)
        moving, still = self.drag("turned")
        session.require(pictures.is_marked(moving) and not pictures.is_marked(still), "coarse pictures have a mark")
        session.require(pictures.psnr(moving, still) > 15, "a picture of a moving camera resembles the still one")
        session.require((moving != still).any(), "a picture of a moving camera is not the still one")

        kept = {}

        def save():
            kept["moving"] = self.saved("saved while moving")
            kept["camera"] = list(self.view.GetActiveCamera().GetPosition())

        self.drag("saved", save)
        camera = self.view.GetActiveCamera()
        camera.SetPosition(*kept["camera"])
        camera.OrthogonalizeViewUp()
        simple.Render(self.view)

        opacity = self.display.ScalarOpacityFunction
        points = list(opacity.Points)

        def change():
            opacity.Points = points[:4] + [value * (0.3 if i % 4 == 1 else 1.0) for i, value in enumerate(points[4:])]

        _, changed = self.drag("other opacities", change)
        session.require(pictures.difference(changed, still).max() > 20, "other opacities are shown")

        self.turn_by_widget()
        self.drag_function()
        simple.Render(self.view)
        self.busy_server()

        # Rays end in other data, wherever those are. The volume is rounded before it is blended over them, and where
        # they meet, ParaView may decide otherwise on several ranks.
        self.worst, self.others = 2, 30
        sphere = simple.Sphere(Radius=25.0, Center=[40.0, 10.0, 20.0], ThetaResolution=40, PhiResolution=40)
        simple.Show(sphere, self.view).DiffuseColor = [0.0, 1.0, 0.0]
        plane = simple.Plane(Origin=[-70, -70, 5], Point1=[70, -70, 5], Point2=[-70, 70, 5])
        simple.Show(plane, self.view).DiffuseColor = [1.0, 1.0, 1.0]
        simple.Render(self.view)
        _, others = self.drag("with other data")
        session.require(pictures.difference(others, changed).max() > 50, "other data are shown")
        whole = self.view.LODThreshold
        self.view.LODThreshold = 0.0
        self.drag("with coarse other data")
        self.view.AxesGrid.Visibility = 1
        self.others = 2000  # ParaView's ticks and numbers, which are drawn at other pixels of a server
        self.drag("with a grid of axes")
        self.view.AxesGrid.Visibility = 0
        self.others = 30

        threshold = self.view.RemoteRenderThreshold
        self.view.RemoteRenderThreshold = 1e-3
        self.require_waits("with more data than a client gets")
        session.require(pictures.difference(self.shown("remote"), changed).max() > 50, "the server shows other data")
        self.require_late("with more data than a client gets, at rest")
        self.view.RemoteRenderThreshold = threshold

        self.view.LODThreshold = whole  # or ParaView delivers coarse data after each still picture of its own
        wavelet = simple.Wavelet(WholeExtent=[-90, -70, -40, 40, -40, 40], Center=[-80.0, 0.0, 0.0])
        second = picture_scenes.volume(wavelet, self.view, "RTData")
        self.displays.append(second)
        simple.Render(self.view)
        self.wait(0.5)  # the window renders once more by itself
        self.require_exact("a second volume")
        _, two = self.drag("with a second volume")
        session.require(pictures.difference(others, two).max() > 20, "a second volume is shown")
        self.view.GetActiveCamera().Azimuth(180.0)
        simple.Render(self.view)
        self.drag("with a second volume from behind")
        second.Decoupled = 0
        self.require_waits("with a second volume that is waited for")
        second.Decoupled = 1
        session.move_to(second, (40, 0, 0))
        self.require_waits("with volumes that are mixed")
        second.MixVolumes = 0
        simple.Render(self.view)
        self.drag("with volumes that share space and are not mixed")
        simple.Hide(wavelet, self.view)
        self.displays.remove(second)

        link = simple.CreateView("RenderView")
        simple.SetActiveView(self.view)
        simple.AddCameraLink(self.view, link, "follows")
        self.require_waits("with a camera that another view follows")
        simple.RemoveCameraLink("follows")
        simple.Delete(link)
        simple.Hide(sphere, self.view)
        simple.Hide(plane, self.view)
        simple.Render(self.view)
        self.worst, self.others = 1, 0
        self.drag("alone again")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    ServedWindow(arguments.out).run()
    print("ok: the window does not wait")


if __name__ == "__main__":
    main()
