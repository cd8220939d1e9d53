# SPDX-License-Identifier: BSD-3-Clause
"""pvbatch that is interrupted while it writes leaves a series that opens, and nothing else.

    test_interruption.py --plugin Banyan.so --out FOLDER [--ranks N]

Needs Python alone: it must not run within ParaView, because MPI does not start within MPI. A
launcher gives its ranks a second to end in good order, so the strict test is that of one rank
without it.
"""
import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import run_paraview

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "write_long.py")
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)


def require(condition, sentence):
    if not condition:
        sys.exit(f"test_interruption.py: {sentence}")


def segments(path):
    """The files that the index names, and those that are there."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    named = [segment["file"] for segment in json.loads(text[text.index("{"):])["segments"]]
    return named, os.listdir(path + ".d")


def wait_for(condition, process, seconds):
    deadline = time.monotonic() + seconds
    while not condition():
        require(process.poll() is None, f"it ended by itself with {process.returncode}")
        require(time.monotonic() < deadline, "nothing happened in time")
        time.sleep(0.02)


def has_two_groups(path):
    return os.path.exists(path) and len(segments(path)[0]) >= 2


STARTED = []


def start(arguments, path, *options):
    launcher = run_paraview.mpi(arguments.ranks) if arguments.ranks > 1 else []
    STARTED.append(run_paraview.start(launcher + ["pvbatch", SCRIPT, "--plugin", arguments.plugin,
                                                  "--write", path, *options]))
    return STARTED[-1]


def end_by(number, process):
    """Sends a signal and waits for the process, and for what it started."""
    if number == signal.SIGKILL:
        os.killpg(process.pid, number)  # the launcher and, where they are in its group, the ranks
    else:
        process.send_signal(number)
    try:
        process.wait(60)
    except subprocess.TimeoutExpired:
        run_paraview.end(process)
        require(False, f"it did not end after {number.name}")
    require(process.returncode != 0, "interrupted, and yet it says that all is well")


def wait_until_quiet(path):
    """Ranks may outlive a launcher that was killed for some moments."""
    before = None
    while before != segments(path):
        before = segments(path)
        time.sleep(1.0)


def interrupt(arguments, number):
    path = os.path.join(arguments.out, f"{number.name}.banyan")
    process = start(arguments, path)
    wait_for(lambda: has_two_groups(path), process, 100)
    end_by(number, process)
    wait_until_quiet(path)
    named, there = segments(path)
    print(f"{number.name}: status {process.returncode}, {len(named)} segments, "
          f"{len(there) - len(named)} other files", flush=True)
    require(2 <= len(named) < 500, f"{len(named)} segments")
    require(set(named) <= set(there), "segments are missing")
    if arguments.ranks == 1:
        require(process.returncode == -number, f"status {process.returncode}")
        require(number == signal.SIGKILL or len(there) == len(named), f"left behind: {there}")
    return path


def old_series_stays(arguments):
    path = os.path.join(arguments.out, "old.banyan")
    require(start(arguments, path, "--steps", "6").wait(100) == 0, "the old series was not written")
    with open(path, "rb") as file:
        before = file.read(), sorted(os.listdir(path + ".d"))
    process = start(arguments, path)
    wait_for(lambda: len(os.listdir(path + ".d")) > len(before[1]) + 2, process, 100)
    end_by(signal.SIGTERM, process)
    with open(path, "rb") as file:
        after = file.read(), sorted(os.listdir(path + ".d"))
    require(before[0] == after[0], "the index of the old series has changed")
    require(set(before[1]) <= set(after[1]), "segments of the old series are gone")
    require(arguments.ranks > 1 or before == after, f"left behind: {after[1]}")
    return path


def error_of_a_rank(arguments, mention, *options):
    """All ranks fail with the sentence of the one that does; nothing is left."""
    path = os.path.join(arguments.out, "error.banyan")
    failing = arguments.ranks - 1
    process = run_paraview.start(
        run_paraview.mpi(arguments.ranks) + ["pvbatch", SCRIPT, "--plugin", arguments.plugin,
                                             "--write", path, "--fail", str(failing), *options],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        output, _ = process.communicate(timeout=100)
    except subprocess.TimeoutExpired:
        run_paraview.end(process)
        sys.exit("test_interruption.py: the ranks hang after an error of one")
    print(output, flush=True)
    require(process.returncode != 0, "an error, and yet it says that all is well")
    require(mention in output, f"it does not say '{mention}'")
    require(arguments.ranks == 1 or f"Rank {failing}" in output, "it does not say which rank")
    require(not os.path.exists(path) and not os.path.exists(path + ".d"), "something was left")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    arguments = parser.parse_args()
    os.environ.update(run_paraview.MPI_ENVIRONMENT)
    shutil.rmtree(arguments.out, ignore_errors=True)
    os.makedirs(arguments.out)
    left = [interrupt(arguments, number) for number in SIGNALS]
    left.append(old_series_stays(arguments))
    error_of_a_rank(arguments, "At step 10 (time 5)")
    error_of_a_rank(arguments, "The file cannot be", "--disk-full")
    check = run_paraview.start(["pvpython", "--force-offscreen-rendering", SCRIPT, "--plugin",
                                arguments.plugin, "--check", *left])
    require(run_paraview.wait(check, time.monotonic() + 100) == 0, "what is left is not in order")


if __name__ == "__main__":
    try:
        main()
    finally:
        for started in STARTED:
            run_paraview.end(started)
