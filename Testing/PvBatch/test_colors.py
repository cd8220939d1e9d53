# SPDX-License-Identifier: BSD-3-Clause
"""Colours that tables of equal steps cannot tell, the array that is chosen, and what has no effect.

Colours beyond the range and those of categories, whatever the labels, must be those of a map that
spells them out. Choosing "Banyan Volume" must choose an array with its map, and leave alone what
was chosen. Properties without effect are named once, in the words of the panel.
"""
import os

from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import VTK_STRING, vtkOutputWindow

import pictures
import session

SIZE = (200, 200)
CAMERA = {"CameraPosition": [45, 40, 100], "CameraFocalPoint": [0, 0, 0], "CameraViewUp": [0, 1, 0]}
LABELS = {"few": list(range(8)), "many": list(range(21)), "gaps": [0, 1, 2, 1000, 1001, 70000],
          "negative": [-5000, -3, 4, 5, 6, 7, 8, 9, 10, 11, 12]}


def calculated(name, function):
    """A field of whole numbers, or any other, of the wavelet's values from 37 to 277."""
    wavelet = session.kept("wavelet", lambda: simple.Wavelet(WholeExtent=[-16, 16, -15, 17, -14, 14]))
    return simple.Calculator(Input=wavelet, ResultArrayName=name, Function=function)


def numbers(count, labels):
    """Calls for the number of a part of the range, or for its label."""
    text = ""
    for i in range(count - 1):
        text += f"if(RTData < {60 + 180 * (i + 1) / count}, {labels[i]}, "
    return text + str(labels[-1]) + ")" * (count - 1)


def show(source, name, colors, opacities):
    view = session.new_view(SIZE, **CAMERA)
    display = simple.Show(source, view)
    display.SetRepresentationType(session.REPRESENTATION)
    simple.ColorBy(display, ("POINTS", name))
    lookup = simple.GetColorTransferFunction(name)
    lookup.AutomaticRescaleRangeMode = "Never"
    lookup.ColorSpace = "RGB"
    lookup.Discretize = 0  # 256 colours over the range of the map that spells it out would be few
    lookup.RGBPoints = colors
    opacity = simple.GetOpacityTransferFunction(name)
    opacity.Points = opacities
    display.LookupTable = lookup
    display.ScalarOpacityFunction = opacity
    display.SampleDistanceVoxels = 0.7
    display.SetScalarBarVisibility(view, False)
    return view, display


class Shots:
    """Pictures in a folder, compared with those of a reference."""

    def __init__(self, folder, reference):
        self.folder = folder
        self.reference = reference

    def take(self, view, name):
        path = os.path.join(self.folder, name + ".png")
        simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
        if self.reference:
            pictures.require_near(path, os.path.join(self.reference, name + ".png"))
        return pictures.load(path)


def beyond_the_range(shots):
    inside = [100, 0, 0, 1, 180, 1, 0, 0]
    spelt = [0, 0, 1, 0, 99.99999, 0, 1, 0, *inside, 180.00001, 1, 1, 0, 300, 1, 1, 0]
    opacities = [100, 0.02, 0.5, 0, 180, 0.2, 0.5, 0]
    taken = []
    for name, colors in (("beyond", inside), ("beyondspelt", spelt)):
        view, display = show(calculated(name, "RTData"), name, colors, opacities)
        lookup = display.LookupTable
        lookup.UseBelowRangeColor = lookup.UseAboveRangeColor = int(colors is inside)
        lookup.BelowRangeColor = [0, 1, 0]
        lookup.AboveRangeColor = [1, 1, 0]
        taken.append(shots.take(view, name))
    alike = pictures.psnr(*taken)
    print(f"colours beyond the range: {alike:.1f} dB", flush=True)
    session.require(alike > 55, f"colours beyond the range are others: {alike:.1f} dB")
    session.clear()


def categories(shots, kind):
    labels = LABELS[kind]
    count = len(labels)
    palette = [((i * 37) % 11 / 10, (i * 53) % 7 / 6, (i * 29) % 13 / 12) for i in range(count)]
    steps = [part for i, color in enumerate(palette) for part in (i - 0.49, *color, i + 0.49, *color)]
    view, display = show(calculated(kind + "steps", numbers(count, list(range(count)))), kind + "steps",
                         steps, [0.4, 0, 0.5, 0, 0.6, 0.2, 0.5, 0, count, 0.2, 0.5, 0])
    display.NearestPoint = 1
    spelt = shots.take(view, kind + "steps")
    between = 0.5 * (labels[0] + labels[1])
    # Linear as well: what lies between two labels is none.
    view, display = show(
        calculated(kind, numbers(count, labels)), kind, [0, 0, 0, 0, labels[-1], 1, 1, 1],
        [labels[0], 0, 0.5, 0, between, 0, 0.5, 0, between + 1e-3, 0.2, 0.5, 0, labels[-1], 0.2, 0.5, 0])
    lookup = display.LookupTable
    lookup.Annotations = [text for label in labels for text in (str(label), f"part {label}")]
    lookup.IndexedColors = [part for color in palette for part in color]
    lookup.IndexedOpacities = [1.0] * count
    lookup.InterpretValuesAsCategories = 1
    alike = pictures.psnr(shots.take(view, kind), spelt)
    print(f"{kind}: {alike:.1f} dB", flush=True)
    session.require(alike > 50, f"labels {labels} have other colours: {alike:.1f} dB")
    session.clear()


