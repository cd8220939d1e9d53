# SPDX-License-Identifier: BSD-3-Clause
"""report.py MIXING.csv [CHART.png PICTURES SHEET.png] : prints a table of what each renderer took, draws error against
time, a panel for each scene, and puts the pictures of the folder PICTURES side by side."""

import os
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

WORDS = {"scene", "renderer"}
MARKS = {"banyan": ("o", "tab:red"), "banyan-every-sample": ("*", "tab:red"), "banyan-apart": ("o", "tab:gray"),
         "banyan-apart-every-sample": ("*", "tab:gray")}
VTK = ("s-", "tab:blue")
EQUAL_DB = 100.0  # where pictures without a difference are drawn


def number(value, text):
    """Nothing where it is not known."""
    return "-" if value is None else format(value, text)


def lines_of(rows):
    yield "| scene | renderer | first frame s | ms per frame | PSNR dB | largest error |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        yield (f"| {row['scene']} | {row['renderer']} | {number(row['first_frame_s'], '.2f')} "
               f"| {number(row['ms_per_frame'], '.0f')} | {number(row['psnr_db'], '.1f')} "
               f"| {number(row['max_error'], '.0f')} |")


def draw_panel(axes, rows):
    axes.set_title(rows[0]["scene"], fontsize=10)
    axes.set_xscale("log")
    axes.set_xlabel("ms per frame")
    axes.grid(True, which="both", alpha=0.25)
    shown = [row for row in rows if row["ms_per_frame"] and row["psnr_db"] is not None]
    points = {row["renderer"]: (row["ms_per_frame"], min(row["psnr_db"], EQUAL_DB)) for row in shown}
    for name, (mark, colour) in MARKS.items():
        if name in points:
            axes.plot(*points[name], mark, color=colour, label=name)
    theirs = {name: point for name, point in points.items() if name not in MARKS}
    if theirs:
        axes.plot(*zip(*theirs.values()), VTK[0], color=VTK[1], label="vtk-multi-volume, by voxels between samples")
    for name, point in theirs.items():
        axes.annotate(name.split("-")[-1], point, fontsize=7, xytext=(4, 3), textcoords="offset points")
    axes.legend(fontsize=7)


def draw(rows, path):
    scenes = in_order(rows, "scene")
    figure, panels = plot.subplots(1, len(scenes), figsize=(5 * len(scenes), 4.2), squeeze=False)
    for axes, scene in zip(panels.flat, scenes):
        draw_panel(axes, [row for row in rows if row["scene"] == scene])
    panels[0, 0].set_ylabel("PSNR, dB")
    figure.suptitle("Higher and left is better")
    figure.tight_layout()
    figure.savefig(path, dpi=80, metadata={"Software": None})
    plot.close(figure)


def side_by_side(rows, folder, path):
    scenes, renderers = in_order(rows, "scene"), ["reference", *in_order(rows, "renderer")]
    figure, panels = plot.subplots(len(scenes), len(renderers), squeeze=False,
                                   figsize=(3 * len(renderers), 3.6 * len(scenes)))
    for line, scene in zip(panels, scenes):
        for axes, renderer in zip(line, renderers):
            picture = os.path.join(folder, f"{scene}-{renderer}.png")
            axes.axis("off")
            if os.path.exists(picture):
                axes.imshow(plot.imread(picture))
                axes.set_title(f"{scene}\n{renderer}", fontsize=9)
    figure.tight_layout()
    figure.savefig(path, dpi=80, metadata={"Software": None})
    plot.close(figure)


def main(arguments):
    rows = read(arguments[0], WORDS)
    print("\n".join(lines_of(rows)))
    if len(arguments) > 1:
        draw(rows, arguments[1])
        side_by_side(rows, *arguments[2:])


if __name__ == "__main__":
    main(sys.argv[1:])
