# SPDX-License-Identifier: BSD-3-Clause
"""Meshes whose points move by displacements that they carry are written as they are at rest.

    test_moving_meshes.py --plugin Banyan.so --generate BANYAN_GENERATE --out FOLDER

One rank compares every value. compare_files.py compares the series of several runs, which must not
depend on the number of ranks.
"""
import glob
import os
import shutil
import subprocess

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import session

BOUND = 1e-3
STEPS = 4
DISPLACEMENT = "ground_displacement"
# So that points move by a part of an element: it has 100 m and more.
TIMES_AS_MUCH = 1e5

MOVED = f"""
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
mesh = inputs[0].VTKObject
if mesh.GetNumberOfPoints() > 0:
    rest = vtk_to_numpy(mesh.GetPoints().GetData())
    moved = {TIMES_AS_MUCH} * vtk_to_numpy(mesh.GetPointData().GetArray("{DISPLACEMENT}"))
    points = vtkPoints()
    points.SetData(numpy_to_vtk((rest + moved).astype(rest.dtype), 1))
    output.VTKObject.SetPoints(points)
    for name, values in (("moved", moved), ("alone", moved[:, 0].copy())):
        array = numpy_to_vtk(values.astype("f4"), 1)
        array.SetName(name)
        output.VTKObject.GetPointData().AddArray(array)
"""


def is_alone():
    return vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses() == 1


def moving(quake):
    merged = simple.MergeBlocks(Input=quake, MergePoints=0)
    filter = simple.ProgrammableFilter(Input=merged, CopyArrays=1, Script=MOVED)
    return merged, filter


def points_of(grid):
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float)


def check_written(quake, folder):
    """The series has the points at rest, and the displacements among its arrays."""
    rest, moved = moving(quake)
    path = os.path.join(folder, "rest.banyan")
    simple.SaveData(path, proxy=moved, ErrorBoundMode="Absolute", ErrorBound=BOUND, WriteTimeSteps=1,
                    KeyframeInterval=2, PointArrays=["velocity", "moved"], DisplacementArray="moved")
    reader = simple.OpenDataFile(path)
    times = list(quake.TimestepValues)
    session.require(list(reader.TimestepValues) == times, f"times {list(reader.TimestepValues)}")
    farthest = 0.0
    for time in times if is_alone() else []:
        for source in (rest, moved, reader):
            source.UpdatePipeline(time)
        at_rest, now, read = [servermanager.Fetch(source) for source in (rest, moved, reader)]
        farthest = numpy.maximum(farthest, numpy.abs(points_of(now) - points_of(at_rest)).max())
        # Coordinates of up to 30 km in float32.
        away = numpy.abs(points_of(read) - points_of(at_rest)).max()
        session.require(away <= 0.01, f"time {time}: points are {away} away from those at rest")
        for name in ("velocity", "moved"):
            a, b = [vtk_to_numpy(grid.GetPointData().GetArray(name)).astype(float) for grid in (now, read)]
            session.require(numpy.abs(a - b).max() <= BOUND * 1.0001, f"time {time}: {name} is away")
    session.require(farthest > 10.0 or not is_alone(), f"points moved by {farthest} only")
    # The array need not be written.
    path = os.path.join(folder, "velocity.banyan")
    simple.SaveData(path, proxy=moved, WriteTimeSteps=1, PointArrays=["velocity"], DisplacementArray="moved")
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline()
    session.require(list(reader.PointData.keys()) == ["velocity"], f"{path}: {list(reader.PointData.keys())}")


def check_refusals(quake, folder):
    def refused(sentences, **options):
        path = os.path.join(folder, "refused.banyan")
        try:
            simple.SaveData(path, proxy=moved, WriteTimeSteps=1, **options)
        except RuntimeError as error:
            for sentence in sentences:
                session.require(sentence in str(error), f"'{error}' and not '{sentence}'")
            session.require(not os.path.exists(path) and not os.path.exists(path + ".d"), "something is left")
            return
        raise AssertionError(f"was written, and not refused with '{sentences}'")

    moved = moving(quake)[1]
    refused(["points have moved, point ", "with DisplacementArray = 'moved'"])
    refused(["apart from what the array velocity says"], DisplacementArray="velocity")
    refused(["There is no point array nonsense, which is to hold"], DisplacementArray="nonsense")
    refused(["holds no displacements: it has 1 comp"], DisplacementArray="alone")
    without = simple.PassArrays(Input=moved, PointDataArrays=["velocity"])
    moved = without
    refused(["name it as 'Displacement Array' (DisplacementArray)"])


def check_real(folder):
    """A column of soil, in files whose points are moved by the array disp_."""
    data = os.environ.get("BANYAN_DATA_DIR")
    files = sorted(glob.glob(os.path.join(data or "", "mastodon_seismic_z", "*.vtu")))
    if not data or not files:
        return
    path = os.path.join(folder, "column.banyan")
    simple.SaveData(path, proxy=simple.OpenDataFile(files), WriteTimeSteps=1, DisplacementArray="disp_")
    reader = simple.OpenDataFile(path)
    session.require(len(reader.TimestepValues) == len(files), f"{len(reader.TimestepValues)} steps")
    for time in (reader.TimestepValues[0], reader.TimestepValues[-1]):
        reader.UpdatePipeline(time)
        bounds = reader.GetDataInformation().GetBounds()
        session.require(numpy.allclose(bounds, (0, 25, 0, 25, 0, 5000), atol=0.01), f"time {time}: {bounds}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--generate", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    session.begin(options)
    if vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0:
        shutil.rmtree(options.out, ignore_errors=True)
        os.makedirs(options.out)
        subprocess.run([options.generate, "--series", "earthquake", "--cells", "3000", "--steps", str(STEPS),
                        "--duration", "12", "--output", os.path.join(options.out, "quake")], check=True)
    quake = simple.OpenDataFile(os.path.join(options.out, "quake", "earthquake.exo"))
    check_written(quake, options.out)
    check_refusals(quake, options.out)
    check_real(options.out)


if __name__ == "__main__":
    main()
