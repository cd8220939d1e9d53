# SPDX-License-Identifier: BSD-3-Clause
"""report.py DIR : draws the charts of playback.csv and playback-paper.csv in DIR, and prints tables of medians and means."""

import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)
from matplotlib.ticker import MaxNLocator  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

WORDS = ("series", "mode", "function", "reuse", "values")
COLORS = {"off": "tab:red", "on": "tab:blue", "paraview-banyan": "tab:green", "paraview-volume": "tab:purple"}
NAMES = {"off": "each frame from nothing", "on": "knows the one before", "paraview-banyan": "in ParaView, Banyan Volume",
         "paraview-volume": "in ParaView, its own Volume"}
SETTLED = 2  # frames of a pass that do not count: nobody knows yet that the series plays


def quickest(rows):
    """One row for each frame: of the pass that took least. A machine that does something else only makes a frame slower."""
    best = {}
    for row in rows:
        key = tuple(row[key] for key in ("series", "mode", "function", "size", "tolerance", "ranks", "reuse", "frame"))
        if key not in best or row["ms"] < best[key]["ms"]:
            best[key] = row
    return list(best.values())


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
    plain = [row for row in rows if row["reuse"] in ("off", "on")]
    for (series, mode, size, tolerance, ranks), of in groups(plain).items():
        if set(of) != {"off", "on"}:
            continue
        off, on = settled(of["off"]), settled(of["on"])
        name = series if mode == "play" else f"{series}, {mode}"
        error = max(row["true_error"] for row in on) if "true_error" in on[0] else 0.0
        yield (f"| {name} | {size:g} | {tolerance:g} | {ranks:g} | {median(off, 'ms'):.1f} | {median(on, 'ms'):.1f} | "
               f"{median(on, 'ms') / median(off, 'ms'):.2f} | {mean(on, 'ms') / mean(off, 'ms'):.2f} | "
               f"{sum(r['plan_ms'] for r in off) / sum(r['ms'] for r in off):.2f} | {mean(on, 'reused_fraction'):.2f} | "
               f"{error:.1f} |")


def legend_below(figure, axes):
    """One for all charts of a figure."""
    columns = 2 if figure.get_figwidth() < 14 else 4
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=columns, fontsize=8)
    figure.tight_layout(rect=(0, 0.6 / figure.get_figheight(), 1, 1))


def in_paraview(rows):
    return [row for row in rows if row["reuse"].startswith("paraview")]


def plain_of(rows):
    """Series that play on one rank from fast files, in the largest pictures."""
    plain = [row for row in rows if row["mode"] == "play" and row["ranks"] == 1 and "(" not in row["series"]]
    size = max(row["size"] for row in plain)
    return [row for row in plain if row["size"] == size], size


def paraview_table(rows):
    yield "| series | pixels | Banyan Volume, tolerance 1 | tolerance 8 | Volume | ratio to tolerance 8 |"
    yield "|---|---|---|---|---|---|"
    keys = in_order([{"key": (row["series"], row["size"])} for row in in_paraview(rows)], "key")
    for name, size in keys:
        of = settled([row for row in in_paraview(rows) if (row["series"], row["size"]) == (name, size)])
        one, eight = (median([r for r in of if r["reuse"] == "paraview-banyan" and r["tolerance"] == tolerance], "ms")
                      for tolerance in (1, 8))
        volume = median([r for r in of if r["reuse"] == "paraview-volume"], "ms")
        yield f"| {name} | {size:g} | {one:.1f} | {eight:.1f} | {volume:.1f} | {eight / volume:.2f} |"


def waiting_table(rows):
    """Means of series that play while cores are free: the interval between frames, and what the longest part of it would be."""
    yield "| series | pixels | ms | reading and decoding | drawing | ms over the larger one |"
    yield "|---|---|---|---|---|---|"
    rows = [row for row in rows if "(a thread" in row["series"] and row["reuse"] == "on"]
    for name, size in in_order([{"key": (row["series"], row["size"])} for row in rows], "key"):
        of = settled([row for row in rows if (row["series"], row["size"]) == (name, size)])
        interval, decoding, drawing = mean(of, "ms"), mean(of, "decode_ms"), mean(of, "ms") - mean(of, "wait_ms")
        yield (f"| {name} | {size:g} | {interval:.1f} | {decoding:.1f} | {drawing:.1f} | "
               f"{interval / max(decoding, drawing):.2f} |")


def draw_frames(rows, path):
    """Time of each frame, one chart for each series: the study's figures 7 and 10."""
    plain, size = plain_of(rows)
    tolerance = 8.0 if any(row["tolerance"] == 8.0 for row in plain) else max(row["tolerance"] for row in plain)
    plain = [row for row in plain if row["tolerance"] == tolerance or row["reuse"] == "paraview-volume"]
    names = in_order([row for row in plain if row["reuse"] in ("off", "on")], "series")
    figure, grid = plot.subplots(2, len(names), figsize=(max(8.0, 3.6 * len(names)), 6.0), squeeze=False)
    for across, name in enumerate(names):
        for reuse in in_order(plain, "reuse"):
            of = [row for row in plain if row["series"] == name and row["reuse"] == reuse]
            if not of:
                continue
            frames = in_order(of, "frame")
            grid[0][across].plot(frames, [row["ms"] for row in of], color=COLORS[reuse], label=NAMES[reuse])
        on = [row for row in plain if row["series"] == name and row["reuse"] == "on"]
        frames = in_order(on, "frame")
        for column, color in (("changed_fraction", "tab:gray"), ("reused_fraction", "tab:blue")):
            grid[1][across].plot(frames[1:], [row[column] for row in on[1:]], color=color,
                                 label="visible bricks that changed" if color == "tab:gray" else "pixels that were reused")
        grid[0][across].set_title(name)
        grid[0][across].set_yscale("log")
        grid[1][across].set_ylim(0, 1.05)
        grid[1][across].set_xlabel("frame")
        for axes in (grid[0][across], grid[1][across]):
            axes.grid(True, alpha=0.25)
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    grid[0][0].set_ylabel("ms per frame")
    grid[1][0].set_ylabel("part")
    grid[1][0].legend(fontsize=8)
    figure.suptitle(f"Series that play, {size:g}^2 pixels, tolerance {tolerance:g}/255")
    legend_below(figure, grid[0][0])
    figure.savefig(path, dpi=110)


