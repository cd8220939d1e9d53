# SPDX-License-Identifier: BSD-3-Clause
"""Draws a mesh in ParaView in one way, and appends a row to a table. A process draws once, so that its memory is that of
one renderer.

    pvpython draw_mesh.py --plugin Banyan.so --mesh FILE.npz --name NAME --renderer RENDERER --picture FILE.png
        [--tolerance T] [--pixels WIDTHxHEIGHT] [--scene S1|S2] [--most SECONDS] [--reference FILE.png --table FILE.csv]

RENDERER is `reference`, `banyan`, or one of ParaView's below. `--picture` gets what is compared with the reference. A line
that begins with NOTE says why a number is missing.
"""
import argparse
import ctypes
import math
import os
import pathlib
import statistics
import sys
import time

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

here = pathlib.Path(__file__).resolve().parent
sys.path += [str(here), str(here.parent / "Balance"), str(here.parent / "Playback")]
import mesh_source  # noqa: E402 (its folder had to be named first)
import paraview_frames  # noqa: E402
import paraview_playback  # noqa: E402

MAPPERS = {  # those that ParaView offers, and whether they take attenuations for opacities
    "paraview-projected-tetra": ("Projected tetra", True),
    "paraview-bunyk": ("Bunyk ray cast", True),
    "paraview-zsweep": ("Z sweep", True),
    "paraview-resample": ("Resample To Image", False),
}
OURS = "Banyan Volume"
COLUMNS = ("mesh", "cells", "renderer", "tolerance", "setup_s", "first_frame_s", "ms_per_frame", "memory_mb", "psnr_db",
           "max_error")
PICTURES = 8  # after the first, before the camera is where it was
TURN = 5.0  # degrees from one picture to the next
REFERENCE_DISTANCE = 0.125  # between samples, of the usual one


def note(sentence):
    print("NOTE: " + sentence, flush=True)


class Memory:
    """Megabytes that this process takes at most from here on, above what it has now."""

    def __init__(self):
        ctypes.CDLL(None).malloc_trim(0)  # what was freed counts when it is taken again
        with open("/proc/self/clear_refs", "w", encoding="ascii") as file:
            file.write("5")
        self.before = self.peak()

    def peak(self):
        with open("/proc/self/status", encoding="ascii") as file:
            return next(int(line.split()[1]) for line in file if line.startswith("VmHWM")) / 1024.0

    def more(self):
        return self.peak() - self.before


def take_functions(display, arguments, limits, unit, attenuations):
    """S1 or S2 over the limits. Mappers of unstructured grids take attenuations a of opacities 1 - exp(-a) per unit; the
    strongest is made 1, as projected tetrahedra keep them in 8 bits."""
    low, high = limits
    colours, opacities = (numpy.array(points).reshape(-1, 4) for points in
                          paraview_frames.colours_and_opacities(arguments.scene))
    if attenuations:
        opacities[:, 1] = -numpy.log1p(-opacities[:, 1])
        strongest = opacities[:, 1].max()
        opacities[:, 1] /= strongest
        unit /= strongest
    for points in (colours, opacities):
        points[:, 0] = low + points[:, 0] * (high - low)
    lookup = simple.GetColorTransferFunction(mesh_source.ARRAY)
    opacity = simple.GetOpacityTransferFunction(mesh_source.ARRAY)
    lookup.ColorSpace = "RGB"
    lookup.RGBPoints, opacity.Points = colours.ravel().tolist(), opacities.ravel().tolist()
    display.LookupTable, display.ScalarOpacityFunction = lookup, opacity
    display.ScalarOpacityUnitDistance = unit


