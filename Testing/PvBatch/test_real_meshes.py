# SPDX-License-Identifier: BSD-3-Clause
"""Real meshes of general hexahedra at the options that a new user has.

    test_real_meshes.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

A can that buckles is drawn, two blocks that crush each other at all of their steps, and a reactor as exactly as is
promised. With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
Without BANYAN_DATA_DIR there is nothing to do.
"""
import glob
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import pictures
import session

REACTOR = "disk_out_ref/disk_out_ref.vtu"


class Said:
    """What ParaView says meanwhile."""

    def __enter__(self):
        self.window = vtkStringOutputWindow()
        self.before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self.window

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)


def show(source, array):
    view = session.new_view((200, 200))
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", array))
    display.SetRepresentationType(session.REPRESENTATION)
    view.ResetCamera()
    simple.GetActiveCamera().Azimuth(30)
    simple.GetActiveCamera().Elevation(30)
    view.ResetCamera()
    return view, display


def draw(path, view):
    view.UseFXAA = 0  # ParaView switches it on again when there is another view
    view.StillRender()
    simple.SaveScreenshot(path, view)
    return pictures.load(path).astype(int)


def seen(picture):
    return int((abs(picture - picture[0, 0]).max(axis=-1) > 20).sum())


def draw_can(data, out):
    """Thin shells, crushed: some cells are turned inside out."""
    source = simple.OpenDataFile(os.path.join(data, "can/can.vtu"))
    with Said() as said:
        view, _ = show(source, "DISPL")
        picture = draw(os.path.join(out, "can.png"), view)
    print(f"can: {seen(picture)} pixels; {said.GetOutput()}", flush=True)
    session.require(seen(picture) > 4000, "the can is not seen")
    for sentence in ("51 cells, the first of which is 195", "folded over at a corner"):
        session.require(sentence in said.GetOutput(), f"'{sentence}' was not said of the can")
    session.clear()


def show_blocks(source):
    """A view that does not depend on the step."""
    view, display = show(source, "displ_")
    colors = simple.GetColorTransferFunction("displ_")
    colors.RGBPoints = [0.0, 0.2, 0.3, 0.9, 0.1, 0.9, 0.2, 0.1]
    colors.ColorSpace = "Diverging"  # ParaView 6.1 begins with another
    simple.GetOpacityTransferFunction("displ_").Points = [0.0, 0.0, 0.5, 0.0, 0.2, 1.0, 0.5, 0.0]
    display.ScalarOpacityUnitDistance = 0.3
    view.CameraPosition, view.CameraFocalPoint = [3, 5, 6], [0, 0, 0]
    return view


def draw_blocks(data, out):
    """Whoever plays the steps sees what those see who open one of them; a contact element is left out."""
    files = sorted(glob.glob(data + "/block_crush/block_crush_*.vtu"))
    session.require(len(files) == 11, "the blocks have 11 steps")
    played, before = simple.OpenDataFile(files), None
    with Said() as said:
        view = show_blocks(played)
        simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
        for step, file in enumerate(files):
            view.ViewTime = played.TimestepValues[step]
            path = os.path.join(out, f"blocks{step}.png")
            picture = draw(path, view)
            print(f"blocks at step {step}: {seen(picture)} pixels", flush=True)
            # At first nothing has moved.
            session.require(step < 3 or seen(picture) > 1000, "the blocks are not seen")
            session.require(step < 3 or abs(picture - before).max() > 4, f"step {step} is the one before")
            before = picture
            if step % 5 == 0:
                alone = os.path.join(out, f"blocks{step}_alone.png")
                draw(alone, show_blocks(simple.OpenDataFile(file)))
                pictures.require_near(alone, path)
                simple.SetActiveView(view)
    session.require("Not drawn: 1 cell, cell 131 of the type vtkVertex" in said.GetOutput(), said.GetOutput())
    session.require("was not drawn" not in said.GetOutput(), said.GetOutput())
    session.clear()


def draw_reactor(data, out):
    """At the default tolerance, beside 64 samples per edge of the finest cell.

    An opacity of 1, which ParaView gives the highest value, hides all that is behind one point of this value: no distance
    between samples is short enough for what has it on a surface, and the estimate has to say that there is more than
    the tolerance."""
    source = simple.OpenDataFile(os.path.join(data, REACTOR))
    view, display = show(source, "Temp")
    opacity = simple.GetOpacityTransferFunction("Temp")
    low, high = opacity.Points[0], opacity.Points[-4]
    for top in (1.0, 0.999):
        opacity.Points = [low, 0.0, 0.5, 0.0, high, top, 0.5, 0.0]
        display.SampleDistanceVoxels = 0.0
        picture = draw(os.path.join(out, f"reactor{top}.png"), view)
        display.UpdatePropertyInformation()
        estimate = display.GetProperty("EstimatedImageError").GetElement(0)
        display.SampleDistanceVoxels = 1.0 / 64
        fine = draw(os.path.join(out, f"reactor{top}_fine.png"), view)
        largest = abs(picture - fine).max()
        print(f"reactor, opacity {top} at the top: {largest} of 255, estimated {estimate:.1f}", flush=True)
        session.require(estimate > 4 if top == 1.0 else largest <= 2, f"the error is {largest}, estimated {estimate}")
    session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    data = session.real_data(REACTOR)
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    draw_can(data, arguments.out)
    draw_blocks(data, arguments.out)
    draw_reactor(data, arguments.out)
    if arguments.reference:
        for path in glob.glob(arguments.out + "/*.png"):
            if "fine" not in path and "reactor1.0" not in path:
                pictures.require_near(path, os.path.join(arguments.reference, os.path.basename(path)))


main()
