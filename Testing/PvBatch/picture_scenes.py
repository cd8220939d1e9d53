# SPDX-License-Identifier: BSD-3-Clause
"""The scenes whose pictures must not depend on how many processes draw them, or where.

Each scene is a function that shows data in a view that it makes, and returns a `Drawn`. `scenes()`
gives all of them by name. The volume and the five opaque spheres mostly lie as follows: one sphere
in front of the volume, one inside, one behind, one beside, one through its face; each is whole on
one rank (sphere i on rank i modulo the number of ranks), so that without an exchange of depth
between the ranks the picture would be wrong.
"""
import os
from dataclasses import dataclass, field

from paraview import simple

import session

SIZE = (400, 300)
CAMERA = dict(CameraPosition=[45, 40, 100], CameraFocalPoint=[0, 0, 0], CameraViewUp=[0, 1, 0],
              CameraViewAngle=30)
# Name, centre, radius, colour.
SPHERES = (
    ("front", (22, 10, 24), 4, (0.9, 0.2, 0.1)),
    ("inside", (3, -4, 2), 5, (0.1, 0.9, 0.2)),
    ("behind", (-17, -6, -26), 6, (0.2, 0.3, 1.0)),
    ("beside", (-27, 16, 5), 4, (0.9, 0.9, 0.1)),
    ("face", (20, -8, 4), 5, (0.9, 0.9, 0.9)),
)
SPHERE_SCRIPT = """
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkFiltersCore import vtkAppendPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
everything = vtkAppendPolyData()
for number, (name, center, radius, _) in enumerate({spheres}):
    if ({first} + number) % controller.GetNumberOfProcesses() != controller.GetLocalProcessId():
        continue
    sphere = vtkSphereSource()
    sphere.SetRadius(radius)
    sphere.SetCenter(center)
    sphere.SetThetaResolution({resolution})
    sphere.SetPhiResolution({resolution})
    sphere.Update()
    numbers = vtkFloatArray()
    numbers.SetName("{array}")
    numbers.SetNumberOfTuples(sphere.GetOutput().GetNumberOfPoints())
    numbers.FillComponent(0, number)
    sphere.GetOutput().GetPointData().AddArray(numbers)
    everything.AddInputData(sphere.GetOutput())
if everything.GetNumberOfInputConnections(0) > 0:
    everything.Update()
    self.GetPolyDataOutput().ShallowCopy(everything.GetOutput())
"""


@dataclass
class Drawn:
    view: object
    volumes: list
    geometry: list = field(default_factory=list)
    image_size: tuple = None  # of the screenshot; that of the view when None
    volume_pixels: int = 0  # the volume changes at least so many pixels; -1: none at all
    extremes: bool = False  # a maximum or minimum


class Settings:
    """Where the scenes find the encoded series, and what they draw volumes with."""

    data = "."
    representation = session.REPRESENTATION


def spheres(view, listed=SPHERES, resolution=24, opacity=1.0, first=0):
    """Shows spheres, all in one source (making and showing many takes longer than drawing them).

    Sphere i of them is on rank `first` + i modulo the number of ranks.
    """
    array = "Sphere" + "".join(name for name, *_ in listed)
    script = SPHERE_SCRIPT.format(spheres=listed, resolution=resolution, array=array,
                                  first=first)
    source = session.kept(script, lambda: simple.ProgrammableSource(
        OutputDataSetType="vtkPolyData", Script=script))
    display = simple.Show(source, view)
    display.SetRepresentationType("Surface")
    # Colours by a table: ParaView takes stored ones for translucent, and redistributes the spheres.
    simple.ColorBy(display, ("POINTS", array))
    lookup = simple.GetColorTransferFunction(array)
    lookup.ColorSpace = "RGB"
    lookup.RGBPoints = [value for number, (*_, color) in enumerate(listed)
                        for value in (number, *color)]
    display.LookupTable = lookup
    # Colours per point: looked up per pixel they would depend on the last bit of the number.
    display.InterpolateScalarsBeforeMapping = 0
    display.Opacity = opacity
    display.SetScalarBarVisibility(view, False)
    return display


def colors_of(array, low, high, opacities=(0.0, 0.0, 0.01, 0.04, 0.12)):
    """Colour and opacity function over [low, high]; opacities at equal distances."""
    points = [low + (high - low) * i / 4 for i in range(5)]
    lookup = simple.GetColorTransferFunction(array)
    lookup.RGBPoints = [points[0], 0.1, 0.2, 0.9, points[1], 0.1, 0.8, 0.9,
                        points[2], 0.3, 0.9, 0.3, points[3], 0.95, 0.8, 0.2,
                        points[4], 0.9, 0.2, 0.1]
    lookup.ColorSpace = "RGB"
    opacity = simple.GetOpacityTransferFunction(array)
    opacity.Points = [number for point, value in zip(points, opacities)
                      for number in (point, value, 0.5, 0.0)]
    return lookup, opacity


