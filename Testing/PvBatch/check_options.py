# SPDX-License-Identifier: BSD-3-Clause
"""Checks the options that ParaView's own Volume has as well, and those that its panel leaves out.

A script that sets shading, nearest interpolation, cropping or a blend mode on "Volume" must get the
same from ours under the same names: each picture is also drawn with "Volume" and must be alike, and
each option must change the picture. Blend modes that we do not draw must draw nothing.
"""
import os
import sys

from paraview import simple

import picture_scenes
import pictures
import session

# Theirs: normals come from differences around a sample, not from those at the points; averages and
# the samples at faces of the cropping box stand for whole steps.
LEAST_DECIBEL = {"shaded": 37.0, "average": 41.0, "cropped": 36.0}
OTHER_LEAST_DECIBEL = 50.0
SIZE = (300, 300)


class Stage:
    """A small data set, so that points can be told apart, drawn in one way with each option."""

    def __init__(self, representation, folder):
        picture_scenes.Settings.representation = representation
        self.folder = folder
        self.taken = {}
        self.view = session.new_view(SIZE, CameraPosition=[30, 25, 55], CameraViewUp=[0, 1, 0],
                                     CameraFocalPoint=[2, 0, 0], CameraViewAngle=25)
        # Light from the viewer, as ours always has it.
        self.view.UseLight = 0
        light = simple.CreateLight()
        light.Coords = "Camera"
        light.Position = [0, 0, 1]
        light.FocalPoint = [0, 0, 0]
        self.view.AdditionalLights = [light]
        source = simple.Wavelet(WholeExtent=[-8, 12, -8, 8, -7, 7])
        self.display = picture_scenes.volume(source, self.view, "RTData", 1.0, (40, 280),
                                             opacities=(0.0, 0.01, 0.05, 0.15, 0.4))
        self.ours = representation == session.REPRESENTATION
        if self.ours:
            self.display.SampleDistanceVoxels = 0.25
        self.stem = representation.replace(" ", "")

    def take(self, name, **options):
        # Copies: attributes of a display are the live properties.
        data = {option: self.display.GetProperty(option).GetData() for option in options}
        before = {option: list(value) if hasattr(value, "__len__") and not isinstance(value, str)
                  else value for option, value in data.items()}
        for option, value in options.items():
            setattr(self.display, option, value)
        path = os.path.join(self.folder, f"{self.stem}.{name}.png")
        simple.SaveScreenshot(path, self.view, ImageResolution=list(SIZE))
        self.taken[name] = pictures.load(path)
        for option, value in before.items():
            setattr(self.display, option, value)

    def run(self):
        self.take("plain")
        # Lights of VTK have no ambient part: theirs would be without effect.
        self.take("shaded", Shade=1, Ambient=0.0, Diffuse=0.9, Specular=0.0)
        self.take("nearest", InterpolationType="Nearest")
        self.take("cropped", UseCropping=1, CroppingOrigin=[3, -1.5, 0.5],
                  CroppingScale=[0.5, 0.75, 0.6])
        for mode, name in enumerate(("maximum", "minimum", "average"), 1):
            self.take(name, BlendMode=mode)
        if self.ours:
            self.take("ambient", Shade=1, Ambient=0.4, Diffuse=0.9, Specular=0.0)
            self.take("highlights", Shade=1, Ambient=0.0, Diffuse=0.9, Specular=0.8,
                      SpecularPower=10)
            self.take("nearest point", NearestPoint=1)
            for mode in ("Maximum", "Minimum", "Average"):
                self.take("projected " + mode.lower(), Projection=mode + " Intensity")
            self.take("isosurface", BlendMode="Isosurface")
            self.take("slice", BlendMode="Slice")
            self.take("plain again")
            self.take("hidden", Visibility=0)
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

    def require(condition, sentence):
        if not condition:
            failures.append(sentence)

    for name, picture in theirs.items():
        decibel = pictures.psnr(picture, ours[name])
        change = pictures.psnr(ours["plain"], ours[name])
        print(f"{name}: {decibel:.1f} dB to ParaView's, {change:.1f} dB to the plain picture")
        least = LEAST_DECIBEL.get(name, OTHER_LEAST_DECIBEL)
        require(decibel >= least, f"'{name}' does not look as it should: {decibel:.1f} dB")
        require(name == "plain" or change < least - 4, f"'{name}' changes too little")
    for one, other in (("plain again", "plain"), ("isosurface", "hidden"), ("slice", "hidden"),
                       ("nearest point", "nearest"), ("projected maximum", "maximum"), ("projected minimum", "minimum"),
                       ("projected average", "average")):
        largest = int(pictures.difference(ours[one], ours[other]).max())
        print(f"'{one}' against '{other}': largest difference {largest}")
        require(largest == 0, f"'{one}' is not '{other}'")
    for name in ("ambient", "highlights"):
        brighter = int((ours[name] - ours["shaded"]).max())
        require(brighter > 20, f"'{name}' makes the picture only {brighter} brighter")
    for failure in failures:
        print("FAILED " + failure, file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
