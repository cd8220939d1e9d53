# SPDX-License-Identifier: BSD-3-Clause
"""Saves one picture, and adds a line to pictures.csv. For pvbatch.

    draw_picture.py --plugin Banyan.so --series FILE.banyan --size WIDTHxHEIGHT --shown surface|banyan|volume
                    --way whole|parts --output DIR
"""
import argparse
import csv
import os
import time

from paraview import simple

SMALL = (400, 300)
COLUMNS = ("size", "megapixels", "ranks", "shown", "way", "seconds", "processor_s", "first_mib", "others_mib",
           "bytes_a_pixel")


def ranks():
    """The processes of all ranks, on this machine: this one first. pvbatch runs the script on the first one alone."""
    own, parent = os.getpid(), os.getppid()
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8") as file:
                fields = file.read().rsplit(")", 1)[1].split()
        except OSError:
            continue  # it has ended meanwhile
        if int(fields[1]) == parent and int(name) != own:
            found.append(int(name))
    return [own] + sorted(found)


def peak(process):
    """MiB that a process has had at most."""
    with open(f"/proc/{process}/status", encoding="utf-8") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmHWM")) / 1024.0


def processor(process):
    """Seconds."""
    with open(f"/proc/{process}/stat", encoding="utf-8") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


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
    processes = ranks()
    before = [peak(process) for process in processes]
    view.ViewSize = size if arguments.way == "whole" else smallest_view(size)
    count = len(processes)
    path = os.path.join(arguments.output, f"{arguments.size}-{arguments.shown}-{arguments.way}-{count}.png")
    began, used = time.monotonic(), sum(map(processor, processes))
    simple.SaveScreenshot(path, view, ImageResolution=size, CompressionLevel="1")
    seconds = time.monotonic() - began
    used = sum(map(processor, processes)) - used
    more = [peak(process) - was for process, was in zip(processes, before)]
    pixels = size[0] * size[1]
    table = os.path.join(arguments.output, "pictures.csv")
    new = not os.path.exists(table)
    with open(table, "a", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        if new:
            rows.writerow(COLUMNS)
        rows.writerow([arguments.size, f"{pixels / 1e6:.1f}", count, arguments.shown, arguments.way, f"{seconds:.1f}",
                       f"{used:.1f}", f"{more[0]:.0f}", f"{max(more[1:]):.0f}" if count > 1 else "",
                       f"{more[0] * 2**20 / pixels:.1f}"])


main()
