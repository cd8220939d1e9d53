# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts of the demonstration share: messages, opening files, reading values."""

import json
import os
import sys

from paraview import servermanager
from paraview import simple


class DemoError(Exception):
    """Something that the user must know, as one sentence."""


def run(main):
    """Calls main(); an error becomes one sentence on stderr and exit status 1."""
    try:
        main()
    except (DemoError, RuntimeError) as error:  # ParaView raises the latter, with a sentence
        print(f"demo: {str(error).strip()}", file=sys.stderr)
    except (OSError, KeyError, ValueError) as error:
        print(f"demo: {type(error).__name__}: {error}", file=sys.stderr)
    else:
        return
    sys.stderr.flush()
    sys.exit(1)


def progress(text):
    print(f"      {text}", file=sys.stderr, flush=True)


def load_plugin():
    """Loads Banyan from the file that BANYAN_PLUGIN names, on every rank."""
    path = os.environ.get("BANYAN_PLUGIN", "")
    if not os.path.isfile(path):
        raise DemoError(f'the plugin "{path}" does not exist; is BANYAN_PLUGIN set?')
    simple.LoadPlugin(path, ns=vars(simple))


def open_series(files):
    """Opens files as one time series of image data or of a mesh, with its first step loaded."""
    reader = simple.OpenDataFile(files if len(files) > 1 else files[0])
    reader.UpdatePipeline()
    information = reader.GetDataInformation()
    if information.GetDataSetTypeAsString() not in ("vtkImageData", "vtkUnstructuredGrid"):
        raise DemoError(f"{files[0]} holds {information.GetDataSetTypeAsString()}, "
                        "and the demonstration draws vtkImageData and vtkUnstructuredGrid.")
    if information.GetNumberOfPoints() == 0:
        raise DemoError(f"nothing could be read from {files[0]}.")
    if reader.PointData.GetNumberOfArrays() == 0:
        raise DemoError(f"{files[0]} has no point data.")
    return reader


def time_values(reader):
    """The time values of a reader; a reader without time has one step."""
    values = getattr(reader, "TimestepValues", None)
    if values is None or len(values) == 0:
        return [0.0]
    return list(values)


def data_at(reader, time):
    """The data set of one time step. Serial sessions only."""
    reader.UpdatePipeline(time)
    return reader.GetClientSideObject().GetOutputDataObject(0)


def array_names(reader):
    return [reader.PointData.GetArray(i).GetName()
            for i in range(reader.PointData.GetNumberOfArrays())]


def write_json(path, content):
    """Writes a JSON file that is whole or not there."""
    unfinished = path + ".partial"
    with open(unfinished, "w", encoding="utf-8") as file:
        json.dump(content, file, indent=2, allow_nan=False)
        file.write("\n")
    os.replace(unfinished, path)


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def paraview_version():
    return ".".join(str(number) for number in
                    (servermanager.vtkSMProxyManager.GetVersionMajor(),
                     servermanager.vtkSMProxyManager.GetVersionMinor(),
                     servermanager.vtkSMProxyManager.GetVersionPatch()))
