"""Opens every series of a run as ParaView does and looks at each of its times.

usage: scripts/pvbatch tests/paraview/open_series.py VTK_DIRECTORY
"""
import glob
import os
import sys

from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

directory = sys.argv[1]
# A flight is lines at one time, without a displacement.
series = sorted(p for p in glob.glob(os.path.join(directory, "*.pvd")) if not os.path.basename(p).startswith("flight-"))
if not series:
    sys.exit("no series in " + directory)
for path in series:
    reader = PVDReader(FileName=path)
    reader.UpdatePipelineInformation()
    times = list(reader.TimestepValues)
    if len(times) < 2 or sorted(times) != times:
        sys.exit("%s: times %s" % (path, times))
    largest = 0.0
    for time in times:
        reader.UpdatePipeline(time)
        data = reader.GetDataInformation()
        if data.GetNumberOfPoints() == 0:
            sys.exit("%s: nothing at t = %g s" % (path, time))
        displacement = reader.PointData["displacement"]
        if displacement.GetNumberOfComponents() != 3:
            sys.exit("%s: displacement has %d components" % (path, displacement.GetNumberOfComponents()))
        largest = max(largest, displacement.GetRange(-1)[1])
    if not largest > 1e-3:
        sys.exit("%s: nothing moved by a millimetre" % path)
    print("%s: %d times to %.4f ms, largest displacement %.1f mm"
          % (os.path.basename(path), len(times), 1e3 * times[-1], 1e3 * largest))
