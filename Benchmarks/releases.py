# SPDX-License-Identifier: BSD-3-Clause
"""The table of releases.sh.

    releases.py TABLE RELEASE FOLDER   appends what the programs wrote into FOLDER on a release
    releases.py TABLE                  prints medians, and the time as a multiple of that of the first release
"""
import os
import statistics
import sys

import tables

# Column, and whether it is a speed: more is quicker.
MEASURED = {"encode_mb_s": True, "decode_mb_s": True, "S1_ms": False, "S2_ms": False}


def measured(folder):
    codec = tables.read(os.path.join(folder, "codec.csv"), ["dataset", "method"])[0]
    rays = {row["scene"]: row for row in tables.read(os.path.join(folder, "rays.csv"), ["type", "scene"])
            if row["type"] == "float32" and row["brick_cells"] == 16}
    return [codec["encode_mb_s"], codec["decode_mb_s"], rays["S1"]["median_ms"], rays["S2"]["median_ms"]]


def append(path, release, folder):
    is_new = not os.path.exists(path)
    with open(path, "a", encoding="utf-8") as table:
        if is_new:
            table.write(",".join(["release", *MEASURED]) + "\n")
        table.write(",".join(map(str, [release, *measured(folder)])) + "\n")


def show(path):
    rows = tables.read(path, ["release"])
    releases = tables.in_order(rows, "release")
    print("release " + "".join(f"{column:>24}" for column in MEASURED))
    first = {}
    for release in releases:
        line = f"{release:8}"
        for column, is_speed in MEASURED.items():
            median = statistics.median(row[column] for row in rows if row["release"] == release)
            start = first.setdefault(column, median)
            times = start / median if is_speed else median / start
            line += f"{median:15.1f} ({times:.2f} x)"
        print(line)


if __name__ == "__main__":
    if len(sys.argv) == 4:
        append(*sys.argv[1:])
    elif len(sys.argv) == 2:
        show(sys.argv[1])
    else:
        sys.exit(__doc__)
