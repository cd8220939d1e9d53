# SPDX-License-Identifier: BSD-3-Clause
"""Real meshes of curved hexahedra, and of mixed cells, are drawn by "Banyan Volume", and kept as they are, or as boxes.

    test_general_meshes.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
Otherwise they are compared with ParaView's own "Volume" of the same data, which cuts cells into tetrahedra.
Without BANYAN_DATA_DIR there is nothing to do.
"""
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import pictures
import session

# File, array, boxes allowed in a series, what must be said of it, and the largest mean difference from ParaView's
# own picture, in 1/255.
MESHES = {
    "mountain": ("specfem_mount_st_helens/specfem_mount_st_helens.vtu", ("POINTS", "elevation"),
                 100000, "", 8.0),
    "reactor": ("disk_out_ref/disk_out_ref.vtu", ("POINTS", "Temp"), 200000, "", 8.0),
    "blocks": ("block_crush/block_crush_005.vtu", ("POINTS", "displ_"), 100000,
               "Not drawn: 1 cell, cell", None),
}
SAMPLING_TOLERANCE = 0.5


class Said:
    """What ParaView says meanwhile."""

    def __enter__(self):
        self.window = vtkStringOutputWindow()
        self.before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)

    def text(self):
        return self.window.GetOutput()


def show(source, array, kind):
    view = session.new_view((200, 200))
    display = simple.Show(source, view)
    simple.ColorBy(display, array)
    display.SetRepresentationType(kind)
    bounds = source.GetDataInformation().GetBounds()
    display.ScalarOpacityUnitDistance = 0.4 * (bounds[5] - bounds[4])
    view.ResetCamera()
    simple.GetActiveCamera().Azimuth(30)
    simple.GetActiveCamera().Elevation(30)
    view.ResetCamera()
    return view, display


def draw(path, view):
    simple.Render(view)
    simple.SaveScreenshot(path, view)
    return pictures.load(path).astype(float)


def draw_mesh(data, out, name, reference):
    file, array, _, sentence, allowed = MESHES[name]
    source = simple.OpenDataFile(os.path.join(data, file))
    source.UpdatePipeline()
    path = os.path.join(out, name + ".png")
    with Said() as said:
        view, display = show(source, array, session.REPRESENTATION)
        picture = draw(path, view)
    print(f"{name}: {said.text()}", flush=True)
    session.require("was not drawn" not in said.text(), f"{name} was not drawn")
    session.require(sentence in said.text(), f"{name}: '{sentence}' was not said")
    session.require(abs(picture - picture[0, 0]).max() > 60, f"{name} is empty")
    if reference:
        pictures.require_near(path, os.path.join(reference, name + ".png"))
    elif allowed is not None:
        camera = view.CameraPosition[:], view.CameraFocalPoint[:]
        simple.Hide(source, view)
        view, display = show(source, array, "Volume")
        display.SelectMapper = "Bunyk ray cast"
        view.CameraPosition, view.CameraFocalPoint = camera
        other = draw(os.path.join(out, name + "_paraview.png"), view)
        mean = abs(picture - other).mean()
        print(f"{name}: {mean:.2f} of 255 from ParaView's own on average", flush=True)
        session.require(mean <= allowed, f"{name} is {mean:.2f} from ParaView's own picture")
    session.clear()


