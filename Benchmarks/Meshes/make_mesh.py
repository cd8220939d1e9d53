# SPDX-License-Identifier: BSD-3-Clause
"""Makes a mesh for meshes.sh, or reads a real one.

    make_mesh.py NAME OUTPUT.npz [--data DIR]

NAME is KIND-N, a cube of N cubes per axis (of `mixed` a multiple of five), or one of the real meshes below, of which DIR
has a folder each. Kinds:

    hexahedra     the cubes
    tetrahedra    six of each cube, all around its diagonal
    mixed         layers of hexahedra, pyramids, wedges, tetrahedra, and pyramids again; faces of neighbours are the same
    curvilinear   the cubes as a structured grid: points without ids

The cube is bent smoothly by 3 % of its edge, and then each point is moved by up to 5 % of an edge of a cell along each
axis. The values are those of StandardField where the points are then. OUTPUT.npz has `points` (float32), `values`
(float32, one per point), `bounds`, `range` (that of the functions), `unit` (length over which opacities apply) and either
`dimensions` (points per axis) or `ids`, `offsets` and `types`, as vtkUnstructuredGrid has them. Real meshes are without
cells that have no volume. The file is made unless it is there. Prints the number of cells.
"""
import argparse
import glob
import os

import numpy

BEND = 0.03
SHAKE = 0.05
TETRAHEDRON, HEXAHEDRON, WEDGE, PYRAMID = 10, 12, 13, 14
UNITS = 255  # of opacities, along the longest edge of a mesh
# File, the last one by name where there are several; the array, of vectors its magnitude; and UNITS are how many times
# more, so that thin walls are seen.
REAL = {
    "specfem_mount_st_helens": ("specfem_mount_st_helens.vtu", "elevation", 1),
    "can": ("can.vtu", "DISPL", 16),
    "disk_out_ref": ("disk_out_ref.vtu", "Temp", 1),
    "block_crush": ("block_crush_*.vtu", "displ_", 1),
    "hexa": ("hexa.vtu", "scalars", 1),
}
# Data/StandardField.cxx
BLOBS = ((.35, .40, .45, .10, 1.0), (.65, .55, .40, .08, .9), (.50, .70, .65, .07, .8), (.25, .25, .70, .06, .9),
         (.75, .30, .70, .09, .7), (.60, .20, .25, .05, 1.0), (.30, .75, .25, .06, .8), (.80, .80, .30, .05, .9))
LOWEST, HIGHEST = -0.0597561449, 1.18257499
CHUNK = 1 << 20  # points whose values are found at once
# Corners of a cube: bits 0, 1 and 2 of a number are x, y and z. Faces turn so that their normals point inwards.
FACES = ((0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6), (0, 1, 3, 2), (4, 6, 7, 5))
LOWER_FACE, UPPER_FACE = 4, 5
CENTRE = 8
CUBE = [(HEXAHEDRON, (0, 1, 3, 2, 4, 5, 7, 6))]
WEDGES = [(WEDGE, (0, 3, 1, 4, 7, 5)), (WEDGE, (0, 2, 3, 4, 6, 7))]  # the first three seen from outside, as VTK says
TETRAHEDRA = [(TETRAHEDRON, corners) for corners in ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7),
                                                     (0, 5, 1, 7))]


def around_centre(split):
    """The cells between the middle of a cube and its faces. The face `split` has the diagonal that wedges and
    tetrahedra have."""
    cells = []
    for number, face in enumerate(FACES):
        if number == split:  # its first and third corner are on the diagonal
            cells += [(TETRAHEDRON, (*face[:3], CENTRE)), (TETRAHEDRON, (face[0], *face[2:], CENTRE))]
        else:
            cells.append((PYRAMID, (*face, CENTRE)))
    return cells


# What the cubes of each layer are cut into, from below.
LAYERS = {
    "hexahedra": [CUBE],
    "tetrahedra": [TETRAHEDRA],
    "mixed": [CUBE, around_centre(UPPER_FACE), WEDGES, TETRAHEDRA, around_centre(LOWER_FACE)],
}


def standard_field(points):
    """StandardField at points [n][3]."""
    turn = 2.0 * numpy.pi
    values = numpy.empty(len(points), numpy.float32)
    for begin in range(0, len(points), CHUNK):
        x, y, z = points[begin:begin + CHUNK].astype(float).T
        total = 0.1 + 0.10 * numpy.sin(4 * turn * x) * numpy.sin(4 * turn * y) * numpy.sin(4 * turn * z)
        total += 0.06 * numpy.sin(turn * (9 * x + 5 * y)) * numpy.sin(turn * (7 * z - 3 * x))
        for *centre, width, amplitude in BLOBS:
            square = sum((p - c) ** 2 for p, c in zip((x, y, z), centre))
            total += amplitude * numpy.exp(-square / (2.0 * width * width))
        values[begin:begin + CHUNK] = numpy.clip((total - LOWEST) / (HIGHEST - LOWEST), 0.0, 1.0)
    return values


def random_numbers(count, seed):
    """In [-1, 1), of the numbers 0 to count - 1: the same everywhere (SplitMix64)."""
    with numpy.errstate(over="ignore"):
        z = (numpy.arange(count, dtype=numpy.uint64) + numpy.uint64(seed << 32)) * numpy.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> numpy.uint64(30))) * numpy.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> numpy.uint64(27))) * numpy.uint64(0x94D049BB133111EB)
    return (z >> numpy.uint64(11)).astype(float) * 2.0 ** -52 - 1.0


