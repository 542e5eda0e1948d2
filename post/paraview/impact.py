"""A picture of ball, face and shaft at maximum compression: the ball cut open, coloured by stress.

usage: scripts/pvbatch post/paraview/impact.py VTK_DIRECTORY [PICTURE.png]
"""
from scene import arguments, blow, caption, largest_force, nearest, save, white_view

folder, picture, _ = arguments("impact.png")
time, force = largest_force(folder)
print("largest force at t = %.3f ms" % (1e3 * time))
view = white_view()
times, show = blow(folder, view)
show(nearest(times, time))
caption(view, "largest force, %.1f kN after %.2f ms" % (1e-3 * force, 1e3 * time), "Upper Right Corner")
save(view, picture)
