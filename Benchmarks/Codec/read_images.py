# SPDX-License-Identifier: BSD-3-Clause
"""read_images.py NAME OUTPUT.raw IMAGES... : one raw series out of image files, for the benchmark.

The images, in order of time, are VTK XML image data (.vti, arrays written inline as "binary") or
MetaImages (.mhd beside its .raw); of a .vti the first array of the points is taken. OUTPUT.raw
becomes float32 [step][z][y][x], and OUTPUT.json describes it as banyan-bench-codec wants it.
"""

import base64
import json
import os
import sys
import xml.etree.ElementTree
import zlib

import numpy

VTK_TYPES = {"Float32": "f4", "Float64": "f8", "Int8": "i1", "UInt8": "u1", "Int16": "i2",
             "UInt16": "u2", "Int32": "i4", "UInt32": "u4", "Int64": "i8", "UInt64": "u8"}
META_TYPES = {"MET_FLOAT": "f4", "MET_DOUBLE": "f8", "MET_CHAR": "i1", "MET_UCHAR": "u1",
              "MET_SHORT": "i2", "MET_USHORT": "u2", "MET_INT": "i4", "MET_UINT": "u4"}


def inline_bytes(text, header_type, compressed):
    """The content of a DataArray with format="binary"."""
    text = "".join(text.split())
    header = numpy.dtype("<" + VTK_TYPES[header_type])
    if not compressed:
        return base64.b64decode(text)[header.itemsize:]
    # The header (blocks, bytes per block, bytes of the last one, compressed bytes of each) is
    # encoded by itself, and padded.
    blocks = int(numpy.frombuffer(base64.b64decode(text[:16]), header, 1)[0])
    header_bytes = (3 + blocks) * header.itemsize
    encoded = (header_bytes + 2) // 3 * 4
    sizes = numpy.frombuffer(base64.b64decode(text[:encoded]), header, 3 + blocks)[3:]
    data = base64.b64decode(text[encoded:])
    parts, start = [], 0
    for size in map(int, sizes):
        parts.append(zlib.decompress(data[start:start + size]))
        start += size
    return b"".join(parts)


def read_vti(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    compressor = root.get("compressor")
    if compressor not in (None, "vtkZLibDataCompressor"):
        sys.exit(f"read_images.py: {path} is compressed with {compressor}, which is not supported.")
    if root.get("byte_order") != "LittleEndian":
        sys.exit(f"read_images.py: {path} is not little-endian.")
    piece = root.find("ImageData/Piece")
    array = piece.find("PointData/DataArray")
    if array.get("format") != "binary" or int(array.get("NumberOfComponents") or 1) != 1:
        sys.exit(f"read_images.py: the first array of {path} is no inline array of scalars.")
    extent = list(map(int, piece.get("Extent").split()))
    samples = [extent[2 * axis + 1] - extent[2 * axis] + 1 for axis in range(3)]
    data = inline_bytes(array.text, root.get("header_type", "UInt32"), compressor is not None)
    return samples, numpy.frombuffer(data, "<" + VTK_TYPES[array.get("type")])


def read_mhd(path):
    with open(path, encoding="utf-8") as file:
        fields = dict(map(str.strip, line.split("=", 1)) for line in file if "=" in line)
    if fields.get("CompressedData", "False") != "False":
        sys.exit(f"read_images.py: {path} is compressed, which is not supported.")
    order = ">" if fields.get("BinaryDataByteOrderMSB", "False") == "True" else "<"
    raw = os.path.join(os.path.dirname(path), fields["ElementDataFile"])
    return (list(map(int, fields["DimSize"].split())),
            numpy.fromfile(raw, order + META_TYPES[fields["ElementType"]]))


def main(name, output, images):
    shape = None
    with open(output, "wb") as raw:
        for path in images:
            samples, values = read_vti(path) if path.endswith(".vti") else read_mhd(path)
            shape = shape or samples
            if samples != shape or values.size != numpy.prod(samples):
                sys.exit(f"read_images.py: {path} does not fit the images before it.")
            values.astype("<f4").tofile(raw)
    description = {"name": name, "file": os.path.basename(output), "samples": shape,
                   "steps": len(images)}
    with open(os.path.splitext(output)[0] + ".json", "w", encoding="utf-8") as file:
        json.dump(description, file, indent=2)


if len(sys.argv) < 4:
    sys.exit(__doc__)
main(sys.argv[1], sys.argv[2], sys.argv[3:])
