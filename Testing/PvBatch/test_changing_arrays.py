# SPDX-License-Identifier: BSD-3-Clause
"""Arrays that come later, and sources that have the present step alone: saved with a word, or not at all.

    test_changing_arrays.py --plugin Banyan.so --out FOLDER
"""
import json
import os

from paraview import servermanager, simple, vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import session
from test_refusals import expect_no_series


class Warnings:
    """What the writer of SaveData warns of."""

    def __init__(self):
        self.text = ""
        self.window = vtk.vtkOutputWindow.GetInstance()
        self.tag = self.window.AddObserver("WarningEvent", self.take)

    def take(self, _window, _event, text=""):
        self.text += text

    take.CallDataType = vtk.VTK_STRING

    def end(self):
        self.window.RemoveObserver(self.tag)
        return self.text


def write_series(path, source, **options):
    """The names of the arrays that are in the series, and what was said."""
    warnings = Warnings()
    simple.SaveData(path, proxy=source, **options)
    said = warnings.end()
    with open(path) as file:
        index = json.loads(file.read().split("\n", 1)[1])
    return [array["name"] for array in index["arrays"]], said, index["times"]


def write_files(folder, name, arrays):
    """A file per step with these arrays: pairs of name and type."""
    paths = []
    for step, there in enumerate(arrays):
        image = vtkImageData()
        image.SetDimensions(6, 5, 4)
        for array_name, kind in there:
            array = kind()
            array.SetName(array_name)
            array.SetNumberOfTuples(120)
            for i in range(120):
                array.SetValue(i, i + step)
            image.GetPointData().AddArray(array)
        paths.append(os.path.join(folder, f"{name}_{step}.vti"))
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(paths[-1])
        writer.SetDataModeToBinary()
        writer.SetInputData(image)
        writer.Write()
    series = os.path.join(folder, name + ".vti.series")
    with open(series, "w") as file:
        json.dump({"file-series-version": "1.0", "files": [
            {"name": os.path.basename(path), "time": 10.0 + step} for step, path in enumerate(paths)]}, file)
    return paths, series




def in_files(folder):
    real, whole = vtk.vtkFloatArray, vtk.vtkIntArray
    paths, series = write_files(folder, "late", [[("a", real)], [("a", real), ("extra", real)]])
    for name, source in (("list", simple.OpenDataFile(paths)), ("series", simple.OpenDataFile(series))):
        for mode in ({}, {"ErrorBoundMode": "Absolute", "ErrorBound": 0.5}):
            names, said, _ = write_series(os.path.join(folder, "late.banyan"), source, **mode)
            session.require(names == ["a"], f"{name}: {names}")
            session.require("point array extra first appears at step 1" in said, f"{name}: {said}")
    # A filter in between makes no difference.
    behind = simple.Calculator(Input=simple.OpenDataFile(paths), Function="a*2", ResultArrayName="b")
    _, said, _ = write_series(os.path.join(folder, "behind.banyan"), behind)
    session.require("point array extra first appears at step 1" in said, f"behind: {said}")
    # One that was left out on purpose is not missed.
    paths, _ = write_files(folder, "chosen", [[("a", real), ("b", real)], [("a", real), ("b", real), ("extra", real)]])
    names, said, _ = write_series(os.path.join(folder, "chosen.banyan"), simple.OpenDataFile(paths), PointArrays=["a"])
    session.require(names == ["a"] and "extra" not in said, f"chosen: {names} {said}")
    expect_no_series("named", simple.OpenDataFile(paths), folder, "There is no point array extra",
                     PointArrays=["a", "extra"])
    paths, _ = write_files(folder, "gone", [[("a", real), ("b", real)], [("a", real)]])
    expect_no_series("gone", simple.OpenDataFile(paths), folder, "b")
    paths, _ = write_files(folder, "type", [[("a", real)], [("a", whole)]])
    expect_no_series("type", simple.OpenDataFile(paths), folder, "the array a was float32 and is int32")


MESH = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
rank = info.Get(executive.UPDATE_PIECE_NUMBER())
grid = self.GetOutputDataObject(0)
image = vtk.vtkImageData()
image.SetDimensions(4, 4, 4)
image.SetOrigin(0, 0, 3 * rank)
append = vtk.vtkAppendFilter()
append.AddInputData(image)
append.Update()
grid.ShallowCopy(append.GetOutput())
heights = vtk_to_numpy(grid.GetPoints().GetData())[:, 2].astype("f4")
def add(data, name, values):
    array = numpy_to_vtk(numpy.ascontiguousarray(values + time), deep=1)
    array.SetName(name)
    data.AddArray(array)
