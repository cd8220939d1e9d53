# SPDX-License-Identifier: BSD-3-Clause
"""TestGoals.py tables : the verdicts of Benchmarks/verdicts.py, on tables made for both sides of each goal."""

import os
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, "..", "..", "Benchmarks"))
from tables import read  # noqa: E402
from verdicts import WORDS, lines_of  # noqa: E402

HEXAHEDRA = """cells,renderer,setup_s,memory_mb,ms_per_frame,psnr_db,max_error_255,note
1000000,banyan,0.1,49,10,60,0.8,
1000000,banyan-full,0.1,49,20,60,0.6,
1000000,vtk-projected-tetrahedra,8,614,{peer},55,1.9,{note}
"""
SET_UP = """mesh,cells,points,bricks,samples_in_bricks,find_s,find_cpu_s,bricks_s,values_s,memory_mb,bytes_per_cell
uniform,1000000,1030301,64,1,0.1,0.1,9.0,0.1,9999,9
uniform,8000000,8120601,512,1,{seconds},2,0.5,0.5,{megabytes},9
"""
VOLUMES = """scene,source,threads,tolerance,first_frame_ms,ms_per_frame,samples,budget_mib,peak_mib,file_mib
S2-256,series,2,1,90,100,1,512,188,1
S2-1024,series,2,1,{first},{later},1,512,555,1
S2-1024,series,2,,100,999,1,512,555,1
S2-512,series,2,1,9999,9999,1,512,555,1
"""


def verdicts(table):
    """Met or missed, line by line."""
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write(table)
        file.flush()
        return [line.split("|")[-2].strip() for line in lines_of(read(file.name, WORDS))]


def check(table, expected):
    found = verdicts(table)
    if found != expected:
        sys.exit(f"FAILED: {expected} was expected, found {found}:\n{table}")


check(HEXAHEDRA.format(peer=1200, note=""), ["met", "met"])
check(HEXAHEDRA.format(peer=1199, note=""), ["met", "missed"])
check(HEXAHEDRA.format(peer=599, note=""), ["missed", "missed"])
check(HEXAHEDRA.format(peer="", note="not within 900 s"), [])
check(SET_UP.format(seconds=1.9, megabytes=499), ["met", "met"])
check(SET_UP.format(seconds=2.1, megabytes=501), ["missed", "missed"])
check(VOLUMES.format(first=4999, later=200), ["met", "met", "met"])
check(VOLUMES.format(first=5001, later=201), ["missed", "missed", "met"])
print("met and missed are told apart")
