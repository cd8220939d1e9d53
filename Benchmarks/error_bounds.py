# SPDX-License-Identifier: BSD-3-Clause
"""What error bounds come to on a series: size, and how far pictures, surfaces and gradients may be off.

    pvbatch Benchmarks/error_bounds.py --plugin build/lib/Banyan/Banyan.so FILES...

FILES are a series of image data, one file per step. Prints a table with a line per bound, of the first array:
bits per value of all steps; and of the middle step the PSNR, the share of points that lie on another side of the surface at
the middle of the range, and the root of the mean squared error of the gradient over that of the gradient itself.
"""
import argparse
import os
import tempfile

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

BOUNDS = (1 / 64, 1 / 256, 1 / 512, 1 / 4096, 1 / 65536, 0)


def values_of(source, name, time):
    """Values of a step as array [z][y][x]."""
    source.UpdatePipeline(time)
    image = simple.servermanager.Fetch(source)
    x, y, z = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(z, y, x).astype(float)


def gradient(values):
    return numpy.stack(numpy.gradient(values))


def size(path):
    inside = [os.path.join(path + ".d", name) for name in os.listdir(path + ".d")]
    return sum(os.path.getsize(name) for name in [path] + inside)


def line(source, name, time, count, bound, folder):
    """One bound: bits per value, PSNR in dB, shares in per cent."""
    path = os.path.join(folder, "bound.banyan")
    simple.SaveData(path, proxy=source, WriteTimeSteps=1, ErrorBound=bound, PointArrays=[name])
    series = simple.OpenDataFile(path)
    one, other = values_of(source, name, time), values_of(series, name, time)
    simple.Delete(series)
    span = one.max() - one.min()
    middle = one.min() + span / 2
    rmse = numpy.sqrt(((one - other) ** 2).mean())
    psnr = 20 * numpy.log10(span / rmse) if rmse > 0 else numpy.inf
    side = ((one > middle) != (other > middle)).mean()
    slope = numpy.sqrt(((gradient(one) - gradient(other)) ** 2).mean() / (gradient(one) ** 2).mean())
    return 8 * size(path) / (count * one.size), psnr, 100 * side, 100 * slope


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, ns=globals())
    source = simple.OpenDataFile(arguments.files)
    source.UpdatePipeline()
    name = source.PointData.keys()[0]
    times = list(source.TimestepValues)
    print(f"{name}, {len(times)} steps\nbound    bits per value  PSNR  other side %  gradient off by %")
    with tempfile.TemporaryDirectory() as folder:
        for bound in BOUNDS:
            told = line(source, name, times[len(times) // 2], len(times), bound, folder)
            print(f"{f'1/{1 / bound:g}' if bound else '0':8} {told[0]:14.2f} {told[1]:5.1f} {told[2]:13.3f} "
                  f"{told[3]:18.2f}", flush=True)


if __name__ == "__main__":
    main()
