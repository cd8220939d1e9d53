# SPDX-License-Identifier: BSD-3-Clause
"""Encodes a series, with the same options in each release.

    pvpython encode.py --plugin Banyan.so --source FILE.series --out FILE.banyan
"""
import os

from paraview import simple

import session


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--source", required=True)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    session.begin(arguments)
    os.makedirs(os.path.dirname(arguments.out))
    source = simple.OpenDataFile(arguments.source)
    simple.SaveData(arguments.out, proxy=source, WriteTimeSteps=1, ErrorBound=1 / 512)
    session.require(os.path.exists(arguments.out), f"{arguments.out} was not written")


if __name__ == "__main__":
    main()
