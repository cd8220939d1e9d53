# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that is another one from some steps on, while it is played: N ranks draw the pictures of one, no step
leaves memory behind.

    test_changing_meshes.py --plugin Banyan.so --out FOLDER [--reference FOLDER] [--ranks N] [--report FILE]

With --ranks N it runs on N ranks of one machine (pvbatch), and looks at what the first one holds. With --report it
samples a mesh for long, and writes there when it has begun to: see test_mesh_interruption.py.
"""
import os
import re

from paraview import simple

import pictures
import session

INFORMATION = """
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
information.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
steps = [0.0, 1.0, 2.0, 3.0, 4.0]
information.Set(executive.TIME_STEPS(), steps, len(steps))
information.Set(executive.TIME_RANGE(), [steps[0], steps[-1]], 2)
"""
# Steps 0, 1 and 4 have one mesh, step 2 has more cells, and step 3 a curved one.
SCRIPT = """
import math
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
piece = information.Get(executive.UPDATE_PIECE_NUMBER())
pieces = information.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
time = information.Get(executive.UPDATE_TIME_STEP()) if information.Has(executive.UPDATE_TIME_STEP()) else 0.0
fine = 8 if time == 2 else 4
cubes = [(x, y, z, 2) for x in (0, 2) for y in (0, 2) for z in (0, 2)]
cubes += [(4 + x * 4 / fine, y * 4 / fine, z * 4 / fine, 4 / fine)
          for x in range(fine) for y in range(fine) for z in range(fine)]
if time == 3:  # curved cells of different sizes would overlap, and the first one counts then
    cubes = [(x * 4 / fine, y * 4 / fine, z * 4 / fine, 4 / fine)
             for x in range(2 * fine) for y in range(fine) for z in range(fine)]
grid = self.GetUnstructuredGridOutput()
points, values = vtkPoints(), []
points.SetDataTypeToDouble()
grid.Allocate(len(cubes))
for number, (x, y, z, edge) in enumerate(cubes):
    if number % pieces != piece:
        continue
    ids = []
    for i in range(8):
        p = [x + edge * (i & 1), y + edge * (i >> 1 & 1), z + edge * (i >> 2)]
        values.append(math.sin(p[0] + 0.7 * time) * math.cos(p[1]) + 0.3 * p[2])
        p[2] += 0.4 * math.sin(p[0]) if time == 3 else 0.0
        ids.append(points.InsertNextPoint(p))
    grid.InsertNextCell(12, 8, [ids[i] for i in (0, 1, 3, 2, 4, 5, 7, 6)])
grid.SetPoints(points)
array = numpy_to_vtk(numpy.array(values, float), 1)
array.SetName("value")
grid.GetPointData().SetScalars(array)
grid.GetInformation().Set(grid.DATA_TIME_STEP(), time)
"""
PLAYED = (0, 1, 2, 3, 4, 2, 0)
# Cells, the octree, five coarser ones, values and what bricks have of them. A curved mesh is no octree.
FILES = 9


def shared_files():
    """The files in memory that this process has mapped, and has open."""
    with open("/proc/self/maps", encoding="ascii") as maps:
        mapped = set(re.findall(r"(?m)^\S+ \S+ \S+ \S+ (\d+)\s+/memfd:banyan", maps.read()))
    links = []
    for number in os.listdir("/proc/self/fd"):
        try:
            links.append(os.readlink(f"/proc/self/fd/{number}"))
        except OSError:
            pass  # that of the folder itself
    # (Scripts of sources leave a `sum` of their own in this module.)
    return len(mapped), len([link for link in links if "/memfd:banyan" in link])


def show(script=SCRIPT):
    source = simple.ProgrammableSource(Script=script, ScriptRequestInformation=INFORMATION,
                                       OutputDataSetType="vtkUnstructuredGrid")
    source.UpdatePipelineInformation()
    view = session.new_view((160, 160))
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", "value"))
    display.SetRepresentationType(session.REPRESENTATION)
    for table in (simple.GetColorTransferFunction("value"), simple.GetOpacityTransferFunction("value")):
        table.RescaleTransferFunction(-1.0, 2.5)
    display.ScalarOpacityUnitDistance = 1.0
    view.CameraPosition = [14.0, -9.0, 9.0]
    view.CameraFocalPoint = [4.0, 2.0, 2.0]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelScale = 5.0
    return view, display


def play(out, reference, ranks, reuse):
    """A picture that is kept asks for no coarser meshes: without any, a step takes what it took before."""
    view, display = show()
    display.ReuseFrames = reuse
    held = []
    for number, step in enumerate(PLAYED):
        view.ViewTime = float(step)
        path = os.path.join(out, f"step{step}.png")
        simple.Render(view)
        simple.SaveScreenshot(path, view)
        picture = pictures.load(path)
        if picture is not None:
            session.require(int(abs(picture.astype(int) - picture[0, 0]).max()) > 60, f"{path} is empty")
            if reference:
                pictures.require_near(path, os.path.join(reference, f"step{step}.png"))
        display.UpdatePropertyInformation()
        size, shared = [display.GetProperty(name).GetElement(0) for name in ("MeshBytes", "MeshBytesShared")]
        print(f"step {step}: {size} bytes, {shared} of them shared; {shared_files()}", flush=True)
        session.require(size > 1000, "a mesh takes memory")
        session.require((ranks > 1 and step != 3) == (shared > 0), "ranks of a machine share an octree")
        session.require(size - shared < shared or ranks == 1 or step == 3, "most of it is shared")
        if ranks > 1:
            files, still_open = shared_files()
            kept = reuse and step in PLAYED[:number]
            session.require(files == (0 if step == 3 else FILES) or (kept and files < FILES),
                            f"step {step}: {files} files in memory")
            session.require(still_open == 0, f"step {step}: {still_open} open files")
        held.append((step, size, shared))
    for first, again in ((2, 5), (0, 6)):
        session.require(held[again][1:] == held[first][1:] or (reuse and held[again][1] < held[first][1]),
                        f"what a step takes depends on those before it: {held}")
    session.clear()


def sample_for_long(report):
    source = simple.ProgrammableSource(Script=SCRIPT.replace("else 4", "else 24"), ScriptRequestInformation=INFORMATION,
                                       OutputDataSetType="vtkUnstructuredGrid")
    boxes = simple.BanyanHexOctree(Input=source, SampleGeneralMeshes=1, MeshSamplingBoxes=3000000,
                                   MeshSamplingTolerance=1e-6)

    def write(_shown, _event):
        with open(report, "w", encoding="ascii") as file:
            file.write(str(os.getpid()))

    boxes.GetClientSideObject().AddObserver("ProgressEvent", write)
    boxes.UpdatePipeline(3.0)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out")
    parser.add_argument("--reference")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--report")
    arguments = parser.parse_args()
    session.begin(arguments)
    if arguments.report:
        sample_for_long(arguments.report)
        return
    for reuse, name in enumerate(("drawn", "kept")):
        folder = os.path.join(arguments.out, name)
        os.makedirs(folder, exist_ok=True)
        play(folder, arguments.reference and os.path.join(arguments.reference, name), arguments.ranks, reuse)


main()
