# SPDX-License-Identifier: BSD-3-Clause
"""Volumes of several kinds in random places of one view, and what each of them shows alone.

A module of its own: scripts of programmable sources replace names of the main one.
"""
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

import picture_scenes
import pictures
import session

SIZE = (200, 150)


def shown(view):
    """What the window shows, as int array [y][x][3]."""
    simple.Render(view)
    return window_of(view)


def window_of(view):
    grab = vtkWindowToImageFilter()
    grab.SetInput(view.SMProxy.GetRenderWindow())
    grab.ShouldRerenderOff()
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return values.reshape(height, width, -1)[:, :, :3].astype(int)


class Pictures:
    """Saves pictures, and compares them with those of another run."""

    def __init__(self, arguments):
        self.folder, self.reference = arguments.out, arguments.reference

    def take(self, name, picture, allowed=1):
        pictures.save(os.path.join(self.folder, name + ".png"), picture)
        if self.reference:
            expected = pictures.load(os.path.join(self.reference, name + ".png"))
            error = pictures.difference(expected, picture)
            session.require(error.max() <= allowed, f"{name} is off by {error.max()} from one rank's")


class Spheres:
    """Opaque ones, each a mesh of its own, whole on one rank. (The depth that OpenGL draws for a part of a
    mesh depends on the rest of it in the last bits, and rays end there.)"""

    def __init__(self, view):
        listed = (("a", (0, 0, 0), 3, (0.9, 0.2, 0.1)), ("b", (9, 3, -6), 4, (0.1, 0.9, 0.2)),
                  ("c", (-8, 5, 8), 3, (0.2, 0.3, 1.0)))
        self.displays = [picture_scenes.spheres(view, [sphere], first=rank)
                         for rank, sphere in enumerate(listed)]
        self.colors = [list(display.LookupTable.RGBPoints) for display in self.displays]

    def set(self, name, value):
        for display in self.displays:
            setattr(display, name, value)

    def paint(self, grey):
        """All over in one grey, without light; None: as they were."""
        for display, colors in zip(self.displays, self.colors):
            display.LookupTable.RGBPoints = [number if grey is None or i % 4 == 0 else grey
                                             for i, number in enumerate(colors)]
            display.Ambient, display.Diffuse = (0, 1) if grey is None else (1, 0)


class Placed:
    """A display, and where its box is."""

    def __init__(self, display, bounds):
        self.display = display
        low, high = numpy.array(bounds[0::2]), numpy.array(bounds[1::2])
        self.middle, self.half = (low + high) / 2, (high - low) / 2

    def place(self, rng, size):
        self.scale = size / self.half.max() * numpy.exp([rng.uniform(-0.6, 0.3) for _ in range(3)])
        self.turn = [rng.uniform(0, 360) for _ in range(3)]
        self.move(numpy.zeros(3))

    def move(self, middle):
        """Puts the middle of the box there."""
        turned = vtkTransform()
        turned.RotateZ(self.turn[2])
        turned.RotateX(self.turn[0])
        turned.RotateY(self.turn[1])
        turned.Scale(self.scale)
        matrix = turned.GetMatrix()
        self.linear = numpy.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
        self.at = middle
        self.display.Scale = list(self.scale)
        self.display.Orientation = self.turn
        session.move_to(self.display, middle - self.linear @ self.middle)

    def reach(self, direction):
        """Half of its extent along a direction."""
        return float(numpy.abs(direction @ self.linear) @ self.half)


def unit(rng):
    while True:
        vector = numpy.array([rng.uniform(-1, 1) for _ in range(3)])
        if 0.1 < numpy.linalg.norm(vector) < 1:
            return vector / numpy.linalg.norm(vector)


def blended(behind, single, order):
    """Single pictures, the farthest one first."""
    result = behind.astype(float)
    for volume in order:
        black, white = single[volume]
        result = black + (white - black) / 255.0 * result
    return result


