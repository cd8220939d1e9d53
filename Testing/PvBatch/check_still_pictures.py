# SPDX-License-Identifier: BSD-3-Clause
"""Checks that a still picture after an interaction keeps its tolerance, and is the one that a script
draws at once.
"""
import os

from paraview import simple

import picture_scenes
import pictures
import session

TOLERANCE = 2.0
COARSE = 64.0


class StillPictures:
    def __init__(self, folder):
        self.folder = folder
        self.view = session.new_view((400, 400), **picture_scenes.CAMERA)
        wavelet = simple.Wavelet(WholeExtent=[-40, 40, -40, 40, -40, 40])
        self.display = picture_scenes.volume(wavelet, self.view, "RTData")
        self.display.ImageErrorTolerance = TOLERANCE
        self.display.InteractiveImageErrorTolerance = COARSE
        self.display.InteractiveFrameSeconds = 0.0

    def statistic(self, name):
        self.display.UpdatePropertyInformation()
        return self.display.GetPropertyValue(name)

    def require_exact(self, what):
        error = self.statistic("EstimatedImageError")
        session.require(error <= TOLERANCE, f"{what} keeps the tolerance, not {error}")
        limit = self.statistic("ImageErrorLimit")
        session.require(not limit, f"{what} needs no words: {limit}")

    def picture(self, name):
        """What the window shows, without drawing again."""
        path = os.path.join(self.folder, name + ".png")
        simple.SaveScreenshot(path, self.view, ImageResolution=[400, 400])
        return pictures.load(path)

    def run(self):
        simple.Render(self.view)
        self.require_exact("the first picture")
        session.require(self.statistic("EncodingErrorOfValues") == 0, "plain data were not encoded")
        first = self.picture("first")
        self.view.SMProxy.InteractiveRender()
        self.view.SMProxy.StillRender()
        self.require_exact("a picture of a scene that is known")

        camera = list(self.view.CameraPosition)
        moved = [camera[0] + 1.0, camera[1], camera[2]]
        self.view.CameraPosition = moved
        self.view.SMProxy.InteractiveRender()
        interactive = self.statistic("EstimatedImageError")
        session.require(interactive > TOLERANCE, f"interaction is coarse ({interactive})")
        self.view.SMProxy.StillRender()
        self.require_exact("a picture after an interaction")
        after = self.picture("after an interaction")
        session.require(pictures.difference(after, first).max() > 1, "the camera has moved")

        self.view.CameraPosition = camera
        simple.Render(self.view)
        self.view.CameraPosition = moved
        simple.Render(self.view)
        worst = pictures.difference(after, self.picture("at once")).max()
        session.require(worst == 0, f"it is the one that is drawn at once ({worst})")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    StillPictures(arguments.out).run()
    session.clear()
    print("ok: still pictures are exact")


if __name__ == "__main__":
    main()
