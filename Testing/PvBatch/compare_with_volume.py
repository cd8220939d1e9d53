# SPDX-License-Identifier: BSD-3-Clause
"""Compares our pictures of real data with those of ParaView's own "Volume".

Same data, colours, opacities, unit distance and camera; at least 38 dB are asked for. What remains:
- ParaView starts sampling where each ray meets the data, we sample at multiples of one distance
  from the eye (so that ranks agree); the two see the values at different points of each ray.
- ParaView looks colours and opacities up in textures of 8 or 16 bit entries with linear
  interpolation, we take the nearest of 4096 float entries.
- ParaView's samples at both ends of a ray stand for a whole step, ours for what is left of one.
Needs BANYAN_DATA_DIR with bonsai and isabel_velmag; without it the test counts as skipped (77).
"""
import os
import sys

from paraview import simple

import pictures
import picture_scenes
import session

LEAST_DECIBEL = 38.0
SIZE = (512, 512)


def bonsai(view, folder):
    source = simple.OpenDataFile(os.path.join(folder, "bonsai", "bonsai.mhd"))
    view.CameraPosition = [128 + 420, 128 - 250, 128 + 330]
    view.CameraFocalPoint = [128, 128, 128]
    view.CameraViewUp = [0, 0, 1]
    array = source.PointData.GetArray(0).GetName()
    return source, array, (20, 220), (0.0, 0.01, 0.05, 0.1, 0.3), 1.0


def isabel(view, folder):
    source = simple.OpenDataFile(os.path.join(folder, "isabel_velmag", "isabel_30.vti"))
    source.UpdatePipeline()
    bounds = source.GetDataInformation().GetBounds()
    center = [(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)]
    length = bounds[1] - bounds[0]
    view.CameraFocalPoint = center
    view.CameraPosition = [center[0] + 0.5 * length, center[1] - 1.2 * length,
                           center[2] + 1.3 * length]
    view.CameraViewUp = [0, 0, 1]
    array = source.PointData.GetArray(0).GetName()
    low, high = source.PointData.GetArray(0).GetRange()
    return source, array, (low, high), (0.0, 0.02, 0.1, 0.2, 0.4), length / 124


def draw(make, folder, representation, path, samples):
    view = session.new_view(SIZE, CameraViewAngle=30)
    source, array, value_range, opacities, unit_distance = make(view, folder)
    picture_scenes.Settings.representation = representation
    display = picture_scenes.volume(source, view, array, unit_distance, value_range,
                                    opacities=opacities)
    if representation == session.REPRESENTATION:
        display.SampleDistanceVoxels = samples
    simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
    session.clear()
    return pictures.load(path)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--samples", type=float, default=1.0, help="SampleDistanceVoxels")
    arguments = parser.parse_args()
    folder = os.environ.get("BANYAN_DATA_DIR", "")
    if not all(os.path.isdir(os.path.join(folder, name)) for name in ("bonsai", "isabel_velmag")):
        print("BANYAN_DATA_DIR has no bonsai and isabel_velmag")
        sys.exit(77)
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    failures = 0
    for make in (bonsai, isabel):
        stem = os.path.join(arguments.out, make.__name__)
        theirs = draw(make, folder, "Volume", stem + ".volume.png", arguments.samples)
        ours = draw(make, folder, session.REPRESENTATION, stem + ".banyan.png", arguments.samples)
        decibel = pictures.psnr(theirs, ours)
        drawn = int((pictures.difference(ours, ours[:1, :1] + 0 * ours) > 8).sum())
        print(f"{make.__name__}: {decibel:.2f} dB, largest difference "
              f"{pictures.difference(theirs, ours).max()}, {drawn} pixels drawn")
        failures += decibel < LEAST_DECIBEL or drawn < 20000
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
