"""What the pictures of this folder share: the arguments, a run's series, a white view, its labels and its camera."""
import csv
import math
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


def label(view, text="", place="Upper Left Corner"):
    """Words in a corner; what is returned has a Text to be changed."""
    source = Text(Text=text)
    display = Show(source, view)
    display.Color = [0, 0, 0]
    display.Justification = "Left"
    display.WindowLocation = place
    display.FontSize = 24
    return source


def caption(view, text, place="Upper Left Corner"):
    label(view, text, place)


def look(view, at, eye, height=None):
    """Parallel view of the point `at` from `eye`, Z up; `height` is half of what the picture shows from top to bottom [m]."""
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelProjection = 1
    view.CameraFocalPoint, view.CameraPosition = at, eye
    if height is None:
        ResetCamera(view)
    else:
        view.CameraParallelScale = height


def side(ball, upper):
    """The cells of a ball on one side of the plane of its mesh's axis and the slip, and where its points are in the mean."""
    cells = Threshold(Input=ball)
    cells.Scalars = ["CELLS", "angle"]
    cells.LowerThreshold, cells.UpperThreshold = (math.pi, 2 * math.pi) if upper else (0.0, math.pi)
    points = servermanager.Fetch(cells).GetPoints()
    count = points.GetNumberOfPoints()
    return cells, [sum(points.GetPoint(i)[k] for i in range(count)) / count for k in range(3)]


def blow(folder, view):
    """Ball, face, head and shaft of a blow, seen from the toe and a little from above; the ball is cut in the plane of its
    mesh's axis and the slip, and what lies nearer is away, so that the flattened patch is seen against the face. Returns the
    times [s], and a function that shows one of them."""
    ball = series(folder, "ball")
    halves = [side(ball, upper) for upper in (False, True)]
    if halves[0][1][1] < halves[1][1][1]:  # that on the heel's side stays
        halves.reverse()
    away = [a - b for a, b in zip(halves[0][1], halves[1][1])]
    length = math.sqrt(sum(x * x for x in away))
    away = [x / length for x in away]
    whole = moved(ball)
    stress = Calculator(Input=moved(halves[0][0]), ResultArrayName="MPa", Function="von_mises/1e6")
    # Linear pieces of the quadratic cells, so fine that they look smooth.
    surface = GenerateSurfaceNormals(Input=ExtractSurface(Input=stress, NonlinearSubdivisionLevel=3), FeatureAngle=40)
    display = coloured(surface, view, "MPa")
    display.Specular, display.Ambient, display.Diffuse = 0.1, 0.25, 0.8
    times = list(ball.TimestepValues)
    most = 0.0
    for time in times:  # one scale for all of them
        stress.UpdatePipeline(time)
        most = max(most, stress.PointData["MPa"].GetRange()[1])
    colours = GetColorTransferFunction("MPa")
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.RescaleTransferFunction(0.0, most)
    scale = bar(display, view, "MPa", "von Mises stress [MPa]")
    scale.TitleFontSize = scale.LabelFontSize = 22
    scale.WindowLocation, scale.Position = "Any Location", [0.86, 0.3]
    scale.ScalarBarLength = 0.4
    cuts = []
    for name, colour, opacity in (("face", [0.62, 0.64, 0.7], 1.0), ("head", [0.6, 0.6, 0.65], 0.2)):
        if has(folder, name):
            cut = Clip(Input=moved(series(folder, name)))
            cut.ClipType = "Plane"
            cut.ClipType.Normal = away
            cut.Invert = 0
            cuts.append(cut)
            painted(cut, view, colour, opacity)
    if has(folder, "shaft"):
        painted(Tube(Input=moved(series(folder, "shaft")), Radius=0.005, NumberofSides=32), view, [0.2, 0.2, 0.2])

    def show(time):
        view.ViewTime = time
        whole.UpdatePipeline(time)
        box = whole.GetDataInformation().GetBounds()
        middle = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2]
        for cut in cuts:
            cut.ClipType.Origin = middle
        # The face's side of the ball a little nearer to the middle of the picture.
        at = [middle[0] - 0.004, middle[1], middle[2]]
        look(view, at, [at[0] - 0.16 * away[0] - 0.03, at[1] - 0.16 * away[1], at[2] - 0.16 * away[2] + 0.03], 0.03)

    return times, show


def save(view, picture):
    SaveScreenshot(picture, view)
    print("wrote", picture)
