# SPDX-License-Identifier: BSD-3-Clause
"""report.py FOLDER : walls.csv, its charts and verdicts, from the tables that walls.sh has left in a folder.

Several folders before the last one are joined in it: `report.py A B ALL` reads A and B and writes into ALL.
"""

import collections
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tables import in_order, read
from verdicts import row_of, show

WORDS = {"volume", "view", "division", "method"}
OURS = ["by-data", "by-picture", "automatic"]
PEERS = {"by-data-few-bits": "by-data", "icet-reduce": "by-data", "icet-floats-reduce": "by-data"}
LOOKS = {"by-data": "tab:blue", "by-picture": "tab:orange", "automatic": "tab:green",
         "by-data-few-bits": "tab:cyan", "icet-reduce": "tab:red", "icet-floats-reduce": "tab:pink"}
MOST_GROWTH = 1.3  # time at the most ranks over that of one, with as many pixels per rank
MOST_IMBALANCE = 1.15  # largest region over the mean
MOST_OF_ICET = 0.5  # time of compositing
MOST_OF_BETTER = 1.1  # automatic over the better of the other two
PAN = "-pan"


def rest_of(view):
    return view[:-len(PAN)] if view.endswith(PAN) else view


def read_all(folders, name):
    paths = [os.path.join(folder, name) for folder in folders]
    return [row for path in paths if os.path.exists(path) for row in read(path, WORDS)]


def automatic(rows):
    """What Division Automatic takes: by picture where several ranks show parts, else by data."""
    return "by-picture" if rows["by-data"]["tiles"] > 1 else "by-data"


def pixels_of(pixels):
    """By wall and method; of the network that comes first."""
    if not pixels:
        return {}
    network = pixels[0]["network"]
    return {(row["volume"], row["megapixels"], row["ranks"], row["view"], row["method"]): row
            for row in pixels if row["network"] == network}


def joined(casting, pixels):
    """Rows of walls.csv. A picture that has moved is composited as that at rest."""
    walls = collections.OrderedDict()
    for row in casting:
        wall = (row["volume"], row["megapixels"], row["tiles"], row["ranks"], row["view"])
        walls.setdefault(wall, {})[row["division"]] = row
    composited = pixels_of(pixels)
    table = []
    for (volume, megapixels, _, ranks, view), cast in walls.items():
        if len(cast) < 2:
            continue
        for name in OURS + list(PEERS):
            drawn = cast[automatic(cast) if name == "automatic" else PEERS.get(name, name)]
            method = drawn["division"] if name == "automatic" else name
            sent = composited.get((volume, megapixels, ranks, rest_of(view), method))
            if sent is None and ranks > 1:
                continue
            composite = sent["ms"] if sent else 0.0
            table.append({
                "volume": volume, "megapixels": megapixels, "ranks": ranks, "division": name, "view": view,
                "cast_ms": drawn["cast_ms"], "composite_ms": composite, "brick_ms": drawn["brick_ms"],
                "total_ms": drawn["cast_ms"] + composite + drawn["brick_ms"],
                "bytes_pixels": sent["bytes"] if sent else 0.0, "bytes_bricks": drawn["bytes_bricks"],
                "imbalance": drawn["cast_ms"] / drawn["mean_ms"], "tiles": drawn["tiles"]})
    return table


def write(table, path):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, table[0].keys())
        writer.writeheader()
        for row in table:
            writer.writerow({key: f"{value:.6g}" if isinstance(value, float) and not key.startswith("bytes")
                             else f"{value:.0f}" if isinstance(value, float) else value
                             for key, value in row.items()})


def grows(row):
    """Whether a row has a tile per rank: the pixels per rank are kept."""
    return row["tiles"] == row["ranks"]


def columns_of(rows, kept):
    """Walls with as many pixels per rank, or of one size on several numbers of ranks."""
    least = min(row["megapixels"] / row["ranks"] for row in rows if row["ranks"] == 1)
    weak = [row for row in rows if grows(row) and row["megapixels"] / row["ranks"] < 1.2 * least]
    if kept:
        return weak
    sizes = collections.Counter(row["megapixels"] for row in rows)
    size = max(sizes, key=lambda megapixels: sizes[megapixels])
    return [row for row in rows if row["megapixels"] == size]


