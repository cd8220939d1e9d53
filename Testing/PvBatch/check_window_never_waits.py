# SPDX-License-Identifier: BSD-3-Clause
"""Checks in the window that pictures which take long come coarse at once, and exact by themselves.

A volume is turned by the mouse, its opacity is dragged, and it is saved while the window is still
coarse. Nothing here measures time: the benchmark interaction.sh does.
"""
import os

from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

from paraview import simple

import picture_scenes
import pictures
import session

SECONDS = 60


class Window:
    def __init__(self, folder):
        self.folder = folder
        self.view = simple.GetActiveView()  # others than the window's own are not drawn
        self.view.UseFXAA = 0
        self.view.OrientationAxesVisibility = 0
        wavelet = simple.Wavelet(WholeExtent=[-100, 100, -100, 100, -100, 100])
        self.display = picture_scenes.volume(wavelet, self.view, "RTData")
        self.display.ImageErrorTolerance = 0.1  # takes longer than one waits for
        self.display.Shade = 1
        self.display.MarkCoarsePictures = 1
        self.interactor = self.view.GetInteractor()
        self.window = self.view.GetRenderWindow()
        self.renders = 0
        self.window.AddObserver("EndEvent", self.rendered)

    def rendered(self, *_):
        self.renders += 1

    def is_exact(self):
        self.display.UpdatePropertyInformation()
        return self.display.GetPropertyValue("PictureIsExact") == 1

    def grab(self, name):
        """What the window shows, without drawing again."""
        image = vtkWindowToImageFilter()
        image.SetInput(self.window)
        image.ShouldRerenderOff()
        image.ReadFrontBufferOff()
        image.Update()
        return self.written(image.GetOutput(), name)

    def written(self, image, name):
        path = os.path.join(self.folder, name + ".png")
        writer = vtkPNGWriter()
        writer.SetInputData(image)
        writer.SetFileName(path)
        writer.Write()
        return pictures.load(path)

    def synchronous(self, name):
        """The picture that one may wait for."""
        self.display.Decoupled = 0
        simple.Render(self.view)
        picture = self.grab(name)
        self.display.Decoupled = 1
        return picture

    def becomes_exact(self, what):
        for _ in range(SECONDS * 100):
            if self.is_exact():
                return
            yield
        session.require(False, f"{what} becomes exact by itself")

    def mouse(self, event, x, y):
        self.interactor.SetEventInformation(x, y, 0, 0, chr(0), 0, None)
        self.interactor.InvokeEvent(event)

    def drag(self, moves, release=True):
        x, y = (size // 2 for size in self.window.GetSize())
        self.mouse("MouseMoveEvent", x, y)
        self.mouse("LeftButtonPressEvent", x, y)
        for move in range(1, moves + 1):
            before = self.renders
            self.mouse("MouseMoveEvent", x + 7 * move, y + 2 * move)
            session.require(self.renders == before + 1, "each move is shown")
            session.require(not self.is_exact(), "by a coarse picture")
            yield
        if release:
            self.mouse("LeftButtonReleaseEvent", x + 7 * moves, y + 2 * moves)

    def turn(self):
        yield from self.drag(5)
        yield from self.becomes_exact("a volume that was turned")
        worst = pictures.difference(self.grab("turned"), self.synchronous("turned, waited for")).max()
        session.require(worst == 0, f"it is the picture that one may wait for ({worst})")
        before = self.renders
        for _ in range(50):
            yield
        session.require(self.renders == before, "nothing is drawn when all is exact")

    def pause(self):
        yield from self.drag(3, release=False)
        yield from self.becomes_exact("a volume that somebody holds still")
        held = self.grab("held")
        self.mouse("LeftButtonReleaseEvent", 0, 0)
        yield
        worst = pictures.difference(held, self.synchronous("held, waited for")).max()
        session.require(worst == 0, f"it is the picture that one may wait for ({worst})")

    def drag_opacity(self):
        """As the editor of the window does: the proxy is told when the drag ends."""
        opacity = simple.GetOpacityTransferFunction("RTData")
        function = opacity.SMProxy.GetClientSideObject()
        low, high = function.GetRange()
        before = self.grab("before its opacity")
        renders = self.renders
        for part in (0.5, 0.4, 0.3):
            function.RemoveAllPoints()
            function.AddPoint(low, 0.0)
            function.AddPoint(low + part * (high - low), 0.0)
            function.AddPoint(high, 1.0)
            for _ in range(10):
                yield
        session.require(self.renders > renders, "the window follows an opacity that is dragged")
        changed = pictures.difference(before, self.grab("while its opacity is dragged")).max()
        session.require(changed > 20, f"and shows it ({changed})")
        opacity.Points = [low, 0.0, 0.5, 0.0, low + 0.3 * (high - low), 0.0, 0.5, 0.0, high, 1.0, 0.5, 0.0]
        simple.Render(self.view)
        yield from self.becomes_exact("another opacity")

    def save(self):
        """Whoever saves a picture gets the exact one, and the window goes on."""
        yield from self.drag(2)
        session.require(pictures.is_marked(self.grab("coarse")), "a coarse picture has a mark")
        path = os.path.join(self.folder, "saved.png")
        simple.SaveScreenshot(path, self.view, ImageResolution=list(self.window.GetSize()))
        saved = pictures.load(path)
        yield from self.becomes_exact("the window after a picture was saved")
        worst = pictures.difference(saved, self.synchronous("saved, waited for")).max()
        session.require(worst == 0, f"a saved picture is exact ({worst})")

    def mix(self):
        """Volumes that share space are waited for, whatever was to come; one alone is not, again."""
        yield from self.drag(2)
        ball = simple.Wavelet(WholeExtent=[60, 120, -30, 30, -30, 30], Center=[90.0, 0.0, 0.0])
        second = picture_scenes.volume(ball, self.view, "RTData")
        simple.Render(self.view)
        session.require(self.is_exact(), "mixed volumes are exact at once")
        mixed = self.grab("mixed")
        for _ in range(50):  # the window renders once or twice more by itself
            yield
        renders = self.renders
        for _ in range(50):
            yield
        session.require(self.renders == renders, "nothing is drawn again")
        path = os.path.join(self.folder, "mixed saved.png")
        simple.SaveScreenshot(path, self.view, ImageResolution=list(self.window.GetSize()))
        worst = pictures.difference(mixed, pictures.load(path)).max()
        session.require(worst <= 1, f"they are saved as they are shown ({worst})")
        second.Visibility = 0
        simple.Render(self.view)
        yield from self.becomes_exact("the first one alone")
        session.require(pictures.difference(mixed, self.grab("not mixed")).max() > 20, "the second one was seen")

    def run(self):
        simple.ResetCamera(self.view)
        simple.Render(self.view)
        yield from self.becomes_exact("the first picture")
        yield from self.turn()
        yield from self.pause()
        yield from self.drag_opacity()
        yield from self.save()
        yield from self.mix()
        print("ok: the window never waits")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    window = Window(arguments.out)
    session.drive(window.view, window.run())


if __name__ == "__main__":
    main()
