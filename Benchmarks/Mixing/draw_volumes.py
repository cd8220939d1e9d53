# SPDX-License-Identifier: BSD-3-Clause
"""Draws two volumes that share space in ParaView in one way, and appends a row to a table. A process draws once.

    pvpython draw_volumes.py --plugin Banyan.so --scene one-grid|crossed|image-and-mesh --renderer RENDERER
        --samples N --pixels N --fields FILE.npy --mesh FILE.npz --picture FILE.png
        [--most SECONDS] [--reference FILE.png --table FILE.csv]

RENDERER is `reference`, one of BANYAN below, or vtk-multi-volume-D with samples D voxels apart. FILE.npy is made unless it
is there: the standard field of N^3 samples.
"""
import argparse
import os
import pathlib
import sys

import numpy
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolume, vtkVolumeProperty
from vtkmodules.vtkRenderingVolume import vtkMultiVolume
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper

here = pathlib.Path(__file__).resolve().parent
sys.path += [str(here.parent / name) for name in ("Meshes", "Balance", "Playback")]
import draw_mesh  # noqa: E402 (its folder had to be named first)
import make_mesh  # noqa: E402
import mesh_source  # noqa: E402
import paraview_frames  # noqa: E402
import paraview_playback  # noqa: E402

BANYAN = {  # settings of the display
    "reference": {"SampleDistanceVoxels": draw_mesh.REFERENCE_DISTANCE},
    "banyan": {"ImageErrorTolerance": 1.0},
    "banyan-every-sample": {"SampleDistanceVoxels": 1.0},
    "banyan-apart": {"ImageErrorTolerance": 1.0, "MixVolumes": 0},
    "banyan-apart-every-sample": {"SampleDistanceVoxels": 1.0, "MixVolumes": 0},
}
VTK = "vtk-multi-volume-"
NAMES = ("first", "second")  # arrays
TURN = 30.0  # degrees, of one of two crossed grids
COLUMNS = ("scene", "renderer", "first_frame_s", "ms_per_frame", "psnr_db", "max_error")


def standard_field(samples, path):
    """[z][y][x]"""
    if not os.path.exists(path):
        at = numpy.linspace(0.0, 1.0, samples)
        y, x = numpy.meshgrid(at, at, indexing="ij")
        planes = [make_mesh.standard_field(numpy.stack([x.ravel(), y.ravel(), numpy.full(x.size, z)], axis=1)) for z in at]
        part = path + ".part.npy"  # nobody takes half a file for a field
        numpy.save(part, numpy.reshape(planes, (samples,) * 3))
        os.replace(part, path)
    return numpy.load(path)


def image_of(arguments):
    """Both fields on one grid: the standard one, and the same with its axes changed."""
    field = standard_field(arguments.samples, arguments.fields)
    image = vtkImageData()
    image.SetDimensions([arguments.samples] * 3)
    for name, values in zip(NAMES, (field, field.transpose(1, 2, 0))):
        array = mesh_source.refer(numpy.ascontiguousarray(values).ravel())
        array.SetName(name)
        image.GetPointData().AddArray(array)
    return image


def mesh_of(arguments):
    """The standard field on cells that fill the grid's box."""
    with numpy.load(arguments.mesh) as file:
        mesh = dict(file)
    mesh["points"] = mesh["points"] * numpy.float32(arguments.samples - 1)
    grid = mesh_source.grid_of(mesh)
    grid.GetPointData().GetScalars().SetName(NAMES[0])
    return grid


def functions_of(name):
    """Points of colours and opacities: S2; of the second volume with other colours."""
    colours, opacities = (numpy.array(points).reshape(-1, 4) for points in paraview_frames.colours_and_opacities("S2"))
    if name == NAMES[1]:
        colours[:, 1:] = colours[:, [3, 1, 2]]
    return colours, opacities


