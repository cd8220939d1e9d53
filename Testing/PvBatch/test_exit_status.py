# SPDX-License-Identifier: BSD-3-Clause
"""A script that does not catch a refusal ends with status 1, and says why.

    test_exit_status.py ARGUMENTS...      (those of run_paraview.py)

Needs Python alone: it must not run within ParaView, because MPI does not start within MPI.
"""
import os
import subprocess
import sys

RUN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_paraview.py")


def main():
    done = subprocess.run([sys.executable, RUN] + sys.argv[1:], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    print(done.stdout)
    for text in ("RuntimeError", "Cell Data to Point Data"):
        if text not in done.stdout:
            sys.exit(f"it does not say {text}")
    if done.returncode != 1:
        sys.exit(f"status {done.returncode} instead of 1")


if __name__ == "__main__":
    main()
