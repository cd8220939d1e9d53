# SPDX-License-Identifier: BSD-3-Clause
"""Common filters give on arrays that decode on first touch what they give on plain arrays.

    pvbatch --sym test_filters.py --plugin Banyan.so --out FOLDER

Runs on any number of ranks, each of which compares its own piece. Every filter is made twice, on
two readers of one series: one defers decoding (the default) and one does not.

Some filters of VTK 9.2 go wrong on arrays that VTK's dispatch does not know. crawl_filters.py finds
them; one of each kind is here.
"""
import filecmp
import glob
import os
import sys

import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkTable
from vtkmodules.vtkFiltersStatistics import vtkContingencyStatistics
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import compare_data
import filter_list
import session

SAMPLES = (41, 34, 29)
STEPS = 3
BOUND = 1 / 4096
TIME = 1.0
BETWEEN_STEPS = 1.25
TEMPORAL = ("temporal interpolator",)
# ParaView's parallel stream tracer gives the lines in another order each time.
UNORDERED = ("stream tracer",)
# Relative to the largest value. Since ParaView 5.13 each thread has a sum of its own.
TOLERANCES = {"integrate variables": 1e-5} if simple.GetParaViewVersion() >= (5, 13) else {}
# Values inline: libexpat's security update breaks VTK 9.2's reading of appended ones.
WRITERS = {
    "pvti": ({"DataMode": "Binary"}, simple.XMLPartitionedImageDataReader),
    "csv": ({}, None),
}


def controller():
    return vtkMultiProcessController.GetGlobalController()


def fields(step):
    """p (one component, with values on both sides of what the filters ask for) and v (three)."""
    z, y, x = numpy.meshgrid(*(numpy.arange(n, dtype="f4") for n in reversed(SAMPLES)),
                             indexing="ij")
    p = 0.5 + 0.5 * numpy.sin(0.21 * x + 0.3 * step) * numpy.cos(0.17 * y) * numpy.cos(0.23 * z)
    v = numpy.stack([numpy.cos(0.13 * y + 0.1 * step), numpy.sin(0.11 * x), 0.3 + 0.1 * p], -1)
    return p.astype("f4").reshape(-1), v.astype("f4").reshape(-1, 3)


def write_steps(folder, make):
    """One .vti per step, with values inline: appended values do not survive every libexpat."""
    for step in range(STEPS):
        image = vtkImageData()
        image.SetDimensions(SAMPLES)
        for name, values in make(step).items():
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            image.GetPointData().AddArray(array)
        image.GetPointData().SetActiveScalars("p")
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(image)
        writer.SetFileName(os.path.join(folder, f"step_{step}.vti"))
        writer.SetDataModeToBinary()
        session.require(writer.Write(), "a step was not written")


def named_fields(step):
    """These, and integers: VTK rounds what it interpolates, or not, by whether it knows the type."""
    p, v = fields(step)
    return {"p": p, "v": v, "w": (30 * v).astype("i2"), "n": (20 * p).astype("u1")}


def make_series(folder, make=named_fields):
    """The path of a series of these steps."""
    if controller().GetLocalProcessId() == 0:
        os.makedirs(folder, exist_ok=True)
        write_steps(folder, make)
    controller().Barrier()
    source = simple.XMLImageDataReader(FileName=sorted(glob.glob(folder + "/step_*.vti")))
    path = os.path.join(folder, "series.banyan")
    simple.SaveData(path, proxy=source, WriteTimeSteps=1, ErrorBound=BOUND)
    return path


def readers(path):
    """New ones, so that nothing has been decoded yet."""
    return simple.OpenDataFile(path), simple.BanyanSeriesReader(FileName=path, DeferDecoding=0)


def piece_of(proxy):
    """This rank's piece of a filter's output."""
    return proxy.GetClientSideObject().GetOutputDataObject(0)


def updated(proxy, time=TIME):
    proxy.UpdatePipeline(time)
    return piece_of(proxy)


def ends_paraview(name):
    """Contingency Statistics crashes in ParaView 6.1 on several ranks, with plain arrays, too."""
    return (name == "contingency statistics" and simple.GetParaViewVersion().major >= 6
            and controller().GetNumberOfProcesses() > 1)


