# SPDX-License-Identifier: BSD-3-Clause
"""Writes series of all kinds that must not depend on the number of ranks, for compare_files.py.

    write_in_parallel.py --plugin Banyan.so --out FOLDER
"""
import os

from paraview import simple

import make_series
import moving_field
import session

SAMPLES = (23, 17, 12)
STEPS = 7
MODES = {"relative": {}, "absolute": {"ErrorBoundMode": "Absolute", "ErrorBound": 0.01},
         "lossless": {"ErrorBound": 0}}


def write(folder, name, source, **options):
    path = os.path.join(folder, name + ".banyan")
    simple.SaveData(path, proxy=source, **options)
    reader = simple.OpenDataFile(path)
    session.require(reader is not None, f"{path} was not written")
    simple.Delete(reader)


def image_with_flags(folder):
    """A file of XML with ghost flags, which ParaView offers among the arrays to write."""
    values = " ".join(str(0.25 * i) for i in range(60))
    flags = " ".join("1" if i % 5 == 4 else "0" for i in range(60))
    path = os.path.join(folder, "flags.vti")
    with open(path, "w", encoding="ascii") as file:
        file.write(f"""<VTKFile type="ImageData" version="1.0">
<ImageData WholeExtent="0 4 0 3 0 2" Origin="0 0 0" Spacing="1 1 1">
<Piece Extent="0 4 0 3 0 2"><PointData Scalars="p">
<DataArray type="Float32" Name="p" format="ascii">{values}</DataArray>
<DataArray type="UInt8" Name="vtkGhostType" format="ascii">{flags}</DataArray>
</PointData></Piece></ImageData></VTKFile>""")
    return simple.OpenDataFile(path)


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    session.empty_folder(arguments.out)
    for pieces in (False, True):
        source = moving_field.source(SAMPLES, STEPS, pieces)
        kind = "pieces" if pieces else "whole"
        for mode, options in MODES.items():
            # 7 steps are 4 groups of 2 (more than ranks, or fewer), or one group for one rank.
            write(arguments.out, f"{kind}_{mode}_2", source, KeyframeInterval=2, **options)
        write(arguments.out, f"{kind}_closed_groups", source, KeyframeInterval=2, ClosedGroups=1)
        write(arguments.out, f"{kind}_one_group", source)
        write(arguments.out, f"{kind}_groups_of_1", source, KeyframeInterval=1)
    files = [make_series.write_step(arguments.out, "step", step, SAMPLES, (1.0, 1.0, 2.0))
             for step in range(5)]
    stored = simple.OpenDataFile(files)
    write(arguments.out, "files", stored, KeyframeInterval=2)
    write(arguments.out, "flags", image_with_flags(arguments.out))
    # Pieces that overlap, with flags.
    ghosts = session.ghost_cells(Input=simple.Wavelet(WholeExtent=[0, 14, 0, 12, 0, 11]))
    write(arguments.out, "ghost_cells", ghosts)
    write(arguments.out, "present_step", simple.Wavelet(WholeExtent=[-3, 9, 0, 7, 2, 8]))


if __name__ == "__main__":
    main()