def volume(source, view, array, unit_distance=1.0, value_range=(40, 280), **functions):
    display = simple.Show(source, view)
    display.SetRepresentationType(Settings.representation)
    simple.ColorBy(display, ("POINTS", array))
    lookup, opacity = colors_of(array, *value_range, **functions)
    display.LookupTable = lookup
    display.ScalarOpacityFunction = opacity
    display.ScalarOpacityUnitDistance = unit_distance
    display.SetScalarBarVisibility(view, False)
    return display


def wavelet(view, extent=(-20, 20, -16, 16, -14, 14), **options):
    source = session.kept(f"wavelet {extent}", lambda: simple.Wavelet(WholeExtent=list(extent)))
    return volume(source, view, "RTData", **options)


def encoded(view, name="swirl", **options):
    """A series of 3 steps, 41 x 33 x 29 samples, that fills the box of `wavelet`."""
    path = os.path.join(Settings.data, name + ".banyan")
    source = session.kept(path, lambda: simple.OpenDataFile(path))
    session.require(source is not None, f"{path} does not open")
    return volume(source, view, "swirl", value_range=(0.0, 1.0), **options)


SCENES = {}


def scene(function):
    SCENES[function.__name__] = function
    return function


@scene
def plain():
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [wavelet(view)], volume_pixels=20000)


@scene
def plain_and_spheres():
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [wavelet(view)], [spheres(view)], volume_pixels=20000)


@scene
def coloured_background():
    # Seen through the volume, before which, in which and behind which there are spheres.
    view = session.new_view(SIZE, **CAMERA, Background=[0.95, 0.55, 0.2])
    return Drawn(view, [wavelet(view)], [spheres(view)], volume_pixels=20000)


@scene
def encoded_and_spheres():
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [encoded(view)], [spheres(view)], volume_pixels=20000)


@scene
def gradient_background():
    # No two rows of the background are of one colour.
    view = session.new_view(SIZE, **CAMERA, BackgroundColorMode="Gradient",
                            Background=[0.95, 0.9, 0.2], Background2=[0.1, 0.6, 0.95])
    return Drawn(view, [encoded(view)], [spheres(view)], volume_pixels=20000)


@scene
def encoded_last_step():
    view = session.new_view(SIZE, **CAMERA)
    drawn = Drawn(view, [encoded(view)], [spheres(view)], volume_pixels=20000)
    view.ViewTime = 2.0
    return drawn


@scene
def parallel_projection():
    view = session.new_view(SIZE, **CAMERA, CameraParallelProjection=1, CameraParallelScale=30)
    return Drawn(view, [wavelet(view)], [spheres(view)], volume_pixels=20000)


@scene
def along_an_axis():
    # Zones and pieces touch in planes that lie along the rays.
    view = session.new_view(SIZE, CameraPosition=[0, 0, 100], CameraFocalPoint=[0, 0, 0],
                            CameraViewUp=[0, 1, 0], CameraParallelProjection=1,
                            CameraParallelScale=25)
    return Drawn(view, [encoded(view)], [spheres(view)], volume_pixels=20000)


@scene
def camera_inside():
    view = session.new_view(SIZE, CameraPosition=[2, 1, 3], CameraFocalPoint=[20, 4, -4],
                            CameraViewUp=[0, 1, 0], CameraViewAngle=70)
    return Drawn(view, [wavelet(view)], [spheres(view)], volume_pixels=60000)


@scene
def camera_inside_encoded():
    view = session.new_view(SIZE, CameraPosition=[-3, 2, 9], CameraFocalPoint=[3, -4, 2],
                            CameraViewUp=[0, 1, 0], CameraViewAngle=80)
    return Drawn(view, [encoded(view)], [spheres(view)], volume_pixels=60000)


@scene
def cells_of_pixels():
    # Levels by the size of cells on the screen: finer in front than beside.
    view = session.new_view(SIZE, CameraPosition=[30, 14, 24], CameraFocalPoint=[0, 0, 0],
                            CameraViewUp=[0, 1, 0], CameraViewAngle=60)
    display = encoded(view)
    display.ScreenErrorPixels = 16
    return Drawn(view, [display], [spheres(view)], volume_pixels=60000)


@scene
def placed():
    # Much larger than its data: a client has to know, to see as far.
    view = session.new_view(SIZE, CameraPosition=[180, 160, 400], CameraFocalPoint=[0, 0, 0],
                            CameraViewUp=[0, 1, 0])
    display = wavelet(view)
    display.Scale = [4, 4, 4]
    display.Orientation = [0, 30, 0]
    session.move_to(display, [5, 0, 0])
    return Drawn(view, [display], volume_pixels=20000)


@scene
def zoomed_to_a_corner():
    # Most ranks have nothing in the picture.
    view = session.new_view(SIZE, CameraPosition=[38, 30, 34], CameraFocalPoint=[19, 15, 13],
                            CameraViewUp=[0, 1, 0], CameraViewAngle=14)
    corner = ("corner", (19, 15, 13), 2, (0.9, 0.5, 0.9))
    shapes = [spheres(view, SPHERES[1:] + (corner,))]
    return Drawn(view, [wavelet(view, opacities=(0.1, 0.1, 0.1, 0.1, 0.1))], shapes,
                 volume_pixels=20000)


