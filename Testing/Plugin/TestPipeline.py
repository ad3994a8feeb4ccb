"""Marks, deforms and measures a bar, and finds it again in saved states."""
import runpy

import cartan_testing
from paraview import simple, smstate
from paraview.vtk.util.numpy_support import vtk_to_numpy

from plugin_testing import (
    check, check_close, load_plugin, mark_ends, open_bar, output, refresh, remove)


def bounds(proxy):
    return output(proxy).GetBounds()


def point_nearest(proxy, position):
    """The place of the point that is at `position` in the bar."""
    rest = vtk_to_numpy(output(simple.FindSource("Bar")).GetPoints().GetData())
    index = ((rest - position) ** 2).sum(axis=1).argmin()
    return output(proxy).GetPoint(index)


def check_bent(proxy):
    """The right end has turned by 90 degrees about the bar's middle, the left end stays."""
    check_close(point_nearest(proxy, [5, 0.5, 0.5]), [2.5, 0.5, -2.0], "the bar's end")
    check_close(point_nearest(proxy, [0, 0.5, 0.5]), [0, 0.5, 0.5], "the pinned end")


load_plugin()
bar = open_bar("TestPipeline")
marked = mark_ends(bar)

# The three kinds of motion give the same surface.
bent = simple.RotationInvariantDeformation(Input=marked, registrationName="Bent")
bent.Motion.Center = [2.5, 0.5, 0.5]
bent.Motion.Axis = [0, 1, 0]
bent.Motion.Angle = 90
bent.GenerateFrameChange = 1
check_bent(bent)
by_axis = bounds(bent)
refresh(bent)
check(bent.NumberOfFactorizations == 1, "one factorization")
check(bent.NumberOfFreePoints > 100, "free points")
check_close(bent.ActiveHandleBounds, [4.48, 5.02, -0.02, 1.02, -0.02, 1.02],
            "the box around the handle", 0.03)

bent.Motion = "Matrix"
bent.Motion.Matrix = [0, 0, 1, 2, 0, 1, 0, 0, -1, 0, 0, 3, 0, 0, 0, 1]
check_close(bounds(bent), by_axis, "by a matrix")
bent.Motion = "Box"
check_close(bent.Motion.ReferenceBounds, bent.ActiveHandleBounds, "the box is the handle's")
bent.Motion.Rotation = [0, 90, 0]
bent.Motion.Position = [2, 0, 3]
check_close(bounds(bent), by_axis, "by a box")

# Rows move the other handle; the active handle can be any.
bent.MotionRows = [2, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0]
check_close(point_nearest(bent, [0, 0.5, 0.5]), [0, 1.0, 0.5], "a row")
bent.MotionRows = []
check_bent(bent)
bent.Motion = "None"
bent.ActiveHandle = 2
check_close(bounds(bent), bounds(bar), "without a motion")
bent.ActiveHandle = 1
bent.Motion = "Axis and Angle"
check_bent(bent)
refresh(bent)
check(bent.NumberOfFactorizations <= 4, "what is kept between motions")

# Options.
bent.LaplacianWeights = "Uniform"
bent.FrameProjection = "None"
bent.Solver = "Eigen"
check_bent(bent)
bent.LaplacianWeights = "Cotangent"
bent.FrameProjection = "Automatic"
bent.Solver = "Automatic"

# Measures, their tables and their colors.
change = simple.VolumeChange(Input=bent, Reference=bar, registrationName="Change")
refresh(change)
check(-0.2 < change.RelativeVolumeChange < -1e-3, "volume: %g" % change.RelativeVolumeChange)
check(change.EdgeLengthRMS > 0, "edge lengths")
check(output(change).GetPointData().GetScalars().GetName() == "AreaRatio", "color")
check(output(change, 1).GetColumnByName("Quantity").GetValue(0) == "Volume", "table")
error = simple.CurvatureError(Input=bent, Reference=bar)
refresh(error)
check(error.MeanCurvatureErrorRMS > 0, "curvature error")
check(output(error).GetPointData().GetScalars().GetName() == "MeanCurvatureError", "color")
curvature = simple.CurvatureError(Input=bent)
check(output(curvature).GetPointData().GetScalars().GetName() == "MeanCurvature", "color")
view = simple.CreateRenderView()
check(simple.Show(error, view).ColorArrayName[1] == "MeanCurvatureError", "color in a view")

# Forms and back.
forms = simple.DiscreteForms(Input=bent)
check(output(forms, 1).GetNumberOfRows() > 1000, "forms")
again = simple.FrameReconstruction(Input=bent, Forms=simple.OutputPort(forms, 1))
again.SeedPoint = 3
again.SeedPosition = [1, 2, 3]
check_close(output(again).GetPoint(3), [1, 2, 3], "the seed")

# States.
state = cartan_testing.output_path("TestPipeline.pvsm")
script = cartan_testing.output_path("TestPipelineState.py")
for path in (state, script):
    remove(path)
simple.SaveState(state)
with open(script, "w", encoding="utf-8") as file:
    file.write(smstate.get_state())
for path in (state, script):
    simple.ResetSession()
    if path == state:
        simple.LoadState(state)
    else:
        runpy.run_path(script)
    bent = simple.FindSource("Bent")
    check_bent(bent)
    check_close(bent.Motion.Angle, 90, "the angle in " + path)
    change = simple.FindSource("Change")
    refresh(change)
    check(change.RelativeVolumeChange < -1e-3, "the measure in " + path)
