# SPDX-License-Identifier: BSD-3-Clause
"""Compares two VTK data objects value by value."""
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy


def as_numpy(array):
    """A copy that is no view: what it is compared with may share the memory."""
    return numpy.array(vtk_to_numpy(array))


def differing_values(a, b, tolerance):
    """What is different, or None. NaN equals NaN; the tolerance is relative to the largest."""
    if a.shape != b.shape:
        return f"shape {a.shape} instead of {b.shape}"
    if a.dtype != b.dtype:
        return f"type {a.dtype} instead of {b.dtype}"
    if a.size == 0 or numpy.array_equal(a, b, equal_nan=a.dtype.kind == "f"):
        return None
    if not numpy.array_equal(numpy.isnan(a), numpy.isnan(b)):
        return "NaN at other places"
    largest = numpy.nanmax(numpy.abs(b.astype(float)))
    error = numpy.nanmax(numpy.abs(a.astype(float) - b.astype(float)))
    if error <= tolerance * largest:
        return None
    return f"differs by {error:.3g} of {largest:.3g} in {numpy.count_nonzero(a != b)} places"


def compare_attributes(a, b, where, tolerance):
    names_a = [a.GetAbstractArray(i).GetName() for i in range(a.GetNumberOfArrays())]
    names_b = [b.GetAbstractArray(i).GetName() for i in range(b.GetNumberOfArrays())]
    if sorted(map(str, names_a)) != sorted(map(str, names_b)):
        yield f"{where}: arrays {names_a} instead of {names_b}"
        return
    for name in names_b:
        x, y = a.GetArray(name), b.GetArray(name)
        if x is None or y is None:
            continue  # strings
        wrong = differing_values(as_numpy(x), as_numpy(y), tolerance)
        if wrong:
            yield f"{where} array {name}: {wrong}"
    if hasattr(b, "GetScalars") and b.GetScalars() is not None:
        if a.GetScalars() is None or a.GetScalars().GetName() != b.GetScalars().GetName():
            yield f"{where}: other active scalars"


def compare_points(a, b, tolerance):
    if a.GetNumberOfPoints() != b.GetNumberOfPoints():
        yield f"{a.GetNumberOfPoints()} points instead of {b.GetNumberOfPoints()}"
    elif a.GetNumberOfCells() != b.GetNumberOfCells():
        yield f"{a.GetNumberOfCells()} cells instead of {b.GetNumberOfCells()}"
    elif a.IsA("vtkImageData"):
        for question in ("GetExtent", "GetOrigin", "GetSpacing"):
            if getattr(a, question)() != getattr(b, question)():
                yield f"{question} gives something else"
    elif a.IsA("vtkPointSet") and b.GetPoints() is not None:
        wrong = differing_values(as_numpy(a.GetPoints().GetData()),
                                 as_numpy(b.GetPoints().GetData()), tolerance)
        if wrong:
            yield f"points: {wrong}"
    if hasattr(b, "GetCells") and hasattr(b.GetCells(), "GetConnectivityArray"):
        wrong = differing_values(as_numpy(a.GetCells().GetConnectivityArray()),
                                 as_numpy(b.GetCells().GetConnectivityArray()), 0)
        if wrong:
            yield f"connectivity: {wrong}"


def leaves(data):
    """The data sets and tables within a data object."""
    if data.IsA("vtkCompositeDataSet"):
        iterator = data.NewIterator()
        iterator.SkipEmptyNodesOff()
        result = []
        while not iterator.IsDoneWithTraversal():
            result.append(iterator.GetCurrentDataObject())
            iterator.GoToNextItem()
        return result
    return [data]


def rows(data):
    """One row per point: its position and all numbers that belong to it; sorted."""
    if data.GetNumberOfPoints() == 0:
        return numpy.zeros((0, 0))
    columns = [as_numpy(data.GetPoints().GetData())]
    attributes = data.GetPointData()
    for i in sorted(range(attributes.GetNumberOfArrays()), key=attributes.GetArrayName):
        columns.append(as_numpy(attributes.GetArray(i)))
    table = numpy.column_stack([column.astype("f8") for column in columns])
    return table[numpy.lexsort(table.T)]


def compare_unordered(a, b, tolerance=0.0):
    """As compare, for points that come in no particular order."""
    wrong = differing_values(rows(a), rows(b), tolerance)
    return [f"rows of points: {wrong}"] if wrong else []


def compare(a, b, tolerance=0.0):
    """All that is different between a and b, as sentences."""
    if a.GetClassName() != b.GetClassName():
        return [f"a {a.GetClassName()} instead of a {b.GetClassName()}"]
    parts_a, parts_b = leaves(a), leaves(b)
    if len(parts_a) != len(parts_b):
        return [f"{len(parts_a)} blocks instead of {len(parts_b)}"]
    wrong = []
    for x, y in zip(parts_a, parts_b):
        if (x is None) != (y is None):
            wrong.append("another block is empty")
        elif x is not None and y.IsA("vtkDataSet"):
            wrong += compare_points(x, y, tolerance)
            wrong += compare_attributes(x.GetPointData(), y.GetPointData(), "point", tolerance)
            wrong += compare_attributes(x.GetCellData(), y.GetCellData(), "cell", tolerance)
        elif x is not None and y.IsA("vtkTable"):
            wrong += compare_attributes(x.GetRowData(), y.GetRowData(), "row", tolerance)
    return wrong


def size(data):
    """Number of points or rows, to see that there was something to compare."""
    return sum(part.GetNumberOfRows() if part.IsA("vtkTable") else part.GetNumberOfPoints()
               for part in leaves(data) if part is not None and
               (part.IsA("vtkDataSet") or part.IsA("vtkTable")))
