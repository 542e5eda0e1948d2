"""A picture of ball, face and shaft at maximum compression.

usage: scripts/pvbatch post/paraview/impact.py VTK_DIRECTORY [PICTURE.png]
"""
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)
from scene import arguments, bar, caption, coloured, has, largest_force, look, moved, nearest, painted, save, series, white_view

folder, picture, _ = arguments("impact.png")
ball = series(folder, "ball")
time, _ = largest_force(folder)
at = nearest(ball.TimestepValues, time)
print("largest force at t = %.3f ms" % (1e3 * time))
view = white_view()
view.ViewTime = at

# Seen from the toe; the near half is cut away, so that the flattened patch is seen against the face.
stress = Calculator(Input=moved(ball), ResultArrayName="MPa", Function="von_mises/1e6")
cut = Clip(Input=stress)
cut.ClipType = "Plane"
cut.ClipType.Origin = [0.0, 0.0, 0.0]
cut.ClipType.Normal = [0.0, 1.0, 0.0]
cut.Invert = 0
shown = coloured(cut, view, "MPa")
shown.RescaleTransferFunctionToDataRange(False, True)
shown.Interpolation = "Gouraud"
bar(shown, view, "MPa", "von Mises stress [MPa]")
for name, colour, opacity in (("face", [0.35, 0.35, 0.4], 1.0), ("head", [0.6, 0.6, 0.65], 0.25)):
    if has(folder, name):
        painted(moved(series(folder, name)), view, colour, opacity)
if has(folder, "shaft"):
    painted(Tube(Input=moved(series(folder, "shaft")), Radius=0.005, NumberofSides=32), view, [0.2, 0.2, 0.2])
caption(view, "t = %.3f ms" % (1e3 * at))
look(view, [0.0, 0.0, 0.0], [0.0, -0.16, 0.02], 0.032)
save(view, picture)