class Volumes(draw_mesh.Scene):
    """Two volumes in a view, shown as their outlines at first."""

    def __init__(self, arguments):
        edge = arguments.samples - 1.0
        self.view = simple.CreateView("RenderView")
        self.view.ViewSize = [arguments.pixels] * 2
        self.view.OrientationAxesVisibility = self.view.UseFXAA = 0
        self.view.UseColorPaletteForBackground, self.view.Background = 0, [0, 0, 0]
        # What ParaView does not know of is not to be clipped.
        self.view.MaxClipBounds, self.view.LockBounds = [-edge, 2 * edge] * 3, 1
        paraview_frames.look(self.view, edge)
        self.image = image_of(arguments)
        self.middle = [0.5 * edge] * 3
        self.turns = (0.0, TURN if arguments.scene == "crossed" else 0.0)
        first = mesh_of(arguments) if arguments.scene == "image-and-mesh" else self.image
        self.displays = [self.show(*each) for each in zip((first, self.image), NAMES, self.turns)]
        self.eye = numpy.array(self.view.CameraPosition)
        self.draw()

    def show(self, data, name, turn):
        source = simple.TrivialProducer()
        source.GetClientSideObject().SetOutput(data)
        source.UpdatePipeline()
        display = simple.Show(source, self.view)
        display.SetRepresentationType("Outline")
        simple.ColorBy(display, ("POINTS", name))
        display.SetScalarBarVisibility(self.view, False)
        display.Origin, display.Orientation = self.middle, [0.0, turn, 0.0]
        lookup, opacity = simple.GetColorTransferFunction(name), simple.GetOpacityTransferFunction(name)
        lookup.ColorSpace = "RGB"
        lookup.RGBPoints, opacity.Points = (points.ravel().tolist() for points in functions_of(name))
        display.LookupTable, display.ScalarOpacityFunction = lookup, opacity
        display.ScalarOpacityUnitDistance = 1.0
        return display

    def switch_to(self, arguments):
        if arguments.renderer.startswith(VTK):
            for display in self.displays:
                display.Visibility = 0
            self.view.GetRenderer().AddVolume(self.multi_volume(float(arguments.renderer[len(VTK):])))
            return
        for display in self.displays:
            display.ReuseFrames = display.Decoupled = 0
            for name, value in BANYAN[arguments.renderer].items():
                setattr(display, name, value)
            display.SetRepresentationType(draw_mesh.OURS)

    def multi_volume(self, distance):
        """@param distance between samples, in voxels"""
        mapper = vtkOpenGLGPUVolumeRayCastMapper()
        mapper.AutoAdjustSampleDistancesOff()
        mapper.LockSampleDistanceToInputSpacingOff()
        mapper.UseJitteringOff()
        mapper.SetImageSampleDistance(1.0)
        mapper.SetSampleDistance(distance)
        several = vtkMultiVolume()
        several.SetMapper(mapper)
        for port, (name, turn) in enumerate(zip(NAMES, self.turns)):
            image = vtkImageData()
            image.CopyStructure(self.image)
            image.GetPointData().SetScalars(self.image.GetPointData().GetArray(name))
            mapper.SetInputDataObject(port, image)
            volume = vtkVolume()
            volume.SetOrigin(self.middle)
            volume.SetOrientation(0.0, turn, 0.0)
            volume.SetProperty(property_of(name))
            several.SetVolume(volume, port)
        return several


def property_of(name):
    colours, opacities = vtkColorTransferFunction(), vtkPiecewiseFunction()
    for points, function in zip(functions_of(name), (colours.AddRGBPoint, lambda x, a, *_: opacities.AddPoint(x, a))):
        for point in points:
            function(*point)
    result = vtkVolumeProperty()
    result.SetColor(colours)
    result.SetScalarOpacity(opacities)
    result.SetScalarOpacityUnitDistance(1.0)
    result.SetInterpolationTypeToLinear()
    result.ShadeOff()
    return result


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("plugin", "renderer", "fields", "mesh", "picture"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--scene", choices=("one-grid", "crossed", "image-and-mesh"), required=True)
    parser.add_argument("--samples", type=int, default=256, help="of a grid, per axis")
    parser.add_argument("--pixels", type=int, default=1024, help="per side of the picture")
    parser.add_argument("--most", type=float, default=60, help="seconds, for pictures after the first")
    parser.add_argument("--reference", default="")
    parser.add_argument("--table")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False)
    simple._DisableFirstRenderCameraReset()
    row, image = draw_mesh.measure(Volumes(arguments), arguments)
    writer = vtkPNGWriter()
    writer.SetFileName(arguments.picture)
    writer.SetInputData(image)
    writer.Write()
    if arguments.table:
        row.update(draw_mesh.errors(image, arguments.reference))
        row.update({"scene": arguments.scene, "renderer": arguments.renderer})
        paraview_playback.append(arguments.table, [{column: row.get(column) for column in COLUMNS}])
    sys.stdout.flush()
    os._exit(0)  # giving all memory back takes long, and nobody needs it


if __name__ == "__main__":
    main()
