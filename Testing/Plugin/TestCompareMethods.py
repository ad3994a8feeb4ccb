"""The macro that puts methods side by side gives each the motions of one."""
from paraview import simple
from vtkcartan.compare import METHODS, compare_methods

from plugin_testing import check, check_close, load_plugin, mark_ends, open_bar, output

load_plugin()
marked = mark_ends(open_bar("TestCompareMethods"))
bent = simple.ShapePreservingDeformation(Input=marked)
bent.ActiveHandle = 2
bent.Motion = "Matrix"
bent.Motion.Matrix = [0, 0, 1, 2, 0, 1, 0, 0, -1, 0, 0, 3, 0, 0, 0, 1]
bent.MotionRows = [1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0.25, 0]

shown = simple.CreateRenderView()
shown.CameraPosition, shown.CameraFocalPoint, shown.CameraViewUp = [2, 9, 1], [2, 0, 1], [1, 0, 0]
results = compare_methods(bent)
check([result.GetXMLName() for result in results]
      == [method + "Deformation" for method in METHODS], "one filter per method")
for result in results:
    check(list(result.MotionRows) == list(bent.MotionRows), "the rows")
    check(list(result.Motion.Matrix) == list(bent.Motion.Matrix), "the matrix")
same = results[METHODS.index("ShapePreserving")]
same.VolumeCorrection = bent.VolumeCorrection
check_close(output(same).GetBounds(), output(bent).GetBounds(), "the same surface", 1e-12)
check(simple.GetActiveSource() is bent or simple.GetActiveSource() == bent,
      "the deformation stays active")

layouts = [layout for (name, _), layout in simple.GetLayouts().items()
           if name.startswith("Compare Methods")]
check(len(layouts) == 1, "a layout")
views = simple.GetViewsInLayout(layouts[0])
check(len(views) == 4, "four views")
for view in views:
    check_close(view.CameraViewUp, [1, 0, 0], "seen as in the view before")
    sight = [a - b for a, b in zip(view.CameraPosition, view.CameraFocalPoint)]
    check_close([sight[0], sight[2]], [0, 0], "from the same side")
    check(sight[1] > 0, "from the same side")
views[0].CameraPosition = [9, 8, 7]
views[0].SMProxy.UpdateVTKObjects()
simple.Render(views[0])
for view in views:
    check_close(view.CameraPosition, [9, 8, 7], "cameras are linked")

labels = [source.Text for (name, _), source in simple.GetSources().items()
          if name.endswith(" label")]
check(len(labels) == 4, "four labels")
for text in labels:
    check("edges" in text and "edges 0 %" not in text and "volume" in text, text)

try:
    compare_methods(marked)
except ValueError as error:
    check("deformation" in str(error), str(error))
else:
    check(False, "a source that is no deformation is refused")