class Stage:
    def __init__(self):
        self.view = session.new_view(SIZE, CameraViewAngle=30)
        # ParaView does not tell clipping planes of what moves.
        self.view.MaxClipBounds = [-45, 45] * 3
        self.view.LockBounds = 1
        wavelet = simple.Wavelet(WholeExtent=[-8, 8, -7, 7, -6, 6])
        cells = simple.UnstructuredCellTypes(CellType="Hex", BlocksDimensions=[8, 6, 7])
        first = Placed(picture_scenes.volume(wavelet, self.view, "RTData", value_range=(130, 280),
                                             opacities=(0.1, 0.2, 0.6, 0.8, 0.9)),
                       [-8, 8, -7, 7, -6, 6])
        second = Placed(picture_scenes.encoded(self.view, opacities=(0.05, 0.1, 0.4, 0.6, 0.7)),
                        [-20, 20, -16, 16, -14, 14])
        third = Placed(picture_scenes.volume(cells, self.view, "DistanceToCenter", value_range=(0, 7),
                                             opacities=(0.9, 0.8, 0.5, 0.3, 0.1)),
                       [0, 8, 0, 6, 0, 7])
        fourth = Placed(picture_scenes.volume(
            simple.Wavelet(WholeExtent=[0, 9, 0, 9, 0, 9], XFreq=20), self.view, "RTData",
            value_range=(130, 280)), [0, 9, 0, 9, 0, 9])
        self.volumes = [first, second, third, fourth]
        self.spheres = Spheres(self.view)

    def arrange(self, rng):
        """Stacks the boxes along a direction, some touching; returns what tells their order."""
        along = unit(rng)
        there = rng.sample(self.volumes, rng.randint(2, 4))
        at = -8.0 * len(there)
        for volume in self.volumes:
            volume.display.Visibility = 0
        for volume in there:
            volume.place(rng, rng.uniform(7, 13))
            reach = volume.reach(along)
            aside = numpy.cross(along, unit(rng)) * 2
            volume.move(along * (at + reach) + aside)
            at += 2 * reach + max(0.0, rng.uniform(-3, 3)) + 1e-6
        for volume in there:
            volume.display.Visibility = 1
        eye = unit(rng) + rng.choice([-1, 0, 1]) * along
        eye = eye / numpy.linalg.norm(eye) * rng.choice([55, 70, 90])
        self.view.CameraPosition = list(eye)
        self.view.CameraFocalPoint = [rng.uniform(-4, 4) for _ in range(3)]
        self.view.CameraViewUp = list(unit(rng))
        self.view.CameraParallelProjection = int(rng.random() < 0.4)
        self.view.CameraParallelScale = 22
        self.spheres.set("Visibility", int(rng.random() < 0.8))
        return along, there

    def far_to_near(self, along, there):
        eye = numpy.array(self.view.CameraPosition)
        if self.view.CameraParallelProjection:
            forward = numpy.array(self.view.CameraFocalPoint) - eye
            return sorted(there, key=lambda volume: -(volume.at @ along) * numpy.sign(forward @ along))

        def distance(volume):
            return max(0.0, abs((volume.at - eye) @ along) - volume.reach(along))
        return sorted(there, key=distance, reverse=True)

    def single_pictures(self, order):
        """What is there without volumes, and of each volume, what it shows alone over black and white."""
        for volume in order:
            volume.display.Visibility = 0
        behind = shown(self.view)
        single = {}
        kept_background = list(self.view.Background)
        for volume in order:
            volume.display.Visibility = 1
            over = []
            for grey in (0.0, 1.0):
                self.view.Background = [grey] * 3
                self.spheres.paint(grey)
                over.append(shown(self.view))
            self.spheres.paint(None)
            self.view.Background = kept_background
            volume.display.Visibility = 0
            single[volume] = over
        for volume in order:
            volume.display.Visibility = 1
        return behind, single
