# SPDX-License-Identifier: BSD-3-Clause
"""A rank of ParaView that is stopped or killed while frames are drawn: the job ends, and says why. A client of a
server ends with it.

    test_lost_rank.py stopped|killed ARGUMENTS...      (those of run_paraview.py)

Needs Python alone: it must not run within ParaView, because MPI does not start within MPI.
"""
import os
import signal
import subprocess
import sys
import time

RUN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run_paraview.py")
LIMIT = 6     # seconds; Testing/Parallel has the default
SECONDS = 16  # after which the job must have ended
FRAME = 8     # after which the rank is lost


def children(process):
    """All processes that a process has started, and those that these have."""
    parents = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                parents[int(name)] = int(file.read().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue  # has ended meanwhile
    found = {process}
    while True:
        more = {name for name, parent in parents.items() if parent in found} - found
        if not more:
            return found
        found |= more


def rank_one(process):
    """The second rank among what was started."""
    for name in children(process):
        try:
            with open(f"/proc/{name}/environ", "rb") as file:
                # The rank itself, not what it has started.
                if b"OMPI_COMM_WORLD_RANK=1\0" in file.read():
                    with open(f"/proc/{name}/comm", encoding="utf-8") as named:
                        if named.read().startswith(("pvbatch", "pvserver")):
                            return name
        except OSError:
            continue
    return None


def main():
    mishap = sys.argv[1]
    environment = dict(os.environ, BANYAN_RANK_LIMIT_SECONDS=str(LIMIT))
    job = subprocess.Popen([sys.executable, RUN] + sys.argv[2:], stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True, env=environment)
    lost, lost_at, said = None, None, []
    for line in job.stdout:
        if line.startswith("frame"):
            if lost is None and int(line.split()[1]) >= FRAME:
                lost = rank_one(job.pid)
                if lost is None:
                    job.terminate()
                    sys.exit("there is no second rank of Open MPI")
                os.kill(lost, signal.SIGSTOP if mishap == "stopped" else signal.SIGKILL)
                lost_at = time.monotonic()
            continue
        said.append(line)
    status = job.wait()
    print("".join(said))
    if lost is None:
        sys.exit("no rank could be lost")
    took = time.monotonic() - lost_at
    print(f"{mishap}: the job ended with status {status} {took:.1f} s after it")
    if status == 0 or took > SECONDS:
        sys.exit(f"status {status} after {took:.0f} s")
    wanted = [f"Rank 1 (process {lost}) has given no sign of life for"]
    if mishap == "killed":
        wanted.append("signal 9")  # the launcher's words
    if not any(text in line for text in wanted for line in said):
        sys.exit("nobody says what has happened")


if __name__ == "__main__":
    main()
