# SPDX-License-Identifier: BSD-3-Clause
"""pieces_report.py PIECES.csv CHART.png : prints a table of what pieces of a mesh take on ranks, and draws the time of
the slowest rank against the number of ranks."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

WORDS = {"shape", "deal"}
COLOURS = ("tab:red", "tab:blue", "tab:green", "tab:orange")


def lines_of(rows):
    """`times` is how much faster than one rank the slowest rank is."""
    yield ("| deal | pixels | level | ranks | set-up ms | first ms | frame ms | times | largest over mean | runs per ray "
           "| raw | asked | bytes | MB |")
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        alone = [other["frame_ms"] for other in rows if other["ranks"] == 1
                 and all(other[key] == row[key] for key in ("deal", "pixels", "level"))]
        times = format(alone[0] / row["frame_ms"], ".1f") if alone else "-"
        yield (f"| {row['deal']} | {row['pixels']:g} | {row['level']:g} | {row['ranks']:g} | {row['setup_ms']:.0f} "
               f"| {row['first_ms']:.0f} | {row['frame_ms']:.1f} | {times} | {row['frame_ms'] / row['mean_ms']:.2f} "
               f"| {row['runs_per_ray']:.2f} | {row['raw_per_ray']:.2f} | {row['asked_per_ray']:.3f} "
               f"| {row['bytes_per_ray']:.0f} | {row['mb_per_rank']:.0f} |")


def draw(rows, path):
    pixels, levels = in_order(rows, "pixels"), in_order(rows, "level")
    figure, panels = plot.subplots(1, len(pixels), figsize=(5.5 * len(pixels), 4.2), squeeze=False)
    for axes, edge in zip(panels.flat, pixels):
        for deal, colour in zip(in_order(rows, "deal"), COLOURS):
            for level, style in zip(levels, ("o-", "s--", "^:", "v-.")):
                found = [(row["ranks"], row["frame_ms"]) for row in rows
                         if (row["deal"], row["pixels"], row["level"]) == (deal, edge, level)]
                name = "cells" if level == 0 else f"level {level:g}"
                axes.plot(*zip(*found), style, color=colour, markersize=4, label=f"{deal}, {name}")
        ranks = in_order(rows, "ranks")
        first = next(row["frame_ms"] for row in rows if row["pixels"] == edge)
        axes.plot(ranks, [first * ranks[0] / count for count in ranks], color="lightgray", label="as many times as fast")
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(ranks, [f"{count:g}" for count in ranks])
        axes.set_xlabel("ranks")
        axes.set_ylabel("processor time of the slowest rank, ms")
        axes.set_title(f"{rows[0]['cells']:,.0f} {rows[0]['shape']}, {edge:g}^2 pixels", fontsize=10)
        axes.grid(True, which="both", alpha=0.25)
        axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    rows = read(sys.argv[1], WORDS)
    print("\n".join(lines_of(rows)))
    draw(rows, sys.argv[2])


main()
