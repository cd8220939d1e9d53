# SPDX-License-Identifier: BSD-3-Clause
"""mpiexec -n N pvbatch demo_earthquake.py SERIES LOOK FOLDER REPORT

Draws each time step of an earthquake, a mesh of hexahedra in an encoded SERIES, with the
representation Banyan Volume into FOLDER: plain_0000.png and so on as it is, enhanced_0000.png with
its motion brought out. LOOK is the report of demo_measure.py. REPORT (JSON) receives the seconds and
the representation's own statistics of each picture.
"""

import sys

from paraview import simple

import demo_common as demo
import demo_draw
import demo_look

IMAGE_SIZE = (640, 480)
STRENGTH = 0.6
CAPTIONS = {"plain": "Ground velocity", "enhanced": "Ground velocity, motion brought out"}


def dress(reader, display, view, look):
    """Colours and opacities for waves that fill the box, and a camera that looks into it."""
    name = look["drawn_array"]
    high = 0.6 * look["histogram"]["range"][1]
    simple.ColorBy(display, ("POINTS", name, "Magnitude"))
    colours = simple.GetColorTransferFunction(name)
    demo_look.apply_colour_map(colours)
    colours.RescaleTransferFunction(0.0, high)
    opacity = simple.GetOpacityTransferFunction(name)
    opacity.Points = [number for share, value in
                      ((0.0, 0.0), (0.03, 0.0), (0.12, 0.04), (0.3, 0.18), (0.6, 0.5), (1.0, 0.9))
                      for number in (share * high, value, 0.5, 0.0)]
    bounds = reader.GetDataInformation().GetBounds()
    edges = [bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3)]
    display.ScalarOpacityUnitDistance = max(edges) / 32.0
    demo_look.outline(reader, view)
    demo_look.clock(reader, view, "{time:.1f} s")
    view.CameraPosition = [bounds[0] + 0.28 * edges[0], bounds[2] - 0.95 * edges[1],
                           bounds[5] + 1.35 * edges[2]]
    view.CameraFocalPoint = [bounds[0] + 0.5 * edges[0], bounds[2] + 0.45 * edges[1],
                             bounds[5] - 0.5 * edges[2]]
    view.CameraViewUp = (0.0, 0.0, 1.0)
    view.CameraViewAngle = 41


def caption(view):
    text = simple.Text(Text="")
    shown = simple.Show(text, view)
    shown.WindowLocation = "Upper Center"
    shown.FontSize = 20
    return text


def main():
    series, look, folder, report = sys.argv[1:5]
    demo.load_plugin()
    reader = demo.open_series([series])
    times = demo.time_values(reader)
    view = demo_look.make_view(IMAGE_SIZE)
    display = simple.Show(reader, view)
    display.SetRepresentationType(demo_draw.REPRESENTATION)
    dress(reader, display, view, demo.read_json(look))
    text = caption(view)
    frames = []
    for step, value in enumerate(times):
        view.ViewTime = value
        for kind, strength in (("plain", 0.0), ("enhanced", STRENGTH)):
            text.Text = CAPTIONS[kind]
            display.TemporalEnhancement = strength
            frames.append(demo_draw.draw_frame(
                view, display, folder, f"{kind}_{step:04d}.png", IMAGE_SIZE))
            frames[-1].update(step=step, time=value)
        demo.progress(f"step {step + 1} of {len(times)}: {frames[-2]['seconds']:.2f} s, and "
                      f"{frames[-1]['seconds']:.2f} s with motion brought out")
    demo.write_json(report, {"representation": demo_draw.REPRESENTATION, "image_size": IMAGE_SIZE,
                             "paraview": demo.paraview_version(), "frames": frames})


if __name__ == "__main__":
    demo.run(main)