def panel(axes, rows, kept):
    for name in LOOKS:
        points = sorted((row["ranks"], row["total_ms"]) for row in rows if row["division"] == name)
        if points:
            axes.plot(*zip(*points), label=name, color=LOOKS[name], marker=".",
                      linestyle="-" if name in OURS else "--", linewidth=3 if name == "automatic" else 1.4,
                      alpha=0.5 if name == "automatic" else 1.0)
    axes.set_xscale("log", base=2)
    axes.set_ylim(bottom=0) if kept else axes.set_yscale("log")
    axes.grid(True, which="both", alpha=0.25)
    axes.set_xlabel("ranks, a tile for each" if kept else f"ranks, {rows[0]['megapixels']:g} megapixels")
    axes.set_ylabel("ms, slowest rank")


def chart_ranks(table, path):
    """A row of panels for each view, at rest: as many pixels per rank, and as many pixels."""
    views = [view for view in in_order(table, "view") if not view.endswith(PAN)]
    volumes = in_order(table, "volume")
    figure, grid = pyplot.subplots(len(views), 2 * len(volumes), squeeze=False,
                                   figsize=(3.9 * 2 * len(volumes), 3.1 * len(views)))
    for line, view in enumerate(views):
        for place, volume in enumerate(volumes):
            rows = [row for row in table if row["view"] == view and row["volume"] == volume]
            for kept in (True, False):
                axes = grid[line][2 * place + (0 if kept else 1)]
                axes.set_title(f"{volume}, {view}", fontsize=9)
                if any(row["ranks"] == 1 for row in rows):
                    panel(axes, columns_of(rows, kept), kept)
                else:
                    axes.axis("off")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=6, fontsize=8)
    figure.tight_layout(rect=(0, 0.03 + 0.06 / len(views), 1, 1))
    figure.savefig(path, dpi=80)


def chart_views(table, path):
    """What the largest wall takes: parts of it by view and division."""
    volumes = in_order(table, "volume")
    figure, grid = pyplot.subplots(1, len(volumes), squeeze=False, figsize=(7.5 * len(volumes), 4.6))
    for axes, volume in zip(grid[0], volumes):
        ours = [row for row in table if row["volume"] == volume and grows(row)]
        most = max(row["ranks"] for row in ours)
        rows = [row for row in ours if row["ranks"] == most and row["division"] != "automatic"]
        names = [f"{row['division']}, {row['view']}" for row in rows]
        left = [0.0] * len(rows)
        for part, colour in (("cast_ms", "tab:blue"), ("composite_ms", "tab:red"), ("brick_ms", "tab:olive")):
            axes.barh(names, [row[part] for row in rows], left=left, color=colour, label=part)
            left = [start + row[part] for start, row in zip(left, rows)]
        axes.invert_yaxis()
        axes.tick_params(axis="y", labelsize=7)
        axes.set_title(f"{volume}, {rows[0]['megapixels']:g} megapixels on {most:g} ranks", fontsize=9)
        axes.set_xlabel("ms, slowest rank")
        axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=3)
    figure.tight_layout()
    figure.savefig(path, dpi=80)


def print_table(table):
    """Each wall in a line."""
    rows = collections.OrderedDict()
    for row in table:
        key = (row["volume"], row["view"], row["megapixels"], row["ranks"])
        rows.setdefault(key, {})[row["division"]] = row
    print("| volume, view | megapixels, ranks | by data: cast + composite + bricks | by picture | "
          "automatic | IceT composites, 8 bits; floats | MB pixels by data; by picture; IceT |")
    print("|---|---|---|---|---|---|---|")
    for (volume, view, megapixels, ranks), found in rows.items():
        if len(found) < 3:
            continue
        parts = [" + ".join(f"{found[name][part]:.3g}" for part in ("cast_ms", "composite_ms", "brick_ms"))
                 for name in ("by-data", "by-picture")]
        peers = [found[name] for name in ("icet-reduce", "icet-floats-reduce") if name in found]
        times = "; ".join(f"{row['composite_ms']:.3g}" for row in peers)
        sizes = "; ".join(f"{1e-6 * row['bytes_pixels']:.3g}"
                          for row in [found["by-data"], found["by-picture"]] + peers[:1])
        print(f"| {volume}, {view} | {megapixels:g}, {ranks:g} | {parts[0]} | {parts[1]} | "
              f"{found['automatic']['total_ms']:.4g} | {times} | {sizes} |")


def ratio_rows(what, pairs, most):
    """A verdict over all walls, and how many keep it. Pairs: a ratio, and the wall's name."""
    pairs = [pair for pair in pairs if pair[0] is not None]
    if not pairs:
        return []
    worst = max(pairs)
    kept = sum(ratio <= most for ratio, _ in pairs)
    return [row_of(f"{what} ({kept} of {len(pairs)} walls keep it)", f"{worst[0]:.3f} ({worst[1]})",
                   f"at most {most:g}", worst[0] <= most)]


