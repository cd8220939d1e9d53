# SPDX-License-Identifier: BSD-3-Clause
"""ParaView lists the plugin by itself, loads it by its name on client and server, and draws with it."""
import os

from paraview import simple
from paraview.modules.vtkRemotingCore import vtkPVPluginsInformation


def plugins():
    """Names of the plugins that this process knows, and whether they are loaded."""
    known = vtkPVPluginsInformation()
    known.CopyFromObject(None)
    return {known.GetPluginName(i): bool(known.GetPluginLoaded(i)) for i in range(known.GetNumberOfPlugins())}


server = os.environ.get("BANYAN_TEST_SERVER")
if server:
    host, port = server.rsplit(":", 1)
    simple.Disconnect()
    simple.Connect(host, int(port))
listed = plugins()
if listed.get("Banyan") is not False:
    raise AssertionError(f"Banyan has to be listed and not loaded: {listed}")
simple.LoadDistributedPlugin("Banyan", remote=False, ns=globals())
if server:
    simple.LoadDistributedPlugin("Banyan", remote=True, ns=globals())
if not plugins()["Banyan"]:
    raise AssertionError("Banyan has to be loaded now")
view = simple.GetActiveViewOrCreate("RenderView")
view.ViewSize = [300, 300]
display = simple.Show(simple.Wavelet(), view)
display.SetRepresentationType("Banyan Volume")
simple.ColorBy(display, ("POINTS", "RTData"))
simple.ResetCamera(view)
simple.Render(view)
display.UpdatePropertyInformation()
if display.GetPropertyValue("BricksDrawn") == 0:
    raise AssertionError("nothing was drawn")
print("ok: found, loaded and drawn")
