# SPDX-License-Identifier: BSD-3-Clause
"""Curvilinear and rectilinear grids are saved as Banyan series, come back, and are shown.

    test_grid_series.py --plugin Banyan.so --out FOLDER

Each rank compares its own piece: points bit by bit, values with the bound. compare_files.py compares the series of
several runs, which must not depend on the number of ranks.
"""
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import session

BOUND = 1e-3
TIMES = [0.0, 1.0, 2.5, 3.0, 4.0]
SAMPLES = (40, 21, 17)
INFORMATION = session.time_information(TIMES) + f"""
info.Set(executive.WHOLE_EXTENT(), 2, {SAMPLES[0] + 1}, 0, {SAMPLES[1] - 1}, -3, {SAMPLES[2] - 4})
info.Set(self.CAN_PRODUCE_SUB_EXTENT(), 1)
"""
DATA = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkParallelCore import vtkMultiProcessController
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
e = info.Get(executive.UPDATE_EXTENT())
grid = self.GetOutputDataObject(0)
grid.SetExtent(e)
x, y, z = (numpy.arange(e[2 * a], e[2 * a + 1] + 1, dtype=float) for a in range(3))
controller = vtkMultiProcessController.GetGlobalController()
if MIXED and controller.GetLocalProcessId() == 1:
    TYPE = numpy.float64
away = 0.25 * int(time / 2) if MOVING else 0.0
if grid.IsA("vtkRectilinearGrid"):
    for values, take in ((x * x + away, grid.SetXCoordinates), (numpy.exp(0.1 * y), grid.SetYCoordinates),
                         (z.astype(numpy.float32), grid.SetZCoordinates)):
        take(numpy_to_vtk(values.astype(TYPE) if values.dtype == float else values, 1))
z, y, x = (values.ravel() for values in numpy.meshgrid(z, y, x, indexing="ij"))
if grid.IsA("vtkStructuredGrid"):
    angle, radius = 0.05 * x + away, 4.0 + 0.2 * y
    places = numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle), z + 0.1 * numpy.sin(angle)], 1)
    if BAD and time == 2.5 and e[0] == 2:
        places[5] = numpy.nan
    points = vtkPoints()
    points.SetData(numpy_to_vtk(places.astype(TYPE), 1))
    grid.SetPoints(points)
def add(name, values):
    values = numpy_to_vtk(numpy.ascontiguousarray(values), 1)
    values.SetName(name)
    grid.GetPointData().AddArray(values)
add("wave", numpy.sin(0.3 * x + 0.1 * y * time).astype(numpy.float32))
add("vector", numpy.stack([x + time, y * y, z], 1))
if HIDDEN:
    add("vtkGhostType", (2 * ((x + y + z) % 11 == 0)).astype(numpy.uint8))
