# SPDX-License-Identifier: BSD-3-Clause
"""mpiexec -n N pvbatch demo_draw.py SERIES LOOK FOLDER REPORT

Draws each time step of the encoded SERIES with the representation Banyan Volume into FOLDER, as
frame_0000.png and so on. LOOK is the report of demo_measure.py: what to draw and a histogram of it.
REPORT (JSON) receives the seconds and the representation's own statistics of each frame.
"""

import os
import sys
import time

from paraview import simple

import demo_common as demo
import demo_look

REPRESENTATION = "Banyan Volume"
IMAGE_SIZE = (1280, 720)
STATISTICS = ("TotalSeconds", "RenderSeconds", "CompositeSeconds", "Imbalance", "SamplesTaken",
              "BricksDrawn", "BricksSkipped", "BytesComposited", "BytesRead", "CacheBytes")


def statistics_of(display):
    display.UpdatePropertyInformation()
    return {name: display.GetPropertyValue(name) for name in STATISTICS}


def draw_frame(view, display, folder, name, image_size):
    """Draws the view's present time into a file; what the report says of it."""
    start = time.perf_counter()
    simple.SaveScreenshot(os.path.join(folder, name), view, ImageResolution=image_size)
    seconds = time.perf_counter() - start
    if not os.path.isfile(os.path.join(folder, name)):
        raise demo.DemoError(f"{name} was not written; the messages above say why.")
    return {"file": name, "seconds": seconds, "statistics": statistics_of(display)}


def draw_frames(view, display, times, folder):
    frames = []
    for step, value in enumerate(times):
        demo_look.turn_camera(view, step, len(times))
        view.ViewTime = value
        frame = draw_frame(view, display, folder, f"frame_{step:04d}.png", IMAGE_SIZE)
        frames.append({"step": step, "time": value, **frame})
        demo.progress(f"frame {step + 1} of {len(times)}: {frame['seconds']:.2f} s, of which "
                      f"{frame['statistics']['TotalSeconds']:.2f} s in the volume")
    return frames


def main():
    series, look, folder, report = sys.argv[1:5]
    demo.load_plugin()
    look = demo.read_json(look)
    reader = demo.open_series([series])
    times = demo.time_values(reader)
    view = demo_look.make_view(IMAGE_SIZE)
    display = simple.Show(reader, view)
    display.SetRepresentationType(REPRESENTATION)
    demo_look.dress(reader, display, view, look)
    frames = draw_frames(view, display, times, folder)
    demo.write_json(report, {"representation": REPRESENTATION, "image_size": IMAGE_SIZE,
                             "paraview": demo.paraview_version(), "frames": frames})


if __name__ == "__main__":
    demo.run(main)