class Scene:
    """The mesh in a view, shown as its outline at first."""

    def __init__(self, arguments):
        self.view = simple.CreateView("RenderView")
        self.view.ViewSize = [int(number) for number in arguments.pixels.split("x")]
        self.view.OrientationAxesVisibility = self.view.UseFXAA = 0
        self.view.UseColorPaletteForBackground, self.view.Background = 0, [0, 0, 0]
        self.source, bounds, limits, unit = mesh_source.make(arguments.mesh)
        self.cells = self.source.GetDataInformation().GetNumberOfCells()
        self.display = simple.Show(self.source, self.view)
        self.display.SetRepresentationType("Outline")
        simple.ColorBy(self.display, ("POINTS", mesh_source.ARRAY))
        self.display.SetScalarBarVisibility(self.view, False)
        if arguments.name.split("-")[0] in ("hexahedra", "tetrahedra", "mixed", "curvilinear"):
            paraview_frames.look(self.view, 1.0)
        else:
            paraview_playback.look_from_afar(self.view, bounds)
        take_functions(self.display, arguments, limits, unit, MAPPERS.get(arguments.renderer, ("", False))[1])
        self.eye = numpy.array(self.view.CameraPosition)
        self.draw()

    def draw(self, degrees=0.0):
        """Seconds of a still picture, with the camera turned about the middle."""
        began = time.perf_counter()
        focus = numpy.array(self.view.CameraFocalPoint)
        x, y, z = self.eye - focus
        cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        self.view.CameraPosition = (focus + [cosine * x + sine * z, y, cosine * z - sine * x]).tolist()
        simple.Render(self.view)
        self.view.GetRenderWindow().WaitForCompletion()
        return time.perf_counter() - began

    def switch_to(self, arguments):
        """To a representation with all that it is told."""
        display, ours = self.display, arguments.renderer not in MAPPERS
        wanted = OURS if ours else "Volume"
        if wanted not in display.GetProperty("Representation").Available:
            raise SystemExit(f"NOTE: ParaView does not offer '{wanted}' for this mesh")
        if ours:
            display.ReuseFrames = display.Decoupled = 0
            if arguments.renderer == "reference":
                display.SampleDistanceVoxels = REFERENCE_DISTANCE
            elif arguments.tolerance == 0:
                display.SampleDistanceVoxels = 1.0
            else:
                display.ImageErrorTolerance = arguments.tolerance
        else:
            display.SelectMapper = MAPPERS[arguments.renderer][0]
        display.SetRepresentationType(wanted)

    def grab(self):
        """What the window shows."""
        reader = vtkWindowToImageFilter()
        reader.SetInput(self.view.GetRenderWindow())
        reader.ShouldRerenderOff()
        reader.ReadFrontBufferOff()
        reader.Update()
        return reader.GetOutput()


def pixels_of(image):
    """[y][x][3]"""
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3].astype(float)


def measure(scene, arguments):
    """Columns that are times and memory, and the last picture, which is as the first one."""
    memory = Memory()
    began = time.perf_counter()
    scene.switch_to(arguments)
    prepared = time.perf_counter() - began
    first = prepared + scene.draw()
    print(f"first frame: {first:.3f} s", flush=True)
    times = []
    if arguments.renderer != "reference":
        while len(times) < PICTURES and sum(times) < arguments.most:
            times.append(scene.draw(TURN * (len(times) + 1)))
        times.append(scene.draw())
    row = {"first_frame_s": first, "memory_mb": memory.more()}
    if times:
        later = statistics.median(times)
        row.update({"setup_s": max(0.0, first - later), "ms_per_frame": 1e3 * later})
    return row, scene.grab()


def errors(image, reference):
    """Columns that compare with the reference."""
    if not os.path.exists(reference):
        note("there is no picture of Banyan's to compare with")
        return {}
    reader = vtkPNGReader()
    reader.SetFileName(reference)
    reader.Update()
    difference = pixels_of(image) - pixels_of(reader.GetOutput())
    mean = numpy.mean(difference ** 2)
    return {"psnr_db": 10 * math.log10(255.0 ** 2 / mean) if mean > 0 else math.inf,
            "max_error": int(abs(difference).max())}


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("plugin", "mesh", "name", "picture"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--renderer", choices=("reference", "banyan", *MAPPERS), required=True)
    parser.add_argument("--tolerance", type=float, default=0)
    parser.add_argument("--pixels", default="1024x1024")
    parser.add_argument("--scene", choices=("S1", "S2"), default="S1")
    parser.add_argument("--most", type=float, default=60)
    parser.add_argument("--reference", default="")
    parser.add_argument("--table")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False)
    simple._DisableFirstRenderCameraReset()
    scene = Scene(arguments)
    row, image = measure(scene, arguments)
    black = pixels_of(image).max() == 0
    if black:
        note("the picture is black")
    if not black or arguments.renderer != "reference":
        writer = vtkPNGWriter()
        writer.SetFileName(arguments.picture)
        writer.SetInputData(image)
        writer.Write()
    if arguments.table:
        row.update({} if black else errors(image, arguments.reference))
        row.update({"mesh": arguments.name, "cells": scene.cells, "renderer": arguments.renderer})
        row["tolerance"] = f"{arguments.tolerance:g}" if arguments.renderer == "banyan" else None
        paraview_playback.append(arguments.table, [{column: row.get(column) for column in COLUMNS}])
    sys.stdout.flush()
    os._exit(0)  # giving all memory back takes long, and nobody needs it


if __name__ == "__main__":
    main()
