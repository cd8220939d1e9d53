# SPDX-License-Identifier: BSD-3-Clause
"""report.py RAYCAST.csv CHART.png CHART-OF-LARGEST.png : draws time against the error of whole
pictures and against that of the worst pixel, and prints ratios as tables."""

import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)
from matplotlib.ticker import LogLocator, NullFormatter  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

OURS = "banyan"
STYLES = {"banyan": dict(color="tab:red", marker="o", linewidth=2.5, zorder=4),
          "banyan-plain": dict(color="tab:orange", marker="o", linewidth=1.2, zorder=3),
          "vtk-gpu": dict(color="tab:blue", marker="s", linewidth=1.2, zorder=3),
          "vtk-fixed-point": dict(color="tab:green", marker="v", linewidth=1.2, zorder=2)}
# Rounding to 8 bits may add a half to an error of 1.
LARGEST_ERROR = 1.5


def rms_error(row):
    """Root of the mean squared error, in 1/255."""
    return 255.0 * 10.0 ** (-row["psnr_db"] / 20.0)


def draw(rows, label, value, path):
    """One panel per scene; only the largest number of threads."""
    most = max(row["threads"] for row in rows)
    rows = [row for row in rows if row["threads"] == most]
    scenes = in_order(rows, "scene")
    columns = min(4, len(scenes))
    lines = -(-len(scenes) // columns)
    figure, grid = plot.subplots(lines, columns, figsize=(4.2 * columns + 0.4, 3.8 * lines + 0.8),
                                 squeeze=False)
    for axes in grid.flat[len(scenes):]:
        axes.axis("off")
    for axes, scene in zip(grid.flat, scenes):
        for renderer in in_order(rows, "renderer"):
            draw_curve(axes, [row for row in rows if row["scene"] == scene and
                              row["renderer"] == renderer], value, STYLES[renderer])
        axes.set_xscale("log")
        axes.set_yscale("log")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="both", alpha=0.25)
        axes.set_title(scene)
        axes.set_xlabel(label)
        axes.set_ylabel("ms per frame")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=6, frameon=False)
    figure.suptitle(f"{most:g} threads; left and below is better")
    figure.tight_layout(rect=(0, 0.04, 1, 1))
    figure.savefig(path, dpi=90, metadata={"Software": None})
    plot.close(figure)


def draw_curve(axes, rows, value, style):
    """A renderer's settings, from exact to quick: the tolerances where it has any."""
    if not rows:
        return
    name = rows[0]["renderer"]
    by_tolerance = [row for row in rows if row["tolerance"] is not None]
    by_step = [row for row in rows if row["tolerance"] is None]
    for curve, label, line in ((by_tolerance, f"{name}, tolerances", "-"),
                               (by_step, f"{name}, steps", ":" if by_tolerance else "-")):
        if curve:
            axes.plot([value(row) for row in curve], [row["ms_per_frame"] for row in curve],
                      label=label, linestyle=line, markersize=4, **style)


def fastest(rows, good):
    """The quickest of the settings that are good enough, or nothing."""
    return min((row["ms_per_frame"] for row in rows if good(row)), default=math.nan)


def print_table(rows, title, good):
    """Milliseconds of each renderer, and how many times faster ours is than each peer."""
    renderers = in_order(rows, "renderer")
    peers = [renderer for renderer in renderers if renderer != OURS]
    print(title)
    print(f"{'scene':18}{'threads':>8}" + "".join(f"{name + ' ms':>20}" for name in renderers) +
          "".join(f"{peer + ' / ours':>24}" for peer in peers))
    for scene in in_order(rows, "scene"):
        for threads in in_order(rows, "threads"):
            here = [row for row in rows if row["scene"] == scene and row["threads"] == threads]
            times = {name: fastest([row for row in here if row["renderer"] == name], good)
                     for name in renderers}
            line = f"{scene:18}{threads:8g}"
            line += "".join(f"{text(times[name], '.1f'):>20}" for name in renderers)
            line += "".join(f"{text(times[peer] / times.get(OURS, math.nan), '.1f'):>24}"
                            for peer in peers)
            print(line)
    print()


def text(number, form):
    return format(number, form) if math.isfinite(number) else "-"


if len(sys.argv) != 4:
    sys.exit(__doc__)
measurements = read(sys.argv[1], ("scene", "renderer"))
print_table(measurements, "One sample per voxel", lambda row: row["sample_distance"] == 1.0)
for decibels in (40, 50):
    print_table(measurements, f"Quickest setting of {decibels} dB or better",
                lambda row: row["psnr_db"] >= decibels)
print_table(measurements, "Quickest setting whose largest error is at most 1/255, rounding apart",
            lambda row: row["max_error"] <= LARGEST_ERROR)
draw(measurements, "rms error in 1/255", rms_error, sys.argv[2])
draw(measurements, "largest error in 1/255", lambda row: row["max_error"], sys.argv[3])
