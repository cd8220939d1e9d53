# SPDX-License-Identifier: BSD-3-Clause
"""report.py DIR : draws the charts of the tables that balance.sh left in DIR, and prints a summary."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402 (the backend has to be chosen first)

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402

NAMES = {"off": "Off", "slice-step": "Slice step", "measured-cost": "Measured cost"}
COLORS = {"off": "tab:red", "slice-step": "tab:orange", "measured-cost": "tab:blue"}
BALANCED_WITHIN = 5  # frames after a jump of the camera
JUMP_EVERY = 10      # frames, on the path of jumps
RESTING_FROM = 20    # frame from which planes of a view at rest should rest
# Goals: the imbalance within BALANCED_WITHIN frames of a jump, and at rest.
AFTER_JUMPS = 1.15
AT_REST = 1.20


def table(folder, name):
    path = folder / name
    return read(path, ("mode",)) if path.exists() else []


def curve(rows, ranks, mode, column):
    return [row[column] for row in rows if row["ranks"] == ranks and row["mode"] == mode]


def mean(values):
    return sum(values) / len(values) if values else float("nan")


def draw_frames(rows, path):
    """The paper's figure 11, and what else there is to a frame."""
    counts = in_order(rows, "ranks")
    columns = [("ms", "ms of the slowest rank", 1), ("imbalance", "largest over mean", 1),
               ("bytes_moved", "MB moved", 1e-6)]
    figure, grid = plot.subplots(len(columns), len(counts), figsize=(4.2 * len(counts), 8.4),
                                 squeeze=False)
    for across, ranks in enumerate(counts):
        for down, (column, label, unit) in enumerate(columns):
            axes = grid[down][across]
            for mode in in_order(rows, "mode"):
                axes.plot([unit * value for value in curve(rows, ranks, mode, column)],
                          color=COLORS[mode], label=NAMES[mode])
            axes.set_ylim(bottom=1 if column == "imbalance" else 0)
            axes.grid(True, alpha=0.25)
            if down == len(columns) - 1:
                axes.set_xlabel("frame")
            if across == 0:
                axes.set_ylabel(label)
        grid[0][across].set_title(f"{ranks:g} ranks")
    grid[0][0].legend(fontsize=8)
    figure.suptitle("Zooming into a part of the volume")
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})


def draw_ranks(rows, path):
    """The paper's figure 12: what each rank takes."""
    ranks = 8 if 8 in in_order(rows, "ranks") else max(in_order(rows, "ranks"))
    modes = in_order(rows, "mode")
    figure, grid = plot.subplots(1, len(modes), figsize=(5 * len(modes), 4), sharey=True,
                                 squeeze=False)
    for axes, mode in zip(grid[0], modes):
        for rank in range(int(ranks)):
            axes.plot([row["ms"] for row in rows if row["ranks"] == ranks
                       and row["mode"] == mode and row["rank"] == rank], label=f"rank {rank}")
        axes.set_title(f"{NAMES[mode]}, {ranks:g} ranks")
        axes.set_xlabel("frame")
        axes.set_ylim(bottom=0)
        axes.grid(True, alpha=0.25)
    grid[0][0].set_ylabel("ms")
    grid[0][-1].legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.02, 1.0))
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})


def print_zoom(name, rows):
    if not rows:
        return
    print(f"{name}: ms are means over all frames; the factor is that of the ms without balancing in "
          "the last quarter")
    print(f"{'ranks':>6} {'mode':14}{'ms':>9}{'imbalance':>11}{'last quarter':>14}{'factor':>8}"
          f"{'MB per frame':>14}{'most':>8}")
    for ranks in in_order(rows, "ranks"):
        for mode in in_order(rows, "mode"):
            ms = curve(rows, ranks, mode, "ms")
            imbalance = curve(rows, ranks, mode, "imbalance")
            moved = curve(rows, ranks, mode, "bytes_moved")
            last = 3 * len(ms) // 4
            static = curve(rows, ranks, "off", "ms")
            factor = mean(static[last:]) / mean(ms[last:]) if static else float("nan")
            print(f"{ranks:6g} {mode:14}{mean(ms):9.2f}{mean(imbalance):11.3f}"
                  f"{mean(imbalance[last:]):14.3f}{factor:8.2f}{1e-6 * mean(moved):14.3f}"
                  f"{1e-6 * max(moved):8.2f}")


