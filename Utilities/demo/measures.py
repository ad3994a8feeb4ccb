# SPDX-License-Identifier: BSD-3-Clause
"""What a deformation did to a surface, in a few numbers."""
from dataclasses import dataclass

from cartan import vtkCurvatureError, vtkVolumeChange


@dataclass
class Measures:
    """Relative changes of volume (NaN if open) and area, of edge lengths as root
    mean square and largest; root mean square of the change of mean curvature, in
    1 / length; the surface with the point array MeanCurvatureError."""
    volume: float
    area: float
    edges: float
    longest: float
    curvature: float
    surface: object


def measure(rest, deformed):
    curvature = vtkCurvatureError()
    curvature.SetInputData(0, deformed)
    curvature.SetInputData(1, rest)
    curvature.Update()
    change = vtkVolumeChange()
    change.SetInputData(0, deformed)
    change.SetInputData(1, rest)
    change.ComputeLocalVolumeOff()
    change.Update()
    return Measures(change.GetRelativeVolumeChange(), change.GetRelativeAreaChange(),
                    change.GetEdgeLengthRMS(), change.GetEdgeLengthMax(),
                    curvature.GetMeanCurvatureErrorRMS(), curvature.GetOutput())
