# SPDX-License-Identifier: BSD-3-Clause
"""What every test script needs first: the server if there is one, and the plugin."""
import argparse
import os
import shutil
import sys
import traceback

from paraview import simple

REPRESENTATION = "Banyan Volume"


def parser(description):
    """A command line that has the options of this module."""
    result = argparse.ArgumentParser(description=description)
    result.add_argument("--plugin", help="path of Banyan.so")
    return result


def real_data(file):
    """The folder of real data; without it, or this file in it, there is nothing to do."""
    data = os.environ.get("BANYAN_DATA_DIR")
    if not data or not os.path.exists(os.path.join(data, file)):
        print("no real data")
        sys.exit(77)
    return data


def time_information(times):
    """A programmable source's script that announces time steps, the first and the last ones its range."""
    return f"""
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Remove(executive.TIME_STEPS())
for time in {times}:
    info.Append(executive.TIME_STEPS(), time)
info.Remove(executive.TIME_RANGE())
info.Append(executive.TIME_RANGE(), {times[0]})
info.Append(executive.TIME_RANGE(), {times[-1]})
"""


def empty_folder(path):
    """Makes the folder of a test anew: files of earlier runs, or of other formats, are no part of it."""
    shutil.rmtree(path, ignore_errors=True)
    os.makedirs(path)


def begin(arguments):
    """Connects to BANYAN_TEST_SERVER if it is set and loads the plugin on all processes."""
    server = os.environ.get("BANYAN_TEST_SERVER")
    if server:
        host, port = server.rsplit(":", 1)
        # The view that the client has made before belongs to the builtin server.
        simple.Disconnect()
        if not simple.Connect(host, int(port)):
            raise RuntimeError(f"no connection to {server}")
    if arguments.plugin:
        simple.LoadPlugin(arguments.plugin, remote=False)
        if server:
            simple.LoadPlugin(arguments.plugin, remote=True)


def new_view(size, **properties):
    """A view whose picture depends on nothing but what is shown in it."""
    view = simple.CreateView("RenderView")
    view.ViewSize = list(size)
    view.UseColorPaletteForBackground = 0
    view.Background = [0.1, 0.2, 0.3]
    view.OrientationAxesVisibility = 0
    # It smooths edges that it decides on by thresholds: the last bit of a pixel may change its neighbours a lot.
    view.UseFXAA = 0
    for name, value in properties.items():
        setattr(view, name, value)
    return view


def move_to(display, offset):
    """Moves what is shown: until ParaView 5.12 the property is called Position."""
    name = "Translation" if display.SMProxy.GetProperty("Translation") else "Position"
    setattr(display, name, list(offset))


def ghost_cells(**properties):
    """The filter Ghost Cells, which is called Ghost Cells Generator until ParaView 5.12."""
    make = getattr(simple, "GhostCells", None) or simple.GhostCellsGenerator
    return make(**properties)


KEPT = {}


def kept(name, make):
    """The source that `make` made when this name was first asked for; `clear` leaves it alone.

    Making a source takes longer than drawing it: scenes share those that they have in common.
    """
    if name not in KEPT:
        KEPT[name] = make()
    return KEPT[name]


def clear():
    """Deletes every view with its displays, and every source that is not kept."""
    for view in simple.GetRenderViews():
        simple.Delete(view)
    # Consumers first: a source with consumers cannot go.
    for source in reversed(list(simple.GetSources().values())):
        if source not in KEPT.values():
            simple.Delete(source)


def require(condition, sentence):
    """`assert` with a sentence, that no optimisation switches off."""
    if not condition:
        raise AssertionError(sentence)


def expect_refusal(folder, made, mentions):
    """Saving this source as a series must fail with a sentence that mentions these words, and leave nothing."""
    path = os.path.join(folder, "bad.banyan")
    try:
        simple.SaveData(path, proxy=made, WriteTimeSteps=1)
    except RuntimeError as error:
        for mention in mentions:
            require(mention in str(error), str(error))
    else:
        raise AssertionError(f"{path} was written")
    require(not os.path.exists(path), "something is left")


driven = False  # whether a script of the window goes on when it has returned


def drive(view, steps):
    """Goes on in the window, whose loop turns between the steps, and ends the process with them.

    steps: a generator; each `yield` gives the loop 10 ms.
    """
    global driven
    driven = True
    interactor = view.GetInteractor()
    inside = []  # dialogs and progress turn loops of their own, where timers run, too

    def step(*_):
        if inside:
            return
        inside.append(True)
        status = 0
        try:
            next(steps)
            inside.pop()
            return
        except StopIteration:
            pass
        except BaseException:
            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)

    interactor.AddObserver("TimerEvent", step)
    interactor.CreateRepeatingTimer(10)
