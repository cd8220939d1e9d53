# SPDX-License-Identifier: BSD-3-Clause
"""What becomes of a series on the disk while it is read, drawn and saved: right values or a sentence.

    test_damage.py --plugin Banyan.so --out FOLDER [--ranks N]

Bits flip in segments that were read before, segments are cut short, others save under the same name,
ranks see other files than others, and properties are set to what is no number.
"""
import argparse
import glob
import math
import os
import random
import subprocess
import sys
import traceback

os.environ["BANYAN_CACHE_MB"] = "0"  # everything is read and decoded again

import numpy
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import session

WINDOW = vtkStringOutputWindow()


def said():
    """What was written into the window since the last call."""
    text = WINDOW.GetOutput()
    new = text[said.before:]
    said.before = len(text)
    return new


said.before = 0


def tell(*what):
    """To where ctest reads: what Python prints goes to the window."""
    os.write(1, (" ".join(str(one) for one in what) + "\n").encode())


class Flips:
    """Flips bits of segments, and back."""

    def __init__(self, path, seed, bits=1):
        self.files = sorted(glob.glob(path + ".d/*.seg"))
        self.random = random.Random(seed)
        self.bits = bits
        self.flipped = []

    def __enter__(self):
        for _ in range(self.bits):
            name = self.random.choice(self.files)
            place = self.random.randrange(os.path.getsize(name))
            self.flipped.append((name, place, 1 << self.random.randrange(8)))
        self._flip()

    def __exit__(self, *_):
        self._flip()
        self.flipped = []

    def _flip(self):
        for name, place, bit in self.flipped:
            with open(name, "r+b") as file:
                file.seek(place)
                old = file.read(1)[0]
                file.seek(place)
                file.write(bytes([old ^ bit]))


def values(reader, array):
    """Read anew, decoded at once or when they are touched."""
    reader.DeferDecoding = 1 - int(reader.DeferDecoding)
    reader.UpdatePipeline()
    data = reader.GetClientSideObject().GetOutputDataObject(0).GetPointData()
    return vtk_to_numpy(data.GetArray(array)).copy()


def outcome(read, right, mention):
    """'same', or 'error' where that names array and file."""
    said()
    try:
        got = read()
    except RuntimeError as error:
        session.require(".banyan.d/" in str(error), f"no file in: {error}")
        return "error"
    text = said()
    if (got == right).all():
        return "same"
    session.require(".banyan.d/" in text and mention in text, f"other values, and said is: {text}")
    session.require(got.dtype.kind != "f" or numpy.isnan(got).any(), "values that are wrong")
    return "error"


def flips_of_values(path, source, array, count):
    simple.SaveData(path, proxy=source, ErrorBound=0.001)
    reader = simple.OpenDataFile(path)
    right = values(reader, array)
    count = {"same": 0, "error": 0, "flips": count}
    flips = Flips(path, 1)
    for _ in range(count.pop("flips")):
        with flips:
            count[outcome(lambda: values(reader, array), right, array)] += 1
        if not (values(reader, array) == right).all():
            sys.exit("good again, and other values")
    tell(os.path.basename(path), count)
    session.require(count["error"] > 10, "hardly anything was noticed")
    cut = sorted(glob.glob(path + ".d/*.seg"))[0]
    os.truncate(cut, 100)
    session.require(outcome(lambda: values(reader, array), right, array) == "error", "cut short")
    simple.Delete(reader)


def picture(view, step):
    view.ViewTime = step
    simple.Render(view)
    image = view.CaptureWindow(1)
    return vtk_to_numpy(image.GetPointData().GetScalars()).copy()


