# SPDX-License-Identifier: BSD-3-Clause
"""Checks that the scenes show what they are meant to: equal pictures of nothing prove nothing.

    check_parts.py OUT        (drawn by draw_scenes.py --parts)

The volume must change many pixels of each scene (none where it is out of sight) and so must the
geometry. Of the five spheres, known by their colours: the front one hides the volume entirely; the
one inside and the one behind are seen through the volume, changed by it and not hidden by it.
"""
import json
import os
import sys

import numpy

import pictures

BACKGROUND = numpy.array([26, 51, 77])
# Scenes with the usual camera and a volume that lies in front of the spheres inside and behind.
USUAL = ("plain_and_spheres", "encoded_and_spheres", "screenshot_larger")


def differs(a, b, by=2):
    return pictures.difference(a, b) > by


def dominated(picture, channel):
    """Pixels whose given channel is at least 1.5 times each other one."""
    others = [c for c in range(3) if c != channel]
    return (picture[:, :, channel] > 1.5 * picture[:, :, others].max(axis=2)) & \
        differs(picture, BACKGROUND[None, None, :] + 0 * picture, 3)


def check_scene(scene, figures, folder):
    picture = pictures.load(os.path.join(folder, scene + ".png"))
    alone = pictures.load(os.path.join(folder, scene + ".alone.png"))
    bare = pictures.load(os.path.join(folder, scene + ".bare.png"))
    by_volume = int(differs(picture, bare).sum())
    by_geometry = int(differs(picture, alone).sum())
    print(f"{scene}: the volume changes {by_volume} pixels, the geometry {by_geometry}")
    least = figures["volume_pixels"]
    if (least < 0 and by_volume > 0) or by_volume < least:
        yield f"the volume changes {by_volume} pixels instead of {max(least, 0)} or more"
    if figures["geometry"] and by_geometry < 300:
        yield f"the geometry changes {by_geometry} pixels"
    if scene in USUAL:
        yield from check_spheres(picture, alone, bare)


def check_spheres(picture, alone, bare):
    covered = differs(alone, BACKGROUND[None, None, :] + 0 * alone)
    # Edge smoothing mixes the rim with what lies behind.
    front = dominated(bare, 0) & covered & ~pictures.rim(bare, 3)
    changed = int((front & differs(picture, bare, 1)).sum())
    if front.sum() < 300 or changed > 0:
        yield f"{changed} of {int(front.sum())} pixels of the front sphere are changed by the " \
            "volume behind it"
    for name, channel in (("inside", 1), ("behind", 2)):
        sphere = dominated(bare, channel) & covered
        seen = int((sphere & differs(picture, alone)).sum())
        veiled = int((sphere & differs(picture, bare)).sum())
        if seen < 300 or veiled < 300:
            yield f"of {int(sphere.sum())} pixels of the sphere {name} {seen} are seen and " \
                f"{veiled} lie behind the volume"


def main():
    folder = sys.argv[1]
    with open(os.path.join(folder, "figures.json"), encoding="utf-8") as file:
        scenes = json.load(file)
    failures = [f"{scene}: {wrong}" for scene, figures in scenes.items()
                for wrong in check_scene(scene, figures, folder)]
    for failure in failures:
        print("FAILED " + failure, file=sys.stderr)
    sys.exit(1 if failures or not scenes else 0)


if __name__ == "__main__":
    main()
