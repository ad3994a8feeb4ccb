# SPDX-License-Identifier: BSD-3-Clause
"""Several deformation methods with the motions of one, side by side in ParaView: a macro.

In ParaView's window choose Macros > Import new macro... and this file, select a deformation
whose handles have moved, and press the new button. In a script with the plugin loaded:

    from vtkcartan.compare import compare_methods
    compare_methods(deformation)
"""
from paraview import servermanager, simple

METHODS = ("RotationInvariant", "ShapePreserving", "Similarity", "AsRigidAsPossible")

# What says which handles move where; all else is a method's own.
HANDLES = ("HandleArrayName", "ActiveHandle", "MotionRows", "ConstrainHandlePositions",
           "TargetPositionArrayName", "RotationVectorArrayName", "TransformArrayName",
           "ConstraintWeightArrayName", "ScaleConstraintWeights", "PrepareInput")


def is_deformation(proxy):
    return proxy is not None and proxy.GetProperty("MotionRows") is not None


def copy_motions(source, copy):
    """Gives the deformation `copy` the handles and motions of `source`."""
    for name in HANDLES:
        copy.GetProperty(name).SMProperty.Copy(source.GetProperty(name).SMProperty)
    kind = source.Motion
    if kind is None:
        copy.Motion = None
    else:
        copy.Motion = kind.GetXMLLabel()
        copy.Motion.SMProxy.Copy(kind.SMProxy)
        copy.Motion.SMProxy.UpdateVTKObjects()
    copy.SMProxy.UpdateVTKObjects()


def figures(deformed, reference):
    """The changes of edge lengths and of volume, as text."""
    change = simple.VolumeChange(Input=deformed, Reference=reference)
    table = servermanager.Fetch(change, idx=1)
    simple.Delete(change)
    rows = {table.GetValueByName(i, "Quantity").ToString():
            table.GetValueByName(i, "RelativeChange").ToDouble()
            for i in range(table.GetNumberOfRows())}
    text = "edges %.3g %%" % (100 * rows["EdgeLengthRMS"])
    if rows["Volume"] == rows["Volume"]:  # NaN where none is enclosed
        text += ", volume %+.3g %%" % (100 * rows["Volume"])
    return text


def divide(layout, cell, count, vertically=True):
    """Splits a cell of the layout into so many, in rows and columns; returns their numbers."""
    if count == 1:
        return [cell]
    split = layout.SplitVertical if vertically else layout.SplitHorizontal
    first = split(cell, 0.5)
    half = (count + 1) // 2
    return (divide(layout, first, half, not vertically)
            + divide(layout, first + 1, count - half, not vertically))


def look_as(before, view):
    """Looks at what `view` shows from the direction of the render view `before`, if it is one."""
    if before is not None and before.GetProperty("CameraViewUp"):
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (
            list(before.CameraPosition), list(before.CameraFocalPoint), list(before.CameraViewUp))
    else:
        view.CameraPosition, view.CameraFocalPoint = [0.6, -1, 0.5], [0, 0, 0]
        view.CameraViewUp = [0, 0, 1]
    simple.ResetCamera(view)


def compare_methods(source=None, methods=METHODS):
    """Deforms the input of `source`, a deformation (default: the active source), by each of
    `methods` with its motions, in linked views of a new layout, with the changes of edge
    lengths (root mean square) and of the volume. Returns the new filters."""
    source = source or simple.GetActiveSource()
    if not is_deformation(source):
        raise ValueError("Select a deformation of Cartan whose handles have moved, then compare.")
    before = simple.GetActiveView()
    layout = simple.CreateLayout("Compare Methods")
    views = [simple.CreateRenderView(detachedFromLayout=True) for _ in methods]
    places = divide(layout, 0, len(views))
    results = []
    for place, view, method in zip(places, views, methods):
        simple.AssignViewToLayout(view=view, layout=layout, hint=place)
        result = getattr(simple, method + "Deformation")(
            Input=source.Input, registrationName=method)
        copy_motions(source, result)
        simple.Show(result, view)
        label = simple.Text(registrationName=method + " label",
                            Text=result.GetXMLLabel() + "\n" + figures(result, source.Input))
        simple.Show(label, view).FontSize = 12
        results.append(result)
    for view in views[1:]:
        simple.AddCameraLink(views[0], view, "Compare Methods %d" % views.index(view))
    look_as(before, views[0])
    simple.RenderAllViews()
    simple.SetActiveSource(source)
    return results


if __name__ == "__main__":
    compare_methods()
