# SPDX-License-Identifier: BSD-3-Clause
"""Writes the encoded series that the scenes draw: OUT/swirl.banyan and OUT/small.banyan.

swirl: 41 x 33 x 29 samples, 3 steps, unit spacing: 3 x 3 x 2 bricks, none of the last ones whole.
small: 9 x 9 x 9 samples in one brick, with a different spacing along each axis.
The values are smooth, in [0, 1], and move from step to step.
"""
import os

import numpy
from paraview import simple

import session

HEADER = """ObjectType = Image
NDims = 3
BinaryData = True
BinaryDataByteOrderMSB = False
CompressedData = False
Offset = {origin[0]} {origin[1]} {origin[2]}
ElementSpacing = {spacing[0]} {spacing[1]} {spacing[2]}
DimSize = {samples[0]} {samples[1]} {samples[2]}
ElementType = MET_FLOAT
ElementDataFile = {raw}
"""


def values(samples, step):
    """Float32 array [z][y][x] of a field with features in all parts of the box."""
    z, y, x = numpy.meshgrid(*(numpy.linspace(-1, 1, n) for n in reversed(samples)), indexing="ij")
    angle = 0.4 * step
    u, v = x * numpy.cos(angle) - y * numpy.sin(angle), x * numpy.sin(angle) + y * numpy.cos(angle)
    waves = numpy.cos(5 * u + 2 * z) * numpy.cos(6 * v - z) * numpy.cos(4 * z + 0.5 * step)
    blob = numpy.exp(-2 * (u**2 + (v - 0.2) ** 2 + z**2))
    return (0.5 + 0.25 * waves + 0.25 * blob).clip(0, 1).astype("<f4")


def write_step(folder, name, step, samples, spacing):
    """Raw values and a MetaImage header, the grid centred at the origin; the header's path."""
    origin = [-0.5 * h * (n - 1) for h, n in zip(spacing, samples)]
    stem = os.path.join(folder, f"{name}_{step}")
    values(samples, step).tofile(stem + ".raw")
    with open(stem + ".mhd", "w", encoding="ascii") as file:
        file.write(HEADER.format(origin=origin, spacing=spacing, samples=samples,
                                 raw=os.path.basename(stem) + ".raw"))
    return stem + ".mhd"


def encode(folder, name, samples, spacing, steps):
    files = [write_step(folder, name, step, samples, spacing) for step in range(steps)]
    source = simple.OpenDataFile(files)
    array = source.PointData.GetArray(0).GetName()
    # The series gets a name of its own, so that its colours are not those of other scenes.
    renamed = simple.Calculator(Input=source, Function=f'"{array}"', ResultArrayName="swirl")
    path = os.path.join(folder, name + ".banyan")
    simple.SaveData(path, proxy=renamed, WriteTimeSteps=1, ErrorBound=1 / 512,
                    PointArrays=["swirl"])
    reader = simple.OpenDataFile(path)
    session.require(reader is not None, f"{path} was not written")
    session.require(len(reader.TimestepValues) == steps or steps == 1, "steps are missing")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    encode(arguments.out, "swirl", (41, 33, 29), (1.0, 1.0, 1.0), 3)
    encode(arguments.out, "small", (9, 9, 9), (4.0, 3.0, 2.0), 1)


if __name__ == "__main__":
    main()
