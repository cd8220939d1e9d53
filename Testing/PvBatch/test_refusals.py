# SPDX-License-Identifier: BSD-3-Clause
"""Bad input makes SaveData and OpenDataFile raise, with a sentence that says why, and leaves nothing.

    test_refusals.py --plugin Banyan.so --out FOLDER

The files that were broken on purpose are looked for in BANYAN_DATA_DIR/malformed_basic; without
them only what can be made here is tested.
"""
import glob
import os
import shutil
import sys

import numpy
from paraview import simple

import make_series
import session

BROKEN = {
    "m01_short.mhd": "data not read completely",
    "m03_missing.mhd": "cannot read data",
    "v11_trunc.vti": "image is empty",
}
AWKWARD = ("m07_one.mhd", "v01_nan.vti", "v04_const.vti", "v07_2d.vti")
MODES = ({}, {"ErrorBoundMode": "Absolute", "ErrorBound": 0.5})


def expect_refusal(what, call, mention):
    """That a call raises an error which mentions something."""
    try:
        call()
    except RuntimeError as error:
        print(f"{what}: {error}", flush=True)
        session.require(mention in str(error), f"{what}: no '{mention}' in '{error}'")
        return
    raise AssertionError(f"{what}: nothing was raised")


def expect_no_series(what, source, folder, mention, **options):
    path = os.path.join(folder, "refused.banyan")
    expect_refusal(what, lambda: simple.SaveData(path, proxy=source, **options), mention)
    session.require(not glob.glob(path + "*"), f"{what}: something was left behind")


def broken_files(data, folder):
    for name, mention in BROKEN.items():
        source = simple.OpenDataFile(os.path.join(data, name))
        for mode in MODES:
            expect_no_series(name, source, folder, mention, **mode)
    dims = simple.OpenDataFile(sorted(glob.glob(data + "/series_trouble/dims_*.vti")))
    for mode in MODES:
        expect_no_series("dims", dims, folder, "At step 1 (time 1)", **mode)
    for name in AWKWARD:
        path = os.path.join(folder, "good.banyan")
        source = simple.OpenDataFile(os.path.join(data, name))
        source.UpdatePipeline()
        simple.SaveData(path, proxy=source)
        reader = simple.OpenDataFile(path)
        reader.UpdatePipeline()
        session.require(reader.GetDataInformation().GetNumberOfPoints() > 0, f"{name}: no points")


def changing_series(folder):
    """Files that ParaView presents as if they were like the first one."""
    first = make_series.write_step(folder, "change", 0, (9, 9, 9), (1.0, 1.0, 1.0))
    changed = {
        "dims": (make_series.write_step(folder, "dims", 1, (9, 8, 9), (1.0, 1.0, 1.0)),
                 "extent was 0..8 x 0..8 x 0..8 and is 0..8 x 0..7 x 0..8"),
        "spacing": (make_series.write_step(folder, "spacing", 1, (9, 9, 9), (1.0, 1.0, 2.0)),
                    "spacing was (1, 1, 1) and is (1, 1, 2)"),
        "type": (make_series.write_step(folder, "type", 1, (9, 9, 9), (1.0, 1.0, 1.0)),
                 "of type float and are of type short"),
    }
    with open(changed["type"][0], "r+", encoding="ascii") as file:
        header = file.read().replace("MET_FLOAT", "MET_SHORT")
        file.seek(0)
        file.write(header)
    for what, (second, mention) in changed.items():
        source = simple.OpenDataFile([first, second])
        for mode in MODES:
            expect_no_series(what, source, folder, mention, **mode)


def cell_data(folder):
    cells = simple.PointDatatoCellData(Input=simple.Wavelet())
    expect_no_series("cell data", cells, folder, "'Cell Data to Point Data'")


def bad_options(folder):
    wavelet = simple.Wavelet()
    expect_no_series("bound", wavelet, folder, "ErrorBound", ErrorBound=-1)
    expect_no_series("interval", wavelet, folder, "key-frame interval", KeyframeInterval=0)
    expect_no_series("array", wavelet, folder, "there are: RTData", PointArrays=["nothere"])
    expect_refusal("folder", lambda: simple.SaveData(
        os.path.join(folder, "no/such/x.banyan"), proxy=wavelet), "no/such")


def damaged_series(folder):
    path = os.path.join(folder, "damaged.banyan")
    simple.SaveData(path, proxy=simple.Wavelet(), ErrorBound=0)
    segment = glob.glob(path + ".d/*")[0]
    with open(segment, "rb") as file:
        good = file.read()
    with open(path, "rb") as file:
        index = file.read()

    def with_bytes(name, content, call, mention):
        with open(segment if name.startswith("segment") else path, "wb") as file:
            file.write(content)
        expect_refusal(name, call, mention)
        with open(segment, "wb") as file:
            file.write(good)
        with open(path, "wb") as file:
            file.write(index)

    def update():
        simple.BanyanSeriesReader(FileName=path).UpdatePipeline()

    numpy.random.seed(3)
    middle = len(good) // 2
    flipped = good[:middle] + bytes([good[middle] ^ 1]) + good[middle + 1:]
    with_bytes("segment, one bit", flipped, update, "damaged.banyan")
    with_bytes("segment, cut", good[:middle], lambda: simple.OpenDataFile(path), "it is cut short")
    with_bytes("index, cut", index[:-9], lambda: simple.OpenDataFile(path), "cut short")
    with_bytes("index, other", b"what is this?", update, "not a Banyan series")
    with_bytes("index, empty", b"", lambda: simple.OpenDataFile(path), "not a Banyan series")
    update()