@scene
def volume_behind_the_viewer():
    view = session.new_view(SIZE, CameraPosition=[0, 0, 30], CameraFocalPoint=[0, 0, 60],
                            CameraViewUp=[0, 1, 0])
    ahead = ("ahead", (0, 0, 60), 6, (0.9, 0.5, 0.9))
    shapes = [spheres(view, SPHERES[:2] + (ahead,))]
    return Drawn(view, [wavelet(view)], shapes, volume_pixels=-1)


@scene
def screenshot_larger():
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [wavelet(view)], [spheres(view)], image_size=(798, 598), volume_pixels=80000)


@scene
def screenshot_smaller_and_odd():
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [encoded(view)], [spheres(view)], image_size=(171, 233), volume_pixels=5000)


@scene
def one_cell():
    # More ranks than cells: all but one are empty.
    view = session.new_view(SIZE, **CAMERA)
    display = wavelet(view, (0, 1, 0, 1, 0, 1), unit_distance=0.2,
                      opacities=(0.0, 0.1, 0.2, 0.3, 0.4))
    view.CameraPosition = [3, 2, 6]
    return Drawn(view, [display], volume_pixels=1000)


@scene
def one_brick():
    # More ranks than bricks, and spheres on the ranks without one.
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [encoded(view, "small", unit_distance=0.5)], [spheres(view)],
                 volume_pixels=15000)


@scene
def one_layer_of_cells():
    view = session.new_view(SIZE, **CAMERA)
    return Drawn(view, [wavelet(view, (-20, 20, -16, 16, 0, 1), unit_distance=0.05)],
                 [spheres(view)], volume_pixels=8000)


@scene
def maximum_intensity():
    view = session.new_view(SIZE, **CAMERA)
    display = encoded(view, opacities=(0.0, 0.3, 0.6, 0.8, 1.0))
    display.Projection = "Maximum Intensity"
    return Drawn(view, [display], [spheres(view)], volume_pixels=20000, extremes=True)


@scene
def minimum_of_labels():
    view = session.new_view(SIZE, **CAMERA)
    display = wavelet(view, opacities=(0.3, 0.9, 0.8, 0.8, 1.0))
    display.Projection = "Minimum Intensity"
    display.InterpolationType = "Nearest"
    return Drawn(view, [display], [spheres(view)], volume_pixels=20000, extremes=True)


@scene
def average_intensity():
    view = session.new_view(SIZE, **CAMERA)
    display = wavelet(view, opacities=(0.5, 0.5, 0.5, 0.8, 1.0))
    display.Projection = "Average Intensity"
    return Drawn(view, [display], [spheres(view)], volume_pixels=20000)


@scene
def cropped_and_shaded():
    view = session.new_view(SIZE, **CAMERA)
    display = encoded(view, opacities=(0.0, 0.05, 0.1, 0.2, 0.5))
    display.Shade = 1
    display.Diffuse = 0.9
    display.Specular = 0.5
    display.SpecularPower = 10
    display.UseCropping = 1
    display.CroppingOrigin = [1.5, -2, 0]
    display.CroppingScale = [0.6, 0.7, 0.9]
    return Drawn(view, [display], [spheres(view)], volume_pixels=8000)


@scene
def slice_inside():
    # Opaque geometry that is itself in pieces on all ranks.
    view = session.new_view(SIZE, **CAMERA)
    display = wavelet(view)
    cut = simple.Slice(Input=display.Input)
    cut.SliceType.Origin = [0, 0, 0]
    cut.SliceType.Normal = [0.3, 0.1, 1]
    surface = simple.Show(cut, view)
    surface.ColorArrayName = [None, ""]
    surface.DiffuseColor = [0.7, 0.7, 0.7]
    return Drawn(view, [display], [surface], volume_pixels=20000)


@scene
def translucent_surface_beside():
    view = session.new_view(SIZE, **CAMERA)
    # Of few cells: ParaView redistributes it through XML, which Debian's parser cuts off.
    nothing = ("nothing", (0, 0, 0), 0, (0, 0, 0))
    glass = ("glass", (-29, 17, 5), 5, (0.9, 0.4, 0.9))
    return Drawn(view, [wavelet(view)], [spheres(view, (nothing, glass), 6, 0.5)],
                 volume_pixels=20000)


@scene
def scalar_bar_and_axes():
    # Both are drawn in layers of their own, and stay in front of the volume.
    view = session.new_view(SIZE, **CAMERA)
    display = wavelet(view)
    display.SetScalarBarVisibility(view, True)
    view.OrientationAxesVisibility = 1
    return Drawn(view, [display], [spheres(view)], volume_pixels=20000)


def scenes():
    """All scenes by name, in the order in which they are drawn."""
    return dict(SCENES)
