# SPDX-License-Identifier: BSD-3-Clause
"""Real meshes of hexahedra, hyper trees and AMR are drawn by "Banyan Volume", and refused by the filter of octrees.

    test_meshes.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
Without BANYAN_DATA_DIR there is nothing to do.
"""
import glob
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import pictures
import session
from random_trees import random_trees

HTG = "htg_derived_hydrogen/hydrogen.htg"
AMR = "amr_hierarchicalbox/HierarchicalBoxDataset.v1.1.vthb"
DRAWN = {
    "hexa": ("hexa/hexa.vtu", ("POINTS", "scalars")),
    "ok_hex": ("malformed_basic/u00_ok_hex.vtu", ("POINTS", "s")),
    "trees": (HTG, ("CELLS", "density")),
    "amr": (AMR, ("CELLS", "TestX")),
    "amr_vector": (AMR, ("CELLS", "VectorXYZ")),
}
REFUSED = {
    "can/can.vtu": ("Cell 0 is not an axis-aligned box", "DISPL"),
    "disk_out_ref/disk_out_ref.vtu": ("is not an axis-aligned box", "Temp"),
    "specfem_mount_st_helens/specfem_mount_st_helens.vtu":
        ("is not an axis-aligned box", "elevation"),
    "mastodon_seismic_z/mastodon_seismic_z_005.vtu": ("beside the corners of the other cells", "vel_"),
    "malformed_basic/u01_oob.vtu": ("refers to point 999, and the mesh has 8 points", "s"),
}
NOTHING = ("malformed_basic/u06_nocells.vtu", "malformed_basic/u07_empty.vtu")
STEPS = range(27)

INFORMATION = """
self.GetExecutive().GetOutputInformation(0).Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
"""
# Cells of two sizes; each rank has ghosts of those of the next one.
CELLS = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
piece = info.Get(executive.UPDATE_PIECE_NUMBER())
pieces = info.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
grid = self.GetUnstructuredGridOutput()
points, values, ghosts = vtkPoints(), [], []
grid.Allocate(1000)
cubes = [(x, y, z, 2) for x in (0, 2) for y in (0, 2) for z in (0, 2)]
cubes += [(x, y, z, 1) for x in range(4, 8) for y in range(4) for z in range(4)]
for number, (x, y, z, edge) in enumerate(cubes):
    if pieces > 1 and number % pieces not in (piece, (piece + 1) % pieces):
        continue
    ids = [points.InsertNextPoint(x + edge * (i & 1), y + edge * (i >> 1 & 1), z + edge * (i >> 2))
           for i in range(8)]
    grid.InsertNextCell(11, 8, ids)
    own = number % pieces == piece
    values.append(number * 37 % 53 if own else 52)
    ghosts.append(0 if own else 1)
grid.SetPoints(points)
for name, array in (("value", numpy.array(values, float)), ("vtkGhostType", numpy.array(ghosts, numpy.uint8))):
    array = numpy_to_vtk(array, 1)
    array.SetName(name)
    grid.GetCellData().AddArray(array)
