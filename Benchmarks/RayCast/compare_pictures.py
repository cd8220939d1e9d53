# SPDX-License-Identifier: BSD-3-Clause
"""compare_pictures.py FOLDER SHEET.png : one row per scene, the converged picture first, then each
renderer's, and under each of them eight times its difference from the first."""

import collections
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)
import numpy  # noqa: E402

MAGNIFIED = 8


def read(path):
    """A binary PPM as numbers from 0 to 255."""
    with open(path, "rb") as file:
        fields = [file.readline() for _ in range(3)]
        width, height = map(int, fields[1].split())
        return numpy.frombuffer(file.read(), numpy.uint8).reshape(height, width, 3).astype(int)


def show(axes, picture, title):
    axes.imshow(numpy.clip(picture, 0, 255).astype(numpy.uint8), interpolation="antialiased")
    axes.set_title(title, fontsize=8)
    axes.axis("off")


def main(folder, sheet):
    scenes = collections.defaultdict(dict)
    for reference in sorted(pathlib.Path(folder).glob("*-reference.ppm")):
        scene = reference.name[:-len("-reference.ppm")]
        for renderer in ("banyan", "vtk"):
            for path in sorted(pathlib.Path(folder).glob(f"{scene}-{renderer}*.ppm")):
                scenes[scene][path.stem[len(scene) + 1:]] = path
        scenes[scene] = {"reference": reference, **scenes[scene]}
    if not scenes:
        sys.exit(f"compare_pictures.py: there are no pictures in {folder}.")
    columns = max(map(len, scenes.values()))
    figure, grid = plot.subplots(2 * len(scenes), columns, squeeze=False,
                                 figsize=(3.2 * columns, 6.6 * len(scenes)))
    for axes in grid.flat:
        axes.axis("off")
    for row, (scene, pictures) in enumerate(scenes.items()):
        truth = read(pictures["reference"])
        for column, (name, path) in enumerate(pictures.items()):
            picture = read(path)
            show(grid[2 * row, column], picture, f"{scene}: {name}")
            if column > 0:
                show(grid[2 * row + 1, column], 128 + MAGNIFIED * (picture - truth),
                     f"difference times {MAGNIFIED}")
    figure.tight_layout()
    figure.savefig(sheet, dpi=80, metadata={"Software": None})


if len(sys.argv) != 3:
    sys.exit(__doc__)
main(sys.argv[1], sys.argv[2])
