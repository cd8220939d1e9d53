# SPDX-License-Identifier: BSD-3-Clause
"""plot_steps.py TABLE PICTURE: draws the number of unchanged subtrees by size over the time steps.

TABLE is what banyan-info --csv writes. Each array has a picture of its own (figure 9 of the study).
"""

import csv
import re
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402 (the line before decides how it draws)

KIND = "unchanged"


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def sizes_of(rows):
    """Names of the columns with counts, and the voxels that they stand for."""
    found = [(int(match.group(1)), name) for name in rows[0]
             if (match := re.fullmatch(KIND + r"_(\d+)", name))]
    return sorted(found)


def draw(axes, rows):
    # Nothing comes before the first step, so nothing of it can be unchanged.
    rows = [row for row in rows if row["step"] != "0"] or rows
    steps = [int(row["step"]) for row in rows]
    marker = "o" if len(steps) == 1 else None
    highest = 1.0
    for voxels, name in sizes_of(rows):
        counts = [float(row[name]) for row in rows]
        highest = max(highest, *counts)
        if any(counts):
            axes.plot(steps, counts, label=f"{voxels} voxel{'s'[:voxels != 1]}", marker=marker)
    axes.set_yscale("symlog", linthresh=1)
    axes.set_ylim(0, 2 * highest)
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.set_xlabel("time step")
    axes.set_ylabel("number of blocks")
    axes.set_title(f"{rows[0]['array']}: unchanged subtrees of bricks", fontsize="medium")
    if axes.lines:
        axes.legend(fontsize="x-small", ncol=2)
    else:
        axes.text(0.5, 0.5, "none at any step", ha="center", transform=axes.transAxes)


def main():
    table, picture = sys.argv[1:3]
    rows = read(table)
    names = list(dict.fromkeys(row["array"] for row in rows))
    figure, axes = pyplot.subplots(len(names), squeeze=False, layout="constrained",
                                   figsize=(6.4, 4.0 * len(names)))
    for place, name in zip(axes[:, 0], names):
        draw(place, [row for row in rows if row["array"] == name])
    figure.savefig(picture, dpi=150)


main()
