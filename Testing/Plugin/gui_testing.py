"""What tests in ParaView's window check in Python.

A test's XML runs lines of Python in the window's shell (executeCommand). check() and its kin print
what ctest takes for a failure, because an exception there does not stop the test.
"""
import json
import os
import sys

import numpy
from paraview import servermanager, simple, smtrace
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

import cartan_testing
from plugin_testing import pixels, write


def say(text):
    """Writes to the output of the process; print() would write to the shell in the window."""
    os.write(1, (text + "\n").encode())


def fail_on_exceptions():
    """Lets an exception in the shell fail the test; the window would only show it."""
    sys.excepthook = lambda kind, value, _trace: say(f"TEST FAILED: {kind.__name__}: {value}")


fail_on_exceptions()


def check(condition, what):
    """Fails the test with a sentence unless the condition holds."""
    if not condition:
        say("TEST FAILED: " + what)


def check_close(actual, expected, what, tolerance=1e-6):
    """Fails the test unless two sequences of numbers agree."""
    check(len(actual) == len(expected)
          and all(abs(a - b) <= tolerance for a, b in zip(actual, expected)),
          f"{what}: {list(actual)}, not {list(expected)}")


def points(name):
    """The points of a source as it is: nothing is updated."""
    source = simple.FindSource(name)
    return vtk_to_numpy(servermanager.Fetch(source).GetPoints().GetData()).copy()


def drawn_data(name):
    """What the active view draws of a source; None if that is nothing."""
    for representation in simple.GetActiveView().Representations:
        if getattr(representation, "Input", None) == simple.FindSource(name):
            drawn = representation.SMProxy.GetClientSideObject().GetActiveRepresentation()
            data = drawn.GetRenderedDataObject(0)
            while data and data.IsA("vtkMultiBlockDataSet"):
                data = data.GetBlock(0) if data.GetNumberOfBlocks() else None
            return data if data and data.GetNumberOfPoints() else None
    return None


def shown(name):
    """The points that the active view draws of a source."""
    data = drawn_data(name)
    return vtk_to_numpy(data.GetPoints().GetData()).copy() if data else None


def shown_array(name, array):
    """The point array that the active view draws with a source."""
    return vtk_to_numpy(drawn_data(name).GetPointData().GetArray(array)).copy()


def open_scan(mesh):
    """A scanned surface, in a file as the demo writes it, opened and seen from the side."""
    reader = simple.OpenDataFile(write(cartan_testing.read_off(mesh), mesh + ".vtp"),
                                 registrationName=mesh + ".vtp")
    simple.Show(reader)
    view = simple.GetActiveView()
    view.CameraPosition, view.CameraViewUp = [1, 0, 0], [0, 0, 1]
    simple.ResetCamera()
    simple.SetActiveSource(reader)


