# SPDX-License-Identifier: BSD-3-Clause
"""Pictures as arrays, and the measures by which two of them are compared."""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter


def load(path):
    """Picture of a PNG file as int array [y][x][3], y up; raises when it cannot be read."""
    reader = vtkPNGReader()
    if not reader.CanReadFile(str(path)):
        raise OSError(f"{path} is missing or no PNG file")
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return values.reshape(height, width, -1)[:, :, :3].astype(int)


def save(path, picture):
    height, width, _ = picture.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    flat = numpy.ascontiguousarray(picture.reshape(-1, 3).clip(0, 255).astype(numpy.uint8))
    image.GetPointData().SetScalars(numpy_to_vtk(flat, deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()


def difference(a, b):
    """Largest channel difference per pixel; pictures of different size differ everywhere."""
    if a.shape != b.shape:
        return numpy.full(a.shape[:2], 255)
    return numpy.abs(a - b).max(axis=2)


def is_marked(picture):
    """Whether the upper right corner has the mark of a coarse picture."""
    return (numpy.abs(picture[-12, -12] - (255, 150, 0)) < 3).all()


def require_near(path, reference, allowed=1):
    """The picture of a file is that of another one, up to so many of 255."""
    error = difference(load(reference), load(path))
    print(f"{path}: {int(error.max())} from {reference}", flush=True)
    if error.max() > allowed:
        raise AssertionError(f"{path} differs from {reference} by {int(error.max())}")


def rim(picture, width=1):
    """Pixels that are at most `width` pixels from a neighbour that looks quite different."""
    result = numpy.zeros(picture.shape[:2], dtype=bool)
    for axis in (0, 1):
        steps = numpy.abs(numpy.diff(picture, axis=axis)).max(axis=2) > 40
        first, second = [slice(None)] * 2, [slice(None)] * 2
        first[axis], second[axis] = slice(0, -1), slice(1, None)
        result[tuple(first)] |= steps
        result[tuple(second)] |= steps
    for _ in range(width - 1):
        padded = numpy.pad(result, 1)
        height, length = result.shape
        result = numpy.any([padded[y:y + height, x:x + length]
                            for y in range(3) for x in range(3)], axis=0)
    return result


def psnr(a, b):
    """Peak signal-to-noise ratio in dB over all pixels and channels, for a peak of 255."""
    mean_square = ((a - b).astype(float) ** 2).mean()
    return float("inf") if mean_square == 0 else 10 * numpy.log10(255**2 / mean_square)