def chosen(make, array):
    """What choosing the representation chooses for new data."""
    view = session.new_view(SIZE)
    source = make()
    display = simple.Show(source, view)
    display.SetRepresentationType(session.REPRESENTATION)
    name = display.ColorArrayName[1]
    session.require(name == array, f"{make.__name__}: '{name}' was chosen in place of '{array}'")
    session.require(display.LookupTable and display.ScalarOpacityFunction, "no map")
    points = list(display.LookupTable.RGBPoints)
    information = source.PointData[array] or source.CellData[array]
    low, high = information.GetRange(0)
    session.require(abs(points[0] - low) < 1e-3 * (high - low) and
                    abs(points[-4] - high) < 1e-3 * (high - low), f"range {points[0]} to {points[-4]}")
    display.SetScalarBarVisibility(view, True)
    simple.Render(view)
    simple.ColorBy(display, None)
    simple.Render(view)
    session.require(not display.ColorArrayName[1], "'Solid Color' was not kept")
    session.clear()


def image():
    return simple.Wavelet(WholeExtent=[-5, 5, -5, 5, -5, 5])


def mesh():
    return simple.AppendDatasets(Input=[image()])


def trees():
    return simple.HyperTreeGridRandom(Dimensions=[4, 4, 4], MaxDepth=3)


def blocks():
    return simple.GroupDatasets(Input=[mesh()])


def choice_is_kept():
    view = session.new_view(SIZE)
    source = calculated("Other", "2*RTData")
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", "Other"))
    lookup = simple.GetColorTransferFunction("Other")
    lookup.RescaleTransferFunction(10, 20)
    display.SetRepresentationType(session.REPRESENTATION)
    session.require(display.ColorArrayName[1] == "Other", "another array was chosen")
    session.require(lookup.RGBPoints[0] == 10 and lookup.RGBPoints[-4] == 20, "the range was changed")
    session.clear()


def solid_color(shots):
    """'Solid Color' draws with ParaView's colours, not on with those of the map that was chosen before."""
    green = [0, 0, 1, 0, 300, 0, 1, 0]
    view, display = show(calculated("Green", "RTData"), "Green", green, [0, 0, 0.5, 0, 300, 0.5, 0.5, 0])
    before = shots.take(view, "green")
    session.require(before[:, :, 0].max() < 40, "the map is not the green one")
    simple.ColorBy(display, None)
    session.require(not display.LookupTable, "'Solid Color' has a map")
    after = shots.take(view, "solid")
    session.require(after[:, :, 0].max() > 150, "'Solid Color' shows the map that was chosen before")
    session.clear()


def scalar_bars(view):
    """The arrays that have a scalar bar on the screen."""
    return [shown.Title for shown in view.Representations
            if shown.GetXMLName() == "ScalarBarWidgetRepresentation" and shown.Visibility]


def bar_of_another_array():
    """In the window choosing shows a scalar bar. It goes when a script takes another array."""
    manager = servermanager.vtkSMProxyManager.GetProxyManager()
    before = manager.GetUndoStackBuilder()
    manager.SetUndoStackBuilder(servermanager.vtkSMUndoStackBuilder())  # the mark of the window
    view = session.new_view(SIZE)
    source = calculated("Bars", "3*RTData")
    display = simple.Show(source, view)
    display.SetRepresentationType(session.REPRESENTATION)
    first = scalar_bars(view)
    session.require(first == ["Bars"], f"scalar bars {first} of the array that was chosen")
    simple.ColorBy(display, ("POINTS", "RTData"))
    session.require(not scalar_bars(view), f"scalar bars {scalar_bars(view)} of no array that is shown")
    display.SetScalarBarVisibility(view, True)
    simple.Render(view)
    session.require(scalar_bars(view) == ["RTData"], f"scalar bars {scalar_bars(view)}")
    manager.SetUndoStackBuilder(before)
    session.clear()


def said(view, display, changes):
    sentences = []

    def hear(_caller, _event, sentence):
        sentences.append(sentence)

    hear.CallDataType = VTK_STRING
    window = vtkOutputWindow.GetInstance()
    number = window.AddObserver("WarningEvent", hear)
    for name, value in changes.items():
        setattr(display, name, value)
    for _ in range(3):
        simple.Render(view)
    window.RemoveObserver(number)
    return sentences


