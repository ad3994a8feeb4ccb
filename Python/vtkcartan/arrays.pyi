from typing import Any, Mapping, NamedTuple, Sequence, Union

from numpy import float32, float64
from numpy.typing import ArrayLike, NDArray

from .vtkCartan import vtkHandleMotion, vtkSurfaceDeformation

Points = Union[NDArray[float32], NDArray[float64]]
Handles = Union[Mapping[int, ArrayLike], ArrayLike]
Motion = Union[vtkHandleMotion, ArrayLike]

class Deformer:
    filter: vtkSurfaceDeformation
    def __init__(self, points: ArrayLike, triangles: ArrayLike, handles: Handles,
                 method: str = "ShapePreserving", **properties: Any) -> None: ...
    def __call__(self, motions: Mapping[int, Motion] | None = None,
                 targets: Mapping[int, ArrayLike] | None = None) -> Points: ...

def deform(points: ArrayLike, triangles: ArrayLike, handles: Handles,
           motions: Mapping[int, Motion] | None = None,
           targets: Mapping[int, ArrayLike] | None = None,
           method: str = "ShapePreserving", **properties: Any) -> Points: ...
def morph(key_frames: Sequence[ArrayLike], triangles: ArrayLike, parameter: ArrayLike,
          method: str = "DiscreteForms", **properties: Any) -> Points: ...

class Measures(NamedTuple):
    totals: dict[str, float]
    point_data: dict[str, NDArray[Any]]

def measure(points: ArrayLike, triangles: ArrayLike, reference: ArrayLike) -> Measures: ...
