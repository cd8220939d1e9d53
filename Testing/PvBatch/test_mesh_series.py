# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of hexahedra are saved as Banyan series, come back, and are drawn.

    test_mesh_series.py --plugin Banyan.so --generate BANYAN_GENERATE --out FOLDER

One rank compares every value. compare_files.py compares the series of several runs, which must not
depend on the number of ranks.
"""
import glob
import os
import shutil
import subprocess

import numpy
from paraview import servermanager, simple
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import mesh_levels
import pictures
import session

BOUND = 1e-3
CELLS = 1  # vtkDataObject.CELL
STEPS = 5
QUAKE_CELLS, SHUFFLED_CELLS = 3489, 280
TIMES = [10.0 * step for step in range(STEPS)]

# Cells of two sizes in any order, with holes, in pieces by ranks that know global numbers of points and cells,
# and ghost cells. (max and min are others there than those of Python.)
SHUFFLED = """
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
piece = info.Get(executive.UPDATE_PIECE_NUMBER())
pieces = info.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
random = numpy.random.RandomState(7)
cubes = []
for z in range(4):
    for y in range(4):
        for x in range(4):
            if (x, y, z) == (1, 2, 1):
                continue  # a hole
            if x < 2:
                cubes += [(2 * x + i, 2 * y + j, 2 * z + k, 1) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
            else:
                cubes.append((2 * x, 2 * y, 2 * z, 2))
random.shuffle(cubes)
numbers, cells = {}, []
for x, y, z, e in cubes:
    corners = [(x, y, z), (x + e, y, z), (x + e, y + e, z), (x, y + e, z)]
    corners += [(a, b, c + e) for a, b, c in corners]
    cells.append([numbers.setdefault(corner, len(numbers)) for corner in corners])
place = numpy.array(sorted(numbers, key=numbers.get), dtype=float)
order = random.permutation(len(place))
place, cells = place[numpy.argsort(order)], order[numpy.array(cells)]
first, end = [len(cells) * i // pieces for i in (piece, piece + 1)]
own = numpy.arange(first, end + 5 if SHARED and piece + 1 < pieces else end)  # some of the next one's: ghosts
used = numpy.unique(cells[own]) if pieces > 1 else numpy.arange(len(place))
local = {point: i for i, point in enumerate(used)}
points = vtkPoints()
points.SetData(numpy_to_vtk(numpy.array([0.1, 10.0, -3.0]) + place[used] * [0.1, 0.2, 0.3], 1))
output = self.GetUnstructuredGridOutput()
output.SetPoints(points)
ids = numpy.array([[8] + [local[p] for p in cells[c]] for c in own], dtype=numpy.int64).ravel()
array = vtkCellArray()
array.ImportLegacyFormat(numpy_to_vtkIdTypeArray(ids, 1))
output.SetCells(12, array)
def add(data, name, values):
    values = numpy_to_vtk(numpy.ascontiguousarray(values), 1)
    values.SetName(name)
    data.AddArray(values)
    return values
x, y, z = place[used].T
add(output.GetPointData(), "u", numpy.stack([numpy.sin(x + time), y * time, z], 1).astype(numpy.float32))
special = numpy.cos(x + y - time)
special[used % 97 == 5] = numpy.nan
special[used % 89 == 3] = -9999.0
add(output.GetPointData(), "special", special)
add(output.GetPointData(), "count", (x + 10 * y).astype(numpy.int16))
# (No means and cosines: their last bit depends on where in memory a number stands.)
mx, my, mz = (0.5 * (place[cells[:, 0]] + place[cells[:, 6]])).T
every = numpy.arange(len(cells))
mass = (0.1 * mx * mx + my * time).astype(numpy.float32)
mass[every % 53 == 7] = numpy.nan
mass[every % 47 == 11] = -9999.0
add(output.GetCellData(), "mass", mass[own])
add(output.GetCellData(), "stress", numpy.stack([mx + time, mx * my, 0.01 * mz * mz * mz], 1)[own])
add(output.GetCellData(), "u", (own % 7 + time).astype(numpy.int32))  # the name of a point array
if GLOBAL:
    for data, values in ((output.GetPointData(), used), (output.GetCellData(), own)):
        ids = numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(values, dtype=numpy.int64), 1)
        ids.SetName("number")
        data.SetGlobalIds(ids)
flags = numpy.where(own < end, 0, vtkDataSetAttributes.DUPLICATECELL).astype(numpy.uint8)
if SHARED and pieces > 1:
    add(output.GetCellData(), "vtkGhostType", flags)
"""
INFORMATION = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Set(executive.TIME_STEPS(), [0.0, 1.0, 2.5], 3)
info.Set(executive.TIME_RANGE(), [0.0, 2.5], 2)
info.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
"""


def shuffled(shared, numbered):
    source = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid")
    source.Script = f"SHARED, GLOBAL = {shared}, {numbered}\n" + SHUFFLED
    source.ScriptRequestInformation = INFORMATION
    return source


def expect_same_mesh(one, other, where):
    """Same points, cells and types, in the same order."""
    for name, get in (("points", lambda g: vtk_to_numpy(g.GetPoints().GetData())),
                      ("corners", lambda g: vtk_to_numpy(g.GetCells().GetConnectivityArray())),
                      ("types", lambda g: dataset_adapter.WrapDataObject(g).CellTypes)):
        a, b = get(one), get(other)
        session.require(a.shape == b.shape and (a == b).all(), f"{where}: other {name}")


def expect_within(one, other, names, where, place=0):
    for name in names:
        a, b = [vtk_to_numpy(g.GetAttributes(place).GetArray(name)) for g in (one, other)]
        session.require(a.dtype == b.dtype and a.shape == b.shape, f"{where}: {name} is another array")
        fixed = ~numpy.isfinite(a.astype(float)) | (a == -9999.0)
        session.require(a[fixed].tobytes() == b[fixed].tobytes(), f"{where}: {name} without value")
        worst = numpy.abs(a[~fixed].astype(float) - b[~fixed].astype(float)).max()
        session.require(worst <= BOUND, f"{where}: {name} is {worst} away")


def compare(source, path, names, times, cells, cell_names=()):
    """Each step of a source and of the series that it was written to."""
    reader = simple.OpenDataFile(path)
    session.require(list(reader.TimestepValues) == times,
                    f"{path}: times {list(reader.TimestepValues)}")
    merged = simple.MergeBlocks(Input=source, MergePoints=0)
    for time in times:
        merged.UpdatePipeline(time)
        reader.UpdatePipeline(time)
        if vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses() == 1:
            one, other = servermanager.Fetch(merged), servermanager.Fetch(reader)
            expect_same_mesh(one, other, path)
            expect_within(one, other, names, f"{path}, time {time}")
            expect_within(one, other, cell_names, f"{path}, cells, time {time}", CELLS)
    read = reader.GetDataInformation()
    session.require(read.GetNumberOfCells() == cells, f"{path}: {read.GetNumberOfCells()} cells")
    for name in names:
        session.require(read.GetPointDataInformation().GetArrayInformation(name), f"{path}: no {name}")
    for name in cell_names:
        session.require(read.GetCellDataInformation().GetArrayInformation(name), f"{path}: no {name}")
    simple.Delete(merged)
    return reader


def write(source, folder, name, names, **options):
    path = os.path.join(folder, name + ".banyan")
    simple.SaveData(path, proxy=source, ErrorBoundMode="Absolute", ErrorBound=BOUND,
                    PointArrays=names, WriteTimeSteps=1, KeyframeInterval=2, **options)
    return path


def check_choice(source, folder):
    """The chosen arrays are written, and read."""
    path = os.path.join(folder, "chosen.banyan")
    simple.SaveData(path, proxy=source, PointArrays=[], CellArrays=["u", "mass"])
    reader = simple.OpenDataFile(path)
    reader.CellArrays = ["mass"]
    reader.UpdatePipeline()
    found = sorted(reader.PointData.keys()), sorted(reader.CellData.keys())
    session.require(found == ([], ["mass"]), f"{path}: {found}")
    simple.Delete(reader)


def check_blocks(folder):
    """Blocks are written as one mesh, if they have the same arrays."""
    whole = simple.Wavelet(WholeExtent=[0, 8, 0, 4, 0, 4])
    halves = [simple.AppendDatasets(Input=simple.ExtractSubset(Input=whole, VOI=[a, a + 4, 0, 4, 0, 4]))
              for a in (0, 4)]
    path = os.path.join(folder, "blocks.banyan")
    simple.SaveData(path, proxy=simple.GroupDatasets(Input=halves), ErrorBoundMode="Absolute",
                    ErrorBound=BOUND)
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline()
    information = reader.GetDataInformation()
    counts = (information.GetNumberOfCells(), information.GetNumberOfPoints())
    alone = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses() == 1
    session.require(counts[0] == 128 and (counts[1] == 225 or not alone), f"{counts} cells and points")
    if alone:
        values = {}
        for source in (whole, reader):
            data = servermanager.Fetch(source)
            array = data.GetPointData().GetArray("RTData")
            for i in range(data.GetNumberOfPoints()):
                values.setdefault(data.GetPoint(i), []).append(array.GetValue(i))
        pairs = numpy.array(list(values.values()))
        session.require(pairs.shape == (225, 2) and numpy.ptp(pairs, axis=1).max() <= BOUND,
                        "other values of blocks")
    simple.Delete(reader)
    more = simple.Calculator(Input=halves[1], ResultArrayName="extra", Function="2*RTData")
    # A cell array of one block only is left out; those of all are not.
    averages = [simple.PointDatatoCellData(Input=half) for half in halves]
    for blocks, count in (([halves[0], averages[1]], None), (averages, 128)):
        if count is None:
            blocks[1] = simple.PointDatatoCellData(Input=halves[1], PassPointData=1)
        simple.SaveData(path, proxy=simple.GroupDatasets(Input=blocks))
        other = simple.OpenDataFile(path)
        other.UpdatePipeline()
        array = other.CellData["RTData"]
        session.require((array is None) == (count is None), f"{path}: cell array {array}")
        session.require((other.PointData["RTData"] is None) == (count is not None), f"{path}: point array")
        simple.Delete(other)
    uneven = simple.GroupDatasets(Input=[halves[0], more])
    try:
        simple.SaveData(path, proxy=uneven)
    except RuntimeError as error:
        session.require("The point array extra is not the same in all pieces or blocks" in str(error),
                        str(error))
    else:
        raise AssertionError("blocks with different arrays were written")
    simple.SaveData(path, proxy=uneven, PointArrays=["RTData"])
    if alone:
        check_uneven_octree(uneven)
    if vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0:
        os.remove(path)
        shutil.rmtree(path + ".d")


def check_motion_of_trees(path, array, out):
    """Motion in trees is that in the grid of their leaves, in pictures and behind the filter."""
    trees = simple.OpenDataFile(path)
    trees.MeshAsHyperTreeGrid = 1
    time = trees.TimestepValues[2]
    leaves = simple.HyperTreeGridToUnstructuredGrid(Input=trees)
    trees.UpdatePipeline(time)
    limits = [0.0, trees.CellData[array].GetRange(-1)[1]]
    found = []
    for shown in (trees, leaves):
        enhanced = simple.BanyanTemporalEnhancement(Input=shown, Array=["CELLS", array], Strength=0.8)
        last = enhanced if shown is leaves else simple.HyperTreeGridToUnstructuredGrid(Input=enhanced)
        last.UpdatePipeline(time)
        data = servermanager.Fetch(last)
        found.append([vtk_to_numpy(data.GetCellData().GetArray(array + end)) for end in ("", "_enhanced")])
    session.require((found[0][1] == found[1][1]).all() and (found[0][1] != found[0][0]).any(),
                    "the filter makes other values of trees")
    drawn = []
    for name, strength, shown in (("trees", 0.8, trees), ("plain", 0.0, trees), ("leaves", 0.8, leaves)):
        view = session.new_view((160, 120), ViewTime=time)
        display = simple.Show(shown, view)
        simple.ColorBy(display, ("CELLS", array, "Magnitude"))
        display.SetRepresentationType(session.REPRESENTATION)
        display.TemporalEnhancement = strength
        display.SampleDistanceVoxels = 0.5  # not as errors are estimated
        display.ScalarOpacityUnitDistance = 5000.0
        for table in (simple.GetColorTransferFunction(array), simple.GetOpacityTransferFunction(array)):
            table.RescaleTransferFunction(*limits)
        view.ResetCamera()
        simple.GetActiveCamera().Elevation(-50)
        drawn.append(os.path.join(out, f"motion_{name}.png"))
        simple.Render(view)
        simple.SaveScreenshot(drawn[-1], view)
        simple.Delete(view)
    pictures.require_near(drawn[2], drawn[0])
    one, other = [pictures.load(picture) for picture in drawn[:2]]
    session.require(abs(one - one[0, 0]).max() > 30, "nothing is drawn of trees")
    session.require(abs(one - other).max() > 10, "no motion is brought out")


def check_uneven_octree(uneven):
    """The filter keeps what all blocks have, and names the rest."""
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    octree = simple.BanyanHexOctree(Input=uneven)
    octree.UpdatePipeline()
    vtkOutputWindow.SetInstance(before)
    session.require("point arrays extra are left out" in window.GetOutput(), window.GetOutput())
    information = octree.GetDataInformation()
    counts = information.GetNumberOfCells(), octree.PointData.keys(), octree.FieldData.keys()
    session.require(counts[0] == 128 and "RTData" in counts[1] and "extra" not in counts[1] and
                    not [name for name in counts[2] if "pieces" in name], f"the octree of blocks has {counts}")
    simple.Delete(octree)


def check_pictures(source, reader, array, out):
    """The picture of the series is that of the mesh."""
    drawn = []
    for name, shown in (("mesh", source), ("series", reader)):
        view = session.new_view((160, 120))
        display = simple.Show(shown, view)
        simple.ColorBy(display, ("POINTS", array, "Magnitude"))
        display.SetRepresentationType(session.REPRESENTATION)
        view.ViewTime = TIMES[-1]
        if not drawn:
            source.UpdatePipeline(TIMES[-1])
            highest = source.PointData[array].GetRange(-1)[1]
        for table in (simple.GetColorTransferFunction(array), simple.GetOpacityTransferFunction(array)):
            table.RescaleTransferFunction(0.0, 0.3 * highest)
        view.ResetCamera()
        simple.GetActiveCamera().Elevation(-50)
        simple.Render(view)
        drawn.append(os.path.join(out, name + ".png"))
        simple.SaveScreenshot(drawn[-1], view)
        simple.Delete(view)
    one, other = [pictures.load(path) for path in drawn]
    if one is not None:
        session.require(abs(one - one[0, 0]).max() > 30, "nothing is drawn")
        worst = abs(one - other).max()
        allowed = 2 + 255 * 2 * BOUND * 3 ** 0.5 / (0.3 * highest)  # colour and opacity change by that
        session.require(worst <= allowed, f"the picture of the series is {worst} away, not {allowed}")


def check_colours(reader, array):
    """Colours of the first step reach as far as the whole series. On several ranks pieces have ghost cells."""
    highest = []
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        highest.append(reader.PointData[array].GetRange(-1)[1])
    session.require(highest[0] < 0.5 * max(highest), f"{highest} would show nothing")
    view = session.new_view((160, 120), ViewTime=reader.TimestepValues[0])
    for kind in ("Surface", session.REPRESENTATION):
        display = simple.Show(reader, view)
        display.SetRepresentationType(kind)
        simple.ColorBy(display, ("POINTS", array, "Magnitude"))
        simple.Render(view)
        display.RescaleTransferFunctionToDataRange(False, True)
        reached = simple.GetColorTransferFunction(array).RGBPoints[-4]
        session.require(abs(reached - max(highest)) <= 1e-6 * max(highest),
                        f"{kind}: colours reach {reached}, the series {max(highest)}")
    simple.Delete(view)


def check_refusals(folder, quake):
    def refused(source, sentence, **options):
        path = os.path.join(folder, "refused.banyan")
        try:
            simple.SaveData(path, proxy=source, **options)
        except RuntimeError as error:
            session.require(sentence in str(error), f"'{error}' and not '{sentence}'")
            session.require(not os.path.exists(path) and not os.path.exists(path + ".d"),
                            "something is left")
            return
        raise AssertionError(f"was written, and not refused with '{sentence}'")

    refused(simple.MergeBlocks(Input=quake, MergePoints=0), "There is no point array nonsense",
            PointArrays=["nonsense"])
    refused(simple.MergeBlocks(Input=quake, MergePoints=0), "There is no cell array nonsense",
            CellArrays=["nonsense"])


def check_damage(path, folder):
    copy = os.path.join(folder, "damaged.banyan")
    shutil.copy(path, copy)
    shutil.copytree(path + ".d", copy + ".d")
    mesh = glob.glob(copy + ".d/*.mesh")[0]
    with open(mesh, "r+b") as file:
        file.seek(100)
        byte = file.read(1)
        file.seek(100)
        file.write(bytes([byte[0] ^ 1]))
    reader = simple.OpenDataFile(copy)
    try:
        reader.UpdatePipeline()
    except RuntimeError as error:
        session.require("The file of the mesh is damaged" in str(error), str(error))
    else:
        raise AssertionError("a damaged mesh was read")
    os.remove(copy)
    shutil.rmtree(copy + ".d")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--generate", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    session.begin(options)
    controller = vtkMultiProcessController.GetGlobalController()
    if controller.GetLocalProcessId() == 0:
        shutil.rmtree(options.out, ignore_errors=True)
        os.makedirs(options.out)
        quake = os.path.join(options.out, "quake")
        subprocess.run([options.generate, "--series", "earthquake", "--cells", "3000", "--steps",
                        str(STEPS), "--duration", str(TIMES[-1]), "--output", quake], check=True)
    quake = simple.OpenDataFile(os.path.join(options.out, "quake", "earthquake.exo"))
    arrays = ["velocity", "ground_displacement"]
    path = write(quake, options.out, "earthquake", arrays + ["ids"])
    reader = compare(quake, path, arrays, TIMES, QUAKE_CELLS)
    mesh_levels.check_series(reader, path, "velocity")
    check_colours(reader, "velocity")
    check_pictures(simple.MergeBlocks(Input=quake), reader, "velocity", options.out)
    names, cell_names = ["u", "special", "count"], ["mass", "stress", "u"]
    for name, shared, numbered in (("numbered", True, True), ("pieces", False, True)):
        source = shuffled(shared, numbered)
        path = write(source, options.out, name, names, FillValues=[-9999.0], CellArrays=cell_names)
        compare(source, path, names, [0.0, 1.0, 2.5], SHUFFLED_CELLS, cell_names)
    if controller.GetNumberOfProcesses() == 1:
        mesh_levels.check_cell_levels(path, cell_names, -9999.0)
    check_choice(source, options.out)
    mesh_levels.check_trees(os.path.join(options.out, "earthquake.banyan"), arrays, numpy.inf)
    check_motion_of_trees(os.path.join(options.out, "earthquake.banyan"), "velocity", options.out)
    mesh_levels.check_trees(path, names, -9999.0, cell_names)
    check_blocks(options.out)
    check_refusals(options.out, quake)
    check_damage(path, options.out)


if __name__ == "__main__":
    main()
