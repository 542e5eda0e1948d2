"""A picture of a face map: one quantity as colours on the curved face, heel on the left.

usage: scripts/pvbatch post/paraview/face.py VTK_DIRECTORY [PICTURE.png [QUANTITY]]

QUANTITY is an array of face.pvd, such as shaft-coupled.backspin; without one it is what the club changes of the ball's speed,
or the speed. What there is, is printed.
"""
import os
import sys

import paraview.simple
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

paraview.simple._DisableFirstRenderCameraReset()

directory = sys.argv[1]
picture = sys.argv[2] if len(sys.argv) > 2 else "face.png"
path = os.path.join(directory, "face.pvd")
if not os.path.exists(path):
    sys.exit("no face.pvd in " + directory)
face = PVDReader(FileName=path)
face.UpdatePipeline()
names = [array.Name for array in face.PointData]
print("quantities:", ", ".join(names))
speeds = sorted((n for n in names if n.endswith("ball_speed")), key=lambda n: (not n.startswith(("fe-full-club", "shaft-coupled")), "-minus-" not in n))
quantity = sys.argv[3] if len(sys.argv) > 3 else (speeds + names)[0]
if quantity not in names:
    sys.exit("no quantity %s in %s" % (quantity, path))

view = CreateView("RenderView")
view.ViewSize = [1400, 800]
view.Background = [1, 1, 1]
view.UseColorPaletteForBackground = 0
shown = Show(face, view)
ColorBy(shown, ("POINTS", quantity))
low, high = face.PointData[quantity].GetRange()
colours = GetColorTransferFunction(quantity)
colours.ApplyPreset("Cool to Warm" if low < 0 < high else "Viridis (matplotlib)", True)
if low < 0 < high:  # white is no difference
    low, high = -max(-low, high), max(-low, high)
colours.RescaleTransferFunction(low, high)
shown.SetScalarBarVisibility(view, True)
shown.Ambient, shown.Diffuse = 1.0, 0.0  # the colours of the bar, without light and shade
bar = GetScalarBar(colours, view)
array = servermanager.Fetch(face).GetPointData().GetArray(quantity)
bar.Title = "%s [%s]" % (quantity, array.GetInformation().Get(array.UNITS_LABEL()))
bar.ComponentTitle = ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]
bar.Orientation = "Horizontal"
bar.WindowLocation = "Lower Center"
bar.ScalarBarLength = 0.6
bar.AddRangeLabels = 0

# From behind, as the golfer sees it: heel on the left, toe on the right.
bounds = face.GetDataInformation().GetBounds()
middle = [(bounds[2 * k] + bounds[2 * k + 1]) / 2 for k in range(3)]
middle[2] -= 0.12 * (bounds[5] - bounds[4])  # room for the bar
view.CameraFocalPoint = middle
view.CameraPosition = [middle[0] - 1, middle[1], middle[2]]
view.CameraViewUp = [0.0, 0.0, 1.0]
view.CameraParallelProjection = 1
view.CameraParallelScale = 0.8 * (bounds[5] - bounds[4])
Render(view)
SaveScreenshot(picture, view)
print("wrote", picture)
