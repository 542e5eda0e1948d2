"""A picture of a swing: the club at several instants, coloured by what the shaft carries, and the trail of its head.

usage: scripts/pvbatch post/paraview/swing.py VTK_DIRECTORY [PICTURE.png [bending_moment|torque|axial_force]]
"""
import os
import sys

import paraview.simple
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

paraview.simple._DisableFirstRenderCameraReset()

directory = sys.argv[1]
picture = sys.argv[2] if len(sys.argv) > 2 else "swing.png"
field = sys.argv[3] if len(sys.argv) > 3 else "bending_moment"
titles = {"bending_moment": "bending moment [N m]", "torque": "torque [N m]", "axial_force": "axial force [N]"}
if field not in titles:
    sys.exit("colour by one of " + ", ".join(titles))
INSTANTS = 12

if not os.path.exists(os.path.join(directory, "shaft.pvd")):
    sys.exit("no shaft.pvd in " + directory)
series = {body: PVDReader(FileName=os.path.join(directory, body + ".pvd")) for body in ("shaft", "head", "hands", "trail")}
for reader in series.values():
    reader.UpdatePipeline()
times = series["shaft"].TimestepValues
end = times[-1]
# Evenly over the last half second: a backswing is slow, and hides what matters.
begin = max(times[0], end - 0.5)
shown = [min(times, key=lambda t: abs(t - (begin + (end - begin) * k / (INSTANTS - 1)))) for k in range(INSTANTS)]

view = CreateView("RenderView")
view.ViewSize = [1400, 1000]
view.Background = [1, 1, 1]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 1
view.ViewTime = end

table = GetColorTransferFunction(field)
low, high = 0.0, 0.0
for t in shown:
    club = ForceTime(Input=series["shaft"], ForcedTime=t)
    tube = Tube(Input=club, Radius=0.008, NumberofSides=16)
    display = Show(tube, view)
    ColorBy(display, ("POINTS", field))
    tube.UpdatePipeline()
    least, most = tube.PointData[field].GetRange()
    low, high = min(low, least), max(high, most)
    head = Show(ForceTime(Input=series["head"], ForcedTime=t), view)
    head.ColorArrayName = ["POINTS", ""]
    head.DiffuseColor = head.AmbientColor = [0.35, 0.35, 0.4]
    # The force of the hands: 1 m for 1 kN.
    hands = ForceTime(Input=series["hands"], ForcedTime=t)
    arrow = Glyph(Input=hands, GlyphType="Arrow")
    arrow.OrientationArray = ["POINTS", "force"]
    arrow.ScaleArray = ["POINTS", "force"]
    arrow.ScaleFactor = 1e-3
    arrow.GlyphMode = "All Points"
    shown_arrow = Show(arrow, view)
    shown_arrow.ColorArrayName = ["POINTS", ""]
    shown_arrow.DiffuseColor = shown_arrow.AmbientColor = [0.85, 0.35, 0.1]
trail = Show(series["trail"], view)
trail.ColorArrayName = ["POINTS", ""]
trail.DiffuseColor = trail.AmbientColor = [0.6, 0.6, 0.6]
trail.LineWidth = 2
table.RescaleTransferFunction(low, high)
bar = GetScalarBar(table, view)
bar.Title = titles[field]
bar.ComponentTitle = ""
bar.RangeLabelFormat = "%.0f"
bar.TitleColor = bar.LabelColor = [0, 0, 0]
display.SetScalarBarVisibility(view, True)
label = Text(Text="%d instants of the last %.2f s; arrows: the hands' force, 1 m for 1 kN" % (INSTANTS, end - begin))
label_display = Show(label, view)
label_display.Color = [0, 0, 0]
label_display.WindowLocation = "Upper Left Corner"

# Face on: the golfer looks along -Y towards the ball; seen from where the ball lies.
view.CameraViewUp = [0, 0, 1]
view.CameraParallelProjection = 1
box = series["trail"].GetDataInformation().GetBounds()
middle = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2]
view.CameraFocalPoint = middle
view.CameraPosition = [middle[0], middle[1] - 5, middle[2]]
view.CameraParallelScale = 0.62 * max(box[1] - box[0], box[5] - box[4])
Render(view)
SaveScreenshot(picture, view)
print("wrote", picture)
