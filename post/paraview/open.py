"""Opens every series of a run: warped by its displacement, the ball coloured by stress and in the middle of the view, the
face of a map by the ball's speed.

`hosel open OUT` starts ParaView with it. HOSEL_VTK names the folders of series, one a line.
"""
import glob
import os

from paraview.simple import *  # noqa: F403  (the way ParaView scripts are written)

view = GetActiveViewOrCreate("RenderView")
opened = []
for folder in os.environ["HOSEL_VTK"].split("\n"):
    for path in sorted(glob.glob(os.path.join(folder, "*.pvd"))):
        name = os.path.splitext(os.path.basename(path))[0]
        source = PVDReader(registrationName=name, FileName=path)
        source.UpdatePipeline()
        if "displacement" in [a.Name for a in source.PointData]:
            source = WarpByVector(registrationName=name + " moved", Input=source, Vectors=["POINTS", "displacement"])
            source.ScaleFactor = 1.0
        display = Show(source, view)
        display.ColorArrayName = ["POINTS", ""]
        if name == "ball":
            ColorBy(display, ("POINTS", "von_mises"))
            display.RescaleTransferFunctionToDataRangeOverTime()
            display.SetScalarBarVisibility(view, True)
        speeds = [a.Name for a in source.PointData if a.Name.endswith("ball_speed")]
        if name == "face" and speeds:  # a face map: any other quantity is in the list of colours
            ColorBy(display, ("POINTS", next((s for s in speeds if "-minus-" in s), speeds[0])))
            display.SetScalarBarVisibility(view, True)
        if name == "head":
            display.Opacity = 0.25
        if name == "patch":
            Hide(source, view)  # pressure and slip of the contact, to be switched on in the browser
        opened.append(path)
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
ResetCamera(view)
if any(os.path.basename(path) == "ball.pvd" for path in opened):
    # From the toe, a ball's width around it; the whole club is one click on "reset camera" away.
    view.CameraParallelProjection = 1
    view.CameraParallelScale = 0.04
    view.CameraFocalPoint = [0.0, 0.0, 0.0]
    view.CameraPosition = [0.0, -0.3, 0.05]
    view.CameraViewUp = [0.0, 0.0, 1.0]
Render(view)
print("opened:", ", ".join(opened))
