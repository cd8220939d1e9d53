# SPDX-License-Identifier: BSD-3-Clause
"""report.py MESHES.csv [CHART.png] : prints a table of what each renderer took, and draws error against time, a panel for
each mesh."""

import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

WORDS = {"mesh", "renderer"}
OURS = "banyan"
MARKS = {"paraview-projected-tetra": "s", "paraview-bunyk": "^", "paraview-zsweep": "v", "paraview-resample": "D"}
EQUAL_DB = 100.0  # where pictures without a difference are drawn


def number(value, text):
    """Nothing where it is not known."""
    return "-" if value is None else format(value, text)


def lines_of(rows):
    """`times` is the time of a frame over that of ours with every sample, where both show the mesh."""
    yield ("| mesh | cells | renderer | tolerance | set-up s | first frame s | ms per frame | times | MB | PSNR dB "
           "| largest error |")
    yield "|---|---|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        ours = [other for other in rows
                if other["mesh"] == row["mesh"] and other["renderer"] == OURS and other["tolerance"] == 0]
        shown = all(one["psnr_db"] is not None for one in (row, *ours))
        times = row["ms_per_frame"] / ours[0]["ms_per_frame"] if ours and shown else None
        yield (f"| {row['mesh']} | {row['cells']:,.0f} | {row['renderer']} | {number(row['tolerance'], 'g')} "
               f"| {number(row['setup_s'], '.2f')} | {number(row['first_frame_s'], '.2f')} "
               f"| {number(row['ms_per_frame'], '.0f')} | {number(times, '.2f')} | {number(row['memory_mb'], '.0f')} "
               f"| {number(row['psnr_db'], '.1f')} | {number(row['max_error'], '.0f')} |")


def points(rows, renderer):
    """Rows of a renderer that have a time and an error: both, and the tolerance."""
    return [(row["ms_per_frame"], min(row["psnr_db"], EQUAL_DB), row["tolerance"]) for row in rows
            if row["renderer"] == renderer and row["ms_per_frame"] and row["psnr_db"] is not None]


def draw_panel(axes, rows):
    axes.set_title(f"{rows[0]['mesh']}: {rows[0]['cells']:,.0f} cells", fontsize=10)
    axes.set_xscale("log")
    axes.grid(True, which="both", alpha=0.25)
    ours = points(rows, OURS)
    for label, style, found in ((OURS, "o-", [point for point in ours if point[2]]),
                                (OURS + ", every sample", "*", [point for point in ours if not point[2]])):
        if found:
            axes.plot(*zip(*[point[:2] for point in found]), style, color="tab:red", label=label)
    for ms, psnr, tolerance in ours:
        if tolerance:
            axes.annotate(f"{tolerance:g}", (ms, psnr), fontsize=7, xytext=(4, 3), textcoords="offset points")
    for renderer, mark in MARKS.items():
        for ms, psnr, _ in points(rows, renderer)[:1]:
            axes.plot(ms, psnr, mark, color="tab:blue", label=renderer)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7)
    else:
        axes.annotate("no picture was compared", (0.5, 0.5), xycoords="axes fraction", ha="center", color="tab:gray")


def draw(rows, path):
    meshes = in_order(rows, "mesh")
    across = min(3, len(meshes))
    down = math.ceil(len(meshes) / across)
    figure, panels = plot.subplots(down, across, figsize=(5 * across, 3.6 * down + 0.6), squeeze=False)
    for axes, mesh in zip(panels.flat, meshes):
        draw_panel(axes, [row for row in rows if row["mesh"] == mesh])
    for axes in panels.flat[len(meshes):]:
        axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel("PSNR, dB")
    for axes in panels[-1]:
        axes.set_xlabel("ms per frame")
    figure.suptitle("Higher and left is better; numbers are tolerances in 1/255")
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})
    plot.close(figure)


def main(arguments):
    rows = read(arguments[0], WORDS)
    print("\n".join(lines_of(rows)))
    if len(arguments) > 1:
        draw(rows, arguments[1])


if __name__ == "__main__":
    main(sys.argv[1:])