def flips_of_pictures(path, count):
    steps = [f"{path}.{step}.vti" for step in range(4)]
    for step, name in enumerate(steps):
        wave = vtkRTAnalyticSource()
        wave.SetWholeExtent(-20, 20, -20, 20, -20, 20)
        wave.SetXFreq(60 + 5 * step)
        writer = vtkXMLImageDataWriter()  # ParaView's own does not write this on several ranks
        writer.SetFileName(name)
        writer.SetDataModeToBinary()
        writer.SetInputConnection(wave.GetOutputPort())
        writer.Write()
    simple.SaveData(path, proxy=simple.OpenDataFile(steps), ErrorBound=0.001, KeyframeInterval=2,
                    WriteTimeSteps=1)
    reader = simple.OpenDataFile(path)
    view = simple.CreateView("RenderView")
    view.ViewSize = [100, 100]
    view.OrientationAxesVisibility = 0
    view.UseFXAA = 0  # which single pixels are smoothed is another matter
    display = simple.Show(reader, view)
    display.SetRepresentationType("Banyan Volume")
    simple.ColorBy(display, ("POINTS", "RTData"))
    display.SampleDistanceVoxels = 1  # with a tolerance pictures depend on those before, within it
    simple.ResetCamera(view)
    right = [picture(view, step) for step in range(4)]
    session.require(right[0].max() > right[0].min(), "nothing is drawn")
    count = {"same": 0, "error": 0, "flips": count}
    flips = Flips(path, 2, bits=2)
    for turn in range(count.pop("flips")):
        said()
        with flips:
            try:
                now = picture(view, turn % 4)
                text = said()
            except RuntimeError as error:
                now, text = right[0] + 9, str(error)
        same = int(abs(now.astype(int) - right[turn % 4]).max()) <= 1
        session.require(same or ".banyan.d/" in text, f"another picture at turn {turn}: {text}")
        count["same" if same else "error"] += 1
        now = picture(view, (turn + 2) % 4)  # neither this step nor the next turn's, which must be read
        wanted = right[(turn + 2) % 4]
        difference = int(abs(now.astype(int) - wanted).max())
        session.require(difference <= 1, f"good again, and not drawn: {difference}, {said()}")
    tell("pictures", count)
    session.require(count["error"] > 5, "hardly anything was noticed")
    for segment in glob.glob(path + ".d/*.seg"):
        os.truncate(segment, 100)
    try:
        picture(view, 2)  # and lives
    except RuntimeError as error:
        session.require(".banyan.d/" in str(error), str(error))
    numbers_of_display(display, view)
    simple.Delete(view)


DISPLAY = ("ImageErrorTolerance", "InteractiveImageErrorTolerance", "InteractiveFrameSeconds",
           "SampleDistanceVoxels", "ScreenErrorPixels", "MeshTolerance",
           "MaxElementsPerPixel", "TemporalEnhancement", "Ambient", "Diffuse", "Specular",
           "SpecularPower")
BAD = (math.nan, math.inf, -math.inf, -0.5)


def expect_refused(proxy, name, good, bad):
    said()
    setattr(proxy, name, bad)
    text = said()
    number = bad[0] if isinstance(bad, list) else bad
    session.require(name in text and f"{number:g}" in text, f"{name} = {bad}: {text}")
    setattr(proxy, name, good)
    session.require(not said(), f"{name} = {good} is refused")


def numbers_of_display(display, view):
    for name in DISPLAY:
        if name not in display.ListProperties():
            continue  # of meshes alone
        good = getattr(display, name)
        for bad in BAD:
            expect_refused(display, name, good, bad)
    for name in ("CroppingOrigin", "CroppingScale"):
        expect_refused(display, name, list(getattr(display, name)), [math.nan] * 3)
    good = display.ScalarOpacityUnitDistance
    said()
    display.ScalarOpacityUnitDistance = math.nan
    simple.Render(view)
    session.require("ScalarOpacityUnitDistance" in said(), "a unit distance that is no number")
    display.ScalarOpacityUnitDistance = good


