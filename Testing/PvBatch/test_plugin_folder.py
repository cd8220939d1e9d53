# SPDX-License-Identifier: BSD-3-Clause
"""The plugin is found in the folder that its libraries lie in, which ParaView opens and closes one by one.

    test_plugin_folder.py --plugin Banyan.so

What a library has told another one must stay valid: once opened, it stays.
"""
import ctypes
import glob
import os

import session

TIMES = 3


def mapped(library):
    with open("/proc/self/maps", encoding="utf-8") as maps:
        return any(line.rstrip().endswith(os.path.realpath(library)) for line in maps)


def main():
    arguments = session.parser(__doc__).parse_args()
    # Those that others need first: what stays open anyway keeps what it needs.
    libraries = sorted(glob.glob(os.path.join(os.path.dirname(arguments.plugin), "*.so")), reverse=True)
    session.require(len(libraries) > 3, f"only {libraries} beside the plugin")
    close = ctypes.CDLL(None).dlclose
    close.argtypes = [ctypes.c_void_p]
    for _ in range(TIMES):
        for library in libraries:
            handle = ctypes.CDLL(library)
            session.require(close(handle._handle) == 0, f"{library} cannot be closed")
            session.require(mapped(library), f"{library} is gone when it is closed")
    session.begin(arguments)
    from paraview import simple
    view = session.new_view((64, 48))
    source = simple.Wavelet()
    display = simple.Show(source, view)
    display.SetRepresentationType(session.REPRESENTATION)
    simple.Render(view)
    print(f"{len(libraries)} libraries stay, and the plugin draws", flush=True)


main()