"""
KINDS = ["vtkStructuredGrid", "vtkRectilinearGrid"]


def grid_source(kind, number="float32", moving=False, hidden=False, bad=False, mixed=False):
    made = simple.ProgrammableSource(OutputDataSetType=kind)
    made.Script = (f"import numpy\nTYPE, MOVING, HIDDEN = numpy.{number}, {moving}, {hidden}\n"
                   f"BAD, MIXED = {bad}, {mixed}\n" + DATA)
    made.ScriptRequestInformation = INFORMATION
    return made


def points_of(grid):
    if grid.IsA("vtkRectilinearGrid"):
        return [vtk_to_numpy(values) for values in (grid.GetXCoordinates(), grid.GetYCoordinates(),
                                                    grid.GetZCoordinates())]
    return [vtk_to_numpy(grid.GetPoints().GetData())]


def mine(proxy, time):
    proxy.UpdatePipeline(time)
    return proxy.GetClientSideObject().GetOutputDataObject(0)


def expect_same(original, decoded, where):
    session.require(decoded.GetClassName() == original.GetClassName(), f"{where}: {decoded.GetClassName()}")
    session.require(decoded.GetExtent() == original.GetExtent(), f"{where}: {decoded.GetExtent()}")
    for a, b in zip(points_of(original), points_of(decoded)):
        session.require(a.dtype == b.dtype and a.tobytes() == b.tobytes(), f"{where}: other points")
    for name in ("wave", "vector"):
        a, b = (vtk_to_numpy(grid.GetPointData().GetArray(name)) for grid in (original, decoded))
        session.require(a.dtype == b.dtype and a.shape == b.shape, f"{where}: {name} is another array")
        session.require(numpy.abs(a - b).max() <= BOUND, f"{where}: {name} is {numpy.abs(a - b).max()} away")
    flags = [grid.GetPointData().GetArray("vtkGhostType") for grid in (original, decoded)]
    session.require((flags[0] is None) == (flags[1] is None), f"{where}: flags")
    if flags[0]:
        a, b = (vtk_to_numpy(each) & 2 for each in flags)
        session.require((a == b).all(), f"{where}: other points are hidden")


def write_and_compare(made, path):
    simple.SaveData(path, proxy=made, ErrorBoundMode="Absolute", ErrorBound=BOUND, WriteTimeSteps=1,
                    KeyframeInterval=2)
    reader = simple.OpenDataFile(path)
    session.require(list(reader.TimestepValues) == TIMES, f"{path}: {list(reader.TimestepValues)}")
    for time in TIMES:
        expect_same(mine(made, time), mine(reader, time), f"{path}, time {time}")
    return reader


def check_block(made, path):
    """The only block of composite data gives the same series."""
    with open(path, "rb") as file:
        before = file.read()
    simple.SaveData(path, proxy=simple.GroupDatasets(Input=[made]), ErrorBoundMode="Absolute", ErrorBound=BOUND,
                    WriteTimeSteps=1, KeyframeInterval=2)
    with open(path, "rb") as file:
        session.require(file.read() == before, f"{path}: another series of a block")


def show(reader):
    """As any other data: a surface, and values along it."""
    view = simple.GetActiveViewOrCreate("RenderView")
    display = simple.Show(reader, view)
    display.SetRepresentationType("Surface")
    simple.ColorBy(display, ("POINTS", "wave"))
    simple.Render(view)
    simple.Hide(reader, view)


def check_level(reader, path):
    """Every second sample, and the last one."""
    whole = reader.GetDataInformation().GetExtent()
    bounds = reader.GetDataInformation().GetBounds()
    reader.Level = 1
    reader.UpdatePipeline(TIMES[0])
    coarse = reader.GetDataInformation()
    wanted = tuple(n for axis in range(3) for n in (0, -(-(whole[2 * axis + 1] - whole[2 * axis]) // 2)))
    session.require(coarse.GetExtent() == wanted, f"{path}: level 1 has {coarse.GetExtent()}")
    if "Rectilinear" in path:
        session.require(coarse.GetBounds() == bounds, f"{path}: {coarse.GetBounds()} is not {bounds}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    controller = vtkMultiProcessController.GetGlobalController()
    if controller.GetLocalProcessId() == 0:
        session.empty_folder(arguments.out)
    controller.Barrier()
    for kind in KINDS:
        for number, moving, hidden in (("float32", False, False), ("float64", True, False), ("float32", True, True)):
            name = f"{kind[3:-4]}_{number}_{moving}_{hidden}.banyan"
            path = os.path.join(arguments.out, name)
            reader = write_and_compare(grid_source(kind, number, moving, hidden), path)
            show(reader)
            if number == "float32":
                check_block(grid_source(kind, number, moving, hidden), path)
            if controller.GetNumberOfProcesses() == 1:
                check_level(reader, path)
    session.expect_refusal(arguments.out, grid_source(KINDS[0], bad=True), ["At step 2", "not finite", "i = 7"])
    for kind in KINDS if controller.GetNumberOfProcesses() > 1 else []:
        session.expect_refusal(arguments.out, grid_source(kind, mixed=True), ["At step 0", "coordinates of different types"])


if __name__ == "__main__":
    main()
