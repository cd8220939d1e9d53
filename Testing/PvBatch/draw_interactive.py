# SPDX-License-Identifier: BSD-3-Clause
"""Draws what is shown while somebody moves the camera, for comparison with other modes.

Pictures of interactive frames: coarser levels, longer steps and pixels without rays of their own, each
drawn by all ranks together. The window is read as it is, without drawing again, because a screenshot
would be a still picture. Which tolerance such frames keep depends on no clock here.
"""
import json
import os

from paraview import simple
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

import picture_scenes
import session

SIZE = (400, 300)
TOLERANCE = 0.5
POSITIONS = ([45, 40, 100], [60, 25, 90], [20, 70, 80])
EXTENT = (-40, 40, -32, 32, -28, 28)


def shown(view, path):
    """Saves what the window shows."""
    window = vtkWindowToImageFilter()
    window.SetInput(view.SMProxy.GetRenderWindow())
    window.ShouldRerenderOff()
    window.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(window.GetOutputPort())
    writer.SetFileName(path)
    writer.Write()


def scenes():
    """Name, and a function that shows a volume in a view."""
    yield "plain", lambda view: picture_scenes.wavelet(view, EXTENT)
    yield "encoded", lambda view: picture_scenes.encoded(view)


def draw(name, show, interactive_tolerance, folder):
    view = session.new_view(SIZE, **picture_scenes.CAMERA)
    # With several ranks ParaView itself would draw such frames with fewer pixels.
    view.ImageReductionFactor = 1
    display = show(view)
    display.ImageErrorTolerance = TOLERANCE
    display.InteractiveImageErrorTolerance = interactive_tolerance
    display.InteractiveFrameSeconds = 0.0
    display.ReuseFrames = 0  # the first of these pictures would be the still one

    def error():
        display.UpdatePropertyInformation()
        return display.GetPropertyValue("EstimatedImageError")

    simple.Render(view)
    still = error()
    for number, position in enumerate(POSITIONS):
        view.CameraPosition = position
        view.SMProxy.InteractiveRender()
        moving = error()
        session.require(still < moving <= interactive_tolerance,
                        f"{name}: interaction is coarser than {still}, within its tolerance, "
                        f"not {moving}")
        picture = f"{name}_{interactive_tolerance:g}_{number}"
        shown(view, os.path.join(folder, picture + ".png"))
        yield picture
    simple.Delete(view)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--data", required=True, help="folder with the encoded series")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    picture_scenes.Settings.data = arguments.data
    session.begin(arguments)
    drawn = [picture for name, show in scenes() for tolerance in (8.0, 64.0)
             for picture in draw(name, show, tolerance, arguments.out)]
    # compare_pictures.py compares what is listed.
    with open(os.path.join(arguments.out, "figures.json"), "w", encoding="utf-8") as file:
        json.dump({picture: {} for picture in drawn}, file)
    session.clear()
    print("ok: interactive frames are drawn")


if __name__ == "__main__":
    main()
