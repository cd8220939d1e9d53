# SPDX-License-Identifier: BSD-3-Clause
"""A field that is known everywhere, as a source of ParaView: whole on each rank, or cut into pieces.

`source` makes a Programmable Source; `value` is what it holds. The scripts run inside ParaView's
filters, on every rank, so they import nothing of ours.
"""
from paraview import simple

INFORMATION = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
n = {samples}
info.Set(executive.WHOLE_EXTENT(), 0, n[0] - 1, 0, n[1] - 1, 0, n[2] - 1)
info.Set(vtk.vtkDataObject.ORIGIN(), 1.0, 2.0, 3.0)
info.Set(vtk.vtkDataObject.SPACING(), 0.5, 0.25, 1.0)
times = [0.5 * step for step in range({steps})]
info.Remove(executive.TIME_STEPS())
for time in times:
    info.Append(executive.TIME_STEPS(), time)
info.Remove(executive.TIME_RANGE())
info.Append(executive.TIME_RANGE(), times[0])
info.Append(executive.TIME_RANGE(), times[-1])
if {pieces}:
    info.Set(vtk.vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""
DATA = """
import numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId() if controller else 0
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
time = info.Get(executive.UPDATE_TIME_STEP()) if info.Has(executive.UPDATE_TIME_STEP()) else 0.0
e = info.Get(executive.UPDATE_EXTENT()) if {pieces} else info.Get(executive.WHOLE_EXTENT())
image = self.GetOutputDataObject(0)
image.SetExtent(e)
image.SetOrigin(1.0, 2.0, 3.0)
image.SetSpacing(0.5, 0.25, 1.0)
z, y, x = numpy.meshgrid(*(numpy.arange(e[2 * a], e[2 * a + 1] + 1) for a in (2, 1, 0)),
                         indexing="ij")
wave = numpy.sin(0.3 * x + 0.8 * time) * numpy.cos(0.2 * y) + 0.1 * numpy.cos(1.7 * z * (x + y))
output.PointData.append(wave.astype("f4").ravel(), "wave")
output.PointData.append(numpy.stack([10 * wave.ravel(), wave.ravel() ** 2, x.ravel() + time],
                                    axis=1).astype("f8"), "vector")
if rank == {failing_rank} and time == 5.0:
    if {disk_full}:
        import resource
        import signal
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
    else:
        raise RuntimeError("this rank has had enough")
"""


def source(samples, steps, pieces, failing=-1, disk_full=False):
    """The rank `failing` fails at time 5: to compute, or from then on to write."""
    words = {"samples": samples, "steps": steps, "pieces": pieces, "failing_rank": failing,
             "disk_full": disk_full}
    return simple.ProgrammableSource(
        OutputDataSetType="vtkImageData", ScriptRequestInformation=INFORMATION.format(**words),
        Script=DATA.format(**words))