def lattice(n):
    """(n + 1)^3 points in the unit cube, x fastest."""
    at = numpy.arange(n + 1) / n
    z, y, x = numpy.meshgrid(at, at, at, indexing="ij")
    return numpy.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)


def warped(points, n):
    """Points of the lattice, bent and shaken."""
    moved = points.copy()
    for axis in range(3):
        a, b = points[:, (axis + 1) % 3], points[:, (axis + 2) % 3]
        moved[:, axis] += BEND * numpy.sin(2 * numpy.pi * (a + 0.3 * b))
        moved[:, axis] += SHAKE / n * random_numbers(len(points), axis)
    return moved


def corners_of(n, layer):
    """Ids of the corners [cubes][8] of a layer of cubes."""
    side = n + 1
    y, x = numpy.meshgrid(numpy.arange(n), numpy.arange(n), indexing="ij")
    first = (x + side * (y + side * layer)).ravel()
    steps = numpy.array([(c & 1) + side * ((c >> 1 & 1) + side * (c >> 2)) for c in range(8)])
    return first[:, None] + steps


def cut(kind, n, points):
    """Cells of a kind, all of a cube one after the other. Returns points, with the middles of cubes, and the cells."""
    layers = LAYERS[kind]
    if n % len(layers) != 0:
        raise SystemExit(f"make_mesh.py: '{kind}' needs a multiple of {len(layers)} cubes per axis.")
    ids, types, added, count = [], [], [], len(points)
    for layer in range(n):
        cells = layers[layer % len(layers)]
        corners = corners_of(n, layer)
        wanted = [corner for _, cell in cells for corner in cell]
        if CENTRE in wanted:
            added.append(points[corners].mean(axis=1))
            corners = numpy.column_stack([corners, count + numpy.arange(len(corners))])
            count += len(corners)
        ids.append(corners[:, wanted].ravel())
        types.append(numpy.tile(numpy.array([kind_of for kind_of, _ in cells], numpy.uint8), len(corners)))
    types = numpy.concatenate(types)
    sizes = numpy.zeros(256, numpy.int64)
    for size, number in ((4, TETRAHEDRON), (8, HEXAHEDRON), (6, WEDGE), (5, PYRAMID)):
        sizes[number] = size
    offsets = numpy.concatenate([[0], numpy.cumsum(sizes[types])])
    return numpy.concatenate([points, *added]), {"ids": numpy.concatenate(ids), "offsets": offsets, "types": types}


def made(kind, n):
    points = warped(lattice(n), n)
    if kind == "curvilinear":
        cells = {"dimensions": numpy.full(3, n + 1)}
    else:
        points, cells = cut(kind, n, points)
    points = points.astype(numpy.float32)
    return {"points": points, "values": standard_field(points), "range": numpy.array([0.0, 1.0]), "unit": 1.0 / UNITS, **cells}


def real(name, data):
    """A real mesh with the values of one array."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    pattern, array, strength = REAL[name]
    files = sorted(glob.glob(os.path.join(data, name, pattern)))
    if not files:
        raise SystemExit(f"make_mesh.py: there is no {pattern} in {os.path.join(data, name)}.")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(files[-1])
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfCells() == 0:
        raise SystemExit(f"make_mesh.py: {files[-1]} has no cells, or cannot be read.")
    values = vtk_to_numpy(grid.GetPointData().GetArray(array)).astype(float)
    values = values if values.ndim == 1 else numpy.linalg.norm(values, axis=1)
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray()).astype(numpy.int64)
    ids = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).astype(numpy.int64)
    types, sizes = vtk_to_numpy(grid.GetCellTypesArray()), numpy.diff(offsets)
    solid = numpy.zeros(len(types), bool)
    for number, first in zip(*numpy.unique(types, return_index=True)):
        solid |= (types == number) & (grid.GetCell(int(first)).GetCellDimension() == 3)
    bounds = grid.GetBounds()
    longest = max(high - low for low, high in zip(bounds[0::2], bounds[1::2]))
    return {"points": vtk_to_numpy(grid.GetPoints().GetData()).astype(numpy.float32), "values": values.astype(numpy.float32),
            "range": numpy.array([values.min(), values.max()]), "unit": longest / UNITS / strength,
            "ids": ids[numpy.repeat(solid, sizes)], "types": types[solid],
            "offsets": numpy.concatenate([[0], numpy.cumsum(sizes[solid])])}


def make(name, data):
    if name in REAL:
        mesh = real(name, data)
    else:
        kind, _, n = name.partition("-")
        if kind not in [*LAYERS, "curvilinear"] or not n.isdigit() or int(n) == 0:
            raise SystemExit(f"make_mesh.py: there is no mesh '{name}'.")
        mesh = made(kind, int(n))
    mesh["bounds"] = numpy.stack([mesh["points"].min(axis=0), mesh["points"].max(axis=0)], axis=1).ravel()
    return mesh


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("name")
    parser.add_argument("output")
    parser.add_argument("--data", default="")
    arguments = parser.parse_args()
    if not os.path.exists(arguments.output):
        part = arguments.output + ".part.npz"  # nobody takes half a file for a mesh
        numpy.savez(part, **make(arguments.name, arguments.data))
        os.replace(part, arguments.output)
    with numpy.load(arguments.output) as mesh:
        print(len(mesh["types"]) if "types" in mesh else numpy.prod(mesh["dimensions"] - 1))


if __name__ == "__main__":
    main()
