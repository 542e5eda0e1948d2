"""A picture of ball, face and shaft at maximum compression.

usage: scripts/pvbatch post/paraview/impact.py VTK_DIRECTORY [PICTURE.png]
"""
import csv
import os
import sys

import paraview.simple
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

paraview.simple._DisableFirstRenderCameraReset()

directory = sys.argv[1]
picture = sys.argv[2] if len(sys.argv) > 2 else "impact.png"


def open_series(name):
    """The series NAME.pvd, warped by its displacement; None where the run has no such body."""
    path = os.path.join(directory, name + ".pvd")
    if not os.path.exists(path):
        return None, None
    reader = PVDReader(FileName=path)
    reader.UpdatePipeline()
    warped = WarpByVector(Input=reader, Vectors=["POINTS", "displacement"], ScaleFactor=1.0)
    return reader, warped


ball, warped_ball = open_series("ball")
if ball is None:
    sys.exit("no ball.pvd in " + directory)
_, warped_face = open_series("face")
_, warped_head = open_series("head")
_, warped_shaft = open_series("shaft")

# Maximum compression: the frame nearest to the largest normal force in the run's history.
with open(os.path.join(directory, "..", "history.csv")) as file:
    rows = list(csv.DictReader(file))
peak = max(rows, key=lambda row: float(row["normal_force_N"]))
at = min(ball.TimestepValues, key=lambda time: abs(time - float(peak["time_s"])))
print("largest force at t = %.3f ms" % (1e3 * float(peak["time_s"])))

view = CreateView("RenderView")
view.ViewSize = [1400, 1000]
view.Background = [1, 1, 1]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 1
view.ViewTime = at

# Seen from the toe; the near half is cut away, so that the flattened patch is seen against the face.
cut = Clip(Input=warped_ball)
cut.ClipType = "Plane"
cut.ClipType.Origin = [0.0, 0.0, 0.0]
cut.ClipType.Normal = [0.0, 1.0, 0.0]
cut.Invert = 0
shown = Show(cut, view)
ColorBy(shown, ("POINTS", "von_mises"))
shown.SetScalarBarVisibility(view, True)
shown.RescaleTransferFunctionToDataRange(False, True)
shown.Interpolation = "Gouraud"
bar = GetScalarBar(GetColorTransferFunction("von_mises"), view)
bar.Title = "von Mises stress [Pa]"
bar.ComponentTitle = ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]
for body, colour, opacity in ((warped_face, [0.35, 0.35, 0.4], 1.0), (warped_head, [0.6, 0.6, 0.65], 0.25)):
    if body is not None:
        display = Show(body, view)
        display.DiffuseColor = colour
        display.AmbientColor = colour
        display.Opacity = opacity
        display.ColorArrayName = ["POINTS", ""]
if warped_shaft is not None:
    tube = Tube(Input=warped_shaft, Radius=0.005, NumberofSides=32)
    display = Show(tube, view)
    display.ColorArrayName = ["POINTS", ""]
    display.DiffuseColor = [0.2, 0.2, 0.2]

label = Text(Text="t = %.3f ms" % (1e3 * at))
label_display = Show(label, view)
label_display.Color = [0, 0, 0]
label_display.WindowLocation = "Upper Left Corner"

view.CameraFocalPoint = [0.0, 0.0, 0.0]
view.CameraPosition = [0.0, -0.16, 0.02]
view.CameraViewUp = [0.0, 0.0, 1.0]
view.CameraParallelProjection = 1
view.CameraParallelScale = 0.032
Render(view)
SaveScreenshot(picture, view)
print("wrote", picture)
