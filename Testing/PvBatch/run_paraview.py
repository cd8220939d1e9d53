# SPDX-License-Identifier: BSD-3-Clause
"""Runs a Python script in ParaView: builtin, on the ranks of pvbatch, as client of a pvserver, in the window, or in the
window as client of a pvserver (served).

    run_paraview.py [--mode builtin|batch|server|window|served] [--ranks N] [--seconds S] [--server-option O ...]
                    -- SCRIPT [ARGUMENTS]

Nothing may hang: every process it starts is ended when the time is over. The script of a client
finds host and port of its server in the environment variable BANYAN_TEST_SERVER. Exits with the
script's status, or 124 when the time was over. Needs a DISPLAY and nothing but Python itself.
"""
import argparse
import os
import random
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

# What Open MPI wants to be told for root and in containers.
MPI_ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_mpi_yield_when_idle": "1",
}
TIMED_OUT = 124


def start(command, **options):
    print("+ " + " ".join(command), flush=True)
    # A process group of its own, so that it can be ended together with all that it started. No
    # session of its own: Linux shares processors between sessions, whatever the priorities in them
    # are, and ParaView's window starts its server in its own session, too.
    return subprocess.Popen(command, preexec_fn=os.setpgrp, **options)


def end(process, grace=10):
    """Ends a process and its children: mpirun needs the polite signal to end its ranks."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        if process.poll() is not None:
            return
        os.killpg(process.pid, number)
        try:
            process.wait(grace)
        except subprocess.TimeoutExpired:
            continue


def wait(process, deadline):
    """Exit status of a process, ended if need be."""
    try:
        return process.wait(max(0.0, deadline - time.monotonic()))
    except subprocess.TimeoutExpired:
        print("run_paraview.py: the time is over", file=sys.stderr, flush=True)
        end(process)
        return TIMED_OUT


def free_port():
    """A port that nobody listens on now, below those that the system lends to outgoing connections
    (mpirun makes many), so that it is unlikely to be taken until the server listens on it."""
    while True:
        port = random.randrange(20000, 32000)
        with socket.socket() as listener:
            try:
                listener.bind(("localhost", port))
            except OSError:
                continue
            return port


def mpi(ranks):
    return [os.environ.get("MPIEXEC", "mpirun"), "--oversubscribe", "-np", str(ranks)]


class Server:
    """A pvserver on several ranks whose output is passed on. What starts it can come `before`."""

    def __init__(self, ranks, options, before=()):
        self.port = free_port()
        self.process = start(
            list(before) + mpi(ranks) + ["pvserver", "--hostname=localhost", f"--server-port={self.port}"] + options,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.told = threading.Event()  # whether it listens, or why not
        self.listens = False
        self.port_was_taken = False
        threading.Thread(target=self._pass_on, daemon=True).start()

    def _pass_on(self):
        for line in self.process.stdout:
            print("server: " + line, end="", flush=True)
            if "Accepting connection" in line:
                self.listens = True
                self.told.set()
            self.port_was_taken |= "Address already in use" in line
        self.told.set()  # nothing more will come: do not wait for it


def run_with_server(server, command, deadline):
    environment = dict(os.environ, BANYAN_TEST_SERVER=f"localhost:{server.port}")
    status = wait(start(command, env=environment), deadline)
    # The server leaves when its client has left; that it does belongs to the test.
    left = wait(server.process, min(deadline, time.monotonic() + 30))
    return status or left


def run_client(command, ranks, options, deadline):
    while True:
        server = Server(ranks, options)
        try:
            if not server.told.wait(max(0.0, deadline - time.monotonic())):
                print("run_paraview.py: the server did not start in time", file=sys.stderr)
                return TIMED_OUT
            if server.listens:
                return run_with_server(server, command, deadline)
            if not server.port_was_taken:  # else somebody was quicker: try another port
                print("run_paraview.py: the server ended before a client came", file=sys.stderr)
                return 1
        finally:
            end(server.process)


# Runs in the window, in place of pvpython: with arguments, output to where ctest reads, and an end.
IN_WINDOW = """
import os, runpy, sys, traceback
sys.argv = {command!r}
sys.path.insert(0, os.path.dirname(sys.argv[0]))
sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
status = 0
try:
    runpy.run_path(sys.argv[0], run_name="__main__")
except SystemExit as end:
    status = end.code or 0
    if isinstance(status, str):
        print(status)
        status = 1
except BaseException:
    traceback.print_exc()
    status = 1
sys.stdout.flush()
sys.stderr.flush()
# A script that goes on while the window turns its loop ends by itself: session.drive.
if status or not getattr(sys.modules.get("session"), "driven", False):
    os._exit(status)
"""


def run_in_window(command, run):
    """Hands the command of a window that runs a script to `run`."""
    with tempfile.TemporaryDirectory() as home:
        script = os.path.join(home, "in_window.py")
        with open(script, "w", encoding="utf-8") as file:
            file.write(IN_WINDOW.format(command=command))
        # Without the settings of the user; the dialog that welcomes new ones is modal.
        os.environ.update(HOME=home, XDG_CONFIG_HOME=home, XDG_RUNTIME_DIR=home)
        return run(["paraview", "--disable-registry", "--script=" + script])


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--mode", choices=("builtin", "batch", "server", "window", "served"), default="builtin")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--server-option", action="append", default=[], help="as --server-option=-tdx=2")
    parser.add_argument("command", nargs="+")
    arguments = parser.parse_args()

    os.environ.update(MPI_ENVIRONMENT)
    deadline = time.monotonic() + arguments.seconds
    python = ["pvpython", "--force-offscreen-rendering"]
    if arguments.mode == "server":
        return run_client(python + arguments.command, arguments.ranks, arguments.server_option, deadline)
    if arguments.mode == "window":
        return run_in_window(arguments.command, lambda window: wait(start(window), deadline))
    if arguments.mode == "served":
        return run_in_window(arguments.command, lambda window: run_client(
            window, arguments.ranks, arguments.server_option, deadline))
    if arguments.mode == "batch":
        return wait(start(mpi(arguments.ranks) + ["pvbatch"] + arguments.command), deadline)
    return wait(start(python + arguments.command), deadline)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    sys.exit(main())
