# SPDX-License-Identifier: BSD-3-Clause
"""Draws a series and plain data with each Division: pictures are those of one rank.

    check_division.py --plugin PLUGIN --data FOLDER --out DIR [--reference DIR]

What cannot be divided by picture is divided by data, and a sentence says so.
"""
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import picture_scenes
import pictures
import session

DIVISIONS = ("Automatic", "By data", "By picture")
SENTENCE = "'Division' By picture has no effect"


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", required=True, help="folder with swirl.banyan")
    parser.add_argument("--reference", help="folder of the pictures of one rank")
    arguments = parser.parse_args()
    picture_scenes.Settings.data = arguments.data
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    ranks = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()
    first = vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0
    told = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(told)
    samples = {}
    for name, show in (("encoded", picture_scenes.encoded), ("plain", picture_scenes.wavelet)):
        view = session.new_view(picture_scenes.SIZE, **picture_scenes.CAMERA)
        picture_scenes.spheres(view)
        display = show(view)
        for number, division in enumerate(DIVISIONS):
            display.Division = division
            view.CameraPosition = [45 + number, 40, 100]  # no picture of before
            path = os.path.join(arguments.out, f"{name}-{number}.png")
            simple.SaveScreenshot(path, view, ImageResolution=list(picture_scenes.SIZE))
            display.UpdatePropertyInformation()
            samples[name, division] = display.GetPropertyValue("SamplesTaken")
            if first and arguments.reference:
                pictures.require_near(path, os.path.join(arguments.reference, f"{name}-{number}.png"))
        session.require(name != "encoded" or SENTENCE not in told.GetOutput(), "no sentence: " + told.GetOutput())
        session.clear()
    print(samples, flush=True)
    if first and ranks > 1:
        session.require(SENTENCE in told.GetOutput(), "plain data: " + told.GetOutput())
    print("ok: divisions")


if __name__ == "__main__":
    main()
