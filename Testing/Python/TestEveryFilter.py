# SPDX-License-Identifier: BSD-3-Clause
"""What holds for each property of every filter: a value that is no number changes nothing and
is an error; the largest and smallest values give a finite result or one error."""
import math
import unittest

import numpy
import vtkcartan
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm
from vtkmodules.vtkFiltersSources import vtkSphereSource

import every_filter

# One morph stands for all: their properties are the same.
TASKS = [task for task in every_filter.TASKS
         if not task.startswith("SurfaceMorph") or task.endswith("DiscreteForms")]

FAR = {float: (math.inf, -math.inf, 1e308, -1e308, 1e-308, 1e30, -1.0, 0.0),
       int: (2**31 - 1, -2**31, 10**9, -1, 0)}


def properties(filter, kind):
    """Names and values of the properties that are a number of this type, or several."""
    for name in sorted(set(dir(filter)) - set(dir(vtkPolyDataAlgorithm))):
        if not name.startswith("Set") or not hasattr(filter, "Get" + name[3:]):
            continue
        getter = getattr(filter, "Get" + name[3:])
        try:
            value = getter()
        except TypeError:  # one with an index
            continue
        first = value[0] if isinstance(value, tuple) and value else value
        if type(first) is kind:
            yield name, getter, value


def replaced(value, first):
    return (first,) + value[1:] if isinstance(value, tuple) else (first,)


class Observed:
    """The filter of a task, and how many errors it has reported."""

    sphere = vtkSphereSource()
    sphere.SetThetaResolution(14)
    sphere.SetPhiResolution(12)
    sphere.Update()
    surface = sphere.GetOutput()

    def __init__(self, task):
        self.errors = 0
        self.filter = every_filter.make(task, self.surface)
        self.filter.AddObserver("ErrorEvent", self.count)
        self.filter.AddObserver("WarningEvent", lambda *_: None)

    def count(self, *_):
        self.errors += 1


def not_finite(filter):
    """Names of what is not finite in the output, "Points" for those."""
    output = filter.GetOutput()
    arrays = [output.GetPointData().GetArray(i)
              for i in range(output.GetPointData().GetNumberOfArrays())]
    names = {array.GetName() for array in arrays
             if array and not numpy.isfinite(vtk_to_numpy(array)).all()}
    names -= {"ConstraintWeight"}  # infinite where a target is exact
    if output.GetNumberOfPoints() > 0 and not numpy.isfinite(
            vtk_to_numpy(output.GetPoints().GetData())).all():
        names.add("Points")
    return names


class EveryProperty(unittest.TestCase):

    def test_no_filter_is_left_out(self):
        there = {"vtk" + task.split()[0] for task in every_filter.TASKS}
        self.assertEqual(set(every_filter.FILTERS) - there, {"vtkCompressedSurfaceWriter"})

    def test_not_a_number_is_an_error(self):
        checked = 0
        for task in TASKS:
            for name, getter, before in properties(Observed(task).filter, float):
                if name == "SetViewDirection":  # only silhouettes ask for it
                    continue
                with self.subTest(task=task, property=name):
                    observed = Observed(task)
                    getattr(observed.filter, name)(*replaced(before, math.nan))
                    observed.filter.Update()
                    self.assertEqual(observed.errors, 1)
                    value = getattr(observed.filter, getter.__name__)()
                    is_kept = value == before
                    self.assertTrue(is_kept or observed.filter.GetOutput().GetNumberOfPoints() == 0)
                    checked += 1
        self.assertGreater(checked, 40)

    def test_far_values_are_no_trap(self):
        checked = 0
        for kind, values in FAR.items():
            for task in TASKS:
                plain = Observed(task)
                plain.filter.Update()
                allowed = not_finite(plain.filter)
                for name, _, before in properties(plain.filter, kind):
                    for value in values:
                        with self.subTest(task=task, property=name, value=value):
                            observed = Observed(task)
                            getattr(observed.filter, name)(*replaced(before, value))
                            observed.filter.Update()
                            self.assertLessEqual(observed.errors, 1)
                            self.assertLessEqual(not_finite(observed.filter), allowed)
                            checked += 1
        self.assertGreater(checked, 400)

    def test_lists_do_not_take_all_memory(self):
        for kind, setter, most in (
                ("RotationInvariantDeformation", "SetNumberOfMotionRows", 10**5),
                ("MeshMerge", "SetNumberOfMotionRows", 10**5),
                ("MarkHandle", "SetNumberOfPointIds", 10**8),
                ("CurveDeformation", "SetNumberOfPointIds", 10**6),
                ("SurfaceMorph", "SetNumberOfWeights", 10**6)):
            filter = getattr(vtkcartan, "vtk" + kind)()
            errors = []
            filter.AddObserver("ErrorEvent", lambda *_, errors=errors: errors.append(1))
            for count in (most + 1, 2**31 - 1, -1):
                getattr(filter, setter)(count)
            self.assertEqual(len(errors), 3, kind)
            self.assertEqual(getattr(filter, setter.replace("Set", "Get"))(), 0, kind)


if __name__ == "__main__":
    unittest.main()