"""


def show(source, array):
    """A view of a source as "Banyan Volume", coloured by an array: of points unless it says more."""
    view = session.new_view((200, 200))
    display = simple.Show(source, view)
    simple.ColorBy(display, array if isinstance(array, tuple) else ("POINTS", array))
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
        if file == AMR:
            source.DefaultNumberOfLevels = 10
        drawn.append(os.path.join(out, name + ".png"))
        draw(drawn[-1], source, array)
        session.clear()
    # Each rank has some of the trees, and of cells that have no points in common.
    trees = random_trees((3, 2, 2))
    cells = simple.ProgrammableSource(Script=CELLS, ScriptRequestInformation=INFORMATION,
                                      OutputDataSetType="vtkUnstructuredGrid")
    for name, source, array in (("pieces", trees, "Depth"), ("cells", cells, "value")):
        drawn.append(os.path.join(out, name + ".png"))
        view, display = show(source, ("CELLS", array))
        display.ScalarOpacityUnitDistance = 0.5  # ParaView's own depends on how many ghosts there are
        draw(drawn[-1], source, None, view)
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
            view, display = show(source, array)
            draw(path, source, array, view)
            octree = simple.BanyanHexOctree(Input=source)
            octree.UpdatePipeline()
        except RuntimeError:
            pass
        finally:
            vtkOutputWindow.SetInstance(before)
        said = window.GetOutput()
        print(f"{file}: {said}", flush=True)
        # Boxes can be sampled of cells that have points.
        session.require(("Sample General Meshes" in said) == ("u01" not in file), f"{file}: wrong advice")
        bad = "u01" in file
        session.require(said.count(sentence) >= (2 if bad else 1), f"{file}: '{sentence}' was not said")
        session.require(("The volume was not drawn." in said) == bad, f"{file}: whether it is drawn")
        session.require(is_empty(path) == bad, f"{file}: the picture")
        session.clear()
    for file in NOTHING:
        source = simple.OpenDataFile(os.path.join(data, file))
        try:
            simple.SaveData(os.path.join(out, "nothing.banyan"), proxy=source)
            raise AssertionError(f"{file} was written")
        except RuntimeError as error:
            session.require("The mesh has no cells" in str(error) and
                            "Sample General Meshes" not in str(error), str(error))
        path = os.path.join(out, os.path.basename(file) + ".png")
        view = session.new_view((200, 200))
        display = simple.Show(source, view)
        display.SetRepresentationType(session.REPRESENTATION)
        draw(path, source, None, view)
        session.require(is_empty(path), f"{file}: something was drawn")
        session.clear()


def check_filter(data):
    """Levels are those of the whole mesh, whichever part of it a rank has."""
    source = simple.OpenDataFile(os.path.join(data, DRAWN["hexa"][0]))
    octree = simple.BanyanHexOctree(Input=source)
    octree.UpdatePipeline()
    information = octree.GetCellDataInformation().GetArray("octree_level")
    session.require(information.GetRange() == (0.0, 0.0), "one level")
    session.require(octree.GetPointDataInformation().GetArray("hanging").GetRange() == (0.0, 0.0),
                    "nothing hangs")
    session.clear()
    for file, cells, levels in ((HTG, 32544, (0, 4)), (AMR, 2241, (0, 2))):
        source = simple.OpenDataFile(os.path.join(data, file))
        if file == AMR:
            source.DefaultNumberOfLevels = 10
        octree = simple.BanyanHexOctree(Input=source)
        octree.UpdatePipeline()
        count = octree.GetDataInformation().GetNumberOfCells()
        session.require(count == cells, f"{file}: {count} cells")
        found = octree.GetCellDataInformation().GetArray("octree_level").GetRange()
        print(f"{file}: {count} cells, levels {found}", flush=True)
        session.require(found == levels, f"{file}: levels {found}")
        session.clear()


def check_series(data, out):
    """Hyper trees and AMR are written as the meshes that are drawn of them."""
    for file, array, cells in ((HTG, "density", 32544), (AMR, "TestX", 2241)):
        source = simple.OpenDataFile(os.path.join(data, file))
        if file == AMR:
            source.DefaultNumberOfLevels = 10
        source.UpdatePipeline()
        path = os.path.join(out, os.path.basename(file) + ".banyan")
        simple.SaveData(path, proxy=source, ErrorBoundMode="Absolute", ErrorBound=1e-5)
        series = simple.OpenDataFile(path)
        series.UpdatePipeline()
        count = series.GetDataInformation().GetNumberOfCells()
        session.require(count == cells, f"{path}: {count} cells")
        drawn, camera = [], None
        for shown, place in ((source, "CELLS"), (series, "POINTS")):
            view, display = show(shown, (place, array))
            display.ScalarOpacityUnitDistance = 1.0
            display.SampleDistanceVoxels = 0.5  # not as errors are estimated
            for table in (simple.GetColorTransferFunction(array),
                          simple.GetOpacityTransferFunction(array)):
                table.RescaleTransferFunction(*source.CellData[array].GetRange(0))
            # Bounds of blocks are rounded differently.
            camera = camera or [view.CameraPosition[:], view.CameraFocalPoint[:]]
            view.CameraPosition, view.CameraFocalPoint = camera
            drawn.append(f"{path}.{place}.png")
            draw(drawn[-1], shown, None, view)
        one, other = [pictures.load(picture) for picture in drawn]
        if one is not None:
            error = pictures.difference(one, other)
            print(f"{path}: {int(error.max())}", flush=True)
            session.require(error.max() <= 1, f"{path}: another picture")
            session.require(not is_empty(drawn[0]), f"{path}: nothing is drawn")
        session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    data = session.real_data(DRAWN["hexa"][0])
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    for path in draw_all(data, arguments.out):
        name = os.path.basename(path)
        at_rest = name in ("seismic0.png", "seismic1.png")
        session.require(is_empty(path) == at_rest, f"{name}: empty or not")
        if arguments.reference:
            pictures.require_near(path, os.path.join(arguments.reference, name))
    check_filter(data)
    check_series(data, arguments.out)
    if not arguments.reference:
        refuse_all(data, arguments.out)


main()
