"""Wrong input gives one error that says what to do, an empty output, and no crash."""
import cartan_testing
from paraview import simple

from plugin_testing import (
    Messages, check, load_plugin, mark_ends, open_bar, output, write)


def check_refused(proxy, *words):
    errors = Messages(proxy)
    surface = output(proxy)
    check(len(errors.texts) == 1, "errors: %s" % errors.texts)
    for word in words:
        check(word in errors.texts[0], "'%s' is missing in: %s" % (word, errors.texts[0]))
    check(surface is None or surface.GetNumberOfPoints() == 0, "the output is not empty")


load_plugin()
bar = open_bar("TestErrors")
marked = mark_ends(bar)
points = output(bar).GetNumberOfPoints()

check_refused(simple.RotationInvariantDeformation(Input=bar), "Handle", "Mark Handle")
check_refused(simple.RotationInvariantDeformation(Input=marked, ActiveHandle=7), "Handle 7", "1, 2")
deformation = simple.RotationInvariantDeformation(Input=marked)
deformation.MotionRows = [1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
check_refused(deformation, "two motions")
deformation = simple.RotationInvariantDeformation(Input=marked, Motion="Matrix")
deformation.Motion.Matrix = [1.0] * 16
check_refused(deformation, "0 0 0 1")
deformation = simple.RotationInvariantDeformation(Input=marked, TransformArrayName="nothing")
check_refused(deformation, "nothing")

other = simple.Sphere()
check_refused(simple.VolumeChange(Input=bar, Reference=other), "points")
check_refused(simple.VolumeChange(Input=bar), "no reference")
check_refused(simple.CurvatureError(Input=bar, Reference=other), "points")
forms = simple.DiscreteForms(Input=other)
check_refused(simple.FrameReconstruction(Input=bar, Forms=simple.OutputPort(forms, 1)), "")
lines = simple.Line()
check_refused(simple.DiscreteForms(Input=lines), "triangle")

# Three triangles at one edge.
fin = cartan_testing.surface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]],
                             [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
fin = simple.XMLPolyDataReader(FileName=[write(fin, "TestErrorsFin.vtp")])
check_refused(simple.DiscreteForms(Input=fin), "edge")

# A mistake can be mended.
deformation = simple.RotationInvariantDeformation(Input=marked, ActiveHandle=7)
check_refused(deformation, "Handle 7")
deformation.ActiveHandle = 1
check(output(deformation).GetNumberOfPoints() == points, "mended")
check(output(bar).GetNumberOfPoints() == points, "the input is unharmed")
