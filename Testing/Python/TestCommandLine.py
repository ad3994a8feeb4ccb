# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m vtkcartan on files: the same as the filters, and errors with exit code 1."""
import contextlib
import io
import os
import unittest

import numpy
from vtkcartan import Deformer, vtkHandleMotion
from vtkcartan.__main__ import main, read, write
from vtkmodules.util.numpy_support import vtk_to_numpy

import cartan_testing


def path(name):
    return cartan_testing.output_path("TestCommandLine-" + name)


def points(name):
    return vtk_to_numpy(read(path(name)).GetPoints().GetData())


class CommandLine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bar = cartan_testing.bar(20, 4, 4, 5.0, 1.0, 1.0)
        cls.points = vtk_to_numpy(cls.bar.GetPoints().GetData())
        write(cls.bar, path("bar.vtp"))

    def run_it(self, *words, code=0):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            returned = main([str(word) for word in words])
        self.assertEqual(returned, code, err.getvalue())
        return out.getvalue() + err.getvalue()

    def test_deform_is_what_the_filter_does(self):
        self.run_it("deform", path("bar.vtp"), path("bent.vtp"),
                    "--handle", "1=box:4.4,-1,-1,6,2,2", "--handle", "2=plane:0.6,0,0,1,0,0",
                    "--turn", "1=90,0,1,0,4.5,0.5,0.5", "--shift", "1=0,0.25,0",
                    "--set", "VolumeCorrection=None")
        motion = vtkHandleMotion()
        motion.SetAngle(90)
        motion.SetAxis(0, 1, 0)
        motion.SetCenter(4.5, 0.5, 0.5)
        motion.SetTranslation(0, 0.25, 0)
        triangles = vtk_to_numpy(self.bar.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        expected = Deformer(self.points, triangles,
                            {1: self.points[:, 0] >= 4.4, 2: self.points[:, 0] <= 0.6},
                            VolumeCorrection="None")({1: motion})
        self.assertLess(abs(points("bent.vtp") - expected).max(), 1e-12)

    def test_a_turn_is_about_the_handles_middle(self):
        ids = ",".join(map(str, numpy.flatnonzero(self.points[:, 0] > 4.4)))
        end = self.points[:, 0] > 4.4
        expected = self.points[end] * [1, -1, -1] + [0, 1, 1]
        for method in ("RotationInvariant", "Pyramid"):
            self.run_it("deform", path("bar.vtp"), path("turned.vtp"), "--handle", "3=ids:" + ids,
                        "--handle", "2=sphere:0,0.5,0.5,0.9", "--turn", "3=180,1,0,0",
                        "--method", method)
            self.assertLess(abs(points("turned.vtp")[end] - expected).max(), 1e-9, method)

    def test_morph_measure_and_prepare(self):
        self.run_it("deform", path("bar.vtp"), path("moved.ply"), "--handle",
                    "1=box:-9,-9,-9,9,9,9", "--shift", "1=2,0,0")
        self.run_it("morph", path("bar.vtp"), path("moved.ply"), path("half.vtp"),
                    "--parameter", 0.5)
        self.assertLess(abs(points("half.vtp") - self.points - [1, 0, 0]).max(), 1e-6)
        text = self.run_it("measure", path("half.vtp"), path("bar.vtp"),
                           "--output", path("measured.vtp"))
        self.assertIn("RelativeVolumeChange", text)
        self.assertLess(abs(float(text.split()[1])), 1e-6)
        self.assertTrue(read(path("measured.vtp")).GetPointData().HasArray("AreaRatio"))
        write(self.bar, path("soup.stl"))
        self.assertIn("repair", self.run_it("prepare", path("soup.stl"), path("prepared.vtp")))
        self.assertEqual(len(points("prepared.vtp")), len(self.points))

    def test_errors_say_what_to_do(self):
        bar = path("bar.vtp")
        for words, expected in (
                (("deform", "no.vtp", "out.vtp"), "no such file"),
                (("deform", bar, path("out.txt"), "--handle", "1=sphere:0,0,0,9"), "must end in"),
                (("deform", bar, path("out.vtp")), "Mark Handle"),
                (("deform", bar, path("out.vtp"), "--handle", "x=ids:1"), "id of a handle"),
                (("deform", bar, path("out.vtp"), "--handle", "1=ids:1,b"), "not the id"),
                (("deform", bar, path("out.vtp"), "--handle", "1=cone:1"), "regions are"),
                (("deform", bar, path("out.vtp"), "--handle", "1=box:1,2"), "6 numbers"),
                (("deform", bar, path("out.vtp"), "--handle", "1=ids:1", "--turn", "2=5,0,0,1"),
                 "no points"),
                (("deform", bar, path("out.vtp"), "--method", "Magic"), "ShapePreserving"),
                (("morph", bar, path("out.vtp")), "key frame"),
                (("measure", bar, path("prepared-not.vtp")), "no such file")):
            text = self.run_it(*words, code=1)
            self.assertTrue(text.startswith("error: "), text)
            self.assertIn(expected, text)
        self.assertFalse(os.path.exists(path("out.vtp")))


if __name__ == "__main__":
    unittest.main()
