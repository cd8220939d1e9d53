# SPDX-License-Identifier: BSD-3-Clause
"""Series in folders must hold the same values, bit for bit, at each time.

    pvpython compare_series.py --plugin Banyan.so REFERENCE.banyan OTHER.banyan...
"""
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkDataObject

import compare_data
import session


def data_of(reader, time):
    reader.UpdatePipeline(time)
    data = simple.servermanager.Fetch(reader)
    session.require(isinstance(data, vtkDataObject), "the reader gives nothing")
    return data


def main():
    parser = session.parser(__doc__)
    parser.add_argument("reference")
    parser.add_argument("others", nargs="+")
    arguments = parser.parse_args()
    session.begin(arguments)
    reference = simple.OpenDataFile(arguments.reference)
    for path in arguments.others:
        other = simple.OpenDataFile(path)
        session.require(list(other.TimestepValues) == list(reference.TimestepValues), f"{path} has other times")
        for time in reference.TimestepValues:
            expected = data_of(reference, time)
            wrong = compare_data.compare(data_of(other, time), expected)
            session.require(not wrong, f"{path} at {time}: {'; '.join(wrong)}")
            session.require(compare_data.size(expected) > 0, "there is nothing to compare")
        print(f"{path}: {len(reference.TimestepValues)} steps, the same values", flush=True)


if __name__ == "__main__":
    main()
