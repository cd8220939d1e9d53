# SPDX-License-Identifier: BSD-3-Clause
"""Checks the figures that runs of draw_scenes.py have read from the representation.

    check_figures.py FOLDER=RANKS...      e.g. pictures/builtin=1 pictures/Server3=3

They come from the servers in every mode, describe all ranks together, and fit to each other.
"""
import json
import os
import sys

OUT_OF_SIGHT = "volume_behind_the_viewer"
# One rank has all of it: if that is the root, nothing has to be sent.
ON_ONE_RANK = "one_cell"


def problems(scene, figures, ranks):
    def expect(condition, sentence):
        if not condition:
            yield f"{scene}: {sentence}"

    if scene == OUT_OF_SIGHT:
        yield from expect(figures["SamplesTaken"] == 0, "samples were taken out of sight")
        return
    for name in ("TotalSeconds", "RenderSeconds", "SamplesTaken", "BricksDrawn"):
        yield from expect(figures[name] > 0, f"{name} is {figures[name]}")
    for name in ("CompositeSeconds", "BricksSkipped", "BytesRead", "CacheBytes"):
        yield from expect(figures[name] >= 0, f"{name} is {figures[name]}")
    yield from expect(figures["TotalSeconds"] >= 0.99 * figures["RenderSeconds"],
                      "rendering took longer than the frame")
    yield from expect(1.0 <= figures["Imbalance"] <= ranks + 1e-6,
                      f"the imbalance of {ranks} ranks is {figures['Imbalance']}")
    yield from expect((figures["BytesComposited"] > 0) == (ranks > 1) or
                      (scene == ON_ONE_RANK and figures["BytesComposited"] == 0),
                      f"{figures['BytesComposited']} bytes were composited on {ranks} ranks")


def check(folder, ranks):
    with open(os.path.join(folder, "figures.json"), encoding="utf-8") as file:
        scenes = json.load(file)
    for scene, figures in scenes.items():
        yield from problems(scene, figures, ranks)
    # The first picture of a series reads it; a later one from the same step finds it in the cache.
    first, later = scenes["encoded_and_spheres"], scenes["screenshot_smaller_and_odd"]
    if not first["BytesRead"] > 0 or not first["CacheBytes"] > 0:
        yield "encoded_and_spheres: nothing was read, or nothing is kept"
    if later["BytesRead"] != 0 or later["CacheBytes"] < first["CacheBytes"]:
        yield "screenshot_smaller_and_odd: bricks were read again"
    if "camera_inside" in scenes and not scenes["camera_inside"]["BricksSkipped"] > 0:
        yield "camera_inside: bricks behind the camera were not skipped"


def main():
    failures = []
    for argument in sys.argv[1:]:
        folder, ranks = argument.rsplit("=", 1)
        failures += [f"{folder}: {problem}" for problem in check(folder, int(ranks))]
    for failure in failures:
        print("FAILED " + failure, file=sys.stderr)
    sys.exit(1 if failures or len(sys.argv) < 2 else 0)


if __name__ == "__main__":
    main()
