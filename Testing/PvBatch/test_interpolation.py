# SPDX-License-Identifier: BSD-3-Clause
"""Times between two steps: ParaView shows values between theirs, drawn from the file and decoded.

The values grow evenly with the time, so that what is between the steps is known: at each time the
picture is that of the source. With --reference, pictures must be those of another run, too.

    test_interpolation.py --out DIR [--reference DIR]
"""
import os

import numpy
from paraview import simple

import picture_scenes
import pictures
import session

SIZE = (300, 240)
TIMES = (0.0, 1.0, 3.0)
INFORMATION = session.time_information(TIMES)
IMAGE_INFORMATION = INFORMATION + """
info.Set(executive.WHOLE_EXTENT(), 0, 40, 0, 32, 0, 20)
info.Set(vtk.vtkDataObject.ORIGIN(), -20.0, -16.0, -10.0)
info.Set(vtk.vtkDataObject.SPACING(), 1.0, 1.0, 1.0)
info.Set(vtk.vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""
IMAGE = """
import numpy
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
e = info.Get(executive.UPDATE_EXTENT())
image = self.GetOutputDataObject(0)
image.SetExtent(e)
image.SetOrigin(-20.0, -16.0, -10.0)
image.SetSpacing(1.0, 1.0, 1.0)
z, y, x = numpy.meshgrid(*(numpy.arange(e[2 * a], e[2 * a + 1] + 1) for a in (2, 1, 0)),
                         indexing="ij")
