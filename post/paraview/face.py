"""A picture of a face map: one quantity as colours on the curved face, heel on the left.

usage: scripts/pvbatch post/paraview/face.py VTK_DIRECTORY [PICTURE.png [QUANTITY]]

QUANTITY is an array of face.pvd, such as shaft-coupled.backspin; without one it is what the club changes of the ball's speed,
or the speed. What there is, is printed.
"""
import sys

from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)
from scene import arguments, bar, caption, coloured, look, save, series, white_view

folder, picture, quantity = arguments("face.png")
face = series(folder, "face")
names = [array.Name for array in face.PointData]
print("quantities:", ", ".join(names))
speeds = sorted((n for n in names if n.endswith("ball_speed")), key=lambda n: (not n.startswith(("fe-full-club", "shaft-coupled")), "-minus-" not in n))
quantity = quantity or (speeds + names)[0]
if quantity not in names:
    sys.exit("no quantity %s in %s" % (quantity, folder))

view = white_view(1400, 800, axes=0)
shown = coloured(face, view, quantity)
low, high = face.PointData[quantity].GetRange()
colours = GetColorTransferFunction(quantity)
colours.ApplyPreset("Cool to Warm" if low < 0 < high else "Viridis (matplotlib)", True)
if low < 0 < high:  # white is no difference
    low, high = -max(-low, high), max(-low, high)
colours.RescaleTransferFunction(low, high)
shown.Ambient, shown.Diffuse = 1.0, 0.0  # the colours of the bar, without light and shade
array = servermanager.Fetch(face).GetPointData().GetArray(quantity)
unit = array.GetInformation().Get(array.UNITS_LABEL())
model, _, of = quantity.rpartition(".")
title = "%s by %s [%s]" % (of.replace("_", " "), model.replace("-minus-", " minus "), unit)
scale = bar(shown, view, quantity, title)
scale.Orientation, scale.WindowLocation, scale.ScalarBarLength, scale.AddRangeLabels = "Horizontal", "Any Location", 0.6, 0
scale.Position = [0.2, 0.1]
caption(view, "heel")
caption(view, "toe", "Upper Right Corner")

# From behind, as the golfer sees it: heel on the left, toe on the right.
bounds = face.GetDataInformation().GetBounds()
middle = [(bounds[2 * k] + bounds[2 * k + 1]) / 2 for k in range(3)]
middle[2] -= 0.12 * (bounds[5] - bounds[4])  # room for the bar
look(view, middle, [middle[0] - 1, middle[1], middle[2]], max(0.75 * (bounds[5] - bounds[4]), 0.31 * (bounds[3] - bounds[2])))
save(view, picture)
