# SPDX-License-Identifier: BSD-3-Clause
"""Ranks that are interrupted while one of them samples a mesh, and the others wait for it, end, and leave nothing.

    test_mesh_interruption.py --plugin Banyan.so --out FOLDER

Needs Python alone: it must not run within ParaView, because MPI does not start within MPI.
"""
import argparse
import os
import shutil
import signal
import sys
import time

import run_paraview
from test_lost_rank import children

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "test_changing_meshes.py")
RANKS = 2


def require(condition, sentence):
    if not condition:
        sys.exit(f"test_mesh_interruption.py: {sentence}")


def interrupt(arguments, number):
    report = os.path.join(arguments.out, number.name)
    process = run_paraview.start(run_paraview.mpi(RANKS) + ["pvbatch", SCRIPT, "--plugin", arguments.plugin,
                                                            "--report", report])
    try:
        deadline = time.monotonic() + 100
        while not os.path.exists(report):
            require(process.poll() is None, f"it ended by itself with {process.returncode}")
            require(time.monotonic() < deadline, "no mesh is sampled")
            time.sleep(0.02)
        started = children(process.pid)
        require(len(started) > RANKS, f"{len(started)} processes")
        process.send_signal(number)
        status = run_paraview.wait(process, time.monotonic() + 30)
        require(status not in (0, run_paraview.TIMED_OUT), f"status {status} after {number.name}")
        deadline = time.monotonic() + 10  # ranks may outlive their launcher for some moments
        while any(os.path.exists(f"/proc/{one}") for one in started):
            require(time.monotonic() < deadline, f"ranks go on after {number.name}")
            time.sleep(0.05)
        print(f"{number.name}: status {status}", flush=True)
    finally:
        run_paraview.end(process)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    os.environ.update(run_paraview.MPI_ENVIRONMENT)
    shutil.rmtree(arguments.out, ignore_errors=True)
    os.makedirs(arguments.out)
    for number in (signal.SIGINT, signal.SIGTERM):
        interrupt(arguments, number)


if __name__ == "__main__":
    main()
