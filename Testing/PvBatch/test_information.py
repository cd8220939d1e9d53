# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView asks of a series without needing values decodes nothing; colours get the range of
the whole series.

    test_information.py --plugin Banyan.so --out FOLDER

Counted on the process that answers (the first rank); on all ranks the reader's output stays
untouched or not together, because all are asked together.
"""
import os

from paraview import simple

import make_series
import pictures
import session

SAMPLES = (41, 33, 29)
STEPS = 3


def decoded(reader):
    reader.UpdatePropertyInformation()
    return reader.GetPropertyValue("BricksDecoded")


def expect_nothing_decoded(reader, after):
    session.require(decoded(reader) == 0, f"{decoded(reader)} bricks decoded by {after}")


def ranges(reader):
    """The range of each step."""
    result = []
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        result.append(reader.PointData["swirl"].GetRange())
    return result


def colour_range(display):
    """What the colour map of a display reaches from and to."""
    points = simple.GetColorTransferFunction("swirl", display).RGBPoints
    return points[0], points[-4]


def close(a, b):
    return all(abs(x - y) <= 1e-6 for x, y in zip(a, b))


def kilobytes(reader):
    """Of the reader's output on all ranks: next to nothing as long as arrays are deferred."""
    # ParaView remembers what it has asked before.
    reader.SMProxy.MarkDirty(reader.SMProxy)
    return reader.GetDataInformation().GetMemorySize()


def volume(display, view, path):
    """The picture of the volume."""
    display.SetRepresentationType(session.REPRESENTATION)
    simple.SaveScreenshot(path, view)
    display.UpdatePropertyInformation()
    session.require(display.GetPropertyValue("BricksDrawn") > 0, "no bricks were drawn")
    return pictures.load(path)


def check_drawing(reader, display, view, of_series, path):
    """A volume is drawn from the series, alone and beside filters; these get plain arrays."""
    picture = volume(display, view, path)
    session.require(kilobytes(reader) < 100, "to draw the volume, values are held")
    before = decoded(reader)
    part = simple.Slice(Input=reader)
    part.UpdatePipeline(view.ViewTime)
    session.require(decoded(reader) >= before, "bricks get lost")
    session.require(kilobytes(reader) > 100, "a slice gets deferred arrays")
    again = volume(display, view, path)
    session.require(pictures.difference(again, picture).max() <= 1,
                    "beside a slice the volume looks different")
    session.require(close(colour_range(display), of_series), "colours change with plain arrays")
    simple.Delete(part)
    del part
    simple.Delete(simple.Shrink(Input=reader))  # which was never updated
    view.ViewTime = reader.TimestepValues[0]
    simple.Render(view)
    session.require(kilobytes(reader) < 100, "without the slice values are held")
    display.SetRepresentationType("Surface")
    simple.Render(view)
    session.require(kilobytes(reader) > 100, "a surface gets deferred arrays")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    make_series.encode(arguments.out, "swirl", SAMPLES, (1.0, 1.0, 1.0), STEPS)
    path = os.path.join(arguments.out, "swirl.banyan")

    reader = simple.OpenDataFile(path)
    of_steps = ranges(reader)
    of_series = (min(low for low, _ in of_steps), max(high for _, high in of_steps))
    expect_nothing_decoded(reader, "asking for the ranges of all steps")
    session.require(len(set(of_steps)) > 1, "all steps have one range: nothing is shown by this")
    information = reader.GetDataInformation()
    session.require(information.GetNumberOfPoints() == 41 * 33 * 29 or
                    information.GetNumberOfPoints() > 41 * 33 * 29,  # ranks share layers
                    "points are missing")
    session.require(information.GetMemorySize() < 100, "values seem to be held")

    view = session.new_view((200, 150))
    display = simple.Show(reader, view)
    display.SetRepresentationType("Outline")
    simple.ColorBy(display, ("POINTS", "swirl"))
    simple.Render(view)
    session.require(close(colour_range(display), of_series),
                    f"colours from {colour_range(display)}, the series from {of_series}")
    display.RescaleTransferFunctionToDataRange(False, True)
    display.SetScalarBarVisibility(view, True)
    view.ViewTime = reader.TimestepValues[-1]
    simple.Render(view)
    session.require(close(colour_range(display), of_series), "the range drifts over time")
    expect_nothing_decoded(reader, "showing an outline, colours and steps")

    check_drawing(reader, display, view, of_series, os.path.join(arguments.out, "volume.png"))


if __name__ == "__main__":
    main()
