# SPDX-License-Identifier: BSD-3-Clause
"""Runs drive_window.py in the window of ParaView, which may have a server.

    start_window.py [--pixels N] [--seconds S] [--server local|line] [--ranks N] -- ARGUMENTS

The view has N x N pixels (default 1024). With --server the window is the client of a pvserver on this machine
(default 2 ranks); `line` puts relay.py between them, and gives the server a low priority: it stands for another
machine, which would leave all cores to the window. Every process it starts is ended when the time is over (default
600 s). ARGUMENTS are those of drive_window.py. Needs a display.
"""
import argparse
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

here = pathlib.Path(__file__).resolve().parent
sys.path.append(str(here.parent.parent / "Testing" / "PvBatch"))
import run_paraview  # noqa: E402 (its folder had to be named first)

AROUND = (308, 235)  # pixels of ParaView's window beside and above its view, in 5.11
IN_WINDOW = """
import sys
sys.argv = {command!r}
sys.path.insert(0, {folder!r})
sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
import drive_window
drive_window.main()
"""


def wait_for(window, server, deadline):
    """The window's exit status. A window whose server has gone would wait for somebody who closes it."""
    while server and server.poll() is None and window.poll() is None and time.monotonic() < deadline:
        time.sleep(0.2)
    if server and server.poll() is not None and window.poll() is None:
        print("start_window.py: the server has ended before the window", flush=True)
        run_paraview.end(window)
    return run_paraview.wait(window, deadline)


def run_window(command, pixels, deadline, server=None):
    """The window's exit status. Without the settings of the user; the dialog that welcomes new ones is modal."""
    with tempfile.TemporaryDirectory() as home:
        command = command + ["--pixels", str(pixels)]
        script = os.path.join(home, "in_window.py")
        with open(script, "w", encoding="utf-8") as file:
            file.write(IN_WINDOW.format(command=["drive_window.py"] + command, folder=str(here)))
        environment = dict(os.environ, HOME=home, XDG_CONFIG_HOME=home, XDG_RUNTIME_DIR=home)
        window = run_paraview.start(
            ["paraview", "--disable-registry", f"--script={script}", "-geometry",
             f"{pixels + AROUND[0]}x{pixels + AROUND[1]}+0+0"], env=environment)
        try:
            return wait_for(window, server, deadline)
        finally:
            run_paraview.end(window)


def run_on_line(server, command, pixels, deadline):
    """The same with a relay before the server's port."""
    with tempfile.TemporaryDirectory() as folder:
        counts = os.path.join(folder, "counts")
        relay = run_paraview.start([sys.executable, str(here / "relay.py"), "--to", f"localhost:{server.port}",
                                    "--counts", counts], stdout=subprocess.PIPE, text=True)
        try:
            relayed = int(relay.stdout.readline())
            return run_window(command + ["--server", f"localhost:{relayed}", "--counts", counts], pixels, deadline,
                              server.process)
        finally:
            run_paraview.end(relay)


def run_with_server(arguments, deadline):
    server = run_paraview.Server(arguments.ranks, [], ["nice", "-n", "19"] if arguments.server == "line" else [])
    try:
        server.told.wait(max(0.0, deadline - time.monotonic()))
        if not server.listens:
            sys.exit("start_window.py: the server did not start")
        if arguments.server == "line":
            status = run_on_line(server, arguments.command, arguments.pixels, deadline)
        else:
            status = run_window(arguments.command + ["--server", f"localhost:{server.port}"], arguments.pixels, deadline,
                                server.process)
        # It leaves when its client has left.
        return status or run_paraview.wait(server.process, min(deadline, time.monotonic() + 30))
    finally:
        run_paraview.end(server.process)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--pixels", type=int, default=1024)
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--server", choices=("local", "line"))
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("command", nargs="+")
    arguments = parser.parse_args()
    os.environ.update(run_paraview.MPI_ENVIRONMENT)
    deadline = time.monotonic() + arguments.seconds
    if arguments.server:
        return run_with_server(arguments, deadline)
    return run_window(arguments.command, arguments.pixels, deadline)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    sys.exit(main())
