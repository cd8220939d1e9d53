# SPDX-License-Identifier: BSD-3-Clause
"""Checks in the window that the group "Last Frame" of the panel follows each still picture by itself."""
from paraview import simple

import picture_scenes
import session


class LastFrame:
    def __init__(self):
        self.view = simple.GetActiveView()  # others than the window's own are not drawn
        wavelet = simple.Wavelet(WholeExtent=[-40, 40, -40, 40, -40, 40])
        self.display = picture_scenes.volume(wavelet, self.view, "RTData")

    def shown(self, name):
        """What the panel shows now: the server is not asked."""
        return simple.servermanager.vtkSMPropertyHelper(self.display.SMProxy, name).GetAsDouble()

    def run(self):
        simple.ResetCamera(self.view)
        simple.Render(self.view)
        first = self.shown("Frames")
        session.require(first >= 1, f"the first still picture was fetched ({first} frames)")
        session.require(self.shown("BricksDrawn") > 0, "it has drawn bricks")
        session.require(self.shown("TotalSeconds") > 0, "it has taken time")
        x, y, z = self.view.CameraPosition
        self.view.CameraPosition = [x + 1.0, y, z]
        self.view.SMProxy.InteractiveRender()
        session.require(self.shown("Frames") == first, "pictures while something moves are not fetched")
        self.view.SMProxy.StillRender()
        later = self.shown("Frames")
        session.require(later == first + 2, f"the next still picture was fetched ({first}, then {later} frames)")


def main():
    arguments = session.parser(__doc__).parse_args()
    session.begin(arguments)
    LastFrame().run()
    print("ok: the panel follows the pictures")


if __name__ == "__main__":
    main()
