# SPDX-License-Identifier: BSD-3-Clause
"""Coarser levels and hyper tree grids of mesh series, for test_mesh_series.py."""
from time import sleep

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import session

# A cell array with the name of a point array has another one in trees, which have cell data only.
CELLS_IN_TREES = {"u": "u of cells"}


def check_cell_levels(path, names, fill):
    """Of coarser levels: means by volume, found by a search through all cells."""
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline(reader.TimestepValues[-1])
    fine = servermanager.Fetch(reader)
    place = vtk_to_numpy(fine.GetPoints().GetData())
    corners = place[vtk_to_numpy(fine.GetCells().GetConnectivityArray()).reshape(-1, 8)]
    middle, volume = corners.mean(1), numpy.ptp(corners, axis=1).prod(1)
    merged = 0
    for level in (1, 2):
        reader.Level = level
        reader.UpdatePipeline(reader.TimestepValues[-1])
        coarse = servermanager.Fetch(reader)
        place = vtk_to_numpy(coarse.GetPoints().GetData())
        corners = place[vtk_to_numpy(coarse.GetCells().GetConnectivityArray()).reshape(-1, 8)]
        low, high = corners.min(1), corners.max(1)
        for name in names:
            values, found = [vtk_to_numpy(g.GetCellData().GetArray(name)) for g in (fine, coarse)]
            session.require(values.dtype == found.dtype, f"{path}: {name} is {found.dtype}")
            for cell in range(coarse.GetNumberOfCells()):
                inside = ((middle > low[cell]) & (middle < high[cell])).all(1)
                merged += inside.sum() > 1
                part, size = values[inside].astype(float), volume[inside]
                mean = numpy.tensordot(size, part, 1) / size.sum()
                mean = numpy.where((part == fill).any(0), fill, mean)
                near = 0.5 if values.dtype.kind == "i" else 1e-6
                session.require(numpy.allclose(mean, found[cell], rtol=1e-6, atol=near, equal_nan=True),
                                f"{path}, level {level}: {name} of cell {cell}")
    session.require(merged > 20, f"{merged} cells are merged ones")
    simple.Delete(reader)


def check_series(reader, path, array):
    """What does not depend on the source: levels, colours, steps that are decoded ahead."""
    check_levels(reader)
    for trees in (0, 1):
        check_colours(path, array, trees)
    check_read_ahead(path, array)


def check_levels(reader):
    counts = []
    for level in range(4):
        reader.Level = level
        reader.UpdatePipeline()
        counts.append(reader.GetDataInformation().GetNumberOfCells())
    reader.Level = 0
    session.require(counts[0] > counts[1] > counts[2], f"cells of levels: {counts}")


def centres(grid, names):
    """The mean of the eight points of each cell, by the middle of the cell; and the types of arrays."""
    place = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    ids = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8)
    middle = place[ids].mean(1)
    arrays = {name: vtk_to_numpy(grid.GetPointData().GetArray(name)) for name in names}
    return middle, {name: (array[ids].astype(float), array.dtype) for name, array in arrays.items()}


def check_trees(path, names, fill, cell_names=()):
    """The series as hyper tree grid has the values at the centres of the cells, at every level."""
    alone = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses() == 1
    grid, trees = simple.OpenDataFile(path), simple.OpenDataFile(path)
    trees.MeshAsHyperTreeGrid = 1
    leaves = simple.HyperTreeGridToUnstructuredGrid(Input=trees)
    for level in (0, 1, 2):
        grid.Level = trees.Level = level
        for time in (grid.TimestepValues[0], grid.TimestepValues[-1]):
            grid.UpdatePipeline(time)
            leaves.UpdatePipeline(time)
            session.require(trees.GetDataInformation().GetDataClassName() == "vtkHyperTreeGrid",
                            f"{path}: {trees.GetDataInformation().GetDataClassName()}")
            counts = [s.GetDataInformation().GetNumberOfCells() for s in (grid, leaves)]
            session.require(counts[0] == counts[1], f"{path}, level {level}: {counts} cells")
            if not alone:
                continue
            middle, expected = centres(servermanager.Fetch(grid), names)
            one = servermanager.Fetch(leaves)
            found = centres(one, [])[0]
            scale = numpy.abs(middle).max() * 1e-6
            order, other = [numpy.lexsort(numpy.round(m / scale).T) for m in (middle, found)]
            session.require(numpy.allclose(middle[order], found[other], atol=2 * scale),
                            f"{path}: other cells")
            for name, (corners, kind) in expected.items():
                values = vtk_to_numpy(one.GetCellData().GetArray(name))
                small = kind == numpy.float32 or kind.itemsize <= 2
                session.require(values.dtype == (numpy.float32 if small else numpy.float64),
                                f"{path}: {name} is {values.dtype}")
                means = corners.mean(1)
                means[(corners == fill).any(1)] = fill
                close = numpy.isclose(means[order], values[other].astype(float), rtol=1e-6, atol=1e-6,
                                      equal_nan=True)
                session.require(close.all(), f"{path}, level {level}: {name}")
            for name in cell_names:
                grids = (servermanager.Fetch(grid), name), (one, CELLS_IN_TREES.get(name, name))
                a, b = [vtk_to_numpy(g.GetCellData().GetArray(n)).astype(float) for g, n in grids]
                near = 0.5 if name == "u" else 1e-6  # integers are rounded in grids
                session.require(numpy.allclose(a[order], b[other], rtol=1e-6, atol=near, equal_nan=True),
                                f"{path}, level {level}: {name} of cells")
    if alone and numpy.isfinite(fill):
        check_inner_cells(trees, leaves, names, fill)
    simple.Delete(leaves)
    for source in (grid, trees):
        simple.Delete(source)


