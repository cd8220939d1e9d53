# SPDX-License-Identifier: BSD-3-Clause
"""report.py pictures.csv: adds the column `off`, from the PNG files beside the table, and prints the table."""

import csv
import os
import sys

import numpy
from PIL import Image

ROWS = 256  # that are compared at once

Image.MAX_IMAGE_PIXELS = None


def difference(path, reference):
    """The largest difference of two pictures, of 255."""
    a, b = Image.open(path), Image.open(reference)
    worst = 0
    a.load()
    b.load()
    for top in range(0, a.height, ROWS):
        box = (0, top, a.width, min(top + ROWS, a.height))
        off = numpy.abs(numpy.asarray(a.crop(box)).astype(int) - numpy.asarray(b.crop(box)).astype(int)).max(axis=2)
        worst = max(worst, int(off.max()))
    return worst


def main():
    table = sys.argv[1]
    with open(table, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        path = os.path.join(os.path.dirname(table), f"{row['size']}-{row['shown']}-{{}}.png")
        reference = path.format("whole-1")
        own = path.format(f"{row['way']}-{row['ranks']}")
        row["off"] = ""
        if os.path.exists(reference) and row["shown"] == "banyan":
            row["off"] = difference(own, reference)
    with open(table, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    print("| " + " | ".join(rows[0]) + " |\n|" + "---|" * len(rows[0]))
    for row in rows:
        print("| " + " | ".join(str(value) for value in row.values()) + " |")


main()
