"""Morphs between surfaces: by a parameter, over time, through an animation, in a chart's table."""
import glob
import os

import cartan_testing
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

from plugin_testing import (
    Messages, check, check_close, load_plugin, mark_ends, open_bar, output, refresh, write)


def points(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def length(surface):
    """Of the bar's middle line, whatever its shape: over the midpoints of its cross-sections."""
    rest = points(output(bar))
    current = points(surface)
    line = [current[abs(rest[:, 0] - x) < 1e-6].mean(axis=0) for x in sorted(set(rest[:, 0]))]
    return sum(((b - a) ** 2).sum() ** .5 for a, b in zip(line, line[1:]))


load_plugin()
bar = open_bar("TestMorph")
bent = simple.ShapePreservingDeformation(
    Input=mark_ends(bar), VolumeCorrection="None", ConstrainHandlePositions=0)
bent.Motion.Axis = [0, 1, 0]
bent.Motion.Angle = 170
straight, curved = length(output(bar)), length(output(bent))

morph = simple.SurfaceMorph(Input=[bar, bent], registrationName="Morph")
for parameter, surface in ((0, output(bar)), (1, output(bent))):
    morph.Parameter = parameter
    check((points(output(morph)) == points(surface)).all(), "key frame at %s" % parameter)
morph.Parameter = 0.5
for method in ("Discrete Forms", "Isometric", "Deformation Gradient", "Pyramid Coordinates"):
    morph.Method = method
    check_close(length(output(morph)), (straight + curved) / 2, method, 0.02)
morph.Method = "Linear"
check(length(output(morph)) < 0.8 * straight, "linear interpolation shrinks")
morph.Method = "Discrete Forms"
for name, values in (("TransitionInterpolation", ("Forms", "Rotations")),
                     ("FrameSolver", ("Direct", "Conjugate Gradients", "Rotation Averaging"))):
    for value in values:
        setattr(morph, name, value)
        check_close(length(output(morph)), (straight + curved) / 2, value, 0.02)
refresh(morph)
check(morph.NumberOfKeyFrames == 2 and morph.NumberOfIterations > 0, "information")

# Time.
morph.StepsBetweenKeyFrames = 4
morph.UpdatePipelineInformation()
check_close(list(morph.TimestepValues), [0, .25, .5, .75, 1], "time steps")
half = points(output(morph)).copy()
morph.UpdatePipeline(0.5)
check_close(abs(points(simple.servermanager.Fetch(morph)) - half).max(), 0, "time .5", 1e-5)
morph.UpdatePipeline(1.0)
check((points(simple.servermanager.Fetch(morph)) == points(output(bent))).all(), "time 1")

# What happens to volume and lengths over time, as a table to plot.
change = simple.VolumeChange(Input=morph, Reference=bar)
table = simple.PlotDataOverTime(Input=simple.OutputPort(change, 1), FieldAssociation="Rows",
                                OnlyReportSelectionStatistics=0)
table.UpdatePipeline()
found = simple.servermanager.Fetch(table)
series = [found.GetBlock(i) for i in range(found.GetNumberOfBlocks())]
check(all(block.GetNumberOfRows() == 5 for block in series), "a row per time step")
# The rows of the table of changes: volume, area, edges (rms, maximum), shape distance.
edges = [series[2].GetColumnByName("Current").GetValue(step) for step in range(5)]
check(edges[0] == 0 and edges == sorted(edges) and edges[-1] > 0.01, "edges over time: %s" % edges)

curvature = simple.CurvatureError(Input=morph, Reference=bar)
curvature.UpdatePipeline(0.0)
curvature.UpdatePropertyInformation()
check(curvature.MeanCurvatureErrorRMS == 0.0, "no curvature error at first")
curvature.UpdatePipeline(1.0)
curvature.UpdatePropertyInformation()
check(curvature.MeanCurvatureErrorRMS > 0.0, "curvature error at last")
table = simple.PlotDataOverTime(Input=curvature, FieldAssociation="Points",
                                OnlyReportSelectionStatistics=1)
table.UpdatePipeline()
found = simple.servermanager.Fetch(table).GetBlock(0)
largest = [found.GetColumnByName("max(MeanCurvatureError)").GetValue(step) for step in range(5)]
check(largest[0] == 0.0 and largest[-1] > 0.0, "curvature over time: %s" % largest)

# Play, and save as pictures.
view = simple.CreateRenderView(ViewSize=[200, 150])
simple.Show(morph, view)
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
check_close(list(scene.TimeKeeper.TimestepValues), [0, .25, .5, .75, 1], "the scene's time steps")
scene.PlayMode = "Snap To TimeSteps"
scene.GoToFirst()
scene.Play()
check(scene.TimeKeeper.Time == 1.0, "played to the end")
for old in glob.glob(cartan_testing.output_path("TestMorph.*.png")):
    os.remove(old)
simple.SaveAnimation(cartan_testing.output_path("TestMorph.png"), view)
frames = sorted(glob.glob(cartan_testing.output_path("TestMorph.*.png")))
check(len(frames) == 5, "pictures: %s" % frames)
check(len({open(frame, "rb").read() for frame in frames}) == 5, "all pictures differ")

# The time steps of one input: files of a series.
files = []
for number, time in enumerate((0, 0.5, 1)):
    morph.UpdatePipeline(time)
    files.append(write(simple.servermanager.Fetch(morph), "TestMorphSeries%d.vtp" % number))
series = simple.XMLPolyDataReader(FileName=files)
between = simple.SurfaceMorph(Input=series, StepsBetweenKeyFrames=2)
between.UpdatePipelineInformation()
check_close(list(between.TimestepValues), [0, .25, .5, .75, 1], "time steps of a series")
between.UpdatePipeline(0.25)
check_close(length(simple.servermanager.Fetch(between)), .75 * straight + .25 * curved,
            "between files", 0.03)

# Wrong input.
other = simple.Sphere()
wrong = simple.SurfaceMorph(Input=[bar, other])
errors = Messages(wrong)
wrong.UpdatePipeline()
check(len(errors.texts) == 1 and "key frame 1" in errors.texts[0]
      and "same points and cells" in errors.texts[0], "errors: %s" % errors.texts)
alone = simple.SurfaceMorph(Input=bar)
errors = Messages(alone)
alone.UpdatePipeline()
check(len(errors.texts) == 1 and "one key frame" in errors.texts[0], "errors: %s" % errors.texts)