def print_settled(name, rows, settled):
    if not rows:
        return
    print(f"{name}: imbalance of the frames that count as settled")
    for ranks in in_order(rows, "ranks"):
        line = f"{ranks:6g} "
        for mode in in_order(rows, "mode"):
            values = [value for frame, value in enumerate(curve(rows, ranks, mode, "imbalance"))
                      if settled(frame)]
            if values:
                line += f"  {mode} mean {mean(values):.3f} largest {max(values):.3f}"
        print(line)


def print_rest(rows):
    """Whether planes come to rest where the view does."""
    if not rows:
        return
    print(f"At rest, from frame {RESTING_FROM}: imbalance, and the last frame of all in which bytes moved")
    for ranks in in_order(rows, "ranks"):
        for mode in in_order(rows, "mode"):
            imbalance = curve(rows, ranks, mode, "imbalance")
            moved = curve(rows, ranks, mode, "bytes_moved")
            last = max((frame for frame, count in enumerate(moved) if count > 0), default=None)
            settled = imbalance[RESTING_FROM:]
            if settled:
                print(f"{ranks:6g} {mode:14} mean {mean(settled):.3f} smallest {min(settled):.3f} "
                      f"largest {max(settled):.3f}; "
                      + ("nothing moved" if last is None else f"frame {last} of {len(moved)}"))


def print_goals(zoom, jumps, at_rest):
    """Each goal beside what was measured of it."""
    mode = "measured-cost"
    print("Goals of measured-cost:")
    for ranks in in_order(jumps, "ranks"):
        imbalance = curve(jumps, ranks, mode, "imbalance")
        after = [imbalance[at:at + JUMP_EVERY] for at in range(0, len(imbalance), JUMP_EVERY)]
        reached = [min(part[:BALANCED_WITHIN + 1]) <= AFTER_JUMPS for part in after]
        stays = [max(part[BALANCED_WITHIN:], default=0) <= AFTER_JUMPS for part in after]
        late = sorted(value for part in after for value in part[BALANCED_WITHIN:])
        if late:
            print(f"{ranks:6g} ranks: {AFTER_JUMPS} within {BALANCED_WITHIN} frames of a jump: "
                  f"{sum(reached)} of {len(after)}; in all frames that follow: {sum(stays)}; "
                  f"in the middle {late[len(late) // 2]:.3f}, mean {mean(late):.3f}, "
                  f"largest {late[-1]:.3f}")
    for ranks in in_order(at_rest, "ranks"):
        imbalance = curve(at_rest, ranks, mode, "imbalance")
        above = [frame for frame, value in enumerate(imbalance) if value > AT_REST]
        print(f"{ranks:6g} ranks: last frame above {AT_REST} at rest: "
              f"{above[-1] if above else 'none'} of {len(imbalance)}; at the end {imbalance[-1]:.3f}")
    for ranks in in_order(zoom, "ranks"):
        ours = mean(curve(zoom, ranks, mode, "ms"))
        published = mean(curve(zoom, ranks, "slice-step", "ms"))
        print(f"{ranks:6g} ranks: ms of the zoom over those of slice-step: {ours / published:.2f}")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    zoom = table(folder, "balance.csv")
    draw_frames(zoom, folder / "balance.png")
    draw_ranks(table(folder, "balance-ranks.csv"), folder / "balance-ranks.png")
    print_zoom("Zoom, simulated ranks", zoom)
    print_zoom("Zoom into bonsai, simulated ranks", table(folder, "balance-bonsai.csv"))
    print_zoom("Zoom, real ranks", table(folder, "balance-real.csv"))
    print_zoom("Zoom, real ranks with half of the volume each", table(folder, "balance-pieces.csv"))
    print_settled(f"Jumps, from frame {BALANCED_WITHIN} after each",
                  table(folder, "balance-jumps.csv"),
                  lambda frame: frame % JUMP_EVERY >= BALANCED_WITHIN)
    at_rest = table(folder, "balance-rest.csv")
    print_settled("At rest, from frame 5", at_rest, lambda frame: frame >= 5)
    print_rest(at_rest)
    print_goals(zoom, table(folder, "balance-jumps.csv"), at_rest)


if __name__ == "__main__":
    main()