def numbers_of_filters_and_files(path):
    source = simple.Wavelet(WholeExtent=[0, 8] * 3)
    for kind, names in (("BanyanHexOctree", ("MeshTolerance", "MeshSamplingTolerance")),
                        ("BanyanTemporalEnhancement", ("Strength", "Sensitivity", "Scale", "NoiseFloor"))):
        proxy = globals()[kind](Input=source)
        for name in names:
            for bad in BAD:
                expect_refused(proxy, name, getattr(proxy, name), bad)
        simple.Delete(proxy)
    refused = {"ErrorBound": BAD, "AsinhScale": BAD, "RangePercentiles": [[b, 99] for b in BAD],
               "Range": [[b, 1] for b in BAD[:3]], "FillValues": [[b] for b in BAD[:3]],
               "TransformTable": [[b, 0, 1, 1] for b in BAD[:3]],
               "OpacityFunction": [[b, 0, 1, 1] for b in BAD[:3]]}
    for name, bad in refused.items():
        for value in bad:
            number = value[0] if isinstance(value, list) else value
            try:
                simple.SaveData(path, proxy=source, **{name: value})
            except RuntimeError as error:
                session.require(name in str(error) and f"{number:g}" in str(error), f"{name}: {error}")
            else:
                sys.exit(f"{name} = {value} was taken")
    session.require(not glob.glob(path + "*"), "something was left behind")
    simple.SaveData(path, proxy=source)
    reader = simple.OpenDataFile(path)
    expect_refused(reader, "CacheBudget", -1, -2)


SAVER = """
import sys, time
from paraview import simple
simple.LoadPlugin(sys.argv[1], ns=globals())
time.sleep(float(sys.argv[4]))
source = simple.Wavelet(WholeExtent=[-16, 16] * 3)
try:
    simple.SaveData(sys.argv[2], proxy=source, ErrorBoundMode="Absolute", ErrorBound=float(sys.argv[3]))
except RuntimeError as error:
    print("refused:", error)
    sys.exit(3)
"""


