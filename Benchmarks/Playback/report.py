# SPDX-License-Identifier: BSD-3-Clause
"""report.py DIR : draws the charts of the playback.csv in DIR, and prints a table of medians."""

import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

WORDS = ("series", "mode", "function", "reuse")
COLORS = {"off": "tab:red", "on": "tab:blue"}
NAMES = {"off": "each frame from nothing", "on": "knows the one before"}
SETTLED = 2  # frames of a pass that do not count: nobody knows yet that the series plays


def settled(rows):
    """Frames that count: of a series that plays, or that were shown once before."""
    first = {"play": SETTLED, "loop": 0, "rest": 1, "function": 1, "turn": 1}
    return [row for row in rows if row["frame"] >= first[row["mode"]]]


def median(rows, column):
    return statistics.median(row[column] for row in rows) if rows else float("nan")


def mean(rows, column):
    return statistics.fmean(row[column] for row in rows) if rows else float("nan")


def groups(rows):
    """What was played how: its name, and the rows by reuse."""
    keys = ("series", "mode", "size", "tolerance", "ranks")
    found = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in keys), {}).setdefault(row["reuse"], []).append(row)
    return found


def table(rows):
    yield "| series | pixels | tolerance | ranks | ms from nothing | ms | ratio | mean ratio | plan | reused | error |"
    yield "|---|---|---|---|---|---|---|---|---|---|---|"
    for (series, mode, size, tolerance, ranks), of in groups(rows).items():
        if set(of) != {"off", "on"}:
            continue
        off, on = settled(of["off"]), settled(of["on"])
        name = series if mode == "play" else f"{series}, {mode}"
        error = max(row["true_error"] for row in on) if "true_error" in on[0] else 0.0
        yield (f"| {name} | {size:g} | {tolerance:g} | {ranks:g} | {median(off, 'ms'):.1f} | {median(on, 'ms'):.1f} | "
               f"{median(on, 'ms') / median(off, 'ms'):.2f} | {mean(on, 'ms') / mean(off, 'ms'):.2f} | "
               f"{sum(r['plan_ms'] for r in off) / sum(r['ms'] for r in off):.2f} | {mean(on, 'reused_fraction'):.2f} | "
               f"{error:.1f} |")


def draw_frames(rows, path):
    """Time of each frame, one chart for each series: the study's figure 10."""
    plain = [row for row in rows if row["mode"] == "play" and row["ranks"] == 1 and "(" not in row["series"]]
    size = max(row["size"] for row in plain)
    tolerance = 8.0 if any(row["tolerance"] == 8.0 for row in plain) else max(row["tolerance"] for row in plain)
    plain = [row for row in plain if row["size"] == size and row["tolerance"] == tolerance]
    names = in_order(plain, "series")
    figure, grid = plot.subplots(2, len(names), figsize=(3.6 * len(names), 6.0), squeeze=False)
    for across, name in enumerate(names):
        for reuse in in_order(plain, "reuse"):
            of = [row for row in plain if row["series"] == name and row["reuse"] == reuse]
            frames = in_order(of, "frame")
            times = [statistics.median(r["ms"] for r in of if r["frame"] == frame) for frame in frames]
            grid[0][across].plot(frames, times, color=COLORS[reuse], label=NAMES[reuse])
        changed = [statistics.median(r["changed_fraction"] for r in of if r["frame"] == frame) for frame in frames]
        grid[1][across].plot(frames[1:], changed[1:], color="tab:gray")
        grid[0][across].set_title(name)
        grid[0][across].set_ylim(bottom=0)
        grid[1][across].set_ylim(0, 1.05)
        grid[1][across].set_xlabel("frame")
        for axes in (grid[0][across], grid[1][across]):
            axes.grid(True, alpha=0.25)
    grid[0][0].set_ylabel("ms per frame")
    grid[1][0].set_ylabel("part of visible bricks that changed")
    grid[0][0].legend(fontsize=8)
    figure.suptitle(f"Series that play, {size:g}^2 pixels, tolerance {tolerance:g}/255")
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def draw_series(rows, path):
    """Medians by series, for each tolerance."""
    plain = [row for row in rows if row["mode"] == "play" and row["ranks"] == 1 and "(" not in row["series"]]
    size = max(row["size"] for row in plain)
    plain = [row for row in plain if row["size"] == size]
    names = in_order(plain, "series")
    tolerances = in_order(plain, "tolerance")
    figure, grid = plot.subplots(1, len(tolerances), figsize=(5.0 * len(tolerances), 4.2), squeeze=False)
    for across, tolerance in enumerate(tolerances):
        axes = grid[0][across]
        for shift, reuse in ((-0.2, "off"), (0.2, "on")):
            of = [settled([row for row in plain if row["series"] == name and row["reuse"] == reuse and
                           row["tolerance"] == tolerance]) for name in names]
            places = [i + shift for i in range(len(names))]
            axes.bar(places, [median(some, "ms") for some in of], 0.4, color=COLORS[reuse], label=NAMES[reuse])
            if reuse == "off":
                axes.bar(places, [median(some, "plan_ms") for some in of], 0.4, color="tab:orange",
                         label="of which planning")
        axes.set_xticks(range(len(names)), names, rotation=30, ha="right", fontsize=8)
        title = "a sample per voxel" if tolerance == 0 else f"tolerance {tolerance:g}/255"
        axes.set_title(title)
        axes.grid(True, axis="y", alpha=0.25)
    grid[0][0].set_ylabel(f"ms per frame, {size:g}^2 pixels")
    grid[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    folder = pathlib.Path(sys.argv[1])
    rows = read(folder / "playback.csv", WORDS)
    draw_frames(rows, folder / "playback-frames.png")
    draw_series(rows, folder / "playback-series.png")
    print("\n".join(table(rows)))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
