# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of cells of any type are saved as Banyan series, come back, and are drawn.

    test_cell_series.py --plugin Banyan.so --out FOLDER [--draw]

Cells are compared in their order: types, places of their points bit by bit, values with the bound; on one rank also the
numbers of points. With --draw "Banyan Volume" draws series and originals. Real meshes are looked at where there are some.
"""
import os

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import pictures
import session

BOUND = 1e-3
TIMES = [0.0, 1.0, 2.5, 3.0, 4.0]
INFORMATION = session.time_information(TIMES) + """
info.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
"""
# Cubes of a bent lattice, each divided in a way of its own; every rank has each second cube, or third one, and so on.
MESH = """
import math
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkFloatArray, vtkIdList, vtkPoints
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
piece = information.Get(executive.UPDATE_PIECE_NUMBER())
pieces = information.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
time = information.Get(executive.UPDATE_TIME_STEP()) if information.Has(executive.UPDATE_TIME_STEP()) else 0.0
grid = self.GetUnstructuredGridOutput()
away = 0.05 * int(time / 2) if MOVING else 0.0
n = 9
places = [(x + 0.2 * math.sin(y) + away * math.cos(z), y + 0.2 * math.cos(z), z + 0.01 * x * y)
          for z in range(n) for y in range(n) for x in range(n)]
points = vtkPoints()
points.SetDataType(TYPE)
wave, velocity = vtkFloatArray(), vtkDoubleArray()
wave.SetName("wave")
velocity.SetName("velocity")
velocity.SetNumberOfComponents(3)
for x, y, z in places:
    points.InsertNextPoint(x, y, z)
    wave.InsertNextValue(math.sin(0.4 * x + 0.3 * y - time) * math.cos(0.5 * z))
    velocity.InsertNextTuple3(math.sin(x + time), math.cos(y - time), 0.1 * z)
grid.SetPoints(points)
grid.GetPointData().SetScalars(wave)
grid.GetPointData().AddArray(velocity)
level = vtkFloatArray()
level.SetName("level")
grid.Allocate(1000)
def add(kind, ids):
    grid.InsertNextCell(kind, len(ids), ids)
    level.InsertNextValue(math.sin(0.01 * grid.GetNumberOfCells() + time))
number = 0
for z in range(n - 1):
    for y in range(n - 1):
        for x in range(n - 1):
            c = [x + (i & 1) + n * (y + (i >> 1 & 1) + n * (z + (i >> 2))) for i in range(8)]
            kind = number % 4
            number += 1
            if number % pieces != piece or (ONLY_FIRST and number > 1):
                continue
            if kind == 0:
                add(12, [c[i] for i in (0, 1, 3, 2, 4, 5, 7, 6)])
            elif kind == 1:
                add(13, [c[i] for i in (0, 1, 2, 4, 5, 6)])
                add(13, [c[i] for i in (1, 3, 2, 5, 7, 6)])
            elif kind == 2:
                for t in ((0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 6, 4), (3, 6, 5, 7), (0, 3, 5, 6)):
                    add(10, [c[i] for i in t])
            else:
                stream = vtkIdList()
                for number_of_face in [6]:
                    stream.InsertNextId(number_of_face)
                for face in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
                    stream.InsertNextId(4)
                    for i in face:
                        stream.InsertNextId(c[i])
                grid.InsertNextCell(42, stream)
                level.InsertNextValue(math.sin(0.01 * grid.GetNumberOfCells() + time))
grid.GetCellData().AddArray(level)
if CHANGING and time == 2.5 and piece == 0:
    turned = vtkIdList()
    grid.GetCellPoints(0, turned)
    last = turned.GetId(0)
    turned.SetId(0, turned.GetId(1))
    turned.SetId(1, last)
    grid.GetCells().ReplaceCellAtId(0, turned)
