"""The filters run in a pvserver that a client is connected to: the same numbers and picture."""
import os
import shutil
import sys

import cartan_testing
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from plugin_testing import check, check_close, mark_ends, open_bar, output, pixels, refresh
from serve import Server


def find_pvserver():
    """The one beside this program, or the one in the path."""
    beside = os.path.join(os.path.dirname(sys.executable or ""), "pvserver")
    return beside if os.path.exists(beside) else shutil.which("pvserver")


def use_filters():
    bar = open_bar("TestServer")
    bent = simple.RotationInvariantDeformation(Input=mark_ends(bar), Motion="Box")
    bent.Motion.Rotation = [0, 90, 0]
    bent.Motion.Position = [2, 0, 3]
    refresh(bent)
    check(bent.NumberOfFreePoints > 100, "free points")
    check_close(bent.GetDataInformation().GetBounds()[4], -2.0, "the lowest point", 1e-4)
    check_close(bent.Motion.ReferenceBounds, bent.ActiveHandleBounds, "the box is the handle's")

    query = simple.SelectionQuerySource(ElementType="Point Data", QueryString="(id < 10)")
    marked = simple.MarkHandle(Input=bent, HandleArrayName="Other", Selection=query)
    refresh(marked)
    check(marked.NumberOfMarkedPoints == 10, "a query: %d" % marked.NumberOfMarkedPoints)
    check(list(marked.GetProperty("MarkedPointIds")) == list(range(10)), "the marked points")

    change = simple.VolumeChange(Input=bent, Reference=bar)
    refresh(change)
    check(change.RelativeVolumeChange < -1e-3, "volume")
    return vtk_to_numpy(output(bent).GetPoints().GetData()), change.RelativeVolumeChange, draw(change)


def draw(surface):
    """The pixels of a picture of a surface, colored by what has changed."""
    view = simple.CreateRenderView(ViewSize=[300, 200])
    simple.ColorBy(simple.Show(surface, view), ("POINTS", "AreaRatio"))
    simple.ResetCamera(view)
    path = cartan_testing.output_path("TestServer.png")
    simple.SaveScreenshot(path, view)
    return pixels(path)


simple.LoadPlugin(cartan_testing.plugin_path(), remote=False)
here = use_filters()
server = Server(find_pvserver())
try:
    simple.Connect("localhost", server.port)
    for remote in (True, False):
        simple.LoadPlugin(cartan_testing.plugin_path(), remote=remote)
    there = use_filters()
    check((here[0] == there[0]).all(), "the same points")
    check(here[1] == there[1], "the same number")
    check(here[2].shape == there[2].shape and here[2].std() > 10, "a picture")
    check(abs(here[2].astype(int) - there[2]).max() <= 2, "the same picture")
except BaseException:
    server.kill()
    raise
# The server leaves with its client, which still has to tell it so.
