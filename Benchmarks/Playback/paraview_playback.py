# SPDX-License-Identifier: BSD-3-Clause
"""Plays a series in ParaView, as its window does: as Banyan Volume, or as ParaView's own Volume.

    pvbatch paraview_playback.py --plugin Banyan.so --info banyan-info --series FILE.banyan --table TABLE.csv
        [--name NAME] [--representation banyan|volume] [--picture N] [--tolerance T] [--frames N] [--pass N]

Appends a line for each frame to TABLE, like banyan-bench-playback: `ms` is the interval from asking for the next
step to the finished picture, with all that ParaView does in it; camera and function are that program's `ramp`.
--tolerance is that of Banyan Volume, in 1/255 (default: the representation's own). A process is one pass.

    pvbatch paraview_playback.py --plugin Banyan.so --encode INPUT --array NAME --series FILE.banyan

encodes what ParaView can read.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import time

from paraview import simple

NODES = 128  # of both functions
FIRST_VISIBLE = 0.004  # part of the range
REPRESENTATIONS = {"banyan": "Banyan Volume", "volume": "Volume"}


def encode(arguments):
    source = simple.OpenDataFile(arguments.encode)
    simple.SaveData(arguments.series, proxy=source, WriteTimeSteps=1, PointArrays=[arguments.array], CellArrays=[])


def range_of(arguments):
    """Whether the array has several components, and its range over all steps: of vectors, from 0 to the largest that a
    component reaches."""
    told = json.loads(subprocess.run([arguments.info, arguments.series, "--json"], check=True, stdout=subprocess.PIPE,
                                     encoding="utf-8").stdout)["components"]
    ranges = [component["range"] for component in told]
    if len(ranges) == 1:
        return (False, *ranges[0])
    return (True, 0.0, max(abs(end) for both in ranges for end in both))


def functions(array, low, high):
    """The function `ramp` of banyan-bench-playback."""
    colours = []
    for node in range(NODES):
        part = node / (NODES - 1)
        colours += [low + part * (high - low)] + [0.5 + 0.5 * math.cos(2 * math.pi * (0.9 * part + phase))
                                                  for phase in (0.0, 0.33, 0.67)]
    lookup = simple.GetColorTransferFunction(array)
    lookup.ColorSpace = "RGB"
    lookup.RGBPoints = colours
    opacity = simple.GetOpacityTransferFunction(array)
    opacity.Points = [number for part, value in ((0.0, 0.0), (FIRST_VISIBLE, 0.0),
                                                 (FIRST_VISIBLE + 1e-3, 0.15 * (FIRST_VISIBLE + 1e-3)), (1.0, 0.15))
                      for number in (low + part * (high - low), value, 0.5, 0.0)]
    return lookup, opacity


def look_from_afar(view, bounds):
    centre = [0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]) for axis in range(3)]
    diagonal = math.dist(bounds[0::2], bounds[1::2])
    view.CameraFocalPoint = centre
    view.CameraPosition = [c + 1.4 * diagonal * d for c, d in zip(centre, (0.48, 0.36, 0.80))]
    view.CameraViewUp = [0, 1, 0]
    view.CameraViewAngle = 40


def show(arguments, reader):
    """The view and the display."""
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [arguments.picture, arguments.picture]
    array = reader.PointData.keys()[0]
    vectors, low, high = range_of(arguments)
    display = simple.Show(reader, view)
    simple.ColorBy(display, ("POINTS", array, "Magnitude") if vectors else ("POINTS", array))
    display.LookupTable, display.ScalarOpacityFunction = functions(array, low, high)
    bounds = reader.GetDataInformation().GetBounds()
    samples = [end - begin + 1 for begin, end in zip(reader.GetDataInformation().GetExtent()[0::2],
                                                     reader.GetDataInformation().GetExtent()[1::2])]
    edges = [high - low for low, high in zip(bounds[0::2], bounds[1::2])]
    # A cell of a grid; of a mesh, which has cells of several sizes, a part of the whole.
    display.ScalarOpacityUnitDistance = (edges[0] / (samples[0] - 1) if samples[0] > 1 else max(edges) / 32)
    display.SetRepresentationType(REPRESENTATIONS[arguments.representation])
    display.SetScalarBarVisibility(view, False)
    if arguments.tolerance and arguments.representation == "banyan":
        display.ImageErrorTolerance = arguments.tolerance
    look_from_afar(view, bounds)
    return view, display


def figures(display):
    """What Banyan Volume says of its last frame."""
    display.UpdatePropertyInformation()
    value = display.GetPropertyValue
    return {"samples": value("SamplesTaken"), "plan_ms": 1e3 * (value("ProbeSeconds") + value("StrideSeconds")),
            "render_ms": 1e3 * value("RenderSeconds"), "composite_ms": 1e3 * value("CompositeSeconds"),
            "bytes_read": value("BytesRead"), "bytes_composited": value("BytesComposited"),
            "decoded_ahead": value("CacheHitsAhead"), "reused_fraction": value("ReusedFraction"),
            "estimated_error": value("EstimatedImageError"), "tolerance": value("ImageErrorTolerance")}


def play(arguments):
    """A row for each frame."""
    reader = simple.OpenDataFile(arguments.series)
    view, display = show(arguments, reader)
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.PlayMode = "Snap To TimeSteps"
    finished = []
    view.SMProxy.GetRenderWindow().AddObserver("EndEvent", lambda *_: finished.append(time.perf_counter()))
    times = list(reader.TimestepValues)[:arguments.frames]
    for frame, value in enumerate(times):
        before = len(finished)
        began = time.perf_counter()
        if frame == 0:
            simple.Render(view)
        else:
            scene.GoToNext()
        ms = 1e3 * (time.perf_counter() - began)
        if len(finished) == before or view.ViewTime != value:
            raise RuntimeError(f"step {frame} was not drawn: ParaView is at {view.ViewTime}, not at {value}.")
        row = {"series": arguments.name, "mode": "play", "function": "ramp", "size": arguments.picture, "shaded": 0,
               "ranks": 1, "reuse": "paraview-" + arguments.representation, "pass": arguments.number, "frame": frame,
               "step": frame, "ms": ms, "tolerance": 0}
        if arguments.representation == "banyan":
            row.update(figures(display))
        yield row
    if arguments.save:
        simple.SaveScreenshot(arguments.save, view, ImageResolution=view.ViewSize)


def append(table, rows):
    """Under the columns that the table has."""
    fresh = not os.path.exists(table)
    if fresh:
        columns = list(dict.fromkeys(key for row in rows for key in row))
    else:
        with open(table, encoding="utf-8", newline="") as file:
            columns = next(csv.reader(file))
    with open(table, "a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        if fresh:
            writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{value:.4f}" if isinstance(value, float) else value for key, value in row.items()})


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--series", required=True)
    parser.add_argument("--encode")
    parser.add_argument("--array")
    parser.add_argument("--info")
    parser.add_argument("--table")
    parser.add_argument("--name", default="")
    parser.add_argument("--representation", choices=REPRESENTATIONS, default="banyan")
    parser.add_argument("--picture", type=int, default=512)
    parser.add_argument("--tolerance", type=float)
    parser.add_argument("--frames", type=int, default=50)
    parser.add_argument("--pass", dest="number", type=int, default=0)
    parser.add_argument("--save", help="file for the last picture")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False)
    if arguments.encode:
        encode(arguments)
    else:
        append(arguments.table, list(play(arguments)))


if __name__ == "__main__":
    main()
