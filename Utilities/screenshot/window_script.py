# SPDX-License-Identifier: BSD-3-Clause
"""Runs inside the ParaView client: opens a series, shows it as 'Banyan Volume', says when it is done.

Environment: BANYAN_SERIES (path of a .banyan file), BANYAN_READY (file to make when the picture
stands).
"""
import os
import traceback

from paraview.simple import (ColorBy, GetActiveView, GetAnimationScene, GetColorTransferFunction,
                             GetOpacityTransferFunction, OpenDataFile, Render, SetActiveSource,
                             Show)

from demo_look import apply_colour_map


def show(path):
    reader = OpenDataFile(path)
    view = GetActiveView()
    display = Show(reader, view)
    display.SetRepresentationType('Banyan Volume')
    reader.UpdatePipeline()
    name = reader.PointData.GetArray(0).Name
    ColorBy(display, ('POINTS', name))
    display.SetScalarBarVisibility(view, True)
    colors = GetColorTransferFunction(name)
    apply_colour_map(colors)
    low, high = colors.RGBPoints[0], colors.RGBPoints[-4]
    opacity = GetOpacityTransferFunction(name)
    opacity.Points = []
    for position, value in ((0.0, 0.0), (0.1, 0.0), (0.3, 0.08), (0.6, 0.25), (1.0, 0.8)):
        opacity.Points = list(opacity.Points) + [low + position * (high - low), value, 0.5, 0.0]
    times = list(reader.TimestepValues)
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = times[(3 * len(times)) // 4]
    view.ResetActiveCameraToPositiveY()
    view.ResetCamera()
    view.CameraViewAngle = 11
    SetActiveSource(reader)
    Render()


try:
    show(os.environ['BANYAN_SERIES'])
    outcome = 'ready'
except Exception:  # the shell script outside waits for a word, whatever happens
    outcome = traceback.format_exc()
with open(os.environ['BANYAN_READY'], 'w', encoding='utf-8') as marker:
    marker.write(outcome)
