# SPDX-License-Identifier: BSD-3-Clause
"""On tile displays and in CAVEs volumes are refused in a sentence: nothing hangs, and surfaces are drawn.

    test_walls.py --plugin PLUGIN --data FOLDER    as client of a server with displays
"""
import os

import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import picture_scenes
import session
from placed_volumes import shown


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--data", required=True, help="folder with the encoded series")
    arguments = parser.parse_args()
    picture_scenes.Settings.data = arguments.data
    told, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(told)
    session.begin(arguments)
    view = session.new_view(picture_scenes.SIZE, **picture_scenes.CAMERA)
    view.RemoteRenderThreshold = 0
    simple.AssignViewToLayout(view)
    layout = simple.GetLayout(view)
    if layout is not None:
        layout.SMProxy.ShowViewsOnTileDisplay()
    spheres = picture_scenes.spheres(view)
    first = picture_scenes.wavelet(view)
    second = picture_scenes.encoded(view)
    session.move_to(second, [60, 0, 0])
    # Displays look into different directions, and one of them may not see a volume.
    for angle in range(0, 360, 60):
        view.CameraPosition = [110 * numpy.cos(numpy.radians(angle)), 30, 110 * numpy.sin(numpy.radians(angle))]
        picture = shown(view)
        view.SMProxy.InteractiveRender()
    first.Visibility = 0
    shown(view)
    first.Visibility = 1
    view.ViewTime = 1.0
    picture = shown(view)
    with_spheres = len(numpy.unique(picture.reshape(-1, 3), axis=0))
    session.require(with_spheres > 20, f"spheres are drawn, not {with_spheres} colours")
    spheres.Visibility = 0
    nothing = len(numpy.unique(shown(view).reshape(-1, 3), axis=0))
    session.require(nothing == 1, f"no volume is drawn: {nothing} colours")
    vtkOutputWindow.SetInstance(before)
    text = told.GetOutput()
    session.require("cannot draw on tile displays and in CAVEs" in text, "the client says so: " + text)
    session.require(text.count("cannot draw on tile displays") == 2, "once per volume: " + text)
    print("ok: walls are refused")


if __name__ == "__main__":
    main()
