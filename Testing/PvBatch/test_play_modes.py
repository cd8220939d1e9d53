# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's play modes: every step one after the other, or the time kept and steps left out. Either
way the last picture is that of the last step.

    test_play_modes.py --out DIR
"""
import os
import time

from paraview import simple

import picture_scenes
import pictures
import session

SIZE = (300, 240)
TIMES = [float(step) for step in range(16)]
INFORMATION = session.time_information(TIMES) + """
info.Set(executive.WHOLE_EXTENT(), 0, 40, 0, 32, 0, 20)
info.Set(vtk.vtkDataObject.ORIGIN(), -20.0, -16.0, -10.0)
info.Set(vtk.vtkDataObject.SPACING(), 1.0, 1.0, 1.0)
"""
MOVES = """
import numpy
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
image = self.GetOutputDataObject(0)
image.SetExtent(0, 40, 0, 32, 0, 20)
image.SetOrigin(-20.0, -16.0, -10.0)
z, y, x = numpy.meshgrid(numpy.arange(21), numpy.arange(33), numpy.arange(41), indexing="ij")
wave = 0.5 + 0.5 * numpy.sin(0.3 * x + 0.2 * y - 0.4 * time)
output.PointData.append(wave.astype("f4").ravel(), "wave")
"""


def play(view, mode, duration=None):
    """Plays from the beginning.

    duration: whole seconds, in real time. Returns the times of all pictures, and the seconds taken.
    """
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.PlayMode = mode
    if duration:
        scene.Duration = duration
    scene.GoToFirst()
    shown = []
    tag = view.SMProxy.AddObserver("EndEvent", lambda *_: shown.append(view.ViewTime))
    begin = time.monotonic()
    scene.Play()
    seconds = time.monotonic() - begin
    view.SMProxy.RemoveObserver(tag)
    return shown, seconds


def slow_down(view, display):
    """Makes a frame take a quarter of a second, on any machine."""
    seconds = 0.0
    display.SampleDistanceVoxels = 0.1
    while seconds < 0.25:
        display.SampleDistanceVoxels = display.SampleDistanceVoxels / 2
        begin = time.monotonic()
        simple.Render(view)
        seconds = time.monotonic() - begin


def check_last(view, path, expected):
    simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
    worst = pictures.difference(pictures.load(path), pictures.load(expected)).max()
    session.require(worst == 0, f"{path} is {worst}/255 off the last step")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    path = os.path.join(arguments.out, "wave.banyan")
    moves = simple.ProgrammableSource(OutputDataSetType="vtkImageData", Script=MOVES,
                                      ScriptRequestInformation=INFORMATION)
    simple.SaveData(path, proxy=moves, WriteTimeSteps=1)
    simple.Delete(moves)
    series = simple.OpenDataFile(path)
    view = session.new_view(SIZE, CameraPosition=[60, -70, 50], CameraFocalPoint=[0, 0, 0],
                            CameraViewUp=[0, 0, 1])
    simple.SetActiveView(view)
    display = picture_scenes.volume(series, view, "wave", 1.0, (0.0, 1.0),
                                    opacities=(0.05, 0.05, 0.05, 0.05, 0.05))
    display.ReuseFrames = 0
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    simple.GetAnimationScene().GoToLast()
    slow_down(view, display)
    expected = os.path.join(arguments.out, "last.png")
    simple.SaveScreenshot(expected, view, ImageResolution=list(SIZE))

    shown, seconds = play(view, "Snap To TimeSteps")
    session.require(sorted(set(shown)) == TIMES and shown == sorted(shown), f"every step: {shown}")
    check_last(view, os.path.join(arguments.out, "every.png"), expected)

    # In less time than all steps take.
    duration = 1
    shown, kept = play(view, "Real Time", duration)
    steps = sorted({int(at) for at in shown})
    session.require(shown == sorted(shown) and shown[-1] == TIMES[-1], f"in real time: {shown}")
    session.require(1 < len(steps) < len(TIMES), f"steps {steps} in {kept:.2f} of {seconds:.2f} s")
    session.require(kept < duration + 3 * seconds / len(TIMES) + 1,
                    f"{kept:.2f} s in place of {duration:.2f} s")
    check_last(view, os.path.join(arguments.out, "real.png"), expected)
    session.clear()
    print(f"All steps in {seconds:.2f} s; {len(steps)} of them in {kept:.2f} s.")


if __name__ == "__main__":
    main()