def half_copied(folder):
    """A series without its folder, under another name, and through links."""
    data, work = os.path.join(folder, "data"), os.path.join(folder, "work")
    for place in (data, work):
        os.makedirs(place)
    path = os.path.join(data, "whole.banyan")
    simple.SaveData(path, proxy=simple.Wavelet(WholeExtent=[0, 4] * 3))
    renamed, linked = os.path.join(data, "renamed.banyan"), os.path.join(work, "linked.banyan")
    alone = os.path.join(work, "alone.banyan")
    shutil.copy(path, renamed)
    shutil.copy(path, alone)
    os.symlink("../data/whole.banyan", linked)
    for good in (path, renamed, linked):
        reader = simple.OpenDataFile(good)
        reader.UpdatePipeline()
        session.require(reader.GetDataInformation().GetExtent() == (0, 4) * 3, good)
    for mention in ("alone.banyan.d", "copy or move both"):
        expect_refusal("alone", lambda: simple.OpenDataFile(alone), mention)
    expect_refusal("folder", lambda: simple.OpenDataFile(path + ".d"), "open the file of the series")


def other_kinds(folder):
    """What cannot be a series: the writer claims the name, and says what to do."""
    kinds = {
        "surface": (simple.Sphere(), "'Resample To Image'"),
        "blocks": (simple.GroupDatasets(Input=[simple.Sphere(), simple.Cone()]), "vtkMultiBlock"),
        "table": (simple.ProgrammableSource(OutputDataSetType="vtkTable"), "'Table To Structured Grid'"),
        "rectilinear": (simple.ProgrammableSource(OutputDataSetType="vtkRectilinearGrid"), "is empty"),
        "curvilinear": (simple.ProgrammableSource(OutputDataSetType="vtkStructuredGrid"), "is empty"),
        "failure": (simple.LegacyVTKReader(FileNames=["nowhere.vtk"]), "nowhere.vtk"),
    }
    for what, (source, mention) in kinds.items():
        expect_no_series(what, source, folder, mention)


STEPS = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Set(executive.WHOLE_EXTENT(), 0, 4, 0, 4, 0, 4)
for time in (0.0, 1.0, 2.0):
    info.Append(executive.TIME_STEPS(), time)
info.Set(executive.TIME_RANGE(), [0.0, 2.0], 2)
"""
STEP = """
import sys
import numpy
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
self.GetOutputDataObject(0).SetExtent(info.Get(executive.UPDATE_EXTENT()))
count = self.GetOutputDataObject(0).GetNumberOfPoints()
output.PointData.append(numpy.log(numpy.arange(count) + 0.0), "a")
print("step", time, "done", file=sys.stderr)
"""


def scripts(folder):
    """A script's warnings, and what else it writes to its standard error, are no failure of it."""
    path = os.path.join(folder, "warns.banyan")
    for mode in MODES:
        warns = simple.ProgrammableSource(
            OutputDataSetType="vtkImageData", Script=STEP, ScriptRequestInformation=STEPS)
        simple.SaveData(path, proxy=warns, **mode)
        times = list(simple.OpenDataFile(path).TimestepValues)
        session.require(times == [0, 1, 2], f"warnings: {times}")
        for line in ("if time == 1: raise ValueError('no such file: alpha')", "work(", "nothere"):
            raises = simple.ProgrammableSource(OutputDataSetType="vtkImageData", Script=STEP + line,
                                               ScriptRequestInformation=STEPS)
            mention = {"i": "ValueError: no such file: alpha", "w": "SyntaxError: ",
                       "n": "NameError: name 'nothere'"}[line[0]]
            expect_no_series("script", raises, folder, "The input cannot be read: " + mention, **mode)
            # The error holds the writer. ParaView 6 hangs where the next error lets go of it while ranks update.
            sys.last_exc = sys.last_value = sys.last_traceback = None


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--fail", action="store_true", help="save what cannot be saved, and stop")
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    if arguments.fail:
        # Not caught: the process has to end with a status other than 0.
        cell_data_only = simple.PointDatatoCellData(Input=simple.Wavelet())
        simple.SaveData(os.path.join(arguments.out, "x.banyan"), proxy=cell_data_only)
        sys.exit(0)
    cell_data(arguments.out)
    bad_options(arguments.out)
    changing_series(arguments.out)
    damaged_series(arguments.out)
    half_copied(arguments.out)
    other_kinds(arguments.out)
    scripts(arguments.out)
    data = os.path.join(os.environ.get("BANYAN_DATA_DIR", ""), "malformed_basic")
    if os.path.isdir(data):
        broken_files(data, arguments.out)


if __name__ == "__main__":
    main()
