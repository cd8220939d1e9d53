# SPDX-License-Identifier: BSD-3-Clause
"""Series in folders must be the same, byte for byte: index files, and names and bytes of segments.

    compare_files.py [--fewest SERIES] REFERENCE FOLDER...
"""
import argparse
import os
import sys


def content(folder):
    """Bytes of all files of all series, by path within the folder."""
    files = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            relative = os.path.relpath(path, folder)
            if ".banyan" in relative:
                with open(path, "rb") as file:
                    files[relative] = file.read()
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fewest", type=int, default=14, help="series that there must be")
    parser.add_argument("reference")
    parser.add_argument("folders", nargs="+")
    arguments = parser.parse_args()
    reference = content(arguments.reference)
    indices = [name for name in reference if name.endswith(".banyan")]
    if len(indices) < arguments.fewest or len(reference) < 2 * len(indices):
        sys.exit(f"too little to compare: {sorted(reference)}")
    for folder in arguments.folders:
        other = content(folder)
        different = [name for name in sorted(set(reference) | set(other))
                     if reference.get(name) != other.get(name)]
        if different:
            sys.exit(f"{folder} differs from {arguments.reference} in {different}")
        print(f"{folder}: {len(other)} files, {sum(map(len, other.values()))} bytes, the same")


if __name__ == "__main__":
    main()
