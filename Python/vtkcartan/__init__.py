# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces described, edited and measured by differential quantities.

The classes are VTK filters: vtkMarkHandle, vtkShapePreservingDeformation, ... The functions
deform(), morph() and measure() do the same with arrays of numpy, for scripts without a
pipeline; Deformer is deform() for many motions of one surface.

If PyVista is installed (0.48 or later), its surfaces have the accessor `cartan` as soon as
vtkcartan.accessor is imported. `python3 -m vtkcartan` works on files.
"""
from .vtkCartan import *
from .arrays import Deformer, Measures, deform, measure, morph
from .landmarks import read_landmarks