def options_without_effect():
    view = session.new_view(SIZE)
    display = simple.Show(image(), view)
    display.SetRepresentationType(session.REPRESENTATION)
    session.require(not said(view, display, {}), "a warning without reason")
    for name, value, label in (
            ("UseTransfer2D", 1, "Use 2D Transfer Function"), ("Opacity", 0.5, "Opacity"),
            ("UseSeparateOpacityArray", 1, "Use Separate Opacity Array"),
            ("MultiComponentsMapping", 1, "Multi Components Mapping"),
            ("GlobalIlluminationReach", 0.5, "Global Illumination Reach"),
            ("VolumetricScatteringBlending", 0.5, "Volumetric Scattering Blending"),
            ("VolumeRenderingMode", "Ray Cast Only", "Volume Rendering Mode"),
            ("Compositing", "Binary swap", "Compositing"),
            ("TemporalEnhancement", 0.5, "Temporal Enhancement")):
        sentences = said(view, display, {name: value})
        session.require(len(sentences) == 1 and f"'{label}' has no effect" in sentences[0],
                        f"{name}: {sentences}")
    session.require(not said(view, display, {"Opacity": 0.7}), "'Opacity' is named twice")
    session.require(not said(view, display, {"LoadBalancing": "Off"}), "'Off' has an effect")
    sentences = said(view, display, {"LoadBalancing": "Slice step"})
    session.require(len(sentences) == 1 and "'Slice step' of" in sentences[0], f"{sentences}")
    for source, array, name, value in (
            (simple.UnstructuredCellTypes(CellType="Hex", BlocksDimensions=[3, 3, 3]),
             ("POINTS", "DistanceToCenter"), "SelectMapper", "Resample To Image"),
            (simple.HierarchicalFractal(Dimensions=4, MaximumLevel=2),
             ("CELLS", "Fractal Volume Fraction"), "ResamplingMode", "Using View Frustum")):
        other = simple.Show(source, view)
        other.SetRepresentationType(session.REPRESENTATION)
        simple.ColorBy(other, array)
        simple.Render(view)
        session.require(not said(view, other, {}), f"{name} is named without need")
        sentences = said(view, other, {name: value})
        session.require(len(sentences) == 1 and "To resample them choose 'Volume'" in sentences[0],
                        f"{name}: {sentences}")
    light = simple.AddLight(view=view)
    light.DiffuseColor = [1, 0, 0]
    sentences = said(view, display, {"Shade": 1})
    session.require(len(sentences) == 1 and "Lights" in sentences[0], f"lights: {sentences}")
    session.clear()


def colors_without_map():
    """What is said where 'Map Scalars' is off and there are no colours, or none from 0 to 255."""
    rgb = calculated("Rgb", "8*(iHat*(coordsX+16)+jHat*(coordsY+16)+kHat*(coordsZ+16))")
    for source, array, changes, words in (
            (rgb, "Rgb", {}, "the numbers of 'Rgb' lie from 0 to 264"),
            (rgb, "Rgb", {"Projection": "Maximum Intensity"}, "Colours have no projection"),
            (calculated("Dark", "iHat*0.5+jHat*0.25+kHat"), "Dark", {}, "lie from 0 to 1:"),
            (calculated("Grey", "RTData"), "Grey", {}, "'Grey' has one component"),
            (simple.AppendDatasets(Input=[rgb]), "Rgb", {}, "use 'Resample To Image'"),
            (calculated("Bytes", "7*(iHat*(coordsX+16)+jHat*(coordsY+15)+kHat*(coordsZ+16))"), "Bytes", {},
             None)):
        view = session.new_view(SIZE)
        display = simple.Show(source, view)
        simple.ColorBy(display, ("POINTS", array))
        display.SetRepresentationType(session.REPRESENTATION)
        simple.Render(view)
        sentences = said(view, display, {"MapScalars": 0, **changes})
        session.require(len(sentences) == 1 and words in sentences[0] if words else not sentences,
                        f"{array}: {sentences}")
    session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    parser.add_argument("--only", choices=["pictures", "choices"])
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    shots = Shots(arguments.out, arguments.reference)
    if arguments.only != "pictures":
        chosen(image, "RTData")  # first: maps are new
        chosen(mesh, "RTData")
        chosen(trees, "Depth")
        chosen(blocks, "RTData")
        choice_is_kept()
        bar_of_another_array()
        options_without_effect()
        colors_without_map()
    if arguments.only != "choices":
        beyond_the_range(shots)
        solid_color(shots)
        for kind in ("gaps",) if arguments.only else LABELS:
            categories(shots, kind)


main()