add(grid.GetPointData(), "p", heights)
add(grid.GetCellData(), "c", numpy.arange(27, dtype="f4"))
if time > 0:
    add(grid.GetPointData(), "late p", heights)
    add(grid.GetCellData(), "late c", numpy.arange(27, dtype="f4"))
if HIDES:
    flags = numpy_to_vtk(numpy.array([32] + 26 * [0], dtype="u1"), deep=1)
    flags.SetName("vtkGhostType")
    grid.GetCellData().AddArray(flags)
"""
MESH_INFORMATION = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Remove(executive.TIME_STEPS())
for time in (0.0, 1.0):
    info.Append(executive.TIME_STEPS(), time)
info.Set(executive.TIME_RANGE(), [0.0, 1.0], 2)
info.Set(vtk.vtkAlgorithm.CAN_HANDLE_PIECE_REQUEST(), 1)
"""


def of_meshes(folder):
    for hides in (False, True):
        mesh = simple.ProgrammableSource(
            OutputDataSetType="vtkUnstructuredGrid", Script=MESH.replace("HIDES", str(hides)),
            ScriptRequestInformation=MESH_INFORMATION)
        mesh.UpdatePipeline(0.0)
        names, said, _ = write_series(os.path.join(folder, "mesh.banyan"), mesh)
        session.require(names == ["p", "c"], f"mesh: {names}")
        for name in ("point array late p", "cell array late c"):
            session.require(f"{name} first appears at step 1 (time 1)" in said, f"mesh: {said}")
        session.require(("Hidden cells of the mesh are not written" in said) == hides, f"mesh: {said}")


PRESENT = """
image = self.GetOutputDataObject(0)
image.SetExtent(self.GetExecutive().GetOutputInformation(0).Get(self.GetExecutive().UPDATE_EXTENT()))
values = vtk.vtkFloatArray()
values.SetName("a")
values.SetNumberOfTuples(image.GetNumberOfPoints())
values.Fill(3)
image.GetPointData().AddArray(values)
image.GetInformation().Set(vtk.vtkDataObject.DATA_TIME_STEP(), 5.0)
"""


def present_on_all_ranks(folder):
    extent = "info.Set(executive.WHOLE_EXTENT(), 0, 5, 0, 5, 0, 5)\n"
    source = simple.ProgrammableSource(OutputDataSetType="vtkImageData", Script=PRESENT,
                                       ScriptRequestInformation=MESH_INFORMATION + extent)
    for mode in ({}, {"ErrorBoundMode": "Absolute", "ErrorBound": 0.5}):
        expect_no_series("present on all ranks", source, folder, "delivers data of time 5", **mode)
        _, _, times = write_series(os.path.join(folder, "present.banyan"), source, WriteTimeSteps=0, **mode)
        session.require(times == [5.0], f"{times} instead of 5")


def present_only(folder):
    """The producer of ParaView's Catalyst adaptors lists the times that it had."""
    wavelet = simple.Wavelet(WholeExtent=[0, 5] * 3)
    wavelet.UpdatePipeline()
    image = wavelet.GetClientSideObject().GetOutputDataObject(0)
    producer = simple.PVTrivialProducer()
    catalyst = producer.GetClientSideObject()
    for time in (0.0, 0.0, 1.0, 2.0):
        catalyst.SetOutput(image, time)
        producer.UpdatePipelineInformation()
        producer.UpdatePipeline(time)
        _, _, times = write_series(os.path.join(folder, f"present_{time}.banyan"), producer, WriteTimeSteps=0)
        session.require(times == [time], f"{times} instead of {time}")
    # Since ParaView 6 the producer lists each time once, and still delivers the last data only.
    listed = catalyst.GetOutputInformation(0).Length(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    expect_no_series("times twice", producer, folder,
                     "do not increase" if listed == 4 else "and delivers data of time 2")
    other = simple.PVTrivialProducer()
    for time in (0.0, 1.0, 2.0):
        other.GetClientSideObject().SetOutput(image, time)
        other.UpdatePipelineInformation()
    for source in (other, simple.Calculator(Input=other, Function="RTData*2")):
        expect_no_series("present only", source, folder,
                         "lists the time 0, and delivers data of time 2 when it is asked for that")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    in_files(arguments.out)
    of_meshes(arguments.out)
    present_on_all_ranks(arguments.out)
    if servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 1:
        present_only(arguments.out)


if __name__ == "__main__":
    main()
