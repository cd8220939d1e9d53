"""Looks for trouble in the input files that ParaView's readers pass over in silence.

A reader of a file series takes extent and arrays from the first file, and fills a step whose file
is smaller with whatever the memory holds; the MetaImage reader does the same with a data file that
is too short. Encoding such steps would be pointless, so they are refused here.
"""

import os

from paraview import simple
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

import demo_common as demo

META_TYPE_BYTES = {"MET_CHAR": 1, "MET_UCHAR": 1, "MET_SHORT": 2, "MET_USHORT": 2, "MET_INT": 4,
                   "MET_UINT": 4, "MET_LONG": 4, "MET_ULONG": 4, "MET_LONG_LONG": 8,
                   "MET_ULONG_LONG": 8, "MET_FLOAT": 4, "MET_DOUBLE": 8}


def check_files(files):
    """Raises DemoError when a file is incomplete, or does not fit the first one."""
    for path in files:
        if path.endswith(".mhd"):
            check_meta_image(path)
    if len(files) > 1:
        check_extents(files)


def check_meta_image(path):
    """Compares the size of the data file with what the header promises."""
    with open(path, encoding="latin-1") as file:
        header = dict((part.strip() for part in line.split("=", 1)) for line in file if "=" in line)
    name = header.get("ElementDataFile", "LOCAL")
    if name.split()[0] in ("LOCAL", "LIST") or "%" in name or \
            header.get("CompressedData", "False") == "True":
        return
    data = os.path.join(os.path.dirname(path), name)
    if not os.path.isfile(data):
        raise demo.DemoError(f"{path} names the data file {name}, which does not exist.")
    needed = META_TYPE_BYTES.get(header.get("ElementType"), 1) * \
        int(header.get("ElementNumberOfChannels", 1))
    for samples in header.get("DimSize", "").split():
        needed *= int(samples)
    if os.path.getsize(data) < needed:
        raise demo.DemoError(f"{data} has {os.path.getsize(data)} bytes, and its header {path} "
                             f"promises {needed}.")


def whole_extent(path):
    """The extent that a file says it has, without reading its values; None for no image."""
    try:
        reader = simple.OpenDataFile(path)
    except RuntimeError as error:
        raise demo.DemoError(str(error).strip()) from error
    reader.UpdatePipelineInformation()
    information = reader.GetClientSideObject().GetOutputInformation(0)
    key = vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT()
    extent = tuple(information.Get(key)) if information.Has(key) else None
    simple.Delete(reader)
    return extent


def check_extents(files):
    first = whole_extent(files[0])
    for step, path in enumerate(files):
        extent = whole_extent(path)
        if extent != first:
            raise demo.DemoError(f"step {step} ({os.path.basename(path)}) has the extent {extent}, "
                                 f"and the first step has {first}: a series has one extent.")
