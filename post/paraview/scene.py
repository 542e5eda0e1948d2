"""What the pictures of this folder share: the arguments, a run's series, a white view, its labels and its camera."""
import csv
import os
import sys

import paraview.simple
from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

paraview.simple._DisableFirstRenderCameraReset()

# What a shaft carries, by the arrays of shaft.pvd.
LOADS = {"bending_moment": "bending moment [N m]", "torque": "torque [N m]", "axial_force": "axial force [N]"}


def arguments(picture, quantity=None):
    """Folder of the series, file of the picture, and what to colour by: as the command line says, or as given here."""
    given = sys.argv[1:]
    return given[0], given[1] if len(given) > 1 else picture, given[2] if len(given) > 2 else quantity


def load(quantity):
    """The title of one of LOADS; ends the script where it is none."""
    if quantity not in LOADS:
        sys.exit("colour by one of " + ", ".join(LOADS))
    return LOADS[quantity]


def has(folder, name):
    return os.path.exists(os.path.join(folder, name + ".pvd"))


def series(folder, name):
    """The reader of NAME.pvd; ends the script where the run has none."""
    if not has(folder, name):
        sys.exit("no %s.pvd in %s" % (name, folder))
    reader = PVDReader(FileName=os.path.join(folder, name + ".pvd"))
    reader.UpdatePipeline()
    return reader


def moved(source, by="displacement"):
    """Points where they are at the view's time, to scale."""
    return WarpByVector(Input=source, Vectors=["POINTS", by], ScaleFactor=1.0)


def largest_force(folder):
    """Time [s] and normal force [N] of the largest force in the history beside the series."""
    with open(os.path.join(folder, "..", "history.csv")) as file:
        peak = max(csv.DictReader(file), key=lambda row: float(row["normal_force_N"]))
    return float(peak["time_s"]), float(peak["normal_force_N"])


def nearest(times, time):
    return min(times, key=lambda t: abs(t - time))


def white_view(width=1400, height=1000, axes=1):
    view = CreateView("RenderView")
    view.ViewSize = [width, height]
    view.Background = [1, 1, 1]
    view.UseColorPaletteForBackground = 0
    view.OrientationAxesVisibility = axes
    view.OrientationAxesLabelColor = [0, 0, 0]
    return view


def painted(source, view, colour, opacity=1.0):
    """Shows a body in one colour."""
    display = Show(source, view)
    display.ColorArrayName = ["POINTS", ""]
    display.DiffuseColor = display.AmbientColor = colour
    display.Opacity = opacity
    return display


def coloured(source, view, quantity):
    """Shows a body by a quantity at its points."""
    display = Show(source, view)
    ColorBy(display, ("POINTS", quantity))
    return display


def bar(display, view, quantity, title):
    """The scale of the colours, in black."""
    scale = GetScalarBar(GetColorTransferFunction(quantity), view)
    scale.Title, scale.ComponentTitle = title, ""
    scale.TitleColor = scale.LabelColor = [0, 0, 0]
    scale.RangeLabelFormat = "%.3g"
    display.SetScalarBarVisibility(view, True)
    return scale


def arrows(source, view, vector, scale, colour):
    """A vector at its points, `scale` metres long for each of its units."""
    arrow = Glyph(Input=source, GlyphType="Arrow", GlyphMode="All Points", ScaleFactor=scale)
    arrow.OrientationArray = arrow.ScaleArray = ["POINTS", vector]
    painted(arrow, view, colour)
    return arrow


def caption(view, text, place="Upper Left Corner"):
    label = Show(Text(Text=text), view)
    label.Color = [0, 0, 0]
    label.Justification = "Left"
    label.WindowLocation = place


def look(view, at, eye, height=None):
    """Parallel view of the point `at` from `eye`, Z up; `height` is half of what the picture shows from top to bottom [m]."""
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelProjection = 1
    view.CameraFocalPoint, view.CameraPosition = at, eye
    if height is None:
        ResetCamera(view)
    else:
        view.CameraParallelScale = height


def save(view, picture):
    Render(view)
    SaveScreenshot(picture, view)
    print("wrote", picture)
