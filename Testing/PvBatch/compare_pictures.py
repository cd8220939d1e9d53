# SPDX-License-Identifier: BSD-3-Clause
"""Compares the pictures of two runs of draw_scenes.py: they must show the same.

    compare_pictures.py REFERENCE OUT [--tolerance 1]

No channel of any pixel may differ by more than the tolerance (of 255), with one exception: on the
rim of opaque geometry, as REFERENCE/<scene>.bare.png shows it, RIM_PIXELS may differ, because there
OpenGL itself may draw the front or the back of a surface, depending on what else a rank draws. The
figures must fit too: samples lie on one lattice whoever takes them. Where pictures differ,
OUT/<scene>.difference.png shows where, 20 times amplified.
"""
import argparse
import json
import os
import sys

import pictures

RIM_PIXELS = 3


def load_figures(folder):
    path = os.path.join(folder, "figures.json")
    if not os.path.exists(path):
        sys.exit(f"{path} is missing: the scenes were not drawn to the end")
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def compare_picture(scene, arguments):
    """What is wrong, or None."""
    reference = pictures.load(os.path.join(arguments.reference, scene + ".png"))
    picture = pictures.load(os.path.join(arguments.out, scene + ".png"))
    if reference.shape != picture.shape:
        return f"size {picture.shape[:2]} instead of {reference.shape[:2]}"
    error = pictures.difference(reference, picture)
    beyond = error > arguments.tolerance
    wrong = int(beyond.sum())
    print(f"{scene}: largest difference {error.max()}, {wrong} pixels beyond the tolerance, "
          f"{pictures.psnr(reference, picture):.1f} dB")
    if wrong == 0:
        return None
    bare = os.path.join(arguments.reference, scene + ".bare.png")
    if wrong <= RIM_PIXELS and os.path.exists(bare) and \
            not (beyond & ~pictures.rim(pictures.load(bare))).any():
        print(f"{scene}: they lie on the rim of the geometry")
        return None
    pictures.save(os.path.join(arguments.out, scene + ".difference.png"),
                  20 * abs(reference - picture))
    return f"{wrong} pixels differ by more than {arguments.tolerance}, at most by {error.max()}"


def compare_figures(expected, found):
    """What is wrong, or None. Ranks end rays apart, so that together they may take more samples.

    In maxima and minima, what a brick may leave out depends on the bricks before it.
    """
    if "SamplesTaken" not in expected or "SamplesTaken" not in found:
        return None
    samples, reference = found["SamplesTaken"], expected["SamplesTaken"]
    # Zones cut bricks wherever they have moved to, and the box around what can be seen of a part is
    # tighter: the samples outside it, which change nothing, are then not taken.
    fewest = 0.9 if expected.get("extremes") else 0.99
    if not samples >= fewest * reference or not samples <= 1.5 * reference:
        return f"{samples} samples taken instead of {reference}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("reference")
    parser.add_argument("out")
    parser.add_argument("--tolerance", type=int, default=1)
    arguments = parser.parse_args()
    expected, found = load_figures(arguments.reference), load_figures(arguments.out)
    failures = []
    for scene in found:
        for wrong in (compare_picture(scene, arguments),
                      compare_figures(expected[scene], found[scene])):
            if wrong:
                failures.append(f"{scene}: {wrong}")
    if not found:
        failures.append("no scene was drawn")
    for failure in failures:
        print("FAILED " + failure, file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
