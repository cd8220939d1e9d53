# SPDX-License-Identifier: BSD-3-Clause
"""Checks that zones move on real ranks, and that the picture does not change by it.

A camera comes closer to a part of an encoded series, and of plain data that lies in pieces, with each
mode of LoadBalancing: every frame must look as without, and on several ranks bricks must move, but
only where a mode asks for it. Plain data is shaded as well: without ghost layers its pieces have no
seams.
"""
import os
import sys

from paraview import simple

import picture_scenes
import pictures
import session

SIZE = (240, 200)
MODES = ("Off", "Measured cost")
FRAMES = {"encoded": 12, "plain": 6, "shaded": 3}
NEAR = 6  # the first frame in the corner
TOLERANCE = 1
FIGURES = ("Imbalance", "BytesMoved", "CacheHits", "CacheMisses", "BricksDrawn")


def camera(frame):
    """From everything to a corner, where one rank has most of the work, and on in the opposite one, where another has. What a
    frame takes is measured: ranks that are not equally fast may leave zones as they are in one of them."""
    side = 1 if frame <= NEAR else -1
    away = (1.0 - 0.13 * min(frame, NEAR)) * 0.95 ** max(0, frame - NEAR)
    target = [side * size * (1 - away) for size in (14, 11, 9)]
    return {"CameraPosition": [at + side * far * away for at, far in zip(target, (45, 40, 100))],
            "CameraFocalPoint": target, "CameraViewUp": [0, 1, 0]}


def shaded_pieces(view):
    display = picture_scenes.wavelet(view, opacities=(0.0, 0.0, 0.05, 0.1, 0.2))
    display.Shade = 1
    return display


DATA = {"encoded": picture_scenes.encoded, "plain": picture_scenes.wavelet,
        "shaded": shaded_pieces}


def draw(data, mode, folder):
    """Pictures and figures of all frames in one mode."""
    view = session.new_view(SIZE, **camera(0))
    display = DATA[data](view)
    # In place of the tolerance, which probes may meet with other samples on other ranks.
    display.SampleDistanceVoxels = 0.5
    display.LoadBalancing = mode
    taken = []
    for frame in range(FRAMES[data]):
        for name, value in camera(frame).items():
            setattr(view, name, value)
        path = os.path.join(folder, f"{data}.{mode.replace(' ', '')}.{frame}.png")
        simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
        display.UpdatePropertyInformation()
        figures = {name: display.GetPropertyValue(name) for name in FIGURES}
        print(data, mode, frame, figures, flush=True)
        taken.append((pictures.load(path), figures))
    session.clear()
    return taken


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", default=".", help="folder with swirl.banyan")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--reference", help="folder of the pictures of one rank")
    arguments = parser.parse_args()
    session.begin(arguments)
    picture_scenes.Settings.data = arguments.data
    os.makedirs(arguments.out, exist_ok=True)
    failures = []

    def require(condition, sentence):
        if not condition:
            failures.append(sentence)

    for data in DATA:
        drawn = {mode: draw(data, mode, arguments.out) for mode in MODES}
        for mode, frames in drawn.items():
            moved = sum(figures["BytesMoved"] for _, figures in frames)
            # Shading takes a layer of samples from the pieces around.
            wanted = (mode != "Off" or data == "shaded") and arguments.ranks > 1
            require((moved > 0) == wanted,
                    f"{data}, '{mode}' moved {moved} bytes on {arguments.ranks} ranks")
            for frame, (picture, figures) in enumerate(frames):
                what = f"{data}, '{mode}', frame {frame}"
                largest = int(pictures.difference(picture, drawn["Off"][frame][0]).max())
                require(largest <= TOLERANCE, f"{what}: pixels differ by {largest}")
                require(picture.max() > 60, f"{what}: nothing was drawn")
                require(1.0 <= figures["Imbalance"] <= arguments.ranks + 1e-6,
                        f"{what}: the imbalance is {figures['Imbalance']}")
        for frame, (picture, _) in enumerate(drawn["Off"] if arguments.reference else ()):
            alone = pictures.load(os.path.join(arguments.reference, f"{data}.Off.{frame}.png"))
            largest = int(pictures.difference(picture, alone).max())
            require(largest <= TOLERANCE,
                    f"{data}, frame {frame}: pixels differ from those of one rank by {largest}")
        changes = pictures.difference(drawn["Off"][0][0], drawn["Off"][-1][0]).max()
        require(changes > 60, f"{data}: the camera did not move")
    for failure in failures:
        print("FAILED " + failure, file=sys.stderr)
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    main()
