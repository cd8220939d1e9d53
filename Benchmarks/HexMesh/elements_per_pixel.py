# SPDX-License-Identifier: BSD-3-Clause
"""What MaxElementsPerPixel saves and costs, from outside, from just outside of a corner, and from inside of a mesh.

    pvbatch elements_per_pixel.py --plugin Banyan.so FILE.banyan ARRAY

Prints `camera, max_elements, ms_per_frame, psnr_db, lowest_quarter_db` at the middle step: the median of five frames of
512^2 pixels in ParaView, at the usual tolerance, and the difference from the picture with any number of elements (0), of all and
of the lowest quarter of the picture, where a mesh that is seen from just above is near; inf where they are the same. For arrays of
three components of a mesh with z upwards.
"""
import argparse
import math
import statistics
import time

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

PIXELS, FRAMES = 512, 5
NUMBERS = (0, 1, 0.06, 0.015)
# Where the eye is and where it looks, in edges of the mesh's box from its middle: the first of x, y and z.
CAMERAS = {
    "outside": ((-1.1, -1.4, 1.2), (0, 0, 0)),
    "corner": ((-0.52, -0.52, 0.2), (0, 0, 0.19)),
    "inside": ((-0.3, -0.3, 0.1), (0.5, 0.5, 0)),
}


def show(arguments):
    """@return the view, the display, the middle of the mesh and its edge along x"""
    reader = simple.OpenDataFile(arguments.file)
    view = simple.CreateView("RenderView")
    view.ViewSize = [PIXELS, PIXELS]
    view.OrientationAxesVisibility = view.UseFXAA = 0
    view.UseColorPaletteForBackground, view.Background = 0, [0, 0, 0]
    view.ViewTime = reader.TimestepValues[len(reader.TimestepValues) // 2]
    display = simple.Show(reader, view)
    simple.ColorBy(display, ("POINTS", arguments.array, "Magnitude"))
    display.SetRepresentationType("Banyan Volume")
    display.SetScalarBarVisibility(view, False)
    colours = simple.GetColorTransferFunction(arguments.array)
    top = 0.3 * colours.RGBPoints[-4]
    colours.RescaleTransferFunction(0, top)
    simple.GetOpacityTransferFunction(arguments.array).RescaleTransferFunction(0, top)
    bounds = reader.GetDataInformation().GetBounds()
    edge = bounds[1] - bounds[0]
    display.ScalarOpacityUnitDistance = edge / 100
    return view, display, [(bounds[2 * axis] + bounds[2 * axis + 1]) / 2 for axis in range(3)], edge


def picture(view):
    grab = vtkWindowToImageFilter()
    grab.SetInput(view.GetRenderWindow())
    grab.ReadFrontBufferOff()
    grab.Update()
    return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).astype(float).reshape(PIXELS, PIXELS, -1)


def milliseconds(view):
    """Each frame with a camera that has moved by nothing that can be seen."""
    times = []
    for frame in range(FRAMES + 1):
        view.CameraViewAngle = 40 + 1e-9 * frame
        start = time.perf_counter()
        view.StillRender()
        times.append(time.perf_counter() - start)
    return 1e3 * statistics.median(times[1:])


def psnr(a, b):
    error = numpy.mean((a - b) ** 2)
    return 10 * math.log10(255 ** 2 / error) if error > 0 else math.inf


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plugin", required=True)
    parser.add_argument("file", help="a series of a mesh")
    parser.add_argument("array")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False)
    simple._DisableFirstRenderCameraReset()
    view, display, middle, edge = show(arguments)
    print("camera, max_elements, ms_per_frame, psnr_db, lowest_quarter_db")
    for name, (eye, focus) in CAMERAS.items():
        view.CameraPosition = [m + edge * e for m, e in zip(middle, eye)]
        view.CameraFocalPoint = [m + edge * f for m, f in zip(middle, focus)]
        view.CameraViewUp = [0, 0, 1]
        for number in NUMBERS:
            display.MaxElementsPerPixel = number
            took = milliseconds(view)
            drawn = picture(view)
            full = drawn if number == 0 else full
            lowest = slice(0, PIXELS // 4)  # rows begin at the bottom
            print(f"{name}, {number}, {took:.0f}, {psnr(drawn, full):.1f}, {psnr(drawn[lowest], full[lowest]):.1f}",
                  flush=True)


main()