def keep(data, out, name, alone):
    """Such a mesh is kept in a series as it is, or as boxes, and drawn as those that the filter makes of it."""
    file, array, boxes, _, _ = MESHES[name]
    source = simple.OpenDataFile(os.path.join(data, file))
    path = os.path.join(out, name + ".banyan")
    simple.SaveData(path, proxy=source, ErrorBound=0.0)
    kept = simple.OpenDataFile(path)
    kept.UpdatePipeline()
    source.UpdatePipeline()
    mine, theirs = (each.GetDataInformation() for each in (source, kept))
    counts = [(each.GetNumberOfCells(), each.GetBounds()) for each in (mine, theirs)]
    session.require(counts[0] == counts[1], f"{name}: {counts}")
    # Ranks read runs of cells, and points between these are on several.
    points = [each.GetNumberOfPoints() for each in (mine, theirs)]
    session.require(points[0] == points[1] if alone else points[0] <= points[1], f"{name}: {points} points")
    ranges = [each.PointData[array[1]].GetRange(0) for each in (source, kept)]
    session.require(ranges[0] == ranges[1], f"{name}: {ranges}")
    simple.Delete(kept)
    sampled = simple.BanyanHexOctree(Input=source, SampleGeneralMeshes=1,
                                     MeshSamplingTolerance=SAMPLING_TOLERANCE, MeshSamplingBoxes=boxes)
    sampled.UpdatePipeline()
    simple.SaveData(path, proxy=sampled, PointArrays=[array[1]], CellArrays=["octree_level"],
                    ErrorBound=1e-4)
    series = simple.OpenDataFile(path)
    series.UpdatePipeline()
    counts = [s.GetDataInformation().GetNumberOfCells() for s in (sampled, series)]
    session.require(counts[0] == counts[1] > 1000, f"{name}: {counts} cells")
    ranges = [s.CellData["octree_level"].GetRange() for s in (sampled, series)]
    session.require(ranges[0] == ranges[1], f"{name}: levels {ranges}")
    drawn, camera, unit, limits = [], None, None, source.PointData[array[1]].GetRange(0)
    for kind, shown in (("boxes", sampled), ("series", series)):
        view, display = show(shown, array, session.REPRESENTATION)
        for table in (simple.GetColorTransferFunction(array[1]), simple.GetOpacityTransferFunction(array[1])):
            table.RescaleTransferFunction(*limits)
        unit = unit or display.ScalarOpacityUnitDistance
        display.ScalarOpacityUnitDistance = unit
        display.SampleDistanceVoxels = 0.5  # not as errors are estimated
        camera = camera or (view.CameraPosition[:], view.CameraFocalPoint[:], view.CameraParallelScale)
        view.CameraPosition, view.CameraFocalPoint, view.CameraParallelScale = camera
        drawn.append(os.path.join(out, f"{name}_{kind}.png"))
        picture = draw(drawn[-1], view)
        session.require(abs(picture - picture[0, 0]).max() > 60, f"{drawn[-1]} is empty")
        simple.Hide(shown, view)
    pictures.require_near(drawn[1], drawn[0])
    session.clear()


def draw_mixed(data, out):
    """Cells of all shapes are drawn; of a surface alone nothing is."""
    mixed = simple.OpenDataFile(os.path.join(data, "malformed_basic/u13_mixed.vtu"))
    others = simple.Tetrahedralize(Input=simple.Wavelet(WholeExtent=[0, 2, 0, 2, 0, 2]))
    surface = simple.Wavelet(WholeExtent=[0, 2, 0, 2, 0, 0])
    triangles = simple.Tetrahedralize(Input=surface)
    for name, source, array, sentence in (
            ("mixed", mixed, "s", ""),
            ("others", others, "RTData", ""),
            ("triangles", triangles, "RTData", "has no cells in three dimensions, but 8 cells, cell 0 of the type "
                                               "vtkTriangle")):
        with Said() as said:
            view, _ = show(source, ("POINTS", array), session.REPRESENTATION)
            picture = draw(os.path.join(out, name + ".png"), view)
        print(f"{name}: {said.text()}", flush=True)
        session.require(sentence in said.text(), f"{name}: '{sentence}' was not said")
        session.require(bool(sentence) or not said.text(), f"{name}: '{said.text()}' was said")
        session.require((abs(picture - picture[0, 0]).max() > 60) != bool(sentence), f"{name}: the picture is wrong")
    session.clear()


def watch(algorithm, update, stop_at=None):
    """The parts that an algorithm says are done while it is updated, which is told to stop at one of them."""
    parts = []

    def look(shown, _):
        parts.append(shown.GetProgress())
        if stop_at is not None and parts[-1] >= stop_at:
            shown.SetAbortExecute(1)

    observer = algorithm.AddObserver("ProgressEvent", look)
    update()
    algorithm.RemoveObserver(observer)
    return parts


def watch_sampling(data):
    """Progress is shown while the filter samples a mesh, which can be stopped."""
    mountain = simple.OpenDataFile(os.path.join(data, MESHES["mountain"][0]))
    octree = simple.BanyanHexOctree(Input=mountain, SampleGeneralMeshes=1, MeshSamplingBoxes=200000)
    algorithm = octree.GetClientSideObject()
    cells = lambda: octree.GetDataInformation().GetNumberOfCells()
    parts = watch(algorithm, octree.UpdatePipeline, 0.05)
    # (The pipeline says at the end that all is done.)
    session.require(0.05 <= max(part for part in parts if part < 1) < 0.5 and cells() == 0, f"it was not stopped: {parts}")
    octree.MeshSamplingTolerance = 0.5
    parts = watch(algorithm, octree.UpdatePipeline)
    session.require(len(set(parts)) > 20 and max(parts) == 1 and cells() > 100000, f"progress: {parts}")
    session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    data = session.real_data(MESHES["reactor"][0])
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    for name in MESHES:
        draw_mesh(data, arguments.out, name, arguments.reference)
    for name in ("mountain", "reactor"):
        keep(data, arguments.out, name, alone=not arguments.reference)
    if not arguments.reference:
        draw_mixed(data, arguments.out)
        watch_sampling(data)


main()
