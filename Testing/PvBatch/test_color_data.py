# SPDX-License-Identifier: BSD-3-Clause
"""Colour data with 'Map Scalars' off: plain and encoded, at two steps, in all modes alike.

Pictures of encoded data are those of the same data in memory, and those of four components are those
of ParaView's own "Volume" (which takes 1 for the unit distance, whatever it is set to). With
--reference, pictures must be those of another run, too.

    test_color_data.py --out DIR [--volume] [--reference DIR]
"""
import os

from paraview import simple

import pictures
import session

SIZE = (300, 240)
TIMES = (0.0, 1.0)
INFORMATION = session.time_information(TIMES) + """
info.Set(executive.WHOLE_EXTENT(), 0, 60, 0, 48, 0, 40)
info.Set(vtk.vtkDataObject.ORIGIN(), 0.0, 0.0, 0.0)
info.Set(vtk.vtkDataObject.SPACING(), 1.0, 1.0, 1.0)
info.Set(vtk.vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""
# Stained cells: a ball of each colour, brighter in the middle, with alpha from 0 to 255 as red is.
IMAGE = """
import numpy
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
e = info.Get(executive.UPDATE_EXTENT())
image = self.GetOutputDataObject(0)
image.SetExtent(e)
z, y, x = numpy.meshgrid(*(numpy.arange(e[2 * a], e[2 * a + 1] + 1) for a in (2, 1, 0)), indexing="ij")
colours = numpy.zeros(x.shape + (4,))
for i, middle in enumerate(((20, 16, 20), (30, 34, 16 + 6 * time), (40, 20, 20))):
    ball = numpy.exp(-((x - middle[0])**2 + (y - middle[1])**2 + (z - middle[2])**2) / 60.0)
    colours[..., i] = numpy.minimum(1.0, 1.02 * ball + 0.2 * numpy.sin(0.4 * x)**2 * ball)
