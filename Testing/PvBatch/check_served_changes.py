# SPDX-License-Identifier: BSD-3-Clause
"""Checks in the window of a client that whatever happens to two views while their server draws, both become exact by
themselves: they show what screenshots, which wait, have."""
import os
import random

from paraview import simple

import picture_scenes
import pictures
import session
from check_served_window import ServedWindow


class Changes(ServedWindow):
    """The window's view, which changes, beside another one."""

    def __init__(self, folder, seed):
        super().__init__(folder)
        self.dice = random.Random(seed)
        self.worst, self.others = 2, 30  # the sphere's edges are others where several ranks have parts of it
        self.source = self.display.Input
        self.points = list(self.display.ScalarOpacityFunction.Points)
        self.sphere = simple.Sphere(Radius=25.0, Center=[40.0, 10.0, 20.0], ThetaResolution=40, PhiResolution=40)
        self.shown_sphere = simple.Show(self.sphere, self.view)
        self.neighbour = picture_scenes.volume(
            simple.Wavelet(WholeExtent=[62, 80, -50, 20, -60, 60], Center=[71.0, -15.0, 0.0]), self.view, "RTData")
        self.second = simple.CreateView("RenderView")
        self.second.UseFXAA = 0
        simple.AssignViewToLayout(view=self.second, layout=simple.GetLayout(self.view), hint=0)
        self.beside = picture_scenes.volume(self.source, self.second, "RTData")
        simple.SetActiveView(self.view)
        for view in (self.view, self.second):
            simple.ResetCamera(view)
            simple.Render(view)

    def turn(self):
        self.mouse("LeftButtonPressEvent")
        self.move(self.dice.randint(1, 4))
        self.wait(self.dice.choice((0.0, 0.15)))
        self.mouse("LeftButtonReleaseEvent")

    def opacity(self):
        factor = self.dice.uniform(0.2, 1.0)
        self.display.ScalarOpacityFunction.Points = [value * (factor if i % 4 == 1 and i > 3 else 1.0)
                                                     for i, value in enumerate(self.points)]
        simple.Render(self.view)

    def shading(self):
        self.display.Shade = 1 - self.display.Shade
        simple.Render(self.view)

    def sphere_moves(self):
        self.sphere.Center = [self.dice.uniform(-60.0, 60.0) for _ in range(3)]
        self.shown_sphere.Visibility = self.dice.choice((0, 1, 1))
        simple.Render(self.view)

    def other_values(self):
        self.source.XFreq = self.dice.uniform(20.0, 80.0)
        simple.Render(self.view)
        simple.Render(self.second)

    def hidden(self):
        self.display.Visibility = 0
        simple.Render(self.view)
        self.wait(self.dice.choice((0.0, 0.1)))
        self.display.Visibility = 1
        simple.Render(self.view)

    def neighbour_moves(self):
        self.neighbour.Visibility = self.dice.choice((0, 1, 1))
        session.move_to(self.neighbour, [self.dice.choice((0.0, -150.0)), 0.0, 0.0])
        simple.Render(self.view)

    def neighbour_is(self):
        self.neighbour.SetRepresentationType(self.dice.choice(("Outline", "Banyan Volume")))
        self.wait(self.dice.choice((0.0, 0.15)))  # timers may come before ParaView's picture
        simple.Render(self.view)

    def other_display(self):
        simple.Delete(self.beside)
        self.wait(self.dice.choice((0.0, 0.1)))
        self.beside = picture_scenes.volume(self.source, self.second, "RTData")
        simple.SetActiveView(self.view)
        simple.Render(self.second)

    def second_moves(self):
        camera = self.second.GetActiveCamera()
        camera.Azimuth(self.dice.uniform(-30.0, 30.0))
        self.second.ResetCamera(False) if self.dice.random() < 0.3 else simple.Render(self.second)

    def decoupled(self):
        self.display.Decoupled = 1 - self.display.Decoupled
        simple.Render(self.view)
        self.display.Decoupled = 1

    def save(self):
        self.saved("meanwhile")

    def run(self, changes):
        what = (self.turn, self.opacity, self.shading, self.sphere_moves, self.other_values, self.hidden,
                self.neighbour_moves, self.neighbour_is, self.other_display, self.second_moves, self.decoupled,
                self.save)
        for number in range(changes):
            change = self.dice.choice(what)
            print(f"{number}: {change.__name__}", flush=True)
            change()
            self.wait(self.dice.choice((0.0, 0.0, 0.05, 0.3)))
            if number % 8 == 7:
                self.check(f"after {number + 1} changes")

    def check(self, when):
        simple.Render(self.view)
        simple.Render(self.second)
        self.require_exact(when)
        # Two volumes are rounded before they are blended, and FXAA, which ParaView switches on again when there is
        # another view, goes by thresholds.
        neighbour = self.neighbour.Visibility and self.neighbour.Representation == "Banyan Volume"
        self.others = 60 if neighbour else 30
        self.require_same(when, self.shown(when))
        self.others = 30
        window, view, display = self.window, self.view, self.display
        self.window, self.view, self.display = self.second.GetRenderWindow(), self.second, self.beside
        try:
            self.require_exact("beside, " + when)
            self.require_same("beside, " + when, self.shown("beside, " + when))
            session.require(pictures.load(os.path.join(self.folder, f"beside, {when}.png")).std() > 5,
                            f"beside, {when}: the window shows a volume")
        finally:
            self.window, self.view, self.display = window, view, display


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--changes", type=int, default=32)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    Changes(arguments.out, arguments.seed).run(arguments.changes)
    print("ok: both views become exact")


if __name__ == "__main__":
    main()
