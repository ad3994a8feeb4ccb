"""The package vtkcartan comes from the prefix that is given, and works."""
import pathlib
import sys

import vtkcartan
from vtkmodules.vtkFiltersSources import vtkSphereSource

prefix = pathlib.Path(sys.argv[1]).resolve()
assert prefix in pathlib.Path(vtkcartan.__file__).resolve().parents, vtkcartan.__file__
sphere = vtkSphereSource()
forms = vtkcartan.vtkDiscreteForms()
forms.SetInputConnection(sphere.GetOutputPort())
forms.Update()
# 50 points and 96 triangles make 144 edges, each seen from both ends.
assert forms.GetFormsTable().GetNumberOfRows() == 288
