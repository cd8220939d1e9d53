# SPDX-License-Identifier: BSD-3-Clause
"""Draws frames until it is ended, and says when it has drawn one."""
from paraview import simple

import picture_scenes
import session


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--frames", type=int, default=100000)
    arguments = parser.parse_args()
    session.begin(arguments)
    view = session.new_view((300, 240), CameraPosition=[45, 40, 100], CameraFocalPoint=[0, 0, 0])
    picture_scenes.wavelet(view)
    for frame in range(arguments.frames):
        view.CameraPosition = [45 + 0.1 * (frame % 50), 40, 100]
        simple.Render(view)
        print("frame", frame, flush=True)


main()
