"""The pictures of a film of a blow: the ball cut open, coloured by stress, the camera with it; 0000.png and on.

usage: scripts/pvbatch post/paraview/film.py VTK_DIRECTORY FOLDER
"""
import os

from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)
from scene import arguments, blow, label, save, white_view

folder, pictures, _ = arguments(".")
view = white_view(1280, 960)
times, show = blow(folder, view)
text = label(view, place="Upper Right Corner")
for number, time in enumerate(times):
    show(time)
    text.Text = "t = %.3f ms" % (1e3 * time)
    save(view, os.path.join(pictures, "%04d.png" % number))
