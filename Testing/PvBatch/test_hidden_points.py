# SPDX-License-Identifier: BSD-3-Clause
"""What images hide comes back from a series to the bit: points, cells, the values below, and the picture.

    test_hidden_points.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

Writes series, compares them with their sources on every rank, and draws both. With --reference, the
folder of a run on another number of ranks, files are to be the same, byte for byte, and pictures within 1/255.
"""
import filecmp
import os

from paraview import simple

import pictures
import session

SAMPLES = (27, 22, 19)
# Pieces that share a layer, with a mask that moves, values that mean nothing below it, hidden cells that follow
# from no point, and flags of neighbours, which are none of the series' business.
DATA = """
import numpy
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
e = info.Get(executive.UPDATE_EXTENT())
image = self.GetOutputDataObject(0)
image.SetExtent(e)
image.SetSpacing(1.0, 1.25, 1.5)
def places(less):
    return numpy.meshgrid(*(numpy.arange(e[2 * a], e[2 * a + 1] + 1 - less) for a in (2, 1, 0)), indexing="ij")
z, y, x = places(0)
hidden = ((x - 9 - 4 * time) ** 2 + (y - 10) ** 2 + (z - 12) ** 2 < 40) | ((x * 7 + y * 5 + z * 3) % 23 == 0)
hidden &= time != LATE
wave = numpy.sin(0.3 * x + 0.5 * time) * numpy.cos(0.2 * y + 0.1 * z) + 1.5
def garbage(seed):
    return ((x * 73 + y * 179 + z * 283 + seed) % 1009) / 3.0 - 100
f = numpy.where(hidden, garbage(1), wave).astype("f4")
f[hidden & (x % 5 == 0)] = numpy.nan
output.PointData.append(f.ravel(), "f")
output.PointData.append(numpy.where(hidden, -30000 + x, 1000 * wave).astype("i2").ravel(), "i")
v = numpy.stack([numpy.where(hidden, garbage(c), c + wave).ravel() for c in range(3)], axis=1)
output.PointData.append(v, "v")
output.PointData.append((numpy.where(hidden, 2, 0) + SHARED * (x == e[0])).astype("u1").ravel(), "vtkGhostType")
z, y, x = places(1)
cells = ((x > 15) & (y < 9) & (z > 5)) & (time != LATE)
output.CellData.append((numpy.where(cells, 32, 0) + SHARED * (y == e[2])).astype("u1").ravel(), "vtkGhostType")
image.GetPointData().SetActiveScalars("f")
"""
INFORMATION = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Set(executive.WHOLE_EXTENT(), 0, 26, 0, 21, 0, 18)
info.Remove(executive.TIME_STEPS())
for time in (0.0, 1.0, 2.0):
    info.Append(executive.TIME_STEPS(), time)
