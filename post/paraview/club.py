"""A picture of a whole club in a blow, at the largest force: coloured by what the shaft carries, beside the straight club
that the grip would carry along; the wrench of the hands as arrows.

usage: scripts/pvbatch post/paraview/club.py VTK_DIRECTORY [PICTURE.png [bending_moment|torque|axial_force]]
"""
import csv
import os
import sys

import paraview.simple
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

paraview.simple._DisableFirstRenderCameraReset()

directory = sys.argv[1]
picture = sys.argv[2] if len(sys.argv) > 2 else "club.png"
field = sys.argv[3] if len(sys.argv) > 3 else "bending_moment"
titles = {"bending_moment": "bending moment [N m]", "torque": "torque [N m]", "axial_force": "axial force [N]"}
if field not in titles:
    sys.exit("colour by one of " + ", ".join(titles))
if not os.path.exists(os.path.join(directory, "hands.pvd")):
    sys.exit("no hands.pvd in " + directory + ": a blow of a whole club is wanted")


def series(name):
    reader = PVDReader(FileName=os.path.join(directory, name + ".pvd"))
    reader.UpdatePipeline()
    return reader


def moved(source, by="displacement"):
    return WarpByVector(Input=source, Vectors=["POINTS", by], ScaleFactor=1.0)


def painted(source, colour, opacity=1.0):
    display = Show(source, view)
    display.ColorArrayName = ["POINTS", ""]
    display.DiffuseColor = display.AmbientColor = colour
    display.Opacity = opacity
    return display


shaft = series("shaft")
with open(os.path.join(directory, "..", "history.csv")) as file:
    peak = max(csv.DictReader(file), key=lambda row: float(row["normal_force_N"]))
at = min(shaft.TimestepValues, key=lambda time: abs(time - float(peak["time_s"])))

view = CreateView("RenderView")
view.ViewSize = [1200, 1000]
view.Background = [1, 1, 1]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 1
view.ViewTime = at

club = moved(shaft)
tube = Tube(Input=club, Radius=0.006, NumberofSides=24)
display = Show(tube, view)
ColorBy(display, ("POINTS", field))
tube.UpdatePipeline(at)
low, high = tube.PointData[field].GetRange()
table = GetColorTransferFunction(field)
table.RescaleTransferFunction(min(low, 0.0), max(high, 0.0))
bar = GetScalarBar(table, view)
bar.Title = titles[field]
bar.ComponentTitle = ""
bar.RangeLabelFormat = "%.0f"
bar.TitleColor = bar.LabelColor = [0, 0, 0]
display.SetScalarBarVisibility(view, True)

straight = Calculator(Input=shaft, ResultArrayName="straight", Function="displacement-deflection")
painted(Tube(Input=moved(straight, "straight"), Radius=0.002, NumberofSides=12), [0.6, 0.6, 0.6])
painted(moved(series("head")), [0.35, 0.35, 0.4], 0.5)
painted(moved(series("ball")), [0.8, 0.8, 0.75])

hands = moved(series("hands"))
hands.UpdatePipeline(at)
size = {name: max(abs(x) for x in hands.PointData[name].GetRange(-1)) for name in ("force", "moment")}
for name, colour, scale in (("force", [0.85, 0.35, 0.1], 1e-3), ("moment", [0.1, 0.35, 0.85], 1e-2)):
    arrow = Glyph(Input=hands, GlyphType="Arrow", GlyphMode="All Points", ScaleFactor=scale)
    arrow.OrientationArray = ["POINTS", name]
    arrow.ScaleArray = ["POINTS", name]
    arrow.GlyphType.ShaftRadius, arrow.GlyphType.TipRadius, arrow.GlyphType.TipLength = 0.012, 0.04, 0.2
    arrow.GlyphType.ShaftResolution = arrow.GlyphType.TipResolution = 24
    painted(arrow, colour)
label = Text(Text="t = %.3f ms, ball on the face with %.1f kN; grey: the straight club\n"
                  "hands: force %.0f N (orange, 1 m for 1 kN), moment %.1f N m (blue, 1 m for 100 N m)"
                  % (1e3 * at, 1e-3 * float(peak["normal_force_N"]), size["force"], size["moment"]))
label_display = Show(label, view)
label_display.Color = [0, 0, 0]
label_display.WindowLocation = "Upper Left Corner"

# From where the golfer looks, across the line of play; all of the club and its arrows in the picture.
view.CameraViewUp = [0, 0, 1]
view.CameraParallelProjection = 1
view.CameraFocalPoint = [0, 0, 0]
view.CameraPosition = [2, -4, 0.3]
ResetCamera(view)
view.CameraParallelScale *= 0.92
Render(view)
SaveScreenshot(picture, view)
print("wrote", picture, "at the largest force; hands %.1f N, %.2f N m" % (size["force"], size["moment"]))
