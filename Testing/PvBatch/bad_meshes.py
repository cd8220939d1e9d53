# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of hexahedra that are broken, one for each way.
"""
from paraview import simple

INFORMATION = """
self.GetExecutive().GetOutputInformation(0).Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
"""
# 4 x 3 x 3 cells, which are bent where BENT says so, and broken by the lines that follow. Every rank has each second
# cell, or third one, and so on.
MESH = """
import math
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
piece = information.Get(executive.UPDATE_PIECE_NUMBER())
pieces = information.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
places = [[x, y, z + BENT * 0.3 * math.sin(x + y)] for z in range(4) for y in range(4) for x in range(5)]
values = [p[0] + p[1] * p[2] for p in places]
cells = []
for z in range(3):
    for y in range(3):
        for x in range(4):
            first = x + 5 * (y + 4 * z)
            cells.append((12, [first, first + 1, first + 6, first + 5,
                               first + 20, first + 21, first + 26, first + 25]))
BROKEN
grid = self.GetUnstructuredGridOutput()
grid.Allocate(len(cells))
for number, (kind, ids) in enumerate(cells):
    if number % pieces == piece:
        grid.InsertNextCell(kind, len(ids), ids)
points, array = vtkPoints(), vtkDoubleArray()
points.SetDataTypeToDouble()
for place, value in zip(places, values):
    points.InsertNextPoint(place)
    array.InsertNextValue(value)
array.SetName("value")
grid.SetPoints(points)
grid.GetPointData().SetScalars(array)
"""
NAN, FAR = "places[26][1] = float('nan')", "places[26][1] = float('inf')"
OUT, NEGATIVE = "cells[7][1][3] = 4000", "cells[7][1][3] = -2"
FLAT = "cells[7] = (12, cells[7][1][:4] * 2)"
ALONE = "places.append([2, 1, 1]); values.append(9.0)"
INVERTED = "ids = cells[7][1]; cells[7] = (12, ids[4:] + ids[:4])"
TANGLED = "ids = cells[7][1]; ids[0], ids[1] = ids[1], ids[0]"
DUPLICATE = """
for number, (kind, ids) in enumerate(cells):
    places += [places[i] for i in ids]; values += [values[i] for i in ids]
    cells[number] = (kind, list(range(len(places) - 8, len(places))))
"""
GAP = "del cells[17]; del cells[3]"
TWICE = "cells.append(cells[5])"
OTHER_TWICE = "cells.append(cells[30])"
MIXED = "cells[7] = (10, cells[7][1][:4]); cells[9] = (13, cells[9][1][:6]); cells.append((1, [0]))"
NO_VALUES = "values = [float('nan')] * len(values)"
HOLE = "values[26] = float('nan')"

# What is broken, whether cells are bent, and what the filter that samples boxes must say: None where nothing is. A
# sentence in brackets is said beside a result.
CASES = {
    "good": ("", 0, None),
    "good_bent": ("", 1, None),
    "nan": (NAN, 0, "not finite"),
    "nan_bent": (NAN, 1, "not finite"),
    "infinite": (FAR, 1, "not finite"),
    "out": (OUT, 0, "refers to point 4000"),
    "out_bent": (OUT, 1, "refers to point 4000"),
    "negative": (NEGATIVE, 1, "refers to point -2"),
    "flat": (FLAT, 0, "is flat"),
    "flat_bent": (FLAT, 1, "has no volume"),
    "inverted": (INVERTED, 0, None),
    "inverted_bent": (INVERTED, 1, None),
    "tangled": (TANGLED, 0, None),
    "tangled_bent": (TANGLED, 1, ["turned inside out at a corner"]),
    "duplicate": (DUPLICATE, 0, None),
    "duplicate_bent": (DUPLICATE, 1, None),
    "unused": (ALONE, 1, None),
    "gap": (GAP, 0, None),
    "gap_bent": (GAP, 1, None),
    "twice": (TWICE, 0, None),
    "other_twice": (OTHER_TWICE, 0, None),
    "twice_bent": (TWICE, 1, None),
    "mixed": (MIXED, 0, ["hexahedra and voxels are sampled, without"]),
    "mixed_bent": (MIXED, 1, ["hexahedra and voxels are sampled, without"]),
    "hole": (HOLE, 1, None),
    "no_values": (NO_VALUES, 1, None),
}


def source(broken, bent):
    """A source of the mesh, with the point array `value`."""
    script = MESH.replace("BENT", str(bent)).replace("BROKEN", broken)
    return simple.ProgrammableSource(Script=script, ScriptRequestInformation=INFORMATION,
                                     OutputDataSetType="vtkUnstructuredGrid")