def draw_series(rows, path):
    """Medians by series, for each tolerance."""
    plain, size = plain_of([row for row in rows if row["reuse"] in ("off", "on")])
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


def draw_paraview(rows, path):
    """Medians in ParaView by series, one chart for each size of picture."""
    rows = in_paraview(rows)
    sizes = in_order(rows, "size")
    names = in_order(rows, "series")
    figure, grid = plot.subplots(1, len(sizes), figsize=(6.0 * len(sizes), 4.2), squeeze=False, sharey=True)
    for across, size in enumerate(sizes):
        axes = grid[0][across]
        for shift, reuse, tolerance, color, label in (
                (-0.27, "paraview-banyan", 1, "tab:olive", "Banyan Volume, tolerance 1/255"),
                (0.0, "paraview-banyan", 8, "tab:green", "Banyan Volume, tolerance 8/255"),
                (0.27, "paraview-volume", 0, "tab:purple", "ParaView's own Volume")):
            heights = [median(settled([row for row in rows if row["series"] == name and row["size"] == size and
                                       row["reuse"] == reuse and row["tolerance"] == tolerance]), "ms")
                       for name in names]
            axes.bar([i + shift for i in range(len(names))], heights, 0.27, color=color, label=label)
        axes.set_xticks(range(len(names)), names, rotation=30, ha="right", fontsize=8)
        axes.set_yscale("log")
        axes.set_title(f"{size:g}^2 pixels")
        axes.grid(True, axis="y", which="both", alpha=0.25)
    grid[0][0].set_ylim(bottom=1)  # of all charts, when all bars are there
    grid[0][0].set_ylabel("ms from frame to frame in ParaView")
    legend_below(figure, grid[0][0])
    figure.savefig(path, dpi=110)


PAPER = (("codes", "every_brick", "tab:red", "-", "8-bit codes, every brick drawn, an image each (the study)"),
         ("codes", "shown_bricks", "tab:orange", "--", "8-bit codes, visible bricks, an image each"),
         ("codes", "blocks", "tab:olive", "-.", "8-bit codes, blocks of rays"),
         ("encoded", "blocks", "tab:blue", ":", "encoded series, blocks of rays (today)"))


def paper_table(rows):
    """Means over all steps but the first; the parts that are saved."""
    yield "| series | values, function | bricks as before | shown | every brick | visible bricks | blocks |"
    yield "|---|---|---|---|---|---|---|"
    rows = [row for row in rows if row["step"] > 0]
    for name in in_order(rows, "series"):
        of = [row for row in rows if row["series"] == name]
        for values, function in in_order([{"key": (row["values"], row["function"])} for row in of], "key"):
            some = [row for row in of if (row["values"], row["function"]) == (values, function)]
            columns = ("bricks_same", "samples_shown", "every_brick", "shown_bricks", "blocks")
            yield f"| {name} | {values}, {function} | " + " | ".join(f"{mean(some, c):.2f}" for c in columns) + " |"


def draw_paper(rows, path):
    """What is left to draw in each step, by series and function: the study's figures 7, 8 and 10 without a clock."""
    names = in_order(rows, "series")
    functions = in_order(rows, "function")
    figure, grid = plot.subplots(len(functions), len(names), figsize=(max(8.0, 3.6 * len(names)), 2.6 * len(functions) + 0.8),
                                 squeeze=False, sharex=True, sharey=True)
    for across, name in enumerate(names):
        for down, function in enumerate(functions):
            axes = grid[down][across]
            for values, column, color, style, label in PAPER:
                of = [row for row in rows if (row["series"], row["function"], row["values"]) == (name, function, values)]
                axes.plot([row["step"] for row in of], [1.0 - row[column] for row in of], color=color,
                          linestyle=style, label=label)
            axes.set_title(f"{name}, {function}", fontsize=10)
            axes.set_ylim(0, 1.05)
            axes.grid(True, alpha=0.25)
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    for axes in grid[-1]:
        axes.set_xlabel("step")
    for row in grid:
        row[0].set_ylabel("samples left to take")
    legend_below(figure, grid[0][0])
    figure.savefig(path, dpi=110)


def main():
    folder = pathlib.Path(sys.argv[1])
    rows = quickest(read(folder / "playback.csv", WORDS))
    if len(in_paraview(rows)) < len(rows):
        draw_frames(rows, folder / "playback-frames.png")
        draw_series(rows, folder / "playback-series.png")
        print("\n".join(table(rows)))
        print("\n".join(waiting_table(rows)))
    if in_paraview(rows):
        draw_paraview(rows, folder / "playback-paraview.png")
        print("\n".join(paraview_table(rows)))
    if (folder / "playback-paper.csv").exists():
        paper = read(folder / "playback-paper.csv", WORDS)
        draw_paper(paper, folder / "playback-paper.png")
        print("\n".join(paper_table(paper)))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
