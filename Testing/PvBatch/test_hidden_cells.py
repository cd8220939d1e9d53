# SPDX-License-Identifier: BSD-3-Clause
"""Hidden (blanked) cells of images are not drawn: beside ParaView's own Volume, on one rank and on several, whose pieces
have ghost cells, with hidden points as well, with flags that change from step to step, and of an encoded series.

    test_hidden_cells.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With --reference, the pictures of another run, it runs on several ranks and must draw the same.
"""
import os

from paraview import simple

import pictures
import session

CAMERA = dict(CameraPosition=[45, 40, 100], CameraFocalPoint=[0, 0, 0], CameraViewUp=[0, 1, 0], CameraViewAngle=30)
SIZE = (300, 300)
INFORMATION = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Set(executive.WHOLE_EXTENT(), 0, 40, 0, 40, 0, 40)
info.Set(vtk.vtkDataObject.ORIGIN(), -20.0, -20.0, -20.0)
info.Remove(executive.TIME_STEPS())
for time in (0.0, 1.0):
    info.Append(executive.TIME_STEPS(), time)
info.Remove(executive.TIME_RANGE())
info.Append(executive.TIME_RANGE(), 0.0)
info.Append(executive.TIME_RANGE(), 1.0)
"""
# A blob in a box of 41^3 points; each rank has a slab of it, and a layer of ghost cells on each side.
BLOB = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = (controller.GetLocalProcessId(), controller.GetNumberOfProcesses()) if controller else (0, 1)
info = self.GetExecutive().GetOutputInformation(0)
key = self.GetExecutive().UPDATE_TIME_STEP()
time = info.Get(key) if info.Has(key) else 0.0
own = (40 * rank // ranks, 40 * (rank + 1) // ranks)
low, high = own[0] - (own[0] > 0), own[1] + (own[1] < 40)
image = self.GetOutputDataObject(0)
image.SetExtent(0, 40, 0, 40, low, high)
image.SetOrigin(-20, -20, -20)
axis = numpy.linspace(-1, 1, 41)
z, y, x = numpy.meshgrid(axis[low:high + 1], axis, axis, indexing="ij")
blob = 1 - numpy.sqrt((x - 0.2) ** 2 + 1.4 * (y + 0.1) ** 2 + 0.8 * z**2) + 0.15 * numpy.sin(7 * x + 3 * y)

def add(data, name, values):
    array = numpy_to_vtk(numpy.ascontiguousarray(values.ravel()), deep=1)
    array.SetName(name)
    data.AddArray(array)

if {flat}:
    blob[:] = 0.7
add(image.GetPointData(), "{name}", blob.astype("f4"))
image.GetPointData().SetActiveScalars("{name}")
flags = numpy.zeros((40, 40, 40), "u1")
if {cells}:
    flags[10:30, 5:25, 20:] = 32 if time == 0 else 0  # HIDDENCELL
    flags[12:26, 15:30, 5:25] |= 8 if time == 1 else 0  # REFINEDCELL
flags[:own[0]] |= 1  # DUPLICATECELL
flags[own[1]:] |= 1
add(image.GetCellData(), "vtkGhostType", flags[low:high])
if {points}:
    hidden = numpy.zeros((41, 41, 41), "u1")
    hidden[15:25, 22:, 18:24] = 2
    add(image.GetPointData(), "vtkGhostType", hidden[low:high + 1])
"""
# The same flags on what a reader gives: whole steps on one rank, pieces of its own on several.
FLAGS = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
image = self.GetOutputDataObject(0)
image.ShallowCopy(self.GetInputDataObject(0, 0))
x0, x1, y0, y1, z0, z1 = image.GetExtent()

def add(data, flags):
    array = numpy_to_vtk(numpy.ascontiguousarray(flags.ravel()), deep=1)
    array.SetName("vtkGhostType")
    data.AddArray(array)

cells = numpy.zeros((40, 40, 40), "u1")
cells[10:30, 5:25, 20:] = 32
add(image.GetCellData(), cells[z0:z1, y0:y1, x0:x1])
if {points}:
    points = numpy.zeros((41, 41, 41), "u1")
    points[15:25, 22:, 18:24] = 2
    add(image.GetPointData(), points[z0:z1 + 1, y0:y1 + 1, x0:x1 + 1])
