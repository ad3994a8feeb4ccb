"""What the tests of the plugin share: a surface with two handles, and the errors of a filter."""
import os

from paraview import servermanager, simple
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_STRING
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

import cartan_testing


def load_plugin():
    """Loads the plugin; its filters are in paraview.simple then."""
    simple.LoadPlugin(cartan_testing.plugin_path(), remote=False)


def write(surface, name):
    """Writes a surface to a file that ParaView reads; returns its path."""
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(cartan_testing.output_path(name))
    # Appended data is more than some versions of expat let VTK read again.
    writer.SetDataModeToBinary()
    writer.SetInputData(surface)
    writer.Write()
    return writer.GetFileName()


def open_bar(name):
    """A bar from 0 to 5 along x with a cross section of 1 x 1, as a source."""
    path = write(cartan_testing.bar(20, 4, 4, 5.0, 1.0, 1.0), name + ".vtp")
    return simple.XMLPolyDataReader(FileName=[path], registrationName="Bar")


def mark_ends(surface):
    """Marks the bar's right end as handle 1 and its left end as handle 2."""
    right = simple.MarkHandle(Input=surface, Region="Box", registrationName="Right")
    right.Region.Position = [4.4, -1, -1]
    right.Region.Length = [1, 3, 3]
    left = simple.MarkHandle(Input=right, HandleId=2, Region="Plane", registrationName="Left")
    left.Region.Origin = [0.6, 0, 0]
    left.Region.Normal = [1, 0, 0]
    return left


def output(proxy, port=0):
    """The data of an output port, updated."""
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy, idx=port)


def refresh(proxy):
    """Updates the proxy and its information properties."""
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()


def pixels(path):
    """The colors of a picture, a row for each pixel."""
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())


class Messages:
    """Collects the errors or warnings of a filter, which are not printed then."""

    def __init__(self, proxy, event="ErrorEvent"):
        self.texts = []

        @calldata_type(VTK_STRING)
        def collect(_caller, _event, text):
            self.texts.append(text)

        algorithm = proxy.GetClientSideObject()
        algorithm.AddObserver(event, collect)

        # The executive reports on its own that the algorithm has failed.
        algorithm.GetExecutive().AddObserver(event, lambda *_: None)


def check(condition, what):
    """Fails the test with a sentence unless the condition holds."""
    if not condition:
        raise AssertionError(what)


def check_close(actual, expected, what, tolerance=1e-6):
    """Fails the test unless two numbers, or two sequences of them, agree."""
    pairs = zip(actual, expected) if hasattr(actual, "__len__") else [(actual, expected)]
    for a, b in pairs:
        check(abs(a - b) <= tolerance, "%s is %s, not %s" % (what, actual, expected))


def remove(path):
    """Removes a file of an earlier run."""
    if os.path.exists(path):
        os.remove(path)
