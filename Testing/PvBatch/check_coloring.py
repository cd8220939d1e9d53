# SPDX-License-Identifier: BSD-3-Clause
"""Checks colouring from Python: ColorBy, rescaling, opacities, components, visibility, placing.

Everything a script does to ParaView's own Volume must do the same to ours, so each picture is also
drawn with "Volume" and must be alike (35 dB); and each change must change the picture. One picture
is compared otherwise: VTK 9.2 applies the opacity twice where a component of a vector is drawn (a
ray of opacity a gets 1 - (1 - a)^2), so a component must look like a scalar array of its values.
"""
import os
import sys

from paraview import simple

import picture_scenes
import pictures
import session

LEAST_DECIBEL = 35.0


class Stage:
    """A data set with a scalar and a vector array, shown in one way; takes pictures by name."""

    def __init__(self, representation, folder):
        picture_scenes.Settings.representation = representation
        self.folder = folder
        self.taken = {}
        wavelet = simple.Wavelet(WholeExtent=[-20, 20, -16, 16, -14, 14])
        square = simple.Calculator(Input=wavelet, Function="RTData*RTData/100",
                                   ResultArrayName="Square")
        vector = "iHat*coordsX + jHat*coordsY*2 + kHat*coordsZ*3"
        both = simple.Calculator(Input=square, Function=vector, ResultArrayName="Vector")
        self.source = simple.Calculator(Input=both, Function="coordsY*2", ResultArrayName="Second")
        self.view = session.new_view((300, 300), **picture_scenes.CAMERA)
        self.display = picture_scenes.volume(self.source, self.view, "RTData")
        self.stem = representation.replace(" ", "")

    def take(self, name):
        path = os.path.join(self.folder, f"{self.stem}.{name}.png")
        simple.SaveScreenshot(path, self.view, ImageResolution=[300, 300])
        self.taken[name] = pictures.load(path)

    def color_by(self, array, component=None):
        """As a user does it: the maps of that array, rescaled to its range."""
        simple.ColorBy(self.display, ("POINTS", array) + ((component,) if component else ()))
        self.display.RescaleTransferFunctionToDataRange(False, True)
        self.display.LookupTable = simple.GetColorTransferFunction(array)
        self.display.ScalarOpacityFunction = simple.GetOpacityTransferFunction(array)
        self.display.SetScalarBarVisibility(self.view, False)

    def run(self):
        self.take("first")
        self.display.RescaleTransferFunctionToDataRange(False, True)
        self.take("rescaled")
        picture_scenes.colors_of("RTData", 100, 200)
        self.take("other functions")
        self.display.ScalarOpacityUnitDistance = 4.0
        self.take("unit distance 4")
        self.display.ScalarOpacityUnitDistance = 2.0
        self.color_by("Square")
        self.take("another array")
        self.color_by("Vector", "Magnitude")
        self.take("magnitude")
        self.color_by("Vector", "Y")
        self.take("component")
        self.color_by("Second")
        self.take("component as scalar")
        self.color_by("RTData")
        self.take("back again")
        session.move_to(self.display, [8, 4, 0])
        self.take("moved")
        self.display.Scale = [0.5, 1.0, 1.0]
        self.take("scaled")
        self.display.Orientation = [0, 30, 0]
        self.take("turned")
        self.display.Visibility = 0
        self.take("hidden")
        session.clear()
        return self.taken


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    theirs = Stage("Volume", arguments.out).run()
    ours = Stage(session.REPRESENTATION, arguments.out).run()
    failures = []
    before = None
    for name, picture in ours.items():
        other = ours["component as scalar"] if name == "component" else theirs[name]
        decibel = pictures.psnr(other, picture)
        changed = 0 if before is None else int((pictures.difference(before, picture) > 4).sum())
        print(f"{name}: {decibel:.1f} dB, {changed} pixels changed")
        if decibel < LEAST_DECIBEL:
            failures.append(f"'{name}' does not look as it should: {decibel:.1f} dB")
        if before is not None and changed < 1000 and name != "component as scalar":
            failures.append(f"'{name}' changes only {changed} pixels")
        before = picture
    for failure in failures:
        print("FAILED " + failure, file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