"""


def mesh_source(single=True, moving=False, changing=False, only_first=False):
    made = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid")
    made.Script = (f"TYPE, MOVING, CHANGING, ONLY_FIRST = {10 if single else 11}, {moving}, {changing}, {only_first}\n"
                   + MESH)
    made.ScriptRequestInformation = INFORMATION
    return made


def soup(grid):
    """What a grid is, whatever the numbers of its points: places of points of cells and faces, and values there."""
    places = vtk_to_numpy(grid.GetPoints().GetData()) if grid.GetPoints() else numpy.zeros((0, 3))
    ids, sizes, types = [], [], []
    points = vtkIdList()
    for cell in range(grid.GetNumberOfCells()):
        types.append(grid.GetCellType(cell))
        grid.GetCellPoints(cell, points)
        found = [points.GetId(i) for i in range(points.GetNumberOfIds())]
        ids += found
        sizes.append(len(found))
        if types[-1] == VTK_POLYHEDRON:
            grid.GetFaceStream(cell, points)
            at = 1
            for _ in range(points.GetId(0)):
                corners = points.GetId(at)
                ids += [points.GetId(at + 1 + i) for i in range(corners)]
                sizes.append(corners)
                at += 1 + corners
    parts = {"types": numpy.array(types, int), "sizes": numpy.array(sizes, int), "places": places[ids]}
    for kind, data, take in (("point", grid.GetPointData(), ids), ("cell", grid.GetCellData(), slice(None))):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            if array is not None and array not in (data.GetGlobalIds(), data.GetPedigreeIds()) \
                    and array.GetName() != "vtkGhostType":
                parts[f"{kind} {array.GetName()}"] = vtk_to_numpy(array)[take]
    return parts


def whole(proxy, time, folder):
    """The soup of all ranks, on rank 0 (and on the client of a server); nothing on others."""
    if time is None:
        proxy.UpdatePipeline()
    else:
        proxy.UpdatePipeline(time)
    controller = vtkMultiProcessController.GetGlobalController()
    if os.environ.get("BANYAN_TEST_SERVER"):
        ranks = servermanager.ActiveConnection.GetNumberOfDataPartitions()
        return joined([soup(servermanager.Fetch(proxy, rank)) for rank in range(ranks)])
    mine = soup(proxy.GetClientSideObject().GetOutputDataObject(0))
    if controller.GetNumberOfProcesses() == 1:
        return mine
    numpy.savez(os.path.join(folder, f"soup{controller.GetLocalProcessId()}.npz"), **mine)
    controller.Barrier()
    parts = None
    if controller.GetLocalProcessId() == 0:
        loaded = [numpy.load(os.path.join(folder, f"soup{rank}.npz"))
                  for rank in range(controller.GetNumberOfProcesses())]
        parts = joined([dict(one) for one in loaded])
    controller.Barrier()
    return parts


def joined(soups):
    """One after the other; those without cells may have other arrays."""
    some = [one for one in soups if len(one["types"]) > 0] or soups[:1]
    return {name: numpy.concatenate([one[name] for one in some]) for name in some[0]}


def expect_same(a, b, bounds, where):
    """@param bounds of the arrays, by name"""
    if a is None:
        return
    session.require(a.keys() == b.keys(), f"{where}: {a.keys()} and {b.keys()}")
    for name in a:
        mine, theirs = a[name], b[name]
        session.require(mine.dtype == theirs.dtype and mine.shape == theirs.shape,
                        f"{where}: {name} is {mine.dtype} {mine.shape}, and {theirs.dtype} {theirs.shape}")
        if name in ("types", "sizes", "places"):
            session.require(mine.tobytes() == theirs.tobytes(), f"{where}: other {name}")
        elif mine.size > 0:
            error = numpy.abs(mine.astype(float) - theirs.astype(float)).max(axis=0)
            session.require(numpy.max(error - bounds(name)) <= 0, f"{where}: {name} is {error} away")


def expect_same_numbers(a, b, where):
    """On one rank numbers of points are the same, too."""
    for take in ("GetConnectivityArray", "GetOffsetsArray"):
        mine, theirs = (vtk_to_numpy(getattr(each.GetCells(), take)()).astype(numpy.int64) for each in (a, b))
        session.require(mine.tobytes() == theirs.tobytes(), f"{where}: {take}")
    mine, theirs = (vtk_to_numpy(each.GetPoints().GetData()) for each in (a, b))
    session.require(mine.dtype == theirs.dtype and mine.tobytes() == theirs.tobytes(), f"{where}: points")


def alone():
    return (not os.environ.get("BANYAN_TEST_SERVER")
            and vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses() == 1)


def widths_of(originals):
    """The width of the range of each component of each array, over all steps."""
    widths = {}
    for name in originals[0] or {}:
        if name not in ("types", "sizes", "places"):
            values = numpy.concatenate([original[name] for original in originals]).astype(float)
            widths[name] = numpy.ptp(values, axis=0) if len(values) > 0 else 0.0
    return widths


def write_and_compare(made, path, times, **options):
    bound = options.setdefault("ErrorBound", BOUND)
    absolute = options.setdefault("ErrorBoundMode", "Absolute") == "Absolute"
    simple.SaveData(path, proxy=made, WriteTimeSteps=1, KeyframeInterval=2, **options)
    reader = simple.OpenDataFile(path)
    folder = os.path.dirname(path)
    widths = {} if absolute else widths_of([whole(made, time, folder) for time in times])
    for time in times:
        original, decoded = whole(made, time, folder), whole(reader, time, folder)
        expect_same(original, decoded, lambda name: bound * widths.get(name, 1.0) * 1.000001, f"{path}, time {time}")
        if alone():
            grids = [each.GetClientSideObject().GetOutputDataObject(0) for each in (made, reader)]
            expect_same_numbers(*grids, f"{path}, time {time}")
    return reader


def draw(source, array, path):
    view = session.new_view((200, 200))
    display = simple.Show(source, view)
    simple.ColorBy(display, array)
    display.SetRepresentationType(session.REPRESENTATION)
    bounds = source.GetDataInformation().GetBounds()
    display.ScalarOpacityUnitDistance = 0.3 * (bounds[5] - bounds[4])
    display.SampleDistanceVoxels = 0.5  # not as errors are estimated, which differ
    limits = [-1.0, 1.0]
    for table in (simple.GetColorTransferFunction(array[1]), simple.GetOpacityTransferFunction(array[1])):
        table.RescaleTransferFunction(*limits)
    middle = [(bounds[2 * a] + bounds[2 * a + 1]) / 2 for a in range(3)]
    view.CameraFocalPoint, view.CameraPosition = middle, [m + d for m, d in zip(middle, (16, -12, 9))]
    view.StillRender()
    simple.SaveScreenshot(path, view)
    simple.Hide(source, view)
    simple.Delete(view)
    picture = pictures.load(path)
    session.require(abs(picture - picture[0, 0]).max() > 60, f"{path} is empty")


def check_pictures(out):
    """A series without loss gives the picture of the original; one with a bound differs by little."""
    source = mesh_source()
    for array in (("POINTS", "wave"), ("CELLS", "level")):
        name = os.path.join(out, array[1])
        draw(source, array, name + ".png")
        for bound in (0.0, BOUND):
            path = f"{name}_{bound}.banyan"
            simple.SaveData(path, proxy=source, ErrorBoundMode="Absolute", ErrorBound=bound)
            draw(simple.OpenDataFile(path), array, path + ".png")
            if bound == 0.0:
                pictures.require_near(path + ".png", name + ".png")
            # Colours come in 256 steps: a small error takes some pixels to the next one.
            error = pictures.difference(pictures.load(path + ".png"), pictures.load(name + ".png"))
            print(f"{path}: {error.max()} of 255, {error.mean():.3f} on average", flush=True)
            session.require(error.max() <= 16 and error.mean() <= 0.5, f"{path} is drawn otherwise")


REAL = {
    "reactor": ["disk_out_ref/disk_out_ref.vtu"],
    "can": ["can/can.vtu"],
    "mountain": ["specfem_mount_st_helens/specfem_mount_st_helens.vtu"],
    "mixed": ["malformed_basic/u13_mixed.vtu"],
    "blocks": [f"block_crush/block_crush_{step:03d}.vtu" for step in range(11)],
}


def check_real(out):
    data = os.environ.get("BANYAN_DATA_DIR", "")
    for name, files in REAL.items():
        paths = [os.path.join(data, file) for file in files]
        # (ParaView's scripts replace all() here.)
        if False in [os.path.exists(path) for path in paths]:
            print(f"no {name}", flush=True)
            continue
        source = simple.OpenDataFile(paths if len(paths) > 1 else paths[0])
        source.UpdatePipelineInformation()
        times = list(source.TimestepValues) if len(paths) > 1 else [None]
        path = os.path.join(out, name + ".banyan")
        write_and_compare(source, path, times, ErrorBoundMode="Relative to series range", ErrorBound=1 / 512)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--draw", action="store_true")
    arguments = parser.parse_args()
    session.begin(arguments)
    if arguments.draw:  # one rank runs the script
        session.empty_folder(arguments.out)
        check_pictures(arguments.out)
        return
    controller = vtkMultiProcessController.GetGlobalController()
    if controller.GetLocalProcessId() == 0:
        session.empty_folder(arguments.out)
    controller.Barrier()
    for single, moving in ((True, False), (False, True), (True, True)):
        path = os.path.join(arguments.out, f"mesh_{single}_{moving}.banyan")
        write_and_compare(mesh_source(single, moving), path, TIMES)
    one = os.path.join(arguments.out, "one.banyan")
    write_and_compare(mesh_source(only_first=True), one, TIMES[:1])
    session.expect_refusal(arguments.out, mesh_source(changing=True), ["At step 2", "must not change"])
    check_real(arguments.out)


if __name__ == "__main__":
    main()