def verdicts(table):
    """Lines of the goals of the design."""
    walls = collections.OrderedDict()
    for row in table:
        walls.setdefault((row["volume"], row["view"], row["megapixels"], row["ranks"]), {})[row["division"]] = row
    tiled = [found for (_, _, _, ranks), found in walls.items() if ranks > 1 and "icet-reduce" in found]

    def name(row):
        return f"{row['volume']}, {row['view']}, {row['megapixels']:g}, {row['ranks']:g}"

    def at_rest(found):
        return not found["by-data"]["view"].endswith(PAN)

    own = [found["by-picture"] for found in tiled if at_rest(found) and grows(found["by-picture"])]
    if own:
        most = max(own, key=lambda row: row["bytes_pixels"] / row["megapixels"])
        bytes_each = most["bytes_pixels"] / (1e6 * most["megapixels"])
        yield row_of("by picture, at rest, a tile per rank: bytes of pixels, per pixel of the wall",
                     f"{bytes_each:.2f} ({name(most)})", "0", bytes_each == 0)
    for volume in in_order(table, "volume"):
        for view in in_order(table, "view"):
            rows = [row for row in table if row["volume"] == volume and row["view"] == view
                    and row["division"] == "automatic"]
            if view.endswith(PAN) or not any(row["ranks"] == 1 for row in rows):
                continue
            kept = sorted(columns_of(rows, True), key=lambda row: row["ranks"])
            growth = kept[-1]["total_ms"] / kept[0]["total_ms"]
            yield row_of(f"{volume}, {view}, automatic: time on {kept[-1]['ranks']:g} ranks over that on 1, "
                         "pixels per rank kept", f"{growth:.2f}", f"at most {MOST_GROWTH:g}",
                         growth <= MOST_GROWTH)
    yield from ratio_rows("by picture, at rest: largest region over the mean",
                          [(found["by-picture"]["imbalance"], name(found["by-picture"]))
                           for found in tiled if at_rest(found)], MOST_IMBALANCE)
    for method, peer in (("by-data", "icet-reduce"), ("by-data", "icet-floats-reduce"),
                         ("by-data-few-bits", "icet-reduce")):
        yield from ratio_rows(f"{method}: time of compositing over that of {peer}",
                              [(found[method]["composite_ms"] / found[peer]["composite_ms"], name(found[peer]))
                               for found in tiled if at_rest(found)], MOST_OF_ICET)

    def over_better(found, threads):
        def time(row):
            return (row["cast_ms"] + row["brick_ms"]) / threads + row["composite_ms"]
        return time(found["automatic"]) / min(time(found["by-data"]), time(found["by-picture"]))

    for threads in (1, 16):
        for rest in (True, False):
            yield from ratio_rows(
                f"automatic over the better one, {'at rest' if rest else 'in a pan'}"
                + (f", if {threads} threads took 1/{threads} of casting and bricks" if threads > 1 else ""),
                [(over_better(found, threads), name(found["automatic"]))
                 for found in tiled if at_rest(found) == rest], MOST_OF_BETTER)


def real_verdicts(real, pixels):
    """Bytes of real ranks against simulated ones, and pictures against those of one rank."""
    # Ranks of one number may have several numbers of tiles: rows of both tables have one order.
    walls = {(row["volume"], row["megapixels"], row["ranks"], row["view"]) for row in real}
    simulated = [row for row in pixels
                 if row["method"] in ("by-data", "by-picture")
                 and (row["volume"], row["megapixels"], row["ranks"], row["view"]) in walls]
    if not real:
        return
    same = len(real) == len(simulated) and all(
        one["bytes"] == other["bytes"] for one, other in zip(real, simulated))
    yield row_of(f"{len(real)} pictures on 2 to 4 real ranks: bytes of pixels", "as simulated" if same else
                 "others than simulated", "as simulated", same)
    worst = max(row["max_difference"] for row in real)
    yield row_of("the same: largest difference to the picture of one rank, in 1/255", f"{worst:g}", "at most 1",
                 worst <= 1)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folders, output = sys.argv[1:-1] or sys.argv[1:], sys.argv[-1]
    pixels = read_all(folders, "walls-pixels.csv")
    table = joined(read_all(folders, "walls-casting.csv"), pixels)
    if not table:
        sys.exit("There is nothing in " + output + ".")
    write(table, os.path.join(output, "walls.csv"))
    chart_ranks(table, os.path.join(output, "walls-ranks.png"))
    chart_views(table, os.path.join(output, "walls-views.png"))
    print_table(table)
    print()
    show([*verdicts(table), *real_verdicts(read_all(folders, "walls-real.csv"), pixels)])


if __name__ == "__main__":
    main()
