# SPDX-License-Identifier: BSD-3-Clause
"""Two views side by side on a wall: each tile shows what one rank's pictures of both views show there.

    test_views_on_wall.py --plugin PLUGIN --data FOLDER --out DIR --tiles X,Y [--reference]

With --reference one rank draws both views into DIR, each as large as its part of the wall. Otherwise it is the client
of a server with tiles, which may differ by 1 of 255, and in five pixels by 2. Each tile has as many pixels as
PV_SHARED_WINDOW_SIZE says; the views meet within one, at a column that is no multiple of anything.
"""
import os

import numpy
from paraview import simple

import picture_scenes
import pictures
import session
import test_walls

SHARE = 0.3725  # of the left view: 149 of 400 columns


class Scene:
    """A volume among spheres on the left, an encoded one on the right, before another background."""

    def __init__(self, size):
        columns = round(SHARE * size[0])
        self.left = session.new_view((columns, size[1]), **picture_scenes.CAMERA)
        self.right = session.new_view((size[0] - columns, size[1]), **picture_scenes.CAMERA)
        self.right.Background = [0.3, 0.1, 0.1]
        self.views = (self.left, self.right)
        self.spheres = [picture_scenes.spheres(view) for view in self.views]
        self.volumes = picture_scenes.wavelet(self.left), picture_scenes.encoded(self.right)
        for view in self.views:
            view.RemoteRenderThreshold = 0
            view.UseFXAA = 0  # the second view has set it back in the first one


def poses(scene):
    """Changes views again and again; gives a name each time, and the views that changed."""
    scene.right.CameraPosition = [-60, 70, 70]
    yield "both", scene.views
    scene.left.CameraViewAngle = 12
    yield "left", [scene.left]
    scene.right.ViewTime = 1.0
    scene.right.CameraFocalPoint = [10, 14, 0]
    yield "right", [scene.right]
    scene.volumes[0].Visibility = 0
    yield "hidden", [scene.left]
    scene.volumes[0].Visibility = 1
    scene.spheres[1].Visibility = 0
    scene.left.CameraPosition = [-45, 40, 100]
    yield "again", scene.views


def picture(out, pose, name):
    return os.path.join(out, f"whole-{pose}-{name}.png")


def draw_whole(size, out):
    for name in ("left", "right"):
        scene = Scene(size)
        view = getattr(scene, name)
        for pose, _ in poses(scene):
            simple.Render(view)
            simple.SaveScreenshot(picture(out, pose, name), view)
        session.clear()


def draw_tiles(wall, out):
    scene = Scene(wall.size)
    simple.AssignViewToLayout(scene.left)
    layout = simple.GetLayout(scene.left)
    layout.SplitHorizontal(0, SHARE)
    layout.AssignView(2, scene.right)
    layout.SMProxy.ShowViewsOnTileDisplay()
    for pose, changed in poses(scene):
        for view in changed:
            view.SMProxy.InteractiveRender()
            simple.Render(view)
        parts = [pictures.load(picture(out, pose, name)) for name in ("left", "right")]
        whole = {"": numpy.concatenate(parts, axis=1)}
        for rank in range(wall.ranks()):
            path = os.path.join(out, f"tile-{pose}{rank}.png")
            layout.SMProxy.SaveAsPNG(rank, path)
            largest = test_walls.compare(pictures.load(path), wall.part(whole, rank), 5, f"{pose}, tile {rank}")
            session.require(largest <= 2, f"{pose}, tile {rank}: surfaces may be off by 2 of 255, not {largest}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--data", required=True, help="folder with the encoded series")
    parser.add_argument("--out", required=True)
    parser.add_argument("--tiles", required=True)
    parser.add_argument("--reference", action="store_true")
    arguments = parser.parse_args()
    picture_scenes.Settings.data = arguments.data
    os.makedirs(arguments.out, exist_ok=True)
    wall = test_walls.Tiles([int(number) for number in arguments.tiles.split(",")], [0, 0])
    session.begin(arguments)
    simple._DisableFirstRenderCameraReset()
    if arguments.reference:
        draw_whole(wall.size, arguments.out)
    else:
        draw_tiles(wall, arguments.out)
    print("ok: two views on a wall")


if __name__ == "__main__":
    main()
