# SPDX-License-Identifier: BSD-3-Clause
"""Writes a series that takes long, for test_interruption.py, or checks what is left of one.

    write_long.py --plugin Banyan.so [--steps N] [--fail RANK [--disk-full]] --write SERIES
    write_long.py --plugin Banyan.so --check SERIES...
"""
from paraview import simple
from paraview.vtk.numpy_interface import dataset_adapter

import numpy

import moving_field
import session

SAMPLES = (40, 36, 30)
BOUND = 0.01


def fetch(source, time):
    source.UpdatePipeline(time)
    data = dataset_adapter.WrapDataObject(simple.servermanager.Fetch(source))
    return {name: numpy.asarray(data.PointData[name]) for name in ("wave", "vector")}


def check(path):
    """Every step that the series has is within the bound."""
    reader = simple.OpenDataFile(path)
    session.require(reader is not None, f"{path} does not open")
    decode = simple.BanyanDecode(Input=reader)
    times = list(reader.TimestepValues) or [0.0]
    session.require(times == [0.5 * step for step in range(len(times))], f"times {times}")
    original = moving_field.source(SAMPLES, len(times), False)
    for time in times[:2] + times[-2:]:
        expected, found = fetch(original, time), fetch(decode, time)
        for name, values in expected.items():
            error = numpy.abs(values.astype("f8") - found[name]).max()
            session.require(error <= BOUND * (1 + 1e-6), f"{path}, {time}, {name}: error {error}")
    print(f"{path}: {len(times)} steps, within the bound", flush=True)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--fail", type=int, default=-1)
    parser.add_argument("--disk-full", action="store_true", help="that is how it fails")
    parser.add_argument("--write")
    parser.add_argument("--check", nargs="*", default=[])
    arguments = parser.parse_args()
    session.begin(arguments)
    if arguments.write:
        source = moving_field.source(SAMPLES, arguments.steps, True, arguments.fail,
                                     arguments.disk_full)
        simple.SaveData(arguments.write, proxy=source, KeyframeInterval=4,
                        ErrorBoundMode="Absolute", ErrorBound=BOUND)
        print("written to the end", flush=True)
    for path in arguments.check:
        check(path)


if __name__ == "__main__":
    main()