def compare_filter(name, make, path):
    """What is different, and how much there was to compare."""
    deferred, plain = readers(path)
    ours, theirs = make(deferred), make(plain)
    time = BETWEEN_STEPS if name in TEMPORAL else TIME
    expected = updated(theirs, time)
    compare = compare_data.compare_unordered if name in UNORDERED else compare_data.compare
    wrong = compare(updated(ours, time), expected, TOLERANCES.get(name, 0.0))
    return wrong, compare_data.size(expected)


def saved(kind, extension, source, folder, options):
    """The file of that kind."""
    source.UpdatePipeline(TIME)
    path = os.path.join(folder, kind + "." + extension)
    simple.SaveData(path, proxy=source, **options)
    controller().Barrier()
    return path


def compare_writer(extension, options, reader, path, folder):
    """Reads back what the same writer made of both, or compares the bytes."""
    files = [saved(kind, extension, source, folder, options)
             for kind, source in zip(("deferred", "plain"), readers(path))]
    if reader is None:
        return [] if filecmp.cmp(*files, shallow=False) else ["the files differ"]
    return compare_data.compare(*(updated(reader(FileName=[file])) for file in files))


def compare_values(path):
    """That every value that all ranks together wrote comes back within the bound, on its place."""
    reader = readers(path)[1]
    wrong = []
    for step in range(STEPS):
        image = updated(reader, float(step))
        x0, x1, y0, y1, z0, z1 = image.GetExtent()
        for name, original in zip("pv", fields(step)):
            grid = original.reshape(SAMPLES[2], SAMPLES[1], SAMPLES[0], -1)
            mine = grid[z0:z1 + 1, y0:y1 + 1, x0:x1 + 1]
            found = compare_data.as_numpy(image.GetPointData().GetArray(name)).reshape(mine.shape)
            # All ranges are at most 2.
            if found.size == 0 or numpy.abs(found - mine).max() > 2 * BOUND:
                wrong.append(f"{name} at step {step}")
    return wrong


def compare_averages(path):
    """Temporal Statistics straight behind the reader, with the averages by their definition."""
    deferred, plain = readers(path)
    found = updated(simple.TemporalStatistics(Input=deferred)).GetPointData()
    steps = [compare_data.as_numpy(updated(plain, float(step)).GetPointData().GetArray("v"))
             for step in range(STEPS)]
    averages = numpy.mean(numpy.array(steps, dtype="f8"), axis=0)
    error = numpy.abs(compare_data.as_numpy(found.GetArray("v_average")) - averages).max()
    return [] if error < 1e-5 else [f"averages are wrong by {error}"]


def handed_by_script(path):
    """What a script takes from the reader and gives to a filter of VTK: numbers are right, the filter is doubted."""
    reader = simple.OpenDataFile(path)
    image = updated(reader)
    told = vtkStringOutputWindow()
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(told)
    compare_data.as_numpy(image.GetPointData().GetArray("p"))
    wrong = ["numpy brings: " + told.GetOutput()] if told.GetOutput() else []
    statistics = vtkContingencyStatistics()
    table = vtkTable()
    for name in ("n", "w"):
        table.AddColumn(image.GetPointData().GetArray(name))
    statistics.SetInputData(table)
    statistics.AddColumnPair("n", "w")
    statistics.Update()
    vtkOutputWindow.SetInstance(before)
    if image.GetNumberOfPoints() and told.GetOutput().count("put Banyan Decode between") != 1:
        wrong.append("no warning of the filter: " + told.GetOutput())
    return wrong


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--only", help="name of one filter")
    arguments = parser.parse_args()
    session.begin(arguments)
    path = make_series(arguments.out)
    failures = []

    def note(name, wrong):
        if wrong:
            failures.append(name)
        print(f"rank {controller().GetLocalProcessId()}: {name}: "
              f"{'; '.join(wrong) if wrong else 'equal'}", flush=True)

    total = 0
    for name, make in filter_list.FILTERS.items():
        if arguments.only in (None, name) and not ends_paraview(name):
            wrong, something = compare_filter(name, make, path)
            note(name, wrong)
            total += something > 0
    if arguments.only is None:
        for extension, (options, reader) in WRITERS.items():
            note("writer of " + extension,
                 compare_writer(extension, options, reader, path, arguments.out))
        note("values", compare_values(path))
        note("averages over time", compare_averages(path))
        note("handed by a script", handed_by_script(path))
        session.require(total >= 36, f"only {total} filters gave anything on this rank")
    if failures:
        sys.exit("different on deferred arrays: " + ", ".join(failures))


if __name__ == "__main__":
    main()
