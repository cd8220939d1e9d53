# SPDX-License-Identifier: BSD-3-Clause
"""Tables that the programs of this folder write."""

import csv


def read(path, words):
    """The rows of a CSV file: numbers, nothing where a field is empty, but for the columns `words`."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for key, text in row.items():
            if key not in words:
                row[key] = float(text) if text else None
    return rows


def in_order(rows, key):
    """What a column holds, each once, in the order of the rows."""
    return list(dict.fromkeys(row[key] for row in rows))