grown = 0.1 + 0.1 * numpy.sin(0.3 * x) + 0.25 * time * (0.5 + 0.5 * numpy.cos(0.2 * y + 0.1 * z))
output.PointData.append(grown.astype("f4").ravel(), "grown")
"""
# Two hexahedra on the first rank.
MESH = """
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
from vtkmodules.vtkParallelCore import vtkMultiProcessController
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
controller = vtkMultiProcessController.GetGlobalController()
grid = self.GetOutputDataObject(0)
points = vtkPoints()
values, means = vtkDoubleArray(), vtkDoubleArray()
values.SetName("value")
means.SetName("mean")
if not controller or controller.GetLocalProcessId() == 0:
    for i in range(12):
        points.InsertNextPoint(i // 4, i % 4 // 2, i % 2)
        values.InsertNextValue(i + time * (i - 3))
    grid.Allocate(2)
    for first in (0, 4):
        corners = [first, first + 4, first + 6, first + 2, first + 1, first + 5, first + 7, first + 3]
        grid.InsertNextCell(12, 8, corners)
        means.InsertNextValue(first - 2 * time)
grid.SetPoints(points)
grid.GetPointData().AddArray(values)
grid.GetCellData().AddArray(means)
"""


def scripted(kind, script, information):
    return simple.ProgrammableSource(OutputDataSetType=kind, ScriptRequestInformation=information,
                                     Script=script)


class Pictures:
    def __init__(self, arguments):
        self.out, self.reference = arguments.out, arguments.reference

    def draw(self, shown, time, name, strength=0.0, view=None):
        """The picture at a time: in a view of its own, or in one that plays."""
        mine = view or self.view()
        if not view or not mine.Representations:
            display = picture_scenes.volume(shown, mine, "grown", 1.0, (0.0, 1.0),
                                            opacities=(0.05, 0.05, 0.05, 0.05, 0.05))
            # Larger values are brighter: so pixels between those of the steps are right.
            display.LookupTable.RGBPoints = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]
            display.SampleDistanceVoxels = 0.5
            display.TemporalEnhancement = strength
        mine.ViewTime = time
        path = os.path.join(self.out, name + ".png")
        simple.SaveScreenshot(path, mine, ImageResolution=list(SIZE))
        if not view:
            simple.Delete(mine)
        if self.reference:
            pictures.require_near(path, os.path.join(self.reference, name + ".png"))
        return pictures.load(path)

    @staticmethod
    def view():
        return session.new_view(SIZE, CameraPosition=[60, -70, 50], CameraFocalPoint=[0, 0, 0],
                                CameraViewUp=[0, 0, 1])


def same(a, b, most, what):
    worst = pictures.difference(a, b).max()
    session.require(worst <= most, f"{what}: {worst}/255 apart")


def differ(a, b, what):
    session.require(pictures.difference(a, b).max() > 10, f"{what}: the same picture")


def check_pictures(keep, series, truth):
    steps = {time: keep.draw(series, time, f"step{time:g}") for time in TIMES}
    off = keep.draw(series, 2.0, "off")
    same(off, steps[1.0], 0, "switched off, the step before is shown")
    series.InterpolateInTime = 1
    for time, step in steps.items():
        same(keep.draw(series, time, f"on{time:g}"), step, 0, f"the step at {time:g}")
    same(keep.draw(series, -1.0, "before"), steps[0.0], 0, "before the first step")
    same(keep.draw(series, 99.0, "after"), steps[3.0], 0, "after the last step")
    between = keep.draw(series, 2.0, "between")
    differ(between, steps[1.0], "between, and the step before")
    differ(between, steps[3.0], "between, and the step after")
    low, high = (numpy.minimum, numpy.maximum)
    inside = (between >= low(steps[1.0], steps[3.0]) - 1) & (
        between <= high(steps[1.0], steps[3.0]) + 1)
    session.require(inside.all(), f"{(~inside).sum()} pixels are not between those of the steps")
    played = (0.0, 0.25, 0.5, 0.75, 1.0, 2.0, 0.75, 3.0, 0.25)
    known = {time: keep.draw(truth, time, f"truth{time:g}") for time in sorted(set(played))}
    for time in (0.25, 0.75, 2.0):
        same(keep.draw(series, time, f"between{time:g}"), known[time], 1, f"the source at {time:g}")
    decoded = simple.BanyanDecode(Input=series)
    same(between, keep.draw(decoded, 2.0, "decoded"), 1, "from the file, and decoded")
    # Frames that know those before show nothing old.
    view = keep.view()
    for time in played:
        same(keep.draw(series, time, f"played{time:g}", view=view), known[time], 1,
             f"played, at {time:g}")
    simple.Delete(view)
    # Enhancement compares steps.
    same(keep.draw(series, 2.0, "enhanced", 0.5), keep.draw(series, 1.0, "enhanced_step", 0.5), 0,
         "enhanced, of the step before")


def check_animation(series):
    """The slider asks for times between steps unless it snaps to them."""
    view = session.new_view(SIZE)
    simple.Show(series, view).SetRepresentationType("Outline")
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.PlayMode = "Sequence"
    scene.StartTime, scene.EndTime, scene.NumberOfFrames = 0.0, 3.0, 7
    probe = simple.Calculator(Input=series, Function="grown", ResultArrayName="copy")
    simple.Show(probe, view).SetRepresentationType("Outline")
    seen = []
    scene.GoToFirst()
    for _ in range(7):
        seen.append(probe.PointData["copy"].GetRange()[1])
        scene.GoToNext()
    expected = numpy.linspace(seen[0], seen[-1], 7)
    session.require(seen[-1] > seen[0] + 0.5 and abs(numpy.array(seen) - expected).max() < 0.02,
                    f"largest values {seen} of an animation")
    scene.PlayMode = "Snap To TimeSteps"
    simple.Delete(view)


def check_mesh(folder):
    mesh = scripted("vtkUnstructuredGrid", MESH, INFORMATION)
    path = os.path.join(folder, "mesh.banyan")
    simple.SaveData(path, proxy=mesh, WriteTimeSteps=1, ErrorBound=0, PointArrays=["value"],
                    CellArrays=["mean"])
    plain, series = simple.OpenDataFile(path), simple.OpenDataFile(path)
    series.InterpolateInTime = 1
    for trees in (0, 1):
        plain.MeshAsHyperTreeGrid = series.MeshAsHyperTreeGrid = trees
        copies = []
        for reader in (plain, series):
            copy = simple.Calculator(Input=reader, Function="mean", ResultArrayName="copy",
                                     AttributeType="Cell Data")
            copies.append([])
            for time in (1.0, 3.0, 2.0):
                copy.UpdatePipeline(time)
                copies[-1].append(copy.CellData["copy"].GetRange())
            simple.Delete(copy)
        (first, last, held), (again, end, between) = copies
        session.require((first, last) == (again, end), f"steps of the mesh: {copies}")
        session.require(held == first, f"not interpolated, {held} instead of {first}")
        session.require(numpy.allclose(between, (numpy.array(first) + last) / 2) and between != first,
                        f"between {first} and {last}: {between}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference", help="pictures of another run")
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    truth = scripted("vtkImageData", IMAGE, IMAGE_INFORMATION)
    path = os.path.join(arguments.out, "grown.banyan")
    simple.SaveData(path, proxy=truth, WriteTimeSteps=1, ErrorBound=1 / 65536)
    series = simple.OpenDataFile(path)
    check_pictures(Pictures(arguments), series, truth)
    check_animation(series)
    check_mesh(arguments.out)
    session.clear()
    print("Values between steps by all ways.")


if __name__ == "__main__":
    main()
