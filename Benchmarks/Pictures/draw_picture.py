# SPDX-License-Identifier: BSD-3-Clause
"""Saves one picture, and adds a line to pictures.csv. For pvbatch.

    draw_picture.py --plugin Banyan.so --series FILE.banyan --size WIDTHxHEIGHT --shown surface|banyan|volume
                    --way whole|parts --output DIR
"""
import argparse
import csv
import os
import resource
import time

from paraview import simple
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SMALL = (400, 300)
COLUMNS = ("size", "megapixels", "ranks", "shown", "way", "seconds", "processor_s", "first_mib", "others_mib",
           "bytes_a_pixel")


def of_ranks(value):
    """A number of each rank, on all of them."""
    controller = vtkMultiProcessController.GetGlobalController()
    mine, every = vtkDoubleArray(), vtkDoubleArray()
    mine.InsertNextValue(value)
    every.SetNumberOfValues(controller.GetNumberOfProcesses())
    controller.AllGather(mine, every)
    return [every.GetValue(i) for i in range(every.GetNumberOfValues())]


def peak():
    """MiB that this process has had at most."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def processor():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def show(arguments, view):
    if arguments.shown == "surface":
        simple.Show(simple.Sphere(Radius=100.0, ThetaResolution=100, PhiResolution=100), view)
        return
    source = simple.OpenDataFile(arguments.series)
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", source.PointData[0].Name))
    display.SetRepresentationType("Banyan Volume" if arguments.shown == "banyan" else "Volume")


def smallest_view(size):
    """The largest view below 2000 pixels whose whole multiple the picture is."""
    factor = next(f for f in range(1, 100) if all(s % f == 0 and s // f < 2000 for s in size))
    return [s // factor for s in size]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--series", required=True)
    parser.add_argument("--size", required=True)
    parser.add_argument("--shown", choices=("surface", "banyan", "volume"), required=True)
    parser.add_argument("--way", choices=("whole", "parts"), required=True)
    parser.add_argument("--output", required=True)
    arguments = parser.parse_args()
    size = [int(number) for number in arguments.size.split("x")]
    simple.LoadPlugin(arguments.plugin, remote=False)
    view = simple.CreateView("RenderView")
    view.ViewSize = list(SMALL)
    view.UseFXAA = 0
    view.OrientationAxesVisibility = 0
    show(arguments, view)
    view.ResetCamera(False)
    camera = simple.GetActiveCamera()
    camera.Azimuth(30)
    camera.Elevation(20)
    camera.Zoom(1.6)
    simple.Render(view)
    before = of_ranks(peak())
    view.ViewSize = size if arguments.way == "whole" else smallest_view(size)
    ranks = len(before)
    path = os.path.join(arguments.output, f"{arguments.size}-{arguments.shown}-{arguments.way}-{ranks}.png")
    began, used = time.monotonic(), processor()
    simple.SaveScreenshot(path, view, ImageResolution=size, CompressionLevel="1")
    seconds = time.monotonic() - began
    used = sum(of_ranks(processor() - used))
    more = [after - was for after, was in zip(of_ranks(peak()), before)]
    if vtkMultiProcessController.GetGlobalController().GetLocalProcessId() > 0:
        return
    pixels = size[0] * size[1]
    table = os.path.join(arguments.output, "pictures.csv")
    new = not os.path.exists(table)
    with open(table, "a", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        if new:
            rows.writerow(COLUMNS)
        rows.writerow([arguments.size, f"{pixels / 1e6:.1f}", ranks, arguments.shown, arguments.way, f"{seconds:.1f}",
                       f"{used:.1f}", f"{more[0]:.0f}", f"{max(more[1:]):.0f}" if ranks > 1 else "",
                       f"{more[0] * 2**20 / pixels:.1f}"])


main()
