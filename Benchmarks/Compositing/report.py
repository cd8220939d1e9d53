# SPDX-License-Identifier: BSD-3-Clause
"""report.py TABLE.csv TIME.png BYTES.png : charts of the simulated compositing, and ratios.

Prints, per network and number of ranks, over all frames: our time over that of the best strategy of
IceT, our bytes over the fewest of any of them (mean and worst), and the time of raw pixels; then time
and bytes of floats, the default, over those of IceT in bytes, as it is in ParaView, and in floats; then which
frames miss the goals of few bits: half of the time, 0.6 of the bytes.
"""

import collections
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

OWN = ["banyan", "banyan-raw", "banyan-floats", "slic-published", "direct-send", "binary-swap"]


def read(path):
    """Rows by frame (scene, camera, ranks, network), and there by method."""
    frames = collections.OrderedDict()
    with open(path, newline="") as table:
        for row in csv.DictReader(table):
            key = (row["scene"], row["camera"], int(row["ranks"]), row["network"])
            frames.setdefault(key, {})[row["method"]] = row
    return frames


def peers_of(methods, prefix):
    """The rows of IceT with pixels of one kind."""
    floats = prefix == "icet-floats-"
    return [row for name, row in methods.items()
            if name.startswith(prefix) and name.startswith("icet-floats-") == floats]


def float_ratios_of(methods):
    """Time and bytes of floats over IceT's least in bytes, and in floats; None where unknown."""
    found = []
    for prefix in ("icet-", "icet-floats-"):
        peers = peers_of(methods, prefix)
        for column in ("ms", "bytes"):
            best = min((float(row[column]) for row in peers), default=0.0)
            if best <= 0 or "banyan-floats" not in methods:
                return None
            found.append(float(methods["banyan-floats"][column]) / best)
    return tuple(found)


def ratios_of(methods):
    """Time, bytes and time without packing over IceT's least; None where these are unknown."""
    peers = peers_of(methods, "icet-")
    if not peers or "banyan" not in methods or "banyan-raw" not in methods:
        return None
    best = min(float(row["ms"]) for row in peers)
    fewest = min(float(row["bytes"]) for row in peers)
    if best <= 0 or fewest <= 0:
        return None
    return (float(methods["banyan"]["ms"]) / best, float(methods["banyan"]["bytes"]) / fewest,
            float(methods["banyan-raw"]["ms"]) / best)


def ratios(frames, of):
    """Lists of ratios per (network, ranks)."""
    result = collections.OrderedDict()
    for (_, _, ranks, network), methods in frames.items():
        found = of(methods)
        if found:
            lists = result.setdefault((network, ranks), [[] for _ in found])
            for values, value in zip(lists, found):
                values.append(value)
    return result


def goals_for(ranks):
    """Largest ratios of the design, in the order of ratios_of."""
    return (0.5, 0.6, 1.02 if ranks <= 4 else 0.9 if ranks >= 8 else float("inf"))


def print_goals(frames):
    """Every frame on 10 Gb/s, for which the goals are, that does not meet one of them."""
    checked, missed = 0, 0
    for (scene, camera, ranks, network), methods in frames.items():
        found = ratios_of(methods)
        if not found or network != "10Gb/s":
            continue
        checked += 1
        names = ("time", "bytes", "time without packing")
        wrong = [f"{name} {value:.3f} in place of {goal:g}"
                 for name, value, goal in zip(names, found, goals_for(ranks)) if value > goal]
        if wrong:
            missed += 1
            print(f"goal missed: {scene}, {camera}, {ranks} ranks: {', '.join(wrong)}")
    print(f"goals at 10 Gb/s: {checked - missed} of {checked} frames meet all")


def print_ratios(result, *titles):
    print("network   ranks  frames  " + "  ".join(f"{title:>17}" for title in titles))
    print("                         " + "  ".join("   mean     worst " for _ in titles))
    for (network, ranks), lists in sorted(result.items(), key=lambda item: (item[0][0], item[0][1])):
        if not lists[0]:
            continue
        cells = [f"{sum(values) / len(values):7.3f} {max(values):7.3f}" for values in lists]
        print(f"{network:9} {ranks:5} {len(lists[0]):6}  {'   '.join(cells)}")


def label(axes, title, unit):
    axes.set_title(title, fontsize=9)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.grid(True, which="both", alpha=0.25)
    axes.set_xlabel("ranks")
    axes.set_ylabel(unit)


def chart(frames, column, factor, unit, path):
    """One panel per scene, camera and network; one curve per method."""
    panels = collections.OrderedDict()
    for (scene, camera, ranks, network), methods in frames.items():
        curves = panels.setdefault((scene, camera, network), {})
        for name, row in methods.items():
            curves.setdefault(name, []).append((ranks, float(row[column]) * factor))
    columns = min(4, len(panels))
    lines = (len(panels) + columns - 1) // columns
    figure, grid = pyplot.subplots(
        lines, columns, figsize=(4.2 * columns, 3.4 * lines), squeeze=False)
    names = sorted({name for curves in panels.values() for name in curves},
                   key=lambda name: (name not in OWN, name))
    colours = {name: pyplot.cm.tab20(i % 20) for i, name in enumerate(names)}
    for axes, (key, curves) in zip(grid.flat, panels.items()):
        for name in names:
            points = [point for point in sorted(curves.get(name, [])) if point[1] > 0]
            if points:
                axes.plot(*zip(*points), label=name, color=colours[name],
                          linewidth=2.4 if name in ("banyan", "banyan-raw", "banyan-floats") else 1.1,
                          linestyle="-" if name in OWN else "--", marker=".")
        label(axes, ", ".join(key), unit)
    for axes in grid.flat[len(panels):]:
        axes.axis("off")
    found = {}
    for axes in grid.flat:
        for handle, text in zip(*axes.get_legend_handles_labels()):
            found.setdefault(text, handle)
    figure.legend(found.values(), found.keys(), loc="lower center", ncol=6, fontsize=8)
    figure.tight_layout(rect=(0, 0.02 + 0.12 / lines, 1, 1))
    figure.savefig(path, dpi=90)


def main():
    table, times, sizes = sys.argv[1:4]
    frames = read(table)
    if not frames:
        sys.exit("There is nothing in " + table + ".")
    chart(frames, "ms", 1.0, "ms until the picture is on the root", times)
    chart(frames, "bytes", 1e-6, "MB on the network", sizes)
    print_ratios(ratios(frames, ratios_of), "time/best IceT", "bytes/fewest IceT", "raw time/best")
    print_ratios(ratios(frames, float_ratios_of), "floats: time/IceT", "bytes", "time/IceT floats",
                 "bytes")
    print_goals(frames)


if __name__ == "__main__":
    main()
