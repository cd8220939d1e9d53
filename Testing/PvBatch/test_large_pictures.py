# SPDX-License-Identifier: BSD-3-Clause
"""Saves pictures that are too large to be drawn at once.

    test_large_pictures.py --plugin PLUGIN --data FOLDER --out DIR [--reference DIR]

A view of that size draws them part by part, and takes a bounded amount of memory for it. A smaller view makes a
screenshot of that size in parts of its own: the same picture. Ranks draw that of one.
"""
import os

from paraview import simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import picture_scenes
import pictures
import session

PARTS = 4
SMALL = (800, 700)
LARGE = tuple(PARTS * size for size in SMALL)
# MiB besides what ParaView has, where nothing but volumes is shown. All at once take 40 bytes a pixel: 342 MiB.
MOST = 280


def peak():
    """Bytes that this process has had at most."""
    with open("/proc/self/status", encoding="utf-8") as file:
        return next(1024 * int(line.split()[1]) for line in file if line.startswith("VmHWM"))


def one_volume(view):
    picture_scenes.spheres(view)
    return [picture_scenes.encoded(view)]


def two_volumes(view):
    display = picture_scenes.wavelet(view)
    session.move_to(display, [-24.0, 0.0, 0.0])
    return [picture_scenes.encoded(view), display]


def screenshot(path, view):
    simple.SaveScreenshot(path, view, ImageResolution=list(LARGE), CompressionLevel="1")


def compare(name, files, allowed, reference):
    whole = pictures.load(files["whole"])
    bare = pictures.load(files["bare"])
    # An edge of a surface may be in the next pixel: of ParaView's own parts, and of other ranks.
    rim = pictures.rim(bare)
    others = [("parts", files["parts"], allowed)]
    if reference:
        others.append(("one rank", os.path.join(reference, f"{name}-whole.png"), 1))
    for kind, path, most in others:
        error = pictures.difference(whole, pictures.load(path))
        print(f"{name}: {int(error[~rim].max())} from {kind}, {int(error.max())} at edges of surfaces")
        session.require(error[~rim].max() <= most, f"{name}: the whole differs from {kind}")
    changed = pictures.difference(whole, bare) > 2
    session.require(changed.mean() > 0.1, f"{name}: {changed.mean():.2f} of the picture show the volume")


def check_scene(name, show, has_surfaces, arguments, is_first):
    files = {kind: os.path.join(arguments.out, f"{name}-{kind}.png") for kind in ("whole", "parts", "bare")}
    view = session.new_view(LARGE, **dict(picture_scenes.CAMERA, CameraViewAngle=15))
    volumes = show(view)
    for volume in volumes:
        volume.Visibility = 0
    screenshot(files["bare"], view)
    before = peak()
    for volume in volumes:
        volume.Visibility = 1
    screenshot(files["whole"], view)
    taken = (peak() - before) / 2**20
    print(f"{name}: {taken:.0f} MiB more", flush=True)
    # Of several ranks, ParaView's compositor needs more for pictures that are not empty.
    alone = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses() == 1
    session.require(
        has_surfaces or not alone or taken < MOST, f"{name}: {taken:.0f} MiB more, where {MOST} are allowed")
    view.ViewSize = list(SMALL)
    view.StillRender()
    screenshot(files["parts"], view)
    if is_first:
        # Parts with surfaces are planned one by one: each may be off by the tolerance, 1. Zones of ranks move.
        allowed = 2 if has_surfaces else 0 if alone else 1
        compare(name, files, allowed, arguments.reference)
    session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", required=True, help="folder with swirl.banyan")
    parser.add_argument("--reference", help="folder of the pictures of one rank")
    arguments = parser.parse_args()
    picture_scenes.Settings.data = arguments.data
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    is_first = vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0
    check_scene("two", two_volumes, False, arguments, is_first)
    check_scene("one", one_volume, True, arguments, is_first)
    print("ok: large pictures")


if __name__ == "__main__":
    main()