colours[..., 3] = colours.max(axis=-1)
data = numpy.rint(255 * colours).astype("u1")
output.PointData.append(data.reshape(-1, 4), "stained")
output.PointData.append(data[..., :3].reshape(-1, 3).copy(), "camera")
"""
OPACITIES = [0, 0, 0.5, 0, 20, 0, 0.5, 0, 255, 0.4, 0.5, 0]


class Shots:
    def __init__(self, arguments):
        self.out, self.reference = arguments.out, arguments.reference

    @staticmethod
    def view():
        return session.new_view(SIZE, CameraPosition=[75, -60, 95], CameraFocalPoint=[30, 24, 20],
                                CameraViewUp=[0, 0, 1])

    def save(self, view, name):
        path = os.path.join(self.out, name + ".png")
        simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
        if self.reference:
            pictures.require_near(path, os.path.join(self.reference, name + ".png"))
        return pictures.load(path)

    def take(self, source, array, name, representation=session.REPRESENTATION, **properties):
        """The pictures of both steps."""
        view = self.view()
        display = simple.Show(source, view)
        simple.ColorBy(display, ("POINTS", array))
        display.SetRepresentationType(representation)
        opacity = simple.GetOpacityTransferFunction(array)
        opacity.Points = OPACITIES
        display.LookupTable.AutomaticRescaleRangeMode = "Never"
        display.ScalarOpacityFunction = opacity
        display.ScalarOpacityUnitDistance = 1.0
        display.MapScalars = 0
        display.SetScalarBarVisibility(view, False)
        for key, value in properties.items():
            setattr(display, key, value)
        taken = []
        for step, time in enumerate(TIMES):
            view.ViewTime = time
            taken.append(self.save(view, f"{name}_{step}"))
        simple.Delete(view)
        return taken


def require_alike(name, some, others):
    for step, (one, other) in enumerate(zip(some, others)):
        error = int(pictures.difference(one, other).max())
        print(f"{name}, step {step}: {error}", flush=True)
        session.require(error <= 1, f"{name} differs by {error} at step {step}")


def require_colors(taken, least):
    """Each of the three colours is seen, and the steps look apart."""
    for picture in taken:
        for channel in range(3):
            others = [c for c in range(3) if c != channel]
            lead = (picture[..., channel] - picture[..., others].max(axis=2)).max()
            session.require(lead > least, f"channel {channel} leads by {lead} only")
    session.require(pictures.difference(*taken).max() > 20, "both steps look the same")


def check_switching(shots, sources):
    """In one view 'Map Scalars' goes on and off, and the array away: nothing old is shown again."""
    for name, source in sources.items():
        view = shots.view()
        display = simple.Show(source, view)
        simple.ColorBy(display, ("POINTS", "stained"))
        display.SetRepresentationType(session.REPRESENTATION)
        opacity = simple.GetOpacityTransferFunction("stained")
        opacity.Points = OPACITIES
        display.SetScalarBarVisibility(view, False)
        taken = {}
        now = {"Projection": "Composite"}
        for number, changes in enumerate(({"MapScalars": 0}, {"MapScalars": 1}, {"MapScalars": 0},
                                          {"Projection": "Maximum Intensity"}, {"MapScalars": 1},
                                          {"Projection": "Composite"}, {"MapScalars": 0})):
            for key, value in changes.items():
                setattr(display, key, value)
            now.update(changes)
            # A projection has no colours: it is that of the magnitude.
            state = (now["MapScalars"] if now["Projection"] == "Composite" else 1, now["Projection"])
            picture = shots.save(view, f"switched_{name}_{number}")
            if state in taken:
                require_alike(f"{name}, {state}", [picture], [taken[state]])
            taken[state] = picture
        first, second = taken[(0, "Composite")], taken[(1, "Composite")]
        session.require(pictures.difference(first, second).max() > 50, "the map changes nothing")
        simple.ColorBy(display, None)
        solid = shots.save(view, f"switched_{name}_solid")
        session.require(pictures.difference(solid, second).max() > 50, "'Solid Color' has the map")
        simple.Delete(view)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    parser.add_argument("--volume", action="store_true", help="compares with ParaView's Volume")
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    shots = Shots(arguments)
    plain = simple.ProgrammableSource(OutputDataSetType="vtkImageData",
                                      ScriptRequestInformation=INFORMATION, Script=IMAGE)
    plain.UpdatePipeline()
    series = {}
    for name, bound in (("exact", 0.0), ("bounded", 2 / 255)):
        path = os.path.join(arguments.out, name + ".banyan")
        simple.SaveData(path, proxy=plain, WriteTimeSteps=1, ErrorBound=bound)
        series[name] = simple.OpenDataFile(path)
    for array in ("stained", "camera"):
        for shade in (0, 1):
            name = array + ("_shaded" if shade else "")
            fixed = {"Shade": shade, "SampleDistanceVoxels": 0.5}
            memory = shots.take(plain, array, name, **fixed)
            require_colors(memory, 60 if array == "stained" else 15)  # blue has little luminance
            file = shots.take(series["exact"], array, name + "_encoded", **fixed)
            require_alike(name + ", encoded", file, memory)
    bounded = shots.take(series["bounded"], "stained", "bounded")
    fine = shots.take(plain, "stained", "fine", SampleDistanceVoxels=0.25)
    for one, other in zip(bounded, fine):
        error = int(pictures.difference(one, other).max())
        print(f"within the bound and the tolerance: {error}", flush=True)
        session.require(error <= 6, f"the bound of 2 and a tolerance of 1 made {error}")
    check_switching(shots, {"plain": plain, "encoded": series["exact"]})
    if arguments.volume:
        theirs = shots.take(plain, "stained", "volume", representation="Volume")
        for one, other in zip(fine, theirs):
            decibel = pictures.psnr(one, other)
            print(f"ParaView's Volume: {decibel:.1f} dB", flush=True)
            session.require(decibel > 50, f"ParaView's Volume is {decibel:.1f} dB away")
    session.clear()


main()
