# SPDX-License-Identifier: BSD-3-Clause
"""Draws the scenes of picture_scenes.py into OUT/<scene>.png, in any mode of ParaView.

With --parts it also draws each scene without its volume (<scene>.bare.png) and without its
geometry (<scene>.alone.png), from which check_parts.py tells whether both are really there. Figures
of the volumes go to OUT/figures.json, which is written last: without it the run did not end.
"""
import json
import os
import time

from paraview import simple

import picture_scenes
import session

FIGURES = ("TotalSeconds", "RenderSeconds", "CompositeSeconds", "Imbalance", "SamplesTaken",
           "BricksDrawn", "BricksSkipped", "BytesComposited", "BytesRead", "CacheBytes")


def screenshot(drawn, path):
    size = drawn.image_size or picture_scenes.SIZE
    simple.SaveScreenshot(path, drawn.view, ImageResolution=list(size), OverrideColorPalette="",
                          TransparentBackground=0)


def figures_of(display):
    display.UpdatePropertyInformation()
    return {name: display.GetPropertyValue(name) for name in FIGURES}


def draw(name, arguments):
    started = time.monotonic()
    drawn = picture_scenes.scenes()[name]()
    if arguments.threshold is not None:
        drawn.view.RemoteRenderThreshold = arguments.threshold
    path = os.path.join(arguments.out, name)
    screenshot(drawn, path + ".png")
    figures = {"volume_pixels": drawn.volume_pixels, "geometry": len(drawn.geometry),
               "extremes": drawn.extremes}
    if arguments.figures:
        figures.update(figures_of(drawn.volumes[0]))
    if arguments.parts:
        for display in drawn.geometry:
            display.Visibility = 0
        screenshot(drawn, path + ".alone.png")
        for display in drawn.geometry:
            display.Visibility = 1
        for display in drawn.volumes:
            display.Visibility = 0
        screenshot(drawn, path + ".bare.png")
    session.clear()
    print(f"{name}: {time.monotonic() - started:.2f} s", flush=True)
    return figures


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", default=".", help="folder with swirl.banyan and small.banyan")
    parser.add_argument("--representation", default=session.REPRESENTATION)
    parser.add_argument("--scenes", nargs="*", help="names; all when left out")
    parser.add_argument("--parts", action="store_true")
    parser.add_argument("--figures", action="store_true")
    parser.add_argument("--threshold", type=float, help="RemoteRenderThreshold of the views")
    arguments = parser.parse_args()
    session.begin(arguments)
    picture_scenes.Settings.data = arguments.data
    picture_scenes.Settings.representation = arguments.representation
    os.makedirs(arguments.out, exist_ok=True)
    figures = {}
    for name in arguments.scenes or picture_scenes.scenes():
        figures[name] = draw(name, arguments)
    with open(os.path.join(arguments.out, "figures.json"), "w", encoding="utf-8") as file:
        json.dump(figures, file, indent=1)


if __name__ == "__main__":
    main()
