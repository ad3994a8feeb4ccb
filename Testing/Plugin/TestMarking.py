"""Marks handles by regions, by selections, by queries, in composite data."""
import runpy

import cartan_testing
from paraview import simple, smstate
from paraview.vtk.util.numpy_support import vtk_to_numpy

from plugin_testing import Messages, check, load_plugin, open_bar, output, refresh


def handles(proxy):
    return vtk_to_numpy(output(proxy).GetPointData().GetArray("Handle"))


def marked_x(proxy):
    """The range of x of the points of handle 1."""
    surface = output(proxy)
    x = vtk_to_numpy(surface.GetPoints().GetData())[handles(proxy) == 1, 0]
    return (x.min(), x.max()) if len(x) else None


load_plugin()
bar = open_bar("TestMarking")

# Regions. The grid has points at every 0.25 along x.
mark = simple.MarkHandle(Input=bar)
mark.Region = "Box"
mark.Region.Position = [3.9, -1, -1]
mark.Region.Length = [2, 3, 3]
check(marked_x(mark) == (4.0, 5.0), "box: %s" % (marked_x(mark),))
mark.InsideOut = 1
check(marked_x(mark) == (0.0, 3.75), "inside out")
mark.InsideOut = 0
mark.Region = "Plane"
mark.Region.Origin = [0.6, 0, 0]
mark.Region.Normal = [1, 0, 0]
check(marked_x(mark) == (0.0, 0.5), "plane")
mark.GrowRings = 2
check(marked_x(mark) == (0.0, 1.0), "rings")
mark.GrowRings = 0
mark.GrowDistance = 0.8
check(marked_x(mark) == (0.0, 1.25), "distance")
mark.GrowDistance = 0
mark.Region = "Sphere"
mark.Region.Center = [5, 0.5, 0.5]
mark.Region.Radius = 0.76
check(marked_x(mark) == (4.5, 5.0), "sphere: %s" % (marked_x(mark),))
mark.Region = "Cylinder"
mark.Region.Center = [2.5, 0.5, 0.5]
mark.Region.Axis = [0, 1, 0]
mark.Region.Radius = 0.6
check(marked_x(mark) == (2.0, 3.0), "cylinder: %s" % (marked_x(mark),))
refresh(mark)
check(mark.NumberOfMarkedPoints == (handles(mark) == 1).sum() > 0, "number of marked points")

# The whole surface, and nothing.
mark.RegionSource = "All Points"
check((handles(mark) == 1).all(), "all points")
mark.RegionSource = "Function or Selection"
mark.Region = "None"
warnings = Messages(mark, "WarningEvent")
check((handles(mark) == 0).all(), "no region")
check("neither a region function nor a selection" in warnings.texts[0], warnings.texts)

# Points by their ids, and by a selection of ids.
mark = simple.MarkHandle(Input=bar, PointIds=[11, 3, 7])
check(list(handles(mark).nonzero()[0]) == [3, 7, 11], "point ids")
refresh(mark)
check(list(mark.GetProperty("MarkedPointIds")) == [3, 7, 11], "the marked points")
ids = simple.IDSelectionSource(FieldType="POINT", IDs=[0, 3, 0, 7, 0, 11])
mark = simple.MarkHandle(Input=bar, Selection=ids, registrationName="ByIds")
check(list(handles(mark).nonzero()[0]) == [3, 7, 11], "ids")
errors = Messages(mark)
mark.PointIds = [12345]
mark.UpdatePipeline()
check(len(errors.texts) == 1 and "12345" in errors.texts[0], "an id of no point")
mark.PointIds = []

# Queries of Find Data: for points, and for cells.
near = simple.SelectionQuerySource(
    ElementType="Point Data", QueryString="pointIsNear([(5, 0.5, 0.5),], 0.51, inputs)")
mark = simple.MarkHandle(Input=bar, Selection=near, registrationName="ByQuery")
check(marked_x(mark) == (5.0, 5.0), "query for points: %s" % (marked_x(mark),))
cells = simple.SelectionQuerySource(ElementType="Cell Data", QueryString="(id >= 0) & (id < 4)")
mark = simple.MarkHandle(Input=bar, Selection=cells, RegionSource="Selection")
check(0 < (handles(mark) == 1).sum() <= 12, "query for cells")

# States hold all of them.
expected = {name: list(handles(simple.FindSource(name))) for name in ("ByIds", "ByQuery")}
state = cartan_testing.output_path("TestMarkingState.py")
with open(state, "w", encoding="utf-8") as file:
    file.write(smstate.get_state())
simple.ResetSession()
runpy.run_path(state)
for name, array in expected.items():
    check(list(handles(simple.FindSource(name))) == array, name + " in a state")
bar = simple.FindSource("Bar")

# Blocks of a composite data set are marked at once.
group = simple.GroupDatasets(Input=[bar, simple.Transform(Input=bar)])
mark = simple.MarkHandle(Input=group, Region="Plane")
mark.Region.Origin = [1.1, 0, 0]
mark.Region.Normal = [1, 0, 0]
blocks = output(mark)
for i in range(2):
    array = vtk_to_numpy(blocks.GetBlock(i).GetPointData().GetArray("Handle"))
    check(array.sum() == (array == 1).sum() > 0, "block %d" % i)
