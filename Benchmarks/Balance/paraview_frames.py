# SPDX-License-Identifier: BSD-3-Clause
"""Times still renders of a standard scene inside ParaView, as a user of pvbatch has them.

    mpirun -np N pvbatch paraview_frames.py --plugin Banyan.so --scene S1|S2 [--shaded] [--frames N]

The field, the functions and the camera are those of the standard scenes (Data/StandardField.h,
RayCast/StandardScenes.cxx); each rank makes its piece of the field. One worker thread per rank. A still
render is timed on the first rank, from the call to the picture, ParaView's own work and compositing
included. The first frames load, pack and balance; the medians of the others are printed, with what
the display says it took in all, for drawing and for compositing.
"""
import argparse
import math
import statistics
import time

from paraview import simple

SIZE = 256
NODES = 256
FIRST_VISIBLE = 64  # node of S2
FIRST = 4  # frame that is counted
# StandardField, on the part of the cube that a rank has.
FIELD = """
import numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.util.numpy_support import numpy_to_vtk
BLOBS = ((.35, .40, .45, .10, 1.0), (.65, .55, .40, .08, .9), (.50, .70, .65, .07, .8),
         (.25, .25, .70, .06, .9), (.75, .30, .70, .09, .7), (.60, .20, .25, .05, 1.0),
         (.30, .75, .25, .06, .8), (.80, .80, .30, .05, .9))
information = self.GetExecutive().GetOutputInformation(0)
extent = information.Get(vtkStreamingDemandDrivenPipeline.UPDATE_EXTENT())
at = [numpy.arange(extent[2 * a], extent[2 * a + 1] + 1) / ({size} - 1.0) for a in range(3)]
x, y, z = at[0][None, None, :], at[1][None, :, None], at[2][:, None, None]
turn = 2.0 * numpy.pi
sines = [numpy.sin(4.0 * turn * p) for p in (x, y, z)]
field = 0.1 + 0.10 * sines[0] * sines[1] * sines[2]
field = field + 0.06 * numpy.sin(turn * (9 * x + 5 * y)) * numpy.sin(turn * (7 * z - 3 * x))
for cx, cy, cz, width, amplitude in BLOBS:
    g = [numpy.exp(-(p - c) ** 2 / (2.0 * width * width)) for p, c in ((x, cx), (y, cy), (z, cz))]
    field = field + amplitude * g[0] * g[1] * g[2]
field = numpy.clip((field - -0.0597561449) / (1.18257499 - -0.0597561449), 0.0, 1.0)
output = self.GetImageDataOutput()
output.SetExtent(extent)
values = numpy_to_vtk(field.astype(numpy.float32).ravel(), deep=True)
values.SetName("field")
output.GetPointData().SetScalars(values)
"""
INFORMATION = """
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkStreamingDemandDrivenPipeline
information = self.GetExecutive().GetOutputInformation(0)
information.Set(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT(), *([0, {size} - 1] * 3))
information.Set(vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""


def colours_and_opacities(scene):
    """Points of both functions, as ParaView takes them."""
    colours = []
    opacities = []
    threshold = FIRST_VISIBLE / (NODES - 1)
    for node in range(NODES):
        x = node / (NODES - 1)
        colours += [x] + [0.5 + 0.5 * math.cos(2 * math.pi * (0.9 * x + phase))
                          for phase in (0.0, 0.33, 0.67)]
        strong = 0.0 if node < FIRST_VISIBLE else 0.02 + 0.28 * (x - threshold) / (1 - threshold)
        opacities += [x, 0.001 + 0.019 * x if scene == "S1" else strong, 0.5, 0.0]
    return colours, opacities


def take_functions(display, array, scene):
    colours = simple.GetColorTransferFunction(array)
    opacities = simple.GetOpacityTransferFunction(array)
    colours.ColorSpace = "RGB"
    colours.RGBPoints, opacities.Points = colours_and_opacities(scene)
    display.LookupTable = colours
    display.ScalarOpacityFunction = opacities


def look(view, edge):
    """The camera on a cube from the origin."""
    middle = 0.5 * edge
    view.CameraFocalPoint = [middle] * 3
    view.CameraPosition = [middle + 1.9 * edge * x for x in (0.48, 0.36, 0.80)]
    view.CameraViewUp = [0, 1, 0]
    view.CameraViewAngle = 45


def show(arguments, view):
    source = simple.ProgrammableSource(
        OutputDataSetType="vtkImageData", Script=FIELD.replace("{size}", str(SIZE)),
        ScriptRequestInformation=INFORMATION.replace("{size}", str(SIZE)))
    source.UpdatePipeline()
    display = simple.Show(source, view, "UniformGridRepresentation")
    simple.ColorBy(display, ("POINTS", "field"))
    display.SetRepresentationType("Banyan Volume")
    take_functions(display, "field", arguments.scene)
    display.ScalarOpacityUnitDistance = 1.0
    display.NumberOfThreads = 1
    display.Shade = int(arguments.shaded)
    display.SampleDistanceVoxels = 1.0
    display.ReuseFrames = 0  # the same scene is to take its time again and again
    return display


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--scene", choices=("S1", "S2"), default="S2")
    parser.add_argument("--shaded", action="store_true")
    parser.add_argument("--no-fxaa", action="store_true",
                        help="without ParaView's smoothing of edges")
    parser.add_argument("--frames", type=int, default=16)
    parser.add_argument("--pixels", type=int, default=1024, help="edge of the picture")
    parser.add_argument("--picture", help="writes the last frame to this file")
    arguments = parser.parse_args()
    if arguments.frames <= FIRST:
        parser.error(f"--frames must be more than {FIRST}: the first ones are not counted")
    simple.LoadPlugin(arguments.plugin, remote=False)
    view = simple.CreateView("RenderView")
    view.ViewSize = [arguments.pixels, arguments.pixels]
    view.OrientationAxesVisibility = 0
    if arguments.no_fxaa:
        view.UseFXAA = 0
    display = show(arguments, view)
    look(view, SIZE - 1)
    taken = []
    for _ in range(arguments.frames):
        began = time.monotonic()
        simple.Render(view)
        seconds = time.monotonic() - began
        display.UpdatePropertyInformation()
        taken.append((seconds, *(display.GetPropertyValue(name) for name in (
            "TotalSeconds", "RenderSeconds", "CompositeSeconds", "Imbalance"))))
    medians = [statistics.median(column) for column in zip(*taken[FIRST:])]
    if arguments.picture:
        simple.SaveScreenshot(arguments.picture, view, ImageResolution=[arguments.pixels, arguments.pixels])
    name = arguments.scene + ("-shaded" if arguments.shaded else "")
    print("scene,ms,banyan_ms,render_ms,composite_ms,imbalance")
    print(name + "," + ",".join(f"{1e3 * value:.1f}" for value in medians[:4])
          + f",{medians[4]:.2f}", flush=True)


if __name__ == "__main__":
    main()
