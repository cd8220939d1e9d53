# SPDX-License-Identifier: BSD-3-Clause
"""Checks that still pictures after an interaction become better in passes, and never worse.

With streaming on (a setting of ParaView) the first still picture may be as coarse as those of the
interaction; each streaming pass draws a better one until the tolerance is kept; and then no more
passes come. Pictures that no interaction came before keep the tolerance at once.
"""
import os

from paraview import simple

import picture_scenes
import pictures
import session

MOST_PASSES = 10
TOLERANCE = 2.0
COARSE = 64.0


class Refinement:
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

    def picture(self, name):
        """What the window shows, without drawing again."""
        path = os.path.join(self.folder, name + ".png")
        simple.SaveScreenshot(path, self.view, ImageResolution=[400, 400])
        return pictures.load(path)

    def passes(self):
        """Error and frame number of each picture until there is none to come."""
        result = [(self.statistic("EstimatedImageError"), self.statistic("Frames"))]
        while self.view.SMProxy.StreamingUpdate(True):
            result.append((self.statistic("EstimatedImageError"), self.statistic("Frames")))
            session.require(len(result) <= MOST_PASSES, "the passes come to an end")
        return result

    def run(self):
        settings = simple.GetSettingsProxy("GeneralSettings")
        settings.EnableStreaming = 1
        simple.Render(self.view)
        session.require(self.statistic("EstimatedImageError") <= TOLERANCE,
                        "without an interaction the first picture keeps the tolerance, not "
                        f"{self.statistic('EstimatedImageError')}")
        session.require(len(self.passes()) == 1, "and no passes follow")
        exact = self.picture("exact")

        self.view.SMProxy.InteractiveRender()
        self.view.SMProxy.StillRender()
        session.require(len(self.passes()) == 1, "of a scene that is known no worse picture follows")

        camera = list(self.view.CameraPosition)
        self.view.CameraPosition = [camera[0] + 1.0, camera[1], camera[2]]
        self.view.SMProxy.InteractiveRender()
        interactive = self.statistic("EstimatedImageError")
        session.require(interactive > TOLERANCE, f"interaction is coarse ({interactive})")
        self.view.SMProxy.StillRender()
        limit = self.statistic("ImageErrorLimit")
        session.require("still being refined" in limit, f"coarse pictures say so: {limit}")
        passes = self.passes()
        print("passes:", passes)
        limit = self.statistic("ImageErrorLimit")
        session.require(not limit, f"the last one needs no words: {limit}")
        session.require(self.statistic("EncodingErrorOfValues") == 0, "plain data were not encoded")
        errors = [error for error, _ in passes]
        session.require(len(passes) >= 3, f"there are several passes: {passes}")
        session.require(errors == sorted(errors, reverse=True), f"errors go down: {errors}")
        session.require(errors[0] <= COARSE, "the first keeps the tolerance of the interaction")
        session.require(errors[-1] <= TOLERANCE < errors[0], f"the last keeps the tolerance: {errors}")
        frames = [frame for _, frame in passes]
        session.require(all(b == a + 1 for a, b in zip(frames, frames[1:])),
                        f"each pass draws one picture: {frames}")
        simple.Render(self.view)
        session.require(self.statistic("EstimatedImageError") <= TOLERANCE,
                        "drawn again it stays as good")
        refined = self.picture("refined")

        # The same without passes.
        settings.EnableStreaming = 0
        self.view.CameraPosition = camera
        simple.Render(self.view)
        self.view.CameraPosition = [camera[0] + 1.0, camera[1], camera[2]]
        simple.Render(self.view)
        session.require(self.statistic("EstimatedImageError") <= TOLERANCE, "streaming can be left off")
        session.require(not self.view.SMProxy.StreamingUpdate(True), "and then nothing streams")
        worst = pictures.difference(refined, self.picture("at once")).max()
        session.require(worst <= 1, f"passes end with the picture drawn at once ({worst})")
        session.require(pictures.difference(refined, exact).max() > 1, "the camera has moved")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    Refinement(arguments.out).run()
    session.clear()
    print("ok: still pictures refine in passes")


if __name__ == "__main__":
    main()
