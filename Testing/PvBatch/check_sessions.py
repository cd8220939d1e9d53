# SPDX-License-Identifier: BSD-3-Clause
"""Checks what people do in a session beyond one picture, on any number of ranks: nothing may hang.

Two views, two volumes, interactive rendering, playing a series, switching representations, caches of
its own for a series, a Surface LIC beside, removing the data, an array that is not there, a series that is damaged. Each step must
leave the following ones right: the same scene is drawn again at the end and must be the same picture.
"""
import glob
import os
import shutil
import sys

from paraview import simple

import picture_scenes
import pictures
import session


class Sessions:
    def __init__(self, arguments):
        self.folder = arguments.out
        self.data = arguments.data
        self.failures = []

    def expect(self, condition, sentence):
        print(("ok: " if condition else "FAILED ") + sentence, flush=True)
        if not condition:
            self.failures.append(sentence)

    def take(self, view, name):
        path = os.path.join(self.folder, name + ".png")
        simple.SaveScreenshot(path, view, ImageResolution=list(picture_scenes.SIZE))
        return pictures.load(path)

    def changed(self, a, b):
        return int((pictures.difference(a, b) > 2).sum())

    def scene(self):
        drawn = picture_scenes.encoded_and_spheres()
        picture = self.take(drawn.view, "scene")
        return drawn, picture

    def two_views(self):
        _, first = self.scene()
        second = picture_scenes.parallel_projection()
        with_both = self.take(second.view, "second view")
        self.expect(self.changed(first, with_both) > 5000, "two views show different pictures")
        session.clear()

    def two_volumes(self):
        # Side by side as seen.
        view = session.new_view(picture_scenes.SIZE, CameraPosition=[0, 0, 150],
                                CameraFocalPoint=[0, 0, 0], CameraViewUp=[0, 1, 0])
        left = picture_scenes.encoded(view)
        session.move_to(left, [-25, 0, 0])
        alone = self.take(view, "left volume")
        right = picture_scenes.wavelet(view)
        session.move_to(right, [25, 0, 0])
        both = self.take(view, "two volumes")
        middle = picture_scenes.SIZE[0] // 2
        self.expect(pictures.difference(alone, both)[:, :middle].max() <= 1,
                    "a second volume beside leaves the first as it is")
        self.expect(self.changed(alone[:, middle:], both[:, middle:]) > 3000,
                    "the second volume is there")
        session.clear()

    def interaction(self):
        drawn, still = self.scene()
        for angle in range(3):
            drawn.view.CameraPosition = [45 + angle, 40, 100]
            drawn.view.SMProxy.InteractiveRender()
        drawn.view.CameraPosition = picture_scenes.CAMERA["CameraPosition"]
        again = self.take(drawn.view, "after interaction")
        self.expect(pictures.difference(still, again).max() <= 1,
                    "after interaction the picture is the one before")
        session.clear()

    def playing(self):
        self.play("Measured cost", 1)
        # Zones that stay where they are give the same bits again.
        self.play("Off", 0)

    def play(self, balancing, most):
        drawn, _ = self.scene()
        drawn.volumes[0].LoadBalancing = balancing
        played = [self.take(drawn.view, f"step 0, {balancing}")]
        for step in (1.0, 2.0, 0.0):
            drawn.view.ViewTime = step
            played.append(self.take(drawn.view, f"step {step}, {balancing}"))
        self.expect(self.changed(played[0], played[1]) > 1000 and
                    self.changed(played[1], played[2]) > 1000, "steps look different")
        self.expect(pictures.difference(played[0], played[3]).max() <= most,
                    f"going back gives the first picture again (balancing: {balancing})")
        session.clear()

    def representations(self):
        drawn, first = self.scene()
        display = drawn.volumes[0]
        for name in ("Outline", "Surface", "Slice", session.REPRESENTATION):
            display.SetRepresentationType(name)
            last = self.take(drawn.view, "representation " + name)
        self.expect(pictures.difference(first, last).max() <= 1,
                    "switching to other representations and back gives the same picture")
        display.Visibility = 0
        hidden = self.take(drawn.view, "hidden")
        display.Visibility = 1
        shown = self.take(drawn.view, "shown")
        self.expect(self.changed(hidden, first) > 5000, "a hidden volume is not drawn")
        self.expect(pictures.difference(first, shown).max() <= 1, "a shown volume is drawn again")
        session.clear()

    def budgets(self):
        """A series gets caches of its own, others, and none again, while it is shown."""
        drawn, first = self.scene()
        display = drawn.volumes[0]
        reader = display.Input
        for mebibytes in (0, 1, 64, -1):
            reader.CacheBudget = mebibytes
            again = self.take(drawn.view, f"budget {mebibytes}")
            self.expect(pictures.difference(first, again).max() <= 1,
                        f"the picture is the same with a budget of {mebibytes}")
            display.UpdatePropertyInformation()
            held = display.GetPropertyValue("CacheBytes")
            self.expect((held > 0) == (mebibytes != 0), f"{held} bytes are kept of {mebibytes} MiB")
        session.clear()

    def surface_lic(self):
        """It draws in ways of its own, which must not change how the volume is drawn beside it."""
        view = session.new_view(picture_scenes.SIZE, **picture_scenes.CAMERA)
        picture_scenes.wavelet(view)
        beside = simple.Show(simple.Sphere(Center=[-32, 0, 0], Radius=4), view)
        taken = []
        for name in ("Surface", "Surface LIC"):
            beside.SetRepresentationType(name)
            taken.append(self.take(view, "beside " + name)[:, picture_scenes.SIZE[0] // 2:])
        self.expect(pictures.difference(*taken).max() <= 1, "a Surface LIC leaves the volume as it is")
        session.clear()

    def missing_array(self):
        drawn, first = self.scene()
        drawn.volumes[0].ColorArrayName = ["POINTS", "no such array"]
        self.take(drawn.view, "missing array")
        drawn.volumes[0].ColorArrayName = ["POINTS", "swirl"]
        again = self.take(drawn.view, "array again")
        self.expect(pictures.difference(first, again).max() <= 1,
                    "after an array that does not exist the picture is the one before")
        session.clear()

    def damaged(self):
        """One byte of one brick: the rank that needs it fails, and all of them refuse the data."""
        name = "damaged"
        source = os.path.join(self.data, "swirl.banyan")
        target = os.path.join(self.folder, name + ".banyan")
        shutil.copytree(source + ".d", target + ".d")
        shutil.copy(source, target)
        # Bricks come first, those of the first step before the others (Documentation/format.md).
        segment, = glob.glob(os.path.join(target + ".d", "*.seg"))
        with open(segment, "r+b") as file:
            file.seek(os.path.getsize(segment) // 8)
            byte = file.read(1)[0]
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte ^ 0xFF]))
        picture_scenes.Settings.data = self.folder
        view = session.new_view(picture_scenes.SIZE, **picture_scenes.CAMERA)
        refused = False
        try:
            picture_scenes.encoded(view, name)
        except RuntimeError as error:
            refused = True
            print(f"refused: {error}")
        picture_scenes.Settings.data = self.data
        self.expect(refused, "a damaged series is refused")
        self.take(view, name)  # and what is there can still be drawn
        session.clear()

    def run(self):
        _, first = self.scene()
        session.clear()
        for step in (self.two_views, self.two_volumes, self.interaction, self.playing,
                     self.representations, self.budgets, self.surface_lic, self.missing_array, self.damaged):
            print(f"--- {step.__name__}", flush=True)
            step()
        _, last = self.scene()
        self.expect(pictures.difference(first, last).max() == 0,
                    "all is as it was at the beginning")
        session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", required=True, help="folder with swirl.banyan")
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    picture_scenes.Settings.data = arguments.data
    sessions = Sessions(arguments)
    sessions.run()
    if sessions.failures:  # an exit of rank 0 alone would look like a crash
        sys.exit(1)


if __name__ == "__main__":
    main()
