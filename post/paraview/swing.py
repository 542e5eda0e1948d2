"""A picture of a swing: the club at several instants, coloured by what the shaft carries, and the trail of its head.

usage: scripts/pvbatch post/paraview/swing.py VTK_DIRECTORY [PICTURE.png [bending_moment|torque|axial_force]]
"""
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)
from scene import arguments, arrows, bar, caption, coloured, load, look, nearest, painted, save, series, white_view

INSTANTS = 12

folder, picture, field = arguments("swing.png", "bending_moment")
title = load(field)
shaft, head, hands, trail = (series(folder, name) for name in ("shaft", "head", "hands", "trail"))
times = shaft.TimestepValues
end = times[-1]
# Evenly over the last half second: a backswing is slow, and hides what matters.
begin = max(times[0], end - 0.5)
view = white_view()
view.ViewTime = end

low, high = 0.0, 0.0
for k in range(INSTANTS):
    t = nearest(times, begin + (end - begin) * k / (INSTANTS - 1))
    tube = Tube(Input=ForceTime(Input=shaft, ForcedTime=t), Radius=0.008, NumberofSides=16)
    display = coloured(tube, view, field)
    tube.UpdatePipeline()
    least, most = tube.PointData[field].GetRange()
    low, high = min(low, least), max(high, most)
    painted(ForceTime(Input=head, ForcedTime=t), view, [0.35, 0.35, 0.4])
    arrows(ForceTime(Input=hands, ForcedTime=t), view, "force", 1e-3, [0.85, 0.35, 0.1])
painted(trail, view, [0.6, 0.6, 0.6]).LineWidth = 2
GetColorTransferFunction(field).RescaleTransferFunction(low, high)
bar(display, view, field, title)
caption(view, "%d instants of the last %.2f s; arrows: the hands' force, 1 m for 1 kN" % (INSTANTS, end - begin))

# Face on: the golfer looks along -Y towards the ball; seen from where the ball lies.
box = trail.GetDataInformation().GetBounds()
middle = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2]
look(view, middle, [middle[0], middle[1] - 5, middle[2]], 0.62 * max(box[1] - box[0], box[5] - box[4]))
save(view, picture)
