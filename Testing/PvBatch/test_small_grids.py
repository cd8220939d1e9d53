# SPDX-License-Identifier: BSD-3-Clause
"""Grids with fewer samples than there are ranks, or flat ones, are written, read and filtered.

    test_small_grids.py --plugin Banyan.so --out FOLDER
"""
import os

from paraview import simple

import session

EXTENTS = ([0, 0, 0, 0, 0, 0], [0, 1, 0, 1, 0, 0], [-3, 3, 5, 5, 2, 2], [0, 0, -1, 2, 0, 15],
           [0, 16, 0, 0, -2, 14])


def check(extent, folder):
    name = "_".join(map(str, extent))
    path = os.path.join(folder, name + ".banyan")
    wavelet = simple.Wavelet(WholeExtent=extent)
    simple.SaveData(path, proxy=wavelet, ErrorBound=0)
    reader = simple.OpenDataFile(path)
    reader.UpdatePipeline()
    wavelet.UpdatePipeline()
    expected, found = wavelet.GetDataInformation(), reader.GetDataInformation()
    session.require(expected.GetExtent() == found.GetExtent() == tuple(extent),
                    f"extent {found.GetExtent()} instead of {extent}")
    session.require(expected.GetNumberOfPoints() == found.GetNumberOfPoints(), "points are missing")
    for source in (wavelet, reader):
        session.require(source.PointData["RTData"].GetNumberOfComponents() == 1, "no array")
    session.require(wavelet.PointData["RTData"].GetRange() == reader.PointData["RTData"].GetRange(),
                    f"{name}: range {reader.PointData['RTData'].GetRange()}")
    sums = []
    for source in (wavelet, reader):
        shifted = simple.Calculator(Input=source, Function="RTData+1", ResultArrayName="r")
        shifted.UpdatePipeline()
        sums.append(shifted.PointData["r"].GetRange())
    session.require(sums[0] == sums[1], f"{name}: {sums}")


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(arguments.out, exist_ok=True)
    for extent in EXTENTS:
        check(extent, arguments.out)


if __name__ == "__main__":
    main()
