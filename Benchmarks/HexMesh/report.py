# SPDX-License-Identifier: BSD-3-Clause
"""report.py HEXMESH.csv CHART.png : draws what each renderer takes of the first mesh, and prints a
    table of each.
report.py --scaling SCALING.csv : prints set-up per cell and per node for meshes of all sizes.
report.py --adaptive ADAPTIVE.csv : prints how much faster pictures with coarser levels are."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402
from verdicts import lines_of, show  # noqa: E402

WORDS = {"renderer", "mesh", "note"}
COLUMNS = [("setup_s", "set-up, s", True), ("memory_mb", "memory, MB", True),
           ("ms_per_frame", "ms per frame", True), ("psnr_db", "PSNR, dB", False)]


def draw(rows, path):
    """Bars, a panel for each column; a note where a renderer did not finish."""
    figure, panels = plot.subplots(1, len(COLUMNS), figsize=(15, 0.5 * len(rows) + 1.6), sharey=True)
    places = range(len(rows))
    for axes, (column, label, logarithmic) in zip(panels, COLUMNS):
        known = [row[column] for row in rows if row[column] is not None]
        if logarithmic:
            axes.set_xscale("log")
            known = [value for value in known if value > 0.0] or [1.0]
            axes.set_xlim(0.5 * min(known), 4.0 * max(known))
        for place, row in zip(places, rows):
            value = row[column]
            if value is None:
                axes.annotate(row["note"] or "not known", (0.02, place), va="center", fontsize=8,
                              xycoords=("axes fraction", "data"), color="tab:gray")
                continue
            ours = row["renderer"].startswith("banyan")
            axes.barh(place, value, color="tab:red" if ours else "tab:blue")
            axes.annotate(f"{value:.3g}", (max(value, axes.get_xlim()[0]), place), va="center",
                          fontsize=8, xytext=(3, 0), textcoords="offset points")
        axes.set_xlabel(label)
        axes.grid(True, axis="x", alpha=0.25)
        if not logarithmic:
            axes.margins(x=0.15)
    panels[0].set_yticks(list(places), [row["renderer"] for row in rows])
    panels[0].invert_yaxis()
    cells = max(row["cells"] for row in rows if row["cells"] is not None)
    figure.suptitle(f"{cells:,.0f} hexahedra; left is better, but for PSNR")
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})
    plot.close(figure)


def number(value, text):
    """Nothing where it is not known."""
    return "-" if value is None else format(value, text)


def print_rows(rows):
    """All columns, and how many times longer a frame takes than ours."""
    ours = next((row["ms_per_frame"] for row in rows if row["renderer"] == "banyan"), None)
    print(f"{'renderer':26}{'set-up s':>10}{'MB':>8}{'ms/frame':>10}{'PSNR':>8}{'times':>8}")
    for row in rows:
        time = row["ms_per_frame"]
        times = time / ours if time is not None and ours else None
        print(f"{row['renderer']:26}{number(row['setup_s'], '.2f'):>10}"
              f"{number(row['memory_mb'], '.0f'):>8}{number(time, '.1f'):>10}"
              f"{number(row['psnr_db'], '.2f'):>8}{number(times, '.1f'):>8}  {row['note']}".rstrip())


def print_scaling(rows):
    """What grows linearly stays the same per cell."""
    print(f"{'mesh':12}{'cells':>10}{'set-up s':>10}{'us/cell':>9}{'us/node':>9}{'MB':>8}"
          f"{'bytes/node':>12}")
    for row in rows:
        setup = row["find_s"] + row["bricks_s"] + row["values_s"]
        print(f"{row['mesh']:12}{row['cells']:>10.0f}{setup:>10.3f}"
              f"{1e6 * setup / row['cells']:>9.3f}{1e6 * setup / row['points']:>9.3f}"
              f"{row['memory_mb']:>8.0f}{1048576 * row['memory_mb'] / row['points']:>12.1f}")


def print_adaptive(rows):
    """Against the first row, the mesh in full."""
    for row in rows:
        print(f"{row['renderer']:26}{row['cells']:>10.0f} cells{row['ms_per_frame']:>10.1f} ms "
              f"{rows[0]['ms_per_frame'] / row['ms_per_frame']:6.2f} times faster  PSNR "
              f"{row['psnr_db']:.2f} dB, largest error {row['max_error_255']:.2f} / 255")


def main(arguments):
    """As the top of this file says."""
    if arguments[0] == "--scaling":
        rows = read(arguments[1], WORDS)
        print_scaling(rows)
        print()
        show(lines_of(rows))
    elif arguments[0] == "--adaptive":
        print_adaptive(read(arguments[1], WORDS))
    else:
        rows = read(arguments[0], WORDS)
        sizes = in_order(rows, "cells")
        draw([row for row in rows if row["cells"] == sizes[0]], arguments[1])
        for cells in sizes:
            print(f"\n{number(cells, ',.0f')} cells")
            print_rows([row for row in rows if row["cells"] == cells])
        print()
        show(lines_of(rows))


if __name__ == "__main__":
    main(sys.argv[1:])
