# SPDX-License-Identifier: BSD-3-Clause
"""report_scaling.py SCALING.csv CHART.png : draws time and memory against the volume's size."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)
from matplotlib.ticker import LogLocator, NullFormatter  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import read  # noqa: E402
from verdicts import lines_of, show  # noqa: E402


def read_scaling(path):
    rows = read(path, ("scene", "source"))
    for row in rows:
        row["size"] = int(row["scene"].split("-")[1])
        row["sampling"] = f"error {row['tolerance']:g}/255" if row["tolerance"] else "one per voxel"
    return rows


def draw(rows, path):
    panels = [("ms_per_frame", "ms per frame, later frames"),
              ("first_frame_ms", "ms until the first frame"), ("peak_mib", "peak memory in MiB")]
    figure, grid = plot.subplots(1, len(panels), figsize=(15, 4.8))
    sizes = sorted({row["size"] for row in rows})
    most = max(row["threads"] for row in rows)
    for axes, (column, label) in zip(grid, panels):
        for source, color in (("series", "tab:red"), ("memory", "tab:blue")):
            for sampling, line in (("one per voxel", ":"), ("error 16/255", "--"), ("error 4/255", "-."),
                                   ("error 1/255", "-")):
                curve = [row for row in rows if row["source"] == source
                         and row["threads"] == most and row["sampling"] == sampling]
                name = "an encoded series" if source == "series" else source
                axes.plot([row["size"] for row in curve], [row[column] for row in curve], line,
                          color=color, marker="o", markersize=4,
                          label=f"from {name}, {sampling}")
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(sizes, [f"{size}³" for size in sizes])
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="both", alpha=0.25)
        axes.set_ylabel(label)
    grid[0].legend(fontsize=8)
    figure.suptitle(f"Scene S2: nine voxels in ten are invisible; {most:g} threads")
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})


def print_table(rows):
    print(f"{'scene':10}{'source':>8}{'threads':>9}{'sampling':>15}{'first ms':>10}{'later ms':>10}"
          f"{'Msamples':>10}{'peak MiB':>10}{'file MiB':>10}{'later / 256^3':>15}")
    for row in rows:
        base = [other["ms_per_frame"] for other in rows if other["size"] == 256
                and all(other[key] == row[key] for key in ("source", "threads", "sampling"))]
        ratio = f"{row['ms_per_frame'] / base[0]:.2f}" if base else "-"
        print(f"{row['scene']:10}{row['source']:>8}{row['threads']:9g}{row['sampling']:>15}"
              f"{row['first_frame_ms']:10.0f}"
              f"{row['ms_per_frame']:10.0f}{1e-6 * row['samples']:10.1f}{row['peak_mib']:10.0f}"
              f"{row['file_mib']:10.1f}{ratio:>15}")


def print_memory(rows):
    """The largest encoded series beside its budget."""
    series = [row for row in rows if row["source"] == "series"]
    for row in series:
        if row["size"] == max(other["size"] for other in series):
            above = row["peak_mib"] - row["budget_mib"]
            print(f"{row['scene']}, {row['threads']:g} thread(s), {row['sampling']}: peak of the whole "
                  f"process {abs(above):.0f} MiB {'above' if above > 0 else 'below'} the budget of its caches")


if len(sys.argv) != 3:
    sys.exit(__doc__)
measurements = read_scaling(sys.argv[1])
print_table(measurements)
print()
print_memory(measurements)
print()
show(lines_of(measurements))
draw(measurements, sys.argv[2])
