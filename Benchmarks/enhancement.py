# SPDX-License-Identifier: BSD-3-Clause
"""What bringing out motion costs: steps of a series played, and frames of one step, with and without.

    pvbatch enhancement.py --plugin Banyan.so [--size N] [--steps N] [--strength S] FILE ARRAY [FILE ARRAY...]

The opacity is the same for all values, so that both draw the same samples, whatever they are enhanced to: what is
left is the enhancement itself. Steps (12 in the middle of the series) are played with and without in turn, three times;
each is drawn twice, the second time with another camera. Prints medians of the processors' time (all threads of one
process), in milliseconds: of the first pictures (the step is read, enhanced and drawn) and of the second ones (it is
drawn).
"""
import argparse
import statistics
import time

from paraview import simple


def show(file, array, size):
    source = simple.OpenDataFile(file)
    source.UpdatePipeline()
    view = simple.CreateView("RenderView")
    view.ViewSize = [size, size]
    view.UseFXAA = 0
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", array))
    display.SetRepresentationType("Banyan Volume")
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    display.RescaleTransferFunctionToDataRangeOverTime()
    opacity = simple.GetOpacityTransferFunction(array)
    low, high = opacity.Points[0], opacity.Points[-4]
    opacity.Points = [low, 0.02, 0.5, 0.0, high, 0.02, 0.5, 0.0]
    bounds = source.GetDataInformation().GetBounds()
    display.ScalarOpacityUnitDistance = max(bounds[1] - bounds[0], bounds[3] - bounds[2]) / 50
    display.SampleDistanceVoxels = 1.0
    display.ReuseFrames = 0  # steps are drawn several times
    view.ResetCamera()
    simple.GetActiveCamera().Azimuth(30)
    simple.GetActiveCamera().Elevation(30)
    return source, view, display


def play(steps, view, display, strength):
    """Milliseconds of the first and of the second picture of each step but the first."""
    display.TemporalEnhancement = strength
    first, second = [], []
    for step in steps:
        for times in (first, second):
            simple.GetActiveCamera().Azimuth(1 if times is first else -1)
            begin = time.process_time()
            view.ViewTime = step
            view.StillRender()
            times.append(1e3 * (time.process_time() - begin))
    return first[1:], second[1:]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--steps", type=int, default=12)
    parser.add_argument("--strength", type=float, default=0.6)
    parser.add_argument("files", nargs="+")
    options = parser.parse_args()
    simple.LoadPlugin(options.plugin)
    for file, array in zip(options.files[::2], options.files[1::2]):
        source, view, display = show(file, array, options.size)
        played = {0.0: ([], []), options.strength: ([], [])}
        first_step = max(0, (len(source.TimestepValues) - options.steps) // 2)
        steps = source.TimestepValues[first_step:first_step + options.steps]
        for _ in range(3):
            for strength, (first, second) in played.items():
                one, two = play(steps, view, display, strength)
                first += one
                second += two
        points = source.GetDataInformation().GetNumberOfPoints()
        print(f"{file}, {array}: {points} points, {len(steps)} steps")
        for strength, (first, second) in played.items():
            print(f"  strength {strength}: {statistics.median(first):.1f} ms of a new step, "
                  f"{statistics.median(second):.1f} ms of a step that was drawn", flush=True)
        simple.Delete(view)
        simple.Delete(source)


main()
