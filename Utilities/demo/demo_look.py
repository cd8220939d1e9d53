# SPDX-License-Identifier: BSD-3-Clause
"""How the demonstration looks: view, camera, colours and opacities, for any scalar volume."""

import math

from paraview import servermanager, simple

BACKGROUND_LOW = (0.020, 0.025, 0.045)
BACKGROUND_HIGH = (0.105, 0.125, 0.180)
TURN_DEGREES = 50.0  # of the camera over the whole animation
OPACITY_POINTS = 24


def apply_colour_map(colours):
    """Inferno, which is called Inferno (matplotlib) until ParaView 6.0."""
    presets = servermanager.vtkSMTransferFunctionPresets.GetInstance()
    colours.ApplyPreset("Inferno" if presets.HasPreset("Inferno") else "Inferno (matplotlib)", True)


def make_view(image_size):
    view = simple.CreateRenderView(ViewSize=list(image_size))
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Gradient"
    view.Background, view.Background2 = BACKGROUND_LOW, BACKGROUND_HIGH
    return view


def opacities(histogram):
    """Points (value, opacity) of an opacity map that hides the most common value, the
    surroundings, and shows a value the more the further it is from that."""
    low, high = histogram["range"]
    counts = histogram["counts"]
    if not high > low:
        return [(low, 0.2), (low + 1.0, 0.2)]
    bins = len(counts)
    mode = max(range(bins), key=lambda i: counts[i])
    reach = max(mode, bins - 1 - mode)
    # Hidden is at least a twentieth of the way, and at most a third, so that half of the voxels
    # are invisible where the data allows it.
    total, near, hidden = sum(counts), 0, 0
    while hidden < reach / 3 and (near < total / 2 or hidden < reach / 20):
        near = sum(counts[max(mode - hidden, 0):mode + hidden + 1])
        hidden += 1
    points = []
    for i in range(OPACITY_POINTS + 1):
        distance = abs(i / OPACITY_POINTS * (bins - 1) - mode)
        share = max(distance - hidden, 0.0) / max(reach - hidden, 1)
        points.append((low + (high - low) * i / OPACITY_POINTS, 0.8 * share))
    return points


def dress(reader, display, view, look):
    """Colours, opacities, camera, outline, scalar bar and time."""
    name, histogram = look["drawn_array"], look["histogram"]
    low, high = histogram["range"]
    simple.ColorBy(display, ("POINTS", name))
    colours = simple.GetColorTransferFunction(name)
    apply_colour_map(colours)
    colours.RescaleTransferFunction(low, high if high > low else low + 1.0)
    opacity = simple.GetOpacityTransferFunction(name)
    opacity.Points = [number for value, share in opacities(histogram)
                      for number in (value, share, 0.5, 0.0)]
    bounds = reader.GetDataInformation().GetBounds()
    edges = [bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3)]
    display.ScalarOpacityUnitDistance = max(edges) / 20.0

    outline(reader, view)
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = name, ""
    bar.ScalarBarLength = 0.4
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    display.SetScalarBarVisibility(view, True)
    clock(reader, view, "Time {time:.3f}")
    place_camera(view, bounds)


def outline(reader, view):
    box = simple.Show(simple.Outline(Input=reader), view)
    box.ColorArrayName = [None, ""]
    box.AmbientColor = box.DiffuseColor = (0.45, 0.50, 0.60)


def clock(reader, view, text):
    """The time of the view in a corner, as `text` formats it."""
    shown = simple.Show(simple.AnnotateTimeFilter(Input=reader, Format=text), view)
    shown.WindowLocation = "Lower Left Corner"
    shown.FontSize = 20


def place_camera(view, bounds):
    """Looks at the middle of the bounds, a little from above, with z upwards."""
    centre = [(bounds[2 * axis] + bounds[2 * axis + 1]) / 2 for axis in range(3)]
    edges = [bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3)]
    distance = 0.5 * math.sqrt(sum(edge * edge for edge in edges)) / math.sin(math.radians(15.5))
    azimuth, height = math.radians(-65), math.radians(18)
    view.CameraFocalPoint = centre
    view.CameraPosition = [
        centre[0] + distance * math.cos(height) * math.cos(azimuth),
        centre[1] + distance * math.cos(height) * math.sin(azimuth),
        centre[2] + distance * math.sin(height)]
    view.CameraViewUp = (0.0, 0.0, 1.0)
    view.CameraViewAngle = 30


def turn_camera(view, step, steps):
    """Goes on to the next frame's place on the camera's circle."""
    if step > 0:
        view.GetActiveCamera().Azimuth(TURN_DEGREES / max(steps - 1, 1))
