# SPDX-License-Identifier: BSD-3-Clause
"""Checks that pictures do not depend on the sample distance, nor on the unit of length.

With smooth colours and opacities, half and a quarter of the sample distance give the same picture
within 2 of 255; so do all coordinates times 10 with the unit distance (and the camera) times 10.
"""
import os
import sys

from paraview import simple

import make_series
import picture_scenes
import pictures
import session

SIZE = (300, 300)
SAMPLES = (41, 33, 29)
TOLERANCE = 2


def draw(source, array, scale, samples, path):
    camera = dict(picture_scenes.CAMERA, CameraPosition=[45 * scale, 40 * scale, 100 * scale])
    # Edge smoothing turns differences of one into larger ones where it begins to see an edge.
    view = session.new_view(SIZE, **camera)
    display = picture_scenes.volume(source, view, array, 2.0 * scale, (0.0, 1.0),
                                    opacities=(0.0, 0.1, 0.2, 0.3, 0.4))
    display.SampleDistanceVoxels = samples
    simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
    simple.Delete(view)
    return pictures.load(path)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    cases = {}
    for scale in (1.0, 10.0):
        name = f"times{scale:.0f}"
        header = make_series.write_step(arguments.out, name, 0, SAMPLES, [scale] * 3)
        plain = simple.OpenDataFile(header)
        array = plain.PointData.GetArray(0).GetName()
        path = os.path.join(arguments.out, name + ".banyan")
        simple.SaveData(path, proxy=plain, ErrorBound=1 / 4096)
        cases[f"plain, {name}"] = plain, array, scale
        cases[f"encoded, {name}"] = simple.OpenDataFile(path), array, scale

    reference = None
    failures = 0
    for name, (source, array, scale) in cases.items():
        for samples in (1.0, 0.5, 0.25):
            path = os.path.join(arguments.out, f"{name}, {samples}.png".replace(", ", "_"))
            picture = draw(source, array, scale, samples, path)
            reference = picture if reference is None else reference
            error = int(pictures.difference(reference, picture).max())
            print(f"{name}, {samples} voxels between samples: largest difference {error}")
            failures += error > TOLERANCE
    drawn = int((pictures.difference(reference, reference[:1, :1] + 0 * reference) > 20).sum())
    print(f"{drawn} pixels drawn")
    sys.exit(1 if failures or drawn < 10000 else 0)


if __name__ == "__main__":
    main()
