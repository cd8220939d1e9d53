# SPDX-License-Identifier: BSD-3-Clause
"""Draws frames until it is ended, and says when it has drawn one.

With --wall it is the client of a server with displays, and each of them shows a part of the volume, which the viewer
is in.
"""
import os

from paraview import simple
from paraview.modules.vtkRemotingCore import vtkProcessModule

import picture_scenes
import session


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--frames", type=int, default=100000)
    parser.add_argument("--wall", action="store_true")
    arguments = parser.parse_args()
    session.begin(arguments)
    eye = [0, 0, 10] if arguments.wall else [45, 40, 100]
    view = session.new_view((300, 240), CameraPosition=eye, CameraFocalPoint=[0, 0, 0])
    picture_scenes.wavelet(view)
    if arguments.wall:
        view.RemoteRenderThreshold = 0
        simple.AssignViewToLayout(view)
        simple.GetLayout(view).SMProxy.ShowViewsOnTileDisplay()
    for frame in range(arguments.frames):
        view.CameraPosition = [eye[0] + 0.1 * (frame % 50), *eye[1:]]
        simple.Render(view)
        if arguments.wall and vtkProcessModule.GetProcessModule().GetNetworkAccessManager().ProcessEvents(1) < 0:
            # A window notices it between frames, a script does not. Python's own end of a client without its server may
            # not come to an end: it frees a thing twice.
            print("the server has gone", flush=True)
            os._exit(1)
        print("frame", frame, flush=True)


main()
