# SPDX-License-Identifier: BSD-3-Clause
"""pvpython demo_measure.py SERIES ERROR_BOUND REPORT FILES...

Reads the files and the encoded SERIES side by side, compares every value of every step, and writes
the differences to REPORT (JSON), with a histogram for the transfer function. Fails when one value
is out of bound.
"""

import math
import sys

import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy

import demo_common as demo

HISTOGRAM_BINS = 256
HISTOGRAM_STEPS = 5


HIDDEN_POINT = 2  # of vtkDataSetAttributes; such points have no value


def values_of(image, name):
    """The values of a point array as [point][component], without those of hidden points."""
    array = image.GetPointData().GetArray(name)
    if array is None:
        raise demo.DemoError(f'the array "{name}" is missing in a time step.')
    values = vtk_to_numpy(array)
    values = values.reshape(len(values), -1)
    ghosts = image.GetPointGhostArray()
    return values if ghosts is None else values[(vtk_to_numpy(ghosts) & HIDDEN_POINT) == 0]


def exact(values):
    """Values in a type in which differences of the original type are exact enough to judge."""
    return values.astype(numpy.longdouble if values.dtype.itemsize == 8 else numpy.float64)


def same_bits(source, decoded):
    """Whether two arrays of one type hold the same bits."""
    return source.tobytes() == decoded.tobytes()


class ComponentErrors:
    """Collects the errors of one component over all steps."""

    def __init__(self):
        self.low, self.high = math.inf, -math.inf
        self.largest = 0.0
        self.squares = 0.0
        self.count = 0
        self.non_finite = 0
        self.non_finite_kept = True

    def add(self, source, decoded):
        finite = numpy.isfinite(source)
        if not finite.all():
            self.non_finite += int((~finite).sum())
            self.non_finite_kept &= same_bits(source[~finite], decoded[~finite])
        original = exact(source[finite])
        if original.size == 0:
            return
        difference = numpy.abs(exact(decoded[finite]) - original)
        self.low = min(self.low, float(original.min()))
        self.high = max(self.high, float(original.max()))
        # A value that became NaN is as wrong as can be, and must not vanish in a maximum.
        self.largest = max(self.largest, float(difference.max())
                           if numpy.isfinite(difference).all() else math.inf)
        self.squares += float((difference * difference).sum())
        self.count += original.size

    def report(self, relative_bound):
        width = max(self.high - self.low, 0.0)
        bound = relative_bound * width
        error = math.sqrt(self.squares / self.count) if self.count else 0.0
        # 20 log10(range / RMSE); nothing is lost when the error is zero, which JSON has no number
        # for.
        ratio = 20.0 * math.log10(width / error) if error > 0.0 and width > 0.0 else None
        return {"range": [self.low, self.high] if self.count else None,
                "error_bound_absolute": bound, "max_error": self.largest,
                "max_error_over_bound": self.largest / bound if bound > 0.0 else None,
                "rmse": error, "psnr_db": ratio, "non_finite_values": self.non_finite,
                "within_bound": self.largest <= bound and self.non_finite_kept}


def magnitude(values):
    values = exact(values)
    return values[:, 0] if values.shape[1] == 1 else numpy.sqrt((values * values).sum(axis=1))


def histogram(reader, times, name):
    """Counts of the values (magnitudes for vectors) over some steps, between their extremes."""
    chosen = sorted({times[round(i * (len(times) - 1) / max(HISTOGRAM_STEPS - 1, 1))]
                     for i in range(HISTOGRAM_STEPS)})
    samples = []
    for time in chosen:
        values = magnitude(values_of(demo.data_at(reader, time), name)).astype(float)
        samples.append(values[numpy.isfinite(values)])
    values = numpy.concatenate(samples)
    if values.size == 0:
        raise demo.DemoError(f'the array "{name}" has no finite value, there is nothing to draw.')
    counts, edges = numpy.histogram(values, bins=HISTOGRAM_BINS)
    return {"range": [float(edges[0]), float(edges[-1])], "counts": counts.tolist()}


def same_grid(a, b):
    """Whether two data sets have the same extent, or the same points and corners of cells."""
    if a.IsA("vtkImageData"):
        return a.GetExtent() == b.GetExtent()
    parts = (lambda grid: vtk_to_numpy(grid.GetPoints().GetData()),
             lambda grid: vtk_to_numpy(grid.GetCells().GetConnectivityArray()),
             lambda grid: dataset_adapter.WrapDataObject(grid).CellTypes)
    return all(same_bits(part(a), part(b)) for part in parts)


def compare(source, decoded, times, names):
    """Errors by array name and component, types by name, and the bytes that the source holds."""
    errors, types, size = {}, {}, 0
    for number, time in enumerate(times):
        original, copy = demo.data_at(source, time), demo.data_at(decoded, time)
        if not same_grid(original, copy):
            raise demo.DemoError(f"the grid of step {number} changed by encoding.")
        for name in names:
            before, after = values_of(original, name), values_of(copy, name)
            if before.dtype != after.dtype or before.shape != after.shape:
                raise demo.DemoError(f'type or size of "{name}" changed by encoding.')
            size += before.nbytes
            types[name] = str(before.dtype)
            parts = errors.setdefault(name, [ComponentErrors() for _ in before.T])
            for part, a, b in zip(parts, before.T, after.T):
                part.add(numpy.ascontiguousarray(a), numpy.ascontiguousarray(b))
        demo.progress(f"step {number + 1} of {len(times)}")
    return errors, types, size


def main():
    series, bound, report, files = sys.argv[1], float(sys.argv[2]), sys.argv[3], sys.argv[4:]
    demo.load_plugin()
    source, decoded = demo.open_series(files), demo.open_series([series])
    if decoded.GetProperty("DeferDecoding"):
        decoded.DeferDecoding = 0
    times, decoded_times = demo.time_values(source), demo.time_values(decoded)
    if times != decoded_times:
        raise demo.DemoError("the time values changed by encoding.")
    names = demo.array_names(decoded)
    errors, types, size = compare(source, decoded, times, names)
    arrays = [{"name": name, "type": types[name],
               "components": [part.report(bound) for part in errors[name]]} for name in names]
    scalars = [name for name in names if len(errors[name]) == 1]
    drawn = (scalars or names)[0]
    demo.write_json(report, {"arrays": arrays, "bytes_raw": size, "times": times,
                             "drawn_array": drawn, "histogram": histogram(source, times, drawn)})
    for array in arrays:
        for component in array["components"]:
            if not component["within_bound"]:
                raise demo.DemoError(f'"{array["name"]}" is out of its bound: error '
                                     f'{component["max_error"]} where '
                                     f'{component["error_bound_absolute"]} is allowed.')


demo.run(main)
