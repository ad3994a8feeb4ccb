# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of PyVista with an accessor: mesh.cartan.deform(...), measure(...), morph(...).

Importing this module registers the accessor, if PyVista 0.48 or later is installed. Its VTK
must be the one that vtkcartan was built for.
"""
import numpy

from . import arrays


def _triangles(mesh):
    """The triangles of a surface of PyVista, m x 3."""
    if not mesh.is_all_triangles:
        raise ValueError("The surface has cells that are not triangles: use mesh.triangulate().")
    return numpy.asarray(mesh.faces).reshape(-1, 4)[:, 1:]


class CartanAccessor:
    """The functions of vtkcartan for a surface of PyVista.

    The filter of the last deformation is kept, with what it has prepared, as long as the
    surface's points, its triangles, the handles, the method and the properties stay the same.
    """

    def __init__(self, mesh):
        self._mesh = mesh
        self._deformer = None
        self._made_from = None

    def deform(self, handles, motions=None, targets=None, method="ShapePreserving", **properties):
        """A copy of the surface after its handles have moved: see vtkcartan.deform()."""
        deformer = self._deformer_for(handles, method, properties)
        result = self._mesh.copy()
        result.points = deformer(motions, targets)
        return result

    def _deformer_for(self, handles, method, properties):
        points = numpy.asarray(self._mesh.points)
        triangles = _triangles(self._mesh)
        items = handles.items() if hasattr(handles, "items") else [(0, handles)]
        made_from = [points.copy(), triangles.copy(), method, dict(properties),
                     [(key, numpy.array(ids)) for key, ids in items]]
        if self._made_from is None or not _equal(made_from, self._made_from):
            self._deformer = arrays.Deformer(points, triangles, handles, method, **properties)
            self._made_from = made_from
        return self._deformer

    def morph(self, others, parameter, method="DiscreteForms", **properties):
        """A copy of the surface between it (0) and the last of `others` (1)."""
        others = others if isinstance(others, (list, tuple)) else [others]
        result = self._mesh.copy()
        result.points = arrays.morph([self._mesh.points] + [other.points for other in others],
                                     _triangles(self._mesh), parameter, method, **properties)
        return result

    def measure(self, reference):
        """What has changed from a surface with the same triangles: see vtkcartan.measure()."""
        return arrays.measure(self._mesh.points, _triangles(self._mesh), reference.points)


def _equal(first, second):
    if isinstance(first, numpy.ndarray):
        return numpy.array_equal(first, second)
    if isinstance(first, (list, tuple)):
        return len(first) == len(second) and all(map(_equal, first, second))
    return first == second


def register():
    """Registers the accessor with PyVista; returns whether that was possible."""
    try:
        import pyvista
    except ImportError:
        return False
    if not hasattr(pyvista, "register_dataset_accessor"):
        return False
    pyvista.register_dataset_accessor("cartan", pyvista.PolyData)(CartanAccessor)
    return True


register()
