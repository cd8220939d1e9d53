# SPDX-License-Identifier: BSD-3-Clause
"""Motion is brought out in ParaView: the filter and the representation give one picture.

Drawn are an encoded series (its bricks are enhanced while they are drawn), the same series decoded
(whole arrays are, in the representation), and what the filter makes of both.

    test_enhancement.py --data SERIES_FOLDER --out DIR
"""
import os

from paraview import simple

import picture_scenes
import pictures
import session

SIZE = (300, 240)
SCALE = 1.0
STEP = 1.0


def draw(source, array, path, strength=0.0, time=STEP):
    view = session.new_view(SIZE, CameraPosition=[60, -70, 50], CameraFocalPoint=[0, 0, 0],
                            CameraViewUp=[0, 0, 1])
    view.ViewTime = time
    display = picture_scenes.volume(source, view, array, 1.0, (0.0, SCALE),
                                    opacities=(0.0, 0.1, 0.2, 0.3, 0.4))
    display.SampleDistanceVoxels = 0.5
    display.TemporalEnhancement = strength
    simple.SaveScreenshot(path, view, ImageResolution=list(SIZE))
    simple.Delete(view)
    return pictures.load(path)


def check_offered(source, array):
    """Of field arrays no motion can be brought out, and none is offered."""
    script = """from vtkmodules.vtkCommonCore import vtkDoubleArray
fact = vtkDoubleArray()
fact.SetName("fact")
fact.InsertNextValue(1.0)
output.GetFieldData().AddArray(fact)"""
    fields = simple.ProgrammableFilter(Input=source, CopyArrays=1, Script=script)
    fields.UpdatePipeline()
    filtered = simple.BanyanTemporalEnhancement(Input=fields)
    domain = filtered.GetProperty("Array").SMProperty.FindDomain("vtkSMArrayListDomain")
    offered = [domain.GetString(i) for i in range(domain.GetNumberOfStrings())]
    if "fact" not in fields.FieldData.keys() or array not in offered or "fact" in offered:
        raise AssertionError(f"arrays {offered} are offered")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--data", required=True)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)

    def path(name):
        return os.path.join(arguments.out, name + ".png")

    def same(a, b, most, what):
        worst = pictures.difference(a, b).max()
        session.require(worst <= most, f"{what}: {worst}/255 apart")

    def differ(a, b, what):
        session.require(pictures.difference(a, b).max() > 20, f"{what}: the same picture")

    encoded = simple.OpenDataFile(os.path.join(arguments.data, "swirl.banyan"))
    array = "swirl"
    plain = draw(encoded, array, path("plain"))
    bricks = draw(encoded, array, path("bricks"), 0.5)
    differ(plain, bricks, "enhancement of bricks")
    same(plain, draw(encoded, array, path("plain_again"), 0.0), 0, "switched off again")
    first = draw(encoded, array, path("bricks_first"), 0.5, 0.0)
    differ(bricks, first, "another step")

    filtered = simple.BanyanTemporalEnhancement(Input=encoded, Strength=0.5, Scale=SCALE)
    filtered.Array = ["POINTS", array]
    same(bricks, draw(filtered, array + "_enhanced", path("filter")), 1, "filter and bricks")
    same(plain, draw(filtered, array, path("filter_off")), 1, "the filter's other array")

    # Without a series there is no error bound to take for a floor.
    decoded = simple.BanyanDecode(Input=encoded)
    arrays = draw(decoded, array, path("arrays"), 0.5)
    differ(plain, arrays, "enhancement of arrays")
    of_decoded = simple.BanyanTemporalEnhancement(Input=decoded, Strength=0.5, Scale=SCALE)
    of_decoded.Array = ["POINTS", array]
    same(arrays, draw(of_decoded, array + "_enhanced", path("filter_of_decoded")), 1,
         "filter and arrays")
    check_offered(decoded, array)
    session.clear()
    print("One picture by all ways.")


if __name__ == "__main__":
    main()
