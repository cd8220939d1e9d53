"""Real meshes of hexahedra are drawn by "Banyan Volume", or refused with a sentence that says why.

    test_meshes.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
Without BANYAN_DATA_DIR there is nothing to do.
"""
import glob
import os
import sys

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import pictures
import session

DRAWN = {
    "hexa": ("hexa/hexa.vtu", "scalars"),
    "ok_hex": ("malformed_basic/u00_ok_hex.vtu", "s"),
}
REFUSED = {
    "can/can.vtu": ("Cell 0 is not an axis-aligned box", "DISPL"),
    "disk_out_ref/disk_out_ref.vtu": ("is not an axis-aligned box", "Temp"),
    "specfem_mount_st_helens/specfem_mount_st_helens.vtu":
        ("is not an axis-aligned box", "elevation"),
    "block_crush/block_crush_000.vtu": ("is of the type vtkVertex", "displ_"),
    "mastodon_seismic_z/mastodon_seismic_z_005.vtu": ("beside the lattice", "vel_"),
    "malformed_basic/u01_oob.vtu": ("refers to point 999, and the mesh has 8 points", "s"),
    "malformed_basic/u13_mixed.vtu": ("is of the type vtkTetra", "s"),
}
NOTHING = ("malformed_basic/u06_nocells.vtu", "malformed_basic/u07_empty.vtu")
STEPS = (0, 5, 13, 26)


def show(source, array):
    """A view of a source as "Banyan Volume", coloured by a point array."""
    view = session.new_view((200, 200))
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", array))
    display.SetRepresentationType(session.REPRESENTATION)
    view.ResetCamera()
    return view, display


def draw(path, source, array, view=None):
    if view is None:
        view, _ = show(source, array)
    simple.Render(view)
    simple.SaveScreenshot(path, view)


def is_empty(path):
    picture = pictures.load(path)
    return int(abs(picture - picture[0, 0]).max()) == 0


def draw_all(data, out):
    """@return the pictures drawn"""
    drawn = []
    for name, (file, array) in DRAWN.items():
        source = simple.OpenDataFile(os.path.join(data, file))
        drawn.append(os.path.join(out, name + ".png"))
        draw(drawn[-1], source, array)
        session.clear()
    steps = sorted(glob.glob(data + "/mastodon_seismic_z/*.vtu"))
    session.require(len(steps) == 27, "the seismic column has 27 steps")
    source = simple.OpenDataFile(steps)
    source.UpdatePipeline()
    view, display = show(source, "vel_")
    # The points of later steps are moved by their displacements: up to 2 % of an edge.
    display.MeshTolerance = 0.03
    # A column 200 times as high as wide, from the side.
    display.Scale = [40.0, 40.0, 1.0]
    view.CameraPosition = [4000.0, -12000.0, 4000.0]
    view.CameraFocalPoint = [500.0, 500.0, 2500.0]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelScale = 3000.0
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    display.RescaleTransferFunctionToDataRangeOverTime()
    display.ScalarOpacityUnitDistance = 30.0
    for step in STEPS:
        view.ViewTime = source.TimestepValues[step]
        drawn.append(os.path.join(out, f"seismic{step}.png"))
        draw(drawn[-1], source, "vel_", view)
    display.Shade = 1
    drawn.append(os.path.join(out, "seismic_shaded.png"))
    draw(drawn[-1], source, "vel_", view)
    session.clear()
    return drawn


def refuse_all(data, out):
    for file, (sentence, array) in REFUSED.items():
        source = simple.OpenDataFile(os.path.join(data, file))
        source.UpdatePipeline()
        window = vtkStringOutputWindow()
        before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(window)
        try:
            path = os.path.join(out, os.path.basename(file) + ".png")
            draw(path, source, array)
            octree = simple.BanyanHexOctree(Input=source)
            octree.UpdatePipeline()
        except RuntimeError:
            pass
        finally:
            vtkOutputWindow.SetInstance(before)
        said = window.GetOutput()
        print(f"{file}: {said}", flush=True)
        session.require(said.count(sentence) >= 2, f"{file}: '{sentence}' was not said twice")
        session.require("The volume was not drawn." in said, f"{file}: the volume is not named")
        session.clear()
    for file in NOTHING:
        source = simple.OpenDataFile(os.path.join(data, file))
        path = os.path.join(out, os.path.basename(file) + ".png")
        view = session.new_view((200, 200))
        display = simple.Show(source, view)
        display.SetRepresentationType(session.REPRESENTATION)
        draw(path, source, None, view)
        session.require(is_empty(path), f"{file}: something was drawn")
        session.clear()


def check_filter(data):
    source = simple.OpenDataFile(os.path.join(data, DRAWN["hexa"][0]))
    octree = simple.BanyanHexOctree(Input=source)
    octree.UpdatePipeline()
    information = octree.GetCellDataInformation().GetArray("octree_level")
    session.require(information.GetRange() == (0.0, 0.0), "one level")
    session.require(octree.GetPointDataInformation().GetArray("hanging").GetRange() == (0.0, 0.0),
                    "nothing hangs")
    session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    data = os.environ.get("BANYAN_DATA_DIR")
    if not data or not os.path.exists(os.path.join(data, DRAWN["hexa"][0])):
        print("no real data")
        sys.exit(77)
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    for path in draw_all(data, arguments.out):
        name = os.path.basename(path)
        session.require(name == "seismic0.png" or not is_empty(path), f"{name} is empty")
        if arguments.reference:
            error = pictures.difference(
                pictures.load(os.path.join(arguments.reference, name)), pictures.load(path))
            print(f"{name}: {int(error.max())}", flush=True)
            session.require(error.max() <= 1, f"{name} differs by {int(error.max())}")
    check_filter(data)
    if not arguments.reference:
        refuse_all(data, arguments.out)


main()
