# SPDX-License-Identifier: BSD-3-Clause
"""report.py CODEC.csv CHART.png : draws rates and distortions, and prints sizes as a table."""

import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)
from matplotlib.lines import Line2D  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

BITS_OF_TABLE = 8
WIDTH = 14  # of the table's columns; longer names of datasets are cut
# Peers' last digits of float32 may cross the bound: that is no reason to leave them out.
SLACK = 1.001


def is_ours(method):
    return method.startswith("banyan")


def keeps_bound(row):
    return row["max_error_over_bound"] <= SLACK


def accuracy_bits(row):
    """The bits of accuracy that the measured error amounts to."""
    error = row["max_error_over_bound"] * row["error_bound"]
    return math.log2(row["range"] / error) - 1 if error > 0 and row["range"] > 0 else math.nan


def style_of(method, methods):
    """Ours are drawn in strong lines, the default strongest; peers in thin ones."""
    own = [name for name in methods if is_ours(name)]
    peers = [name for name in methods if not is_ours(name)]
    if is_ours(method):
        shade = 0.9 - 0.5 * own.index(method) / max(1, len(own) - 1)
        return dict(color=plot.cm.Reds(shade), linewidth=2.5 if method == "banyan" else 1.5,
                    marker="o", zorder=4 if method == "banyan" else 3)
    place = peers.index(method)
    # The ten colours of the map without its red, which is ours.
    colors = [plot.cm.tab10(i) for i in range(10) if i != 3]
    return dict(color=colors[place % 9], linewidth=1,
                marker="sv^D<>Pp*h"[place % 10], linestyle="--", zorder=2)


def draw_curve(axes, rows, value, style):
    rows = [row for row in rows if math.isfinite(value(row))]
    axes.plot([row["bits_per_voxel"] for row in rows], [value(row) for row in rows],
              markersize=0, **style)
    for row in rows:
        # Hollow: the bound is broken.
        axes.plot(row["bits_per_voxel"], value(row), marker=style["marker"], markersize=5,
                  color=style["color"], zorder=style["zorder"],
                  fillstyle="full" if keeps_bound(row) else "none")


def limit_to_ours(axes, values):
    """Peers that overshoot far must not squeeze all others together."""
    values = [value for value in values if math.isfinite(value)]
    if values and axes.get_ylim()[1] > 1.4 * max(values):
        axes.set_ylim(top=1.4 * max(values))


def draw(rows, path):
    methods = in_order(rows, "method")
    # A dataset with a single accuracy has no curve; it stands in the table.
    datasets = [dataset for dataset in in_order(rows, "dataset")
                if len({row["bits_of_accuracy"] for row in rows if row["dataset"] == dataset}) > 1]
    datasets = datasets or in_order(rows, "dataset")
    figure, grid = plot.subplots(2, len(datasets), figsize=(4.2 * len(datasets) + 0.6, 8.5),
                                 squeeze=False)
    measures = [("PSNR in dB", lambda row: row["psnr_db"]),
                ("accuracy of the worst voxel in bits", accuracy_bits)]
    for column, dataset in enumerate(datasets):
        for axes, (label, value) in zip(grid[:, column], measures):
            for method in methods:
                curve = [row for row in rows
                         if row["dataset"] == dataset and row["method"] == method]
                draw_curve(axes, curve, value, style_of(method, methods))
            limit_to_ours(axes, [value(row) for row in rows
                                 if row["dataset"] == dataset and is_ours(row["method"])])
            axes.set_xscale("log", base=2)
            axes.xaxis.set_major_formatter("{x:g}")
            axes.grid(True, alpha=0.3)
            axes.set_title(dataset)
            axes.set_xlabel("bits per voxel")
            axes.set_ylabel(label)
    handles = [Line2D([], [], label=method, markersize=5, **style_of(method, methods))
               for method in methods]
    figure.legend(handles=handles, loc="lower center", ncol=7, frameon=False)
    figure.tight_layout(rect=(0, 0.07, 1, 1))
    figure.savefig(path, dpi=100, metadata={"Software": None})


def print_table(rows):
    rows = [row for row in rows if row["bits_of_accuracy"] == BITS_OF_TABLE]
    datasets = in_order(rows, "dataset")
    cell = {(row["method"], row["dataset"]): row for row in rows}
    print(f"Bits per voxel at {BITS_OF_TABLE} bits of accuracy (* breaks the bound)")
    print(" " * 18 + "".join(f"{dataset[:WIDTH - 2]:>{WIDTH}}" for dataset in datasets))
    for method in in_order(rows, "method"):
        line = f"{method:18}"
        for dataset in datasets:
            row = cell.get((method, dataset))
            text = "-" if row is None else f"{row['bits_per_voxel']:.4f}" + (
                " " if keeps_bound(row) else "*")
            line += f"{text:>{WIDTH}}"
        print(line)
    print_best(rows, datasets)


def print_best(rows, datasets):
    """The smallest peer that keeps the bound, and how many times it is larger than ours."""
    names, ratios = f"{'best peer':18}", f"{'best peer / banyan':18}"
    for dataset in datasets:
        own = [row for row in rows if row["dataset"] == dataset and row["method"] == "banyan"]
        peers = [row for row in rows if row["dataset"] == dataset
                 and not is_ours(row["method"]) and keeps_bound(row)]
        best = min(peers, key=lambda row: row["bits_per_voxel"], default=None)
        names += f"{best['method'][:WIDTH - 2] + ' ' if best else '- ':>{WIDTH}}"
        ratio = f"{best['bits_per_voxel'] / own[0]['bits_per_voxel']:.2f} " if best and own else "- "
        ratios += f"{ratio:>{WIDTH}}"
    print(names)
    print(ratios)


if len(sys.argv) != 3:
    sys.exit(__doc__)
measurements = read(sys.argv[1], ("dataset", "method"))
print_table(measurements)
draw(measurements, sys.argv[2])
