# SPDX-License-Identifier: BSD-3-Clause
"""Prints tables of what banyan-bench-tickets has measured: tickets.py TICKETS.csv"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from tables import in_order, read  # noqa: E402


def print_table(title, columns, rows):
    """Columns are a head and how a row's field is written."""
    print(f"\n{title}\n")
    print("| " + " | ".join(head for head, _ in columns) + " |")
    print("|" + "---|" * len(columns))
    for row in rows:
        print("| " + " | ".join(write(row) for _, write in columns) + " |")


def number(name, digits=0):
    return lambda row: f"{row[name]:.{digits}f}"


def two(first, second, digits=0, unit=1.0):
    return lambda row: f"{row[first] / unit:.{digits}f}, {row[second] / unit:.{digits}f}"


def main():
    rows = read(sys.argv[1], {"scene"})
    scenes = in_order(rows, "scene")
    rows.sort(key=lambda row: scenes.index(row["scene"]))  # ranks stay in their order
    whose = [("scene", lambda row: row["scene"]), ("ranks", number("ranks"))]
    real = [row for row in rows if not row["simulated"]]
    print_table("Pictures of ranks that are processes", whose + [
        ("ms: direct, late", two("sync_ms", "ms", 1)),
        ("late over direct", number("overhead", 2)),
        ("coarse ms", number("coarse_ms", 1)),
        ("pictures a second", number("pictures_per_s", 2)),
        ("per rank", number("pictures_per_s_per_rank", 2))], real)
    dragged = [row for row in real if row["drag_tickets"]]
    print_table("A drag", whose + [
        ("pictures of tickets", lambda row: f"{row['drag_pictures']:.0f} of {row['drag_tickets']:.0f}"),
        ("ms to the coarse picture: median, 95 %", two("drag_coarse_ms_p50", "drag_coarse_ms_p95", 1)),
        ("ms until stopped: median, 95 %", two("drag_stop_ms_p50", "drag_stop_ms_p95", 1)),
        ("ms to the last exact picture", number("drag_exact_ms"))], dragged)
    print_table("Work and messages of a picture: direct, late. Ranks in parentheses are threads of one process", [
        whose[0], ("ranks", lambda row: f"({row['ranks']:.0f})" if row["simulated"] else f"{row['ranks']:.0f}"),
        ("processor ms of a rank", two("sync_cpu_ms", "cpu_ms", 1)),
        ("collective operations", two("sync_collectives", "collectives")),
        ("asks", number("asks")),
        ("messages", two("sync_messages", "messages")),
        ("kB", two("sync_bytes", "bytes", 1, 1e3))], rows)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
