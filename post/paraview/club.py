"""A picture of a whole club in a blow, at the largest force: coloured by what the shaft carries, beside the straight club
that the grip would carry along; the wrench of the hands as arrows.

usage: scripts/pvbatch post/paraview/club.py VTK_DIRECTORY [PICTURE.png [bending_moment|torque|axial_force]]
"""
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)
from scene import arguments, arrows, bar, caption, coloured, largest_force, load, look, moved, nearest, painted, save, series, white_view

folder, picture, field = arguments("club.png", "bending_moment")
title = load(field)
hands, shaft = series(folder, "hands"), series(folder, "shaft")
time, force = largest_force(folder)
at = nearest(shaft.TimestepValues, time)
view = white_view(1200, 1000)
view.ViewTime = at

tube = Tube(Input=moved(shaft), Radius=0.006, NumberofSides=24)
display = coloured(tube, view, field)
tube.UpdatePipeline(at)
low, high = tube.PointData[field].GetRange()
GetColorTransferFunction(field).RescaleTransferFunction(min(low, 0.0), max(high, 0.0))
bar(display, view, field, title)

straight = Calculator(Input=shaft, ResultArrayName="straight", Function="displacement-deflection")
painted(Tube(Input=moved(straight, "straight"), Radius=0.002, NumberofSides=12), view, [0.6, 0.6, 0.6])
painted(moved(series(folder, "head")), view, [0.35, 0.35, 0.4], 0.5)
painted(moved(series(folder, "ball")), view, [0.8, 0.8, 0.75])

grip = moved(hands)
grip.UpdatePipeline(at)
size = {name: max(abs(x) for x in grip.PointData[name].GetRange(-1)) for name in ("force", "moment")}
for name, colour, scale in (("force", [0.85, 0.35, 0.1], 1e-3), ("moment", [0.1, 0.35, 0.85], 1e-2)):
    arrow = arrows(grip, view, name, scale, colour)
    arrow.GlyphType.ShaftRadius, arrow.GlyphType.TipRadius, arrow.GlyphType.TipLength = 0.012, 0.04, 0.2
    arrow.GlyphType.ShaftResolution = arrow.GlyphType.TipResolution = 24
caption(view, "t = %.3f ms, ball on the face with %.1f kN; grey: the straight club\n"
              "hands: force %.0f N (orange, 1 m for 1 kN), moment %.1f N m (blue, 1 m for 100 N m)"
              % (1e3 * at, 1e-3 * force, size["force"], size["moment"]))

# From where the golfer looks, across the line of play; all of the club and its arrows in the picture.
look(view, [0, 0, 0], [2, -4, 0.3])
view.CameraParallelScale *= 0.92
save(view, picture)
print("at the largest force; hands %.1f N, %.2f N m" % (size["force"], size["moment"]))
