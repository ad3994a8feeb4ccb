"""Marks handles by regions, by selections, by queries, in composite data."""
from paraview import simple
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

# A selection of points by their ids.
ids = simple.IDSelectionSource(FieldType="POINT", IDs=[0, 3, 0, 7, 0, 11])
mark = simple.MarkHandle(Input=bar, Selection=ids)
check(list(handles(mark).nonzero()[0]) == [3, 7, 11], "ids")

# Find Data: a query for points, and one for cells; the active selection is
# copied when the filter is made.
simple.Show(bar, simple.CreateRenderView())
simple.QuerySelect("pointIsNear([(5, 0.5, 0.5),], 0.51, inputs)", FieldType="POINT", Source=bar)
mark = simple.MarkHandle(Input=bar)
check(marked_x(mark) == (5.0, 5.0), "query for points: %s" % (marked_x(mark),))
simple.QuerySelect("(id >= 0) & (id < 4)", FieldType="CELL", Source=bar)
mark = simple.MarkHandle(Input=bar, RegionSource="Selection")
check(0 < (handles(mark) == 1).sum() <= 12, "query for cells")
simple.ClearSelection(bar)

# Blocks of a composite data set are marked at once.
group = simple.GroupDatasets(Input=[bar, simple.Transform(Input=bar)])
mark = simple.MarkHandle(Input=group, Region="Plane")
mark.Region.Origin = [1.1, 0, 0]
mark.Region.Normal = [1, 0, 0]
blocks = output(mark)
for i in range(2):
    array = vtk_to_numpy(blocks.GetBlock(i).GetPointData().GetArray("Handle"))
    check(array.sum() == (array == 1).sum() > 0, "block %d" % i)