"""


def blob(name, cells=True, points=False, flat=False):
    script = BLOB.replace("{name}", name).replace("{cells}", str(cells))
    script = script.replace("{points}", str(points)).replace("{flat}", str(flat))
    return simple.ProgrammableSource(
        OutputDataSetType="vtkImageData", Script=script, ScriptRequestInformation=INFORMATION)


def show(source, view, name, representation=session.REPRESENTATION, **properties):
    display = simple.Show(source, view)
    display.SetRepresentationType(representation)
    simple.ColorBy(display, ("POINTS", name))
    lookup = simple.GetColorTransferFunction(name)
    lookup.ColorSpace = "RGB"
    lookup.RGBPoints = [0, 0, 0, 1, 0.5, 0, 1, 0, 1.1, 1, 0, 0]
    lookup.AutomaticRescaleRangeMode = "Never"
    opacity = simple.GetOpacityTransferFunction(name)
    opacity.Points = [0, 0, 0.5, 0, 0.3, 0, 0.5, 0, 1.1, 0.3, 0.5, 0]
    display.LookupTable = lookup
    display.ScalarOpacityFunction = opacity
    display.ScalarOpacityUnitDistance = 1.0
    display.SetScalarBarVisibility(view, False)
    for key, value in properties.items():
        setattr(display, key, value)
    return display


class Drawing:
    def __init__(self, arguments):
        self.arguments = arguments
        self.pictures = {}
        self.view = session.new_view(SIZE, **CAMERA)

    def draw(self, name, source, array, **options):
        simple.HideAll(self.view)
        display = show(source, self.view, array, **options)
        self.keep(name)
        return display

    def keep(self, name, time=0.0):
        self.view.ViewTime = time
        path = os.path.join(self.arguments.out, name + ".png")
        simple.SaveScreenshot(path, self.view, ImageResolution=list(SIZE))
        self.pictures[name] = pictures.load(path)
        if self.arguments.reference:
            pictures.require_near(path, os.path.join(self.arguments.reference, name + ".png"))

    def decibel(self, one, other):
        error = float(((self.pictures[one] - self.pictures[other]) ** 2).mean())
        return 99.0 if error == 0 else 10 * float(pictures.numpy.log10(255**2 / error))

    def require_alike(self, one, other, least):
        found = self.decibel(one, other)
        print(f"{one} and {other}: {found:.1f} dB", flush=True)
        session.require(found > least, f"{one} and {other} differ: {found:.1f} dB")

    def require_unlike(self, one, other, most=36.0):
        found = self.decibel(one, other)
        session.require(found < most, f"{one} and {other} are too much alike: {found:.1f} dB")


def draw_plain(drawing):
    """Each with an array of its own: ParaView shares colour maps by name."""
    everything = blob("all", cells=False)
    drawing.draw("all", everything, "all")
    cells = blob("cells")
    drawing.draw("cells", cells, "cells")
    drawing.require_unlike("cells", "all")
    drawing.keep("later", 1.0)
    drawing.require_unlike("later", "all")
    drawing.require_unlike("later", "cells")
    drawing.keep("again")
    drawing.require_alike("again", "cells", 60)
    drawing.draw("both", blob("both", points=True), "both")
    drawing.require_unlike("both", "cells", 40)
    drawing.draw("shaded", cells, "cells", Shade=1)
    drawing.require_unlike("shaded", "all")


def draw_beside_volume(drawing):
    """Pieces that overlap ParaView's own Volume draws twice: on one rank."""
    drawing.draw("their both", blob("their both", points=True), "their both", representation="Volume")
    drawing.require_alike("both", "their both", 33)
    drawing.draw("their cells", blob("their cells"), "their cells", representation="Volume")
    drawing.require_alike("cells", "their cells", 33)
    drawing.keep("their later", 1.0)
    drawing.require_alike("later", "their later", 33)


def draw_series(drawing):
    path = os.path.join(drawing.arguments.reference or drawing.arguments.out, "series.banyan")
    if not drawing.arguments.reference:
        simple.SaveData(path, proxy=blob("cells", cells=False), ErrorBound=0)
    reader = simple.OpenDataFile(path)
    for name, points in (("cells", False), ("both", True)):
        flagged = simple.ProgrammableFilter(
            Input=reader, Script=FLAGS.replace("{points}", str(points)))
        drawing.draw("series " + name, flagged, "cells")
        drawing.require_alike("series " + name, name, 60)
    # One value everywhere, and what is hidden in the file: its bricks are drawn without being loaded, but for these.
    flat = blob("cells", points=True, flat=True)
    drawing.draw("flat", flat, "cells")
    path = path.replace("series.banyan", "flat.banyan")
    if not drawing.arguments.reference:
        simple.SaveData(path, proxy=flat, ErrorBound=0)
    drawing.draw("series flat", simple.OpenDataFile(path), "cells")
    drawing.require_alike("series flat", "flat", 60)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    drawing = Drawing(arguments)
    draw_plain(drawing)
    draw_series(drawing)
    if not arguments.reference:
        draw_beside_volume(drawing)


if __name__ == "__main__":
    main()