info.Set(executive.TIME_RANGE(), [0.0, 2.0], 2)
info.Set(vtk.vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""
# Of the piece of each rank; says what differs.
COMPARE = """
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController
one, other = (self.GetInputDataObject(0, i) for i in (0, 1))
a, b = one.GetExtent(), other.GetExtent()
# Not all sources cut their data as they are asked to. (max and min are others here than those of Python.)
common = [a[i] if (a[i] > b[i]) == (i % 2 == 0) else b[i] for i in range(6)]
def values(image, kind, name):
    array = getattr(image, "Get" + kind)().GetArray(name)
    if array is None:
        return None
    e, less = image.GetExtent(), 0 if kind == "PointData" else 1
    shape = [e[2 * i + 1] - e[2 * i] + 1 - less for i in (2, 1, 0)]
    whole = vtk_to_numpy(array).reshape(shape + [-1])
    return whole[tuple(slice(common[2 * i] - e[2 * i], common[2 * i + 1] - e[2 * i] + 1 - less) for i in (2, 1, 0))]
mistakes = []
for kind in ("PointData", "CellData"):
    data = getattr(other, "Get" + kind)()
    for name in [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())] + ["vtkGhostType"]:
        first, second = values(one, kind, name), values(other, kind, name)
        if first is None and second is None:
            continue
        if first is None or second is None:
            mistakes.append("%s %s is not in both" % (kind, name))
            continue
        if name == "vtkGhostType":
            first = first & (2 if kind == "PointData" else 32 | 8)
        if first.dtype != second.dtype or first.tobytes() != second.tobytes():
            mistakes.append("%s %s: %s of %s differ" % (kind, name, (first != second).sum(), first.size))
controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId() if controller else 0
open("%s.%d" % (OUT, rank), "w").write("; ".join(mistakes))
"""


def moving(late=-1, shared=1):
    script = DATA.replace("LATE", str(late)).replace("SHARED", str(shared))
    return simple.ProgrammableSource(
        OutputDataSetType="vtkImageData", Script=script, ScriptRequestInformation=INFORMATION)


def compare(source, reader, times, out):
    """Every value of all ranks' pieces, and both ghost arrays."""
    judge = simple.ProgrammableFilter(
        Input=[source, reader], OutputDataSetType="vtkTable", Script=COMPARE.replace("OUT", repr(out)))
    for time in times:
        judge.UpdatePipeline(time)
        folder, name = os.path.split(out)
        found = [file for file in os.listdir(folder) if file.startswith(name + ".") and file[-1].isdigit()]
        session.require(found, "nothing was compared")
        for file in found:
            with open(os.path.join(folder, file)) as text:
                mistakes = text.read()
            session.require(not mistakes, f"{name} at time {time}, {file}: {mistakes}")
            os.remove(os.path.join(folder, file))
    simple.Delete(judge)


def write(folder, name, source, times=(0.0,), **options):
    path = os.path.join(folder, name + ".banyan")
    simple.SaveData(path, proxy=source, **options)
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline(times[0])
    return reader


def resampled(folder):
    """What limits.md advises for other grids, and filters behind it."""
    wavelet = simple.Wavelet(WholeExtent=[-10, 10] * 3)
    ball = simple.Clip(Input=wavelet, ClipType="Sphere")
    ball.ClipType.Center = [0, 0, 0]
    ball.ClipType.Radius = 8
    image = simple.ResampleToImage(Input=ball, SamplingDimensions=[20, 19, 18])
    onto = simple.ResampleWithDataset(SourceDataArrays=ball, DestinationMesh=simple.Wavelet(WholeExtent=[-9, 9] * 3))
    for name, source in (("to_image", image), ("onto_image", onto),
                         ("pass_arrays", simple.PassArrays(Input=image, PointDataArrays=["RTData"])),
                         ("calculator", simple.Calculator(Input=image, Function="RTData*2")),
                         ("to_points", simple.CellDatatoPointData(Input=image))):
        reader = write(folder, name, source, ErrorBound=0)
        compare(source, reader, [0.0], os.path.join(folder, name))
        points = reader.PointData["RTData"].GetRange()
        expected = source.PointData["RTData"].GetRange()
        session.require(points == expected, f"{name}: range {points} instead of {expected}")
    return image, simple.OpenDataFile(os.path.join(folder, "to_image.banyan"))


def filters_agree(source, reader, time):
    """Counts and ranges of what filters make, which leave out what is hidden."""
    def threshold(s):
        return simple.Threshold(Input=s, Scalars=["POINTS", "f"], LowerThreshold=-1e9, UpperThreshold=1e9)

    makers = {"contour": lambda s: simple.Contour(Input=s, ContourBy=["POINTS", "f"], Isosurfaces=[1.5]),
              "slice": lambda s: simple.Slice(Input=s, SliceType="Plane"),
              "threshold": threshold, "decode": simple.BanyanDecode}
    for name, make in makers.items():
        found = []
        for one in (source, reader):
            made = make(one)
            made.UpdatePipeline(time)
            info = made.GetDataInformation()
            found.append((info.GetNumberOfPoints(), info.GetNumberOfCells(), info.GetBounds()))
            simple.Delete(made)
        session.require(found[0] == found[1], f"{name}: {found}")


def draw(source, array, time, path, representation=session.REPRESENTATION):
    view = session.new_view((200, 180), CameraPosition=[60, 50, 70], CameraFocalPoint=[13, 13, 13])
    display = simple.Show(source, view)
    display.SetRepresentationType(representation)
    simple.ColorBy(display, ("POINTS", array))
    colors, opacity = simple.GetColorTransferFunction(array), simple.GetOpacityTransferFunction(array)
    colors.AutomaticRescaleRangeMode = "Never"
    low, high = (500, 2500) if array == "i" else (0.5, 2.5)
    colors.RGBPoints = [low, 0, 0, 1, high, 1, 0.5, 0]
    opacity.Points = [low, 0.1, 0.5, 0, high, 0.3, 0.5, 0]
    display.ScalarOpacityUnitDistance = 2.0
    view.ViewTime = time
    simple.SaveScreenshot(path, view, ImageResolution=[200, 180])
    simple.Delete(view)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    session.begin(arguments)
    out = arguments.out
    os.makedirs(out, exist_ok=True)
    times = (0.0, 1.0, 2.0)
    source = moving()
    modes = {"exact": {"ErrorBound": 0}, "relative": {"ErrorBound": 1e-3},
             "asinh": {"ErrorBound": 1e-3, "Transform": "Asinh", "KeyframeInterval": 2}}
    readers = {name: write(out, name, source, times, **options) for name, options in modes.items()}
    compare(source, readers["exact"], times, os.path.join(out, "exact"))
    # Nothing is hidden at first: one pass does not know.
    late = moving(late=0)
    compare(late, write(out, "late", late, times, ErrorBound=0), times, os.path.join(out, "late"))
    resampled(out)
    # Since VTK 9.3 filters leave out cells of neighbours, too.
    filters_agree(moving(shared=0), readers["exact"], 1.0)
    for array in ("f", "i", "v"):
        for time in (0.0, 2.0):
            for name, one in (("source", source), ("series", readers["exact"])):
                draw(one, array, time, os.path.join(out, f"{array}_{time}_{name}.png"))
            pictures.require_near(os.path.join(out, f"{array}_{time}_series.png"),
                                  os.path.join(out, f"{array}_{time}_source.png"), 3)
    drawn = pictures.load(os.path.join(out, "f_0.0_series.png"))
    moved = pictures.load(os.path.join(out, "f_2.0_series.png"))
    session.require(pictures.difference(drawn, moved).max() > 20, "the mask does not move")
    if arguments.reference:
        for file in sorted(os.listdir(arguments.reference)):
            mine = os.path.join(out, file)
            theirs = os.path.join(arguments.reference, file)
            if file.endswith(".png"):
                pictures.require_near(mine, theirs)
            elif file in ("exact.banyan", "relative.banyan", "asinh.banyan", "late.banyan"):
                session.require(filecmp.cmp(mine, theirs, shallow=False), f"{file} depends on the number of ranks")


if __name__ == "__main__":
    main()