def snapshot(name):
    """Saves what is on the screen as a picture in the test's output."""
    frame = os.environ["CARTAN_SCREEN"]
    # The X window dump of Xvfb -fbdir: a header of big-endian numbers, a color map, rows of
    # blue, green, red and a byte without use.
    with open(frame, "rb") as file:
        data = file.read()
    header = numpy.frombuffer(data, ">u4", 25)
    size, width, height, stride, colors = (int(header[i]) for i in (0, 4, 5, 12, 19))
    rows = numpy.frombuffer(data, "u1", stride * height, size + 12 * colors)
    pixels = rows.reshape(height, stride)[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1]
    window = numpy.argwhere(pixels.any(axis=2)).max(axis=0) + 1  # the rest of the screen is black
    pixels = pixels[:window[0], :window[1]]
    height, width = pixels.shape[:2]
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(
        numpy_to_vtk(numpy.ascontiguousarray(pixels[::-1]).reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(cartan_testing.output_path(name + ".png"))
    writer.Write()


def start_trace():
    """As Tools > Start Trace does."""
    smtrace.start_trace()


def save_for_replay(test, name):
    """Writes trace, states and the surface of the source `name`; PlayInGui.cmake replays them."""
    trace = smtrace.stop_trace()
    folder = cartan_testing.output_path(test)
    os.makedirs(folder, exist_ok=True)
    surface = points(name)
    surface.dump(os.path.join(folder, "points.npy"))
    from paraview import smstate
    scripts = {"trace.py": trace, "state.py": smstate.get_state()}
    for file_name, text in scripts.items():
        with open(os.path.join(folder, file_name), "w", encoding="utf-8") as file:
            file.write(text)
    simple.SaveState(os.path.join(folder, "state.pvsm"))
    with open(os.path.join(folder, "replay.json"), "w", encoding="utf-8") as file:
        json.dump({"source": name, "data_type": str(surface.dtype)}, file)
    say(f"saved {len(surface)} points of {name}, a trace of {len(trace.splitlines())} lines")


def bounds_of(deformation, handle):
    """The box of a handle, as the deformation reports it."""
    rows = list(deformation.GetProperty("HandleBounds"))
    return next(rows[i + 1:i + 7] for i in range(0, len(rows), 7) if rows[i] == handle)


def boxes_in_view():
    """The boxes that can be dragged in the active view."""
    return [widget for widget in simple.GetActiveView().GetProperty("HiddenRepresentations")
            if "Box" in widget.SMProxy.GetXMLName() and widget.Visibility]


def check_handle_colors(marking):
    """Handles 1 and 2 are blue and orange, free points gray, in the map and in the picture."""
    display = simple.GetDisplayProperties(marking)
    check(list(display.ColorArrayName) == ["POINTS", "Handle"], "colored by handles")
    colors = display.LookupTable
    check(colors.InterpretValuesAsCategories == 1, "by categories")
    check(list(colors.Annotations)[:6] == ["0", "free", "1", "1", "2", "2"], "names")
    expected = [(0.8, 0.8, 0.8), (0.0, 0.447, 0.698), (0.902, 0.624, 0.0)]
    check_close(list(colors.IndexedColors)[:9], sum(expected, ()), "colors of the map")
    simple.Show(marking)
    simple.SetActiveSource(None)
    display.Ambient, display.Diffuse, display.Specular = 1, 0, 0
    picture = cartan_testing.output_path("handle-colors.png")
    simple.SaveScreenshot(picture, simple.GetActiveView())
    found = pixels(picture).astype(int)
    for color in expected:
        equal = abs(found - numpy.array(color) * 255).max(axis=1) < 1.5
        check(equal.mean() > 0.001, f"{color} in the picture: {equal.sum()} of {len(found)} pixels")


def label_actors():
    """The numbers of handles that the active view shows."""
    renderer = simple.GetActiveView().SMProxy.GetClientSideView().GetNonCompositedRenderer()
    return [actor for actor in renderer.GetViewProps() if actor.IsA("vtkTextActor")
            and actor.GetVisibility() and actor.GetInput().strip().isdigit()]


def labels_in_view():
    """Where they are, from 0 to 1 from the upper left."""
    view = simple.GetActiveView().SMProxy.GetClientSideView()
    width, height = view.GetRenderWindow().GetSize()
    places = {}
    for actor in label_actors():
        x, y = actor.GetPositionCoordinate().GetComputedDisplayValue(
            view.GetNonCompositedRenderer())
        places[int(actor.GetInput())] = (x / width, 1 - y / height)
    return places


def active_label():
    """The number that is highlighted."""
    return int(max(label_actors(), key=lambda actor: sum(
        actor.GetTextProperty().GetBackgroundColor())).GetInput())


def chart_lines():
    """The lines that the active view, a chart, shows: what they are called, and their values."""
    chart = simple.GetActiveView()
    source = simple.GetActiveSource()
    shown_series = list(simple.GetDisplayProperties(source, chart).SeriesVisibility)
    labels = list(simple.GetDisplayProperties(source, chart).SeriesLabel)
    names = dict(zip(labels[::2], labels[1::2]))
    table = servermanager.Fetch(source)
    return {names[series]: vtk_to_numpy(table.GetColumnByName(series)) for series in shown_series}


def save_picture(test):
    """Writes what the active view shows; replay.py draws it again."""
    simple.SaveScreenshot(cartan_testing.output_path(test + "/picture.png"),
                          simple.GetActiveView(), ImageResolution=[300, 200])
