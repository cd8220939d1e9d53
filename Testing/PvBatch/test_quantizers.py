# SPDX-License-Identifier: BSD-3-Clause
"""What the writer's properties ask for is what is in the series: read back and judged with numpy.

    pvbatch --sym test_quantizers.py --plugin Banyan.so --out FOLDER

Each rank judges its own piece. The series stay in FOLDER/series: they are the same files on any
number of ranks (compare_files.py).
"""
import glob
import json
import os

import numpy
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import compare_data
import session

SAMPLES = (40, 36, 35)
STEPS = 3
FILL = numpy.float32(1e20)


def controller():
    return vtkMultiProcessController.GetGlobalController()


def field(step):
    """Float32 [z][y][x]: waves over five decades, with some fill values."""
    z, y, x = numpy.meshgrid(*(numpy.arange(n, dtype="f8") for n in reversed(SAMPLES)),
                             indexing="ij")
    r = numpy.sqrt(x**2 + y**2 + z**2)
    values = (100 * numpy.exp(-0.15 * r - 2 * step) * numpy.sin(0.6 * r - step)).astype("f4")
    values[:, 3, :4] = FILL
    return values


def make_source(folder):
    if controller().GetLocalProcessId() == 0:
        os.makedirs(os.path.join(folder, "series"), exist_ok=True)
        for step in range(STEPS):
            image = vtkImageData()
            image.SetDimensions(SAMPLES)
            array = numpy_to_vtk(field(step).reshape(-1), deep=True)
            array.SetName("u")
            image.GetPointData().SetScalars(array)
            writer = vtkXMLImageDataWriter()
            writer.SetInputData(image)
            writer.SetFileName(os.path.join(folder, f"step_{step}.vti"))
            writer.SetDataModeToBinary()
            session.require(writer.Write(), "a step was not written")
    controller().Barrier()
    return simple.XMLImageDataReader(FileName=sorted(glob.glob(folder + "/step_*.vti")))


def write(folder, name, source, **properties):
    """The path of the series, and what its index says of the one component."""
    path = os.path.join(folder, "series", name + ".banyan")
    simple.SaveData(path, proxy=source, WriteTimeSteps=1, KeyframeInterval=2, **properties)
    with open(path, encoding="utf-8") as file:
        file.readline()
        index = json.load(file)
    return path, index["arrays"][0]["components"][0]


def pieces(path):
    """Original and decoded values of this rank, step by step."""
    reader = simple.BanyanSeriesReader(FileName=path, DeferDecoding=0)
    for step in range(STEPS):
        reader.UpdatePipeline(float(step))
        image = reader.GetClientSideObject().GetOutputDataObject(0)
        x0, x1, y0, y1, z0, z1 = image.GetExtent()
        original = field(step)[z0:z1 + 1, y0:y1 + 1, x0:x1 + 1]
        decoded = compare_data.as_numpy(image.GetPointData().GetArray("u"))
        yield original, decoded.reshape(original.shape)


def judge(name, path, transform, bound, clamp=None):
    """|f(decoded) - f(original)| <= bound; fill values keep their bits."""
    greatest = 0.0
    for original, decoded in pieces(path):
        fill = original == FILL
        session.require((decoded[fill] == FILL).all(), f"{name}: fill values changed")
        wanted = original if clamp is None else original.clip(*clamp)
        error = numpy.abs(transform(decoded[~fill].astype("f8")) -
                          transform(wanted[~fill].astype("f8")))
        greatest = max(greatest, error.max())
    session.require(greatest <= bound * (1 + 1e-9), f"{name}: error {greatest}, bound {bound}")
    session.require(greatest > 0.3 * bound, f"{name}: error {greatest} is no use of {bound}")


def same(values):
    return values


def check_transforms(folder, source):
    fills = {"FillValues": [1e20]}
    path, component = write(folder, "uniform", source, **fills)
    session.require(component["errorBoundAbsolute"] < 200 / 512, "the fill value set the range")
    session.require(component["fillCount"] == STEPS * 4 * SAMPLES[2], "fill values: wrong count")
    judge("uniform", path, same, component["errorBoundAbsolute"])

    path, component = write(folder, "asinh", source, Transform="Asinh", AsinhScale=0.01, **fills)
    low, high = component["promisedRange"]
    session.require(component["transform"] == {"kind": "asinh", "scale": 0.01}, "no asinh")
    bound = (numpy.arcsinh(high / 0.01) - numpy.arcsinh(low / 0.01)) / 512
    judge("asinh", path, lambda v: numpy.arcsinh(v / 0.01), bound)

    knots = [-100, -100, 0, 0, 1, 50, 100, 149]
    path, component = write(folder, "table", source, Transform="Table", TransformTable=knots,
                            ErrorBoundMode="Absolute", ErrorBound=0.1, Profile="Fast", **fills)
    judge("table", path, lambda v: numpy.interp(v, knots[::2], knots[1::2]), 0.1)

    path, component = write(folder, "adaptive", source, Transform="Adaptive", **fills)
    table = component["transform"]
    judge("adaptive", path, lambda v: numpy.interp(v, table["x"], table["y"]),
          component["errorBoundAbsolute"])


def check_ranges(folder, source):
    path, component = write(folder, "percentiles", source, RangeMode="Percentiles",
                            RangePercentiles=[1, 98], Profile="Compact")
    session.require(component["errorBoundAbsolute"] < 50 / 512, "outliers set the range")
    judge("percentiles", path, same, component["errorBoundAbsolute"])

    path, component = write(folder, "clamped", source, RangeMode="Given", Range=[-1, 2],
                            ClampOutside=1, FillValues=[1e20])
    outside = sum(((v < -1) | ((v > 2) & (v != FILL))).sum() for v in map(field, range(STEPS)))
    session.require(component["clampedCount"] == outside, "clamped: wrong count")
    judge("clamped", path, same, 3 / 512, (-1, 2))


def check_opacity(folder, source):
    fills = {"FillValues": [1e20], "ErrorBound": 1e-4}
    plain = write(folder, "plain", source, **fills)[0]
    path, component = write(folder, "opacity", source, OpacityFunction=[1, 0, 2, 1], **fills)
    bound = component["errorBoundAbsolute"]
    changed = 0
    for original, decoded in pieces(path):
        far = numpy.abs(decoded.astype("f8") - original.astype("f8")) > bound
        session.require((original[far] <= 1).all() and (decoded[far] <= 1).all(),
                        "a visible value is out of bound, or an invisible one became visible")
        changed += far.sum()
    session.require(changed > 0 and component["invisibleCount"] > 0, "opacity saves nothing")
    sizes = [sum(os.path.getsize(file) for file in glob.glob(name + ".d/*"))
             for name in (plain, path)]
    session.require(sizes[1] < sizes[0], f"the opacity function makes the series larger: {sizes}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    source = make_source(arguments.out)
    check_transforms(arguments.out, source)
    check_ranges(arguments.out, source)
    check_opacity(arguments.out, source)
    try:
        write(arguments.out, "refused", source, Transform="Table", TransformTable=[0, 0, 1])
    except (RuntimeError, OSError):
        return
    raise AssertionError("a table of one and a half knots was written")


if __name__ == "__main__":
    main()
