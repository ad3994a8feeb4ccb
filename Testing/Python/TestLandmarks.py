# SPDX-License-Identifier: BSD-3-Clause
"""read_landmarks() for the files of 3D Slicer, and what vtkLandmarkHandles makes of them."""
import json
import pathlib
import tempfile
import unittest

import vtkcartan
from vtkcartan import read_landmarks, vtkLandmarkHandles

import cartan_testing

FCSV = """# Markups fiducial file version = 4.11
# CoordinateSystem = {}
# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID
1,0.5,0.25,-1,0,0,0,1,1,1,0,"tip, left",,
2,2.5,0,3,0,0,0,1,1,1,0,tail,,
"""


def rows(table):
    return [(table.GetValueByName(k, "label").ToString(),
             *(table.GetValueByName(k, axis).ToDouble() for axis in "xyz"))
            for k in range(table.GetNumberOfRows())]


class Landmarks(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)

    def write(self, name, text):
        path = pathlib.Path(self._folder.name, name)
        path.write_text(text, encoding="utf-8")
        return path

    def test_fcsv(self):
        expected = [("tip, left", 0.5, 0.25, -1.0), ("tail", 2.5, 0.0, 3.0)]
        turned = [("tip, left", -0.5, -0.25, -1.0), ("tail", -2.5, 0.0, 3.0)]
        for stated, name in (("LPS", "LPS"), ("0", "RAS"), ("1", "LPS"), ("RAS", "RAS")):
            path = self.write("marks.fcsv", FCSV.format(stated))
            self.assertEqual(rows(read_landmarks(path, name)), expected)
            other = "RAS" if name == "LPS" else "LPS"
            self.assertEqual(rows(read_landmarks(path, other)), turned)

    def test_json(self):
        points = [{"label": "a", "position": [1, 2, 3]},
                  {"label": "b", "position": [0, 0, 0], "positionStatus": "undefined"}]
        path = self.write("marks.mrk.json", json.dumps(
            {"markups": [{"coordinateSystem": "LPS", "controlPoints": points}]}))
        self.assertEqual(rows(read_landmarks(path)), [("a", 1.0, 2.0, 3.0)])
        self.assertEqual(rows(read_landmarks(path, "RAS")), [("a", -1.0, -2.0, 3.0)])

    def test_refuses(self):
        for name, text in (("marks.csv", "1,2"), ("marks.fcsv", "1,a,b,c"), ("m.json", "{}")):
            with self.assertRaisesRegex(ValueError, name):
                read_landmarks(self.write(name, text))
        with self.assertRaisesRegex(ValueError, "LPS or RAS"):
            read_landmarks(self.write("marks.fcsv", FCSV.format("LPS")), "LAS")

    def test_handles(self):
        surface = cartan_testing.bar(20, 4, 4, 5.0, 1.0, 1.0)
        table = read_landmarks(self.write("marks.fcsv", FCSV.format("LPS")))
        landmarks = vtkLandmarkHandles()
        landmarks.SetInputData(surface)
        landmarks.SetFromData(table)
        landmarks.SetToData(table)
        landmarks.SetTolerance(10.0)
        landmarks.Update()
        self.assertEqual(landmarks.GetNumberOfLandmarks(), 2)
        names = landmarks.GetLandmarkTable().GetColumnByName("Landmark")
        self.assertEqual([names.GetValue(k) for k in range(2)], ["tip, left", "tail"])
        self.assertTrue(hasattr(vtkcartan, "read_landmarks"))


if __name__ == "__main__":
    unittest.main()