def check_inner_cells(trees, leaves, names, fill):
    """Cells above others have a fill value, or a mean of values that are none: nothing in between."""
    trees.Level = 0
    trees.UpdatePipeline(trees.TimestepValues[0])
    limited = simple.HyperTreeGridDepthLimiter(Input=trees, SetDepth=0)
    above = simple.HyperTreeGridToUnstructuredGrid(Input=limited)
    above.UpdatePipeline(trees.TimestepValues[0])
    leaves.UpdatePipeline(trees.TimestepValues[0])
    fine, coarse = servermanager.Fetch(leaves), servermanager.Fetch(above)
    session.require(0 < coarse.GetNumberOfCells() < fine.GetNumberOfCells(), "no cells above others")
    filled = 0
    for name in names:
        values, means = [vtk_to_numpy(g.GetCellData().GetArray(name)).astype(float) for g in (fine, coarse)]
        true, mean = values[(values != fill) & (values == values)], means[(means != fill) & (means == means)]
        session.require(mean.min() >= true.min() - 1e-6 and mean.max() <= true.max() + 1e-6,
                        f"{name}: {mean.min()} to {mean.max()} is no mean of {true.min()} to {true.max()}")
        filled += (means == fill).sum()
    session.require(filled > 0, "no fill value above leaves")
    for source in (above, limited):
        simple.Delete(source)


def check_colours(path, array, trees):
    """Colours reach over all steps, whichever is shown first, and do not drift."""
    reader = simple.OpenDataFile(path)
    reader.MeshAsHyperTreeGrid = trees
    place = "CELLS" if trees else "POINTS"
    ranges = []
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        ranges.append((reader.CellData if trees else reader.PointData)[array].GetRange(-1))
    series = min(low for low, _ in ranges), max(high for _, high in ranges)
    session.require(ranges[0][1] < 0.5 * series[1], "the first step has it all: nothing is shown by this")
    view = session.new_view((100, 80))
    view.ViewTime = reader.TimestepValues[0]
    display = simple.Show(reader, view)
    simple.ColorBy(display, (place, array))
    for time in (reader.TimestepValues[0], reader.TimestepValues[-1]):
        view.ViewTime = time
        simple.Render(view)
        points = simple.GetColorTransferFunction(array, display).RGBPoints
        # Means of corners are less far apart than the points' own values.
        wrong = points[-4] < series[1] if trees else abs(points[-4] - series[1]) > 1e-6 * series[1]
        session.require(not wrong, f"colours up to {points[-4]}, the series up to {series[1]}")
    simple.Delete(view)
    simple.Delete(reader)


def check_read_ahead(path, array):
    """A series that plays finds its steps decoded, and they are the same."""
    played = {}
    for ahead in (0, 1):
        reader = simple.OpenDataFile(path)
        reader.ReadAhead = ahead
        reader.CacheBudget = 512  # nothing is there that others have decoded
        for time in reader.TimestepValues:
            reader.UpdatePipeline(time)
            grid = servermanager.Fetch(reader)
            values = grid.GetPointData().GetArray(array) if grid and grid.GetNumberOfPoints() else None
            played.setdefault(time, []).append(None if values is None else vtk_to_numpy(values).copy())
            sleep(0.1)  # a display shows it
        reader.UpdatePropertyInformation()
        hits = reader.GetPropertyValue("BricksReadAhead")
        seconds = reader.GetPropertyValue("LoadSeconds")
        print(f"{hits} bricks of {path} were decoded ahead, the last step took {1e3 * seconds:.1f} ms", flush=True)
        session.require(seconds > 0.0, "no word of what loading took")
        session.require((hits > 0) == (ahead == 1), f"{hits} bricks were decoded ahead with ReadAhead={ahead}")
        simple.Delete(reader)
    for time, (without, with_it) in played.items():
        same = without is None or without.tobytes() == with_it.tobytes()
        session.require(same, f"the step at {time} is another one when it is decoded ahead")