def two_savers(plugin, path):
    """Both begin at once; one may be refused, and what is there is whole."""
    with open(path + ".py", "w", encoding="utf-8") as file:
        file.write(SAVER)
    savers = [subprocess.Popen(["pvpython", path + ".py", plugin, path, bound, "0"], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
              for bound in ("0.001", "0.01")]
    for saver in savers:
        output, _ = saver.communicate(timeout=60)
        session.require(saver.returncode in (0, 3), output)
        session.require(saver.returncode == 0 or "under way" in output, output)
    session.require(any(saver.returncode == 0 for saver in savers), "neither was saved")
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline()
    session.require(reader.GetDataInformation().GetNumberOfPoints() == 33**3, "it does not open")
    simple.Delete(reader)


def held_by_another(path):
    """All ranks hear of a lock that another process holds, and of one that it has left."""
    source = simple.Wavelet(WholeExtent=[0, 8] * 3)
    simple.SaveData(path, proxy=source)
    code = ("import fcntl, sys, time; f = open(sys.argv[1], 'w'); fcntl.lockf(f, fcntl.LOCK_EX); "
            "f.write('process 7 on elsewhere, since 2020-01-01'); f.flush(); print(); "
            "sys.stdout.flush(); time.sleep(60)")
    holder = subprocess.Popen(["python3", "-c", code, path + ".d/saving.lock"], stdout=subprocess.PIPE)
    holder.stdout.readline()
    before = sorted(os.listdir(path + ".d"))
    try:
        simple.SaveData(path, proxy=source)
    except RuntimeError as error:
        session.require("process 7 on elsewhere" in str(error) and path in str(error), str(error))
    else:
        sys.exit("saved while another one saves")
    session.require(sorted(os.listdir(path + ".d")) == before, "files have changed")
    holder.kill()
    holder.wait()
    simple.SaveData(path, proxy=source, ErrorBound=0.01)
    session.require(len(os.listdir(path + ".d")) == 1, str(os.listdir(path + ".d")))


WALK = """
import os
from vtkmodules.vtkParallelCore import vtkMultiProcessController
rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
os.chdir({folders}[1 if rank else 0])
"""


def walk(rank_zero, others):
    """Ranks go to folders, where relative names lead to other files."""
    source = simple.ProgrammableSource(Script=WALK.format(folders=[rank_zero, others]))
    source.UpdatePipeline()
    simple.Delete(source)


def other_files_of_ranks(folder, ranks):
    """One name, and not the same files on all machines: refused by all ranks."""
    home = os.getcwd()
    for name, size in (("a", 8), ("b", 8), ("c", 12)):
        os.makedirs(os.path.join(folder, name))
        source = simple.Wavelet(WholeExtent=[0, size] * 3, Maximum=ord(name))
        simple.SaveData(os.path.join(folder, name, "one.banyan"), proxy=source)
    for name in ("b", "c"):
        walk(*(os.path.abspath(os.path.join(folder, n)) for n in ("a", name)))
        try:
            simple.OpenDataFile("one.banyan")
        except RuntimeError as error:
            session.require("the ranks see different series" in str(error), str(error))
            session.require(ranks > 1, str(error))
        else:
            session.require(ranks == 1, f"ranks read a and {name}")
        walk(home, home)


def rank_without_data(path):
    """It reads what replaces a series, too: its zone may have something of it."""
    pictures = []
    for name, value in ((path, 1), (path, 8), (path + ".banyan", 8)):
        image = simple.Wavelet(WholeExtent=[0, 1] * 3)
        source = simple.Calculator(Input=image, ResultArrayName="v", Function=f"{value}+coordsX/9")
        simple.SaveData(name, proxy=source, PointArrays=["v"])
        if value == 1 or name != path:
            reader = simple.OpenDataFile(name)
            view = simple.CreateView("RenderView")
            view.ViewSize = [100, 100]
            view.OrientationAxesVisibility = 0
            view.UseFXAA = 0
            display = simple.Show(reader, view)
            display.SetRepresentationType("Banyan Volume")
            display.LoadBalancing = 0
            simple.ColorBy(display, ("POINTS", "v"))
            simple.GetColorTransferFunction("v").RescaleTransferFunction(0, 10)
            simple.GetOpacityTransferFunction("v").RescaleTransferFunction(0, 10)
            simple.ResetCamera(view)
        else:
            simple.ReloadFiles(reader)
        pictures.append(picture(view, 0).astype(int))
    session.require(abs(pictures[0] - pictures[1]).max() > 20, "the old one is drawn")
    difference = abs(pictures[1] - pictures[2]).max()
    session.require(difference <= 1, f"a part of the old one is drawn: {difference}")
    simple.Delete(view)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--alone", action="store_true", help="one process, which may start others")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, ns=globals())
    session.empty_folder(arguments.out)
    vtkOutputWindow.SetInstance(WINDOW)

    def path(name):
        return os.path.join(arguments.out, name)

    held_by_another(path("held.banyan"))
    flips_of_pictures(path("drawn.banyan"), 40)
    if arguments.alone:
        two_savers(arguments.plugin, path("two.banyan"))
        numbers_of_filters_and_files(path("numbers.banyan"))
        image = simple.Wavelet(WholeExtent=[-20, 20] * 3)
        flips_of_values(path("image.banyan"), image, "RTData", 150)
        mesh = simple.AppendDatasets(Input=simple.Wavelet(WholeExtent=[-10, 10] * 3))
        flips_of_values(path("mesh.banyan"), mesh, "RTData", 60)
        view = simple.CreateView("RenderView")
        display = simple.Show(mesh, view)
        display.SetRepresentationType("Banyan Volume")
        session.require("MeshTolerance" in display.ListProperties(), "the display of a mesh")
        numbers_of_display(display, view)
        simple.Delete(view)
    rank_without_data(path("tiny.banyan"))
    # Last: ParaView's scripts import names into this one.
    other_files_of_ranks(path("ranks"), 1 if arguments.alone else 3)


if __name__ == "__main__":
    try:
        main()
    except BaseException:
        tell(WINDOW.GetOutput() + traceback.format_exc())
        os._exit(1)
