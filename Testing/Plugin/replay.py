"""Replays what a test in the window has saved: the same surface comes out, to 1e-12, and the same
picture.

    pvbatch replay.py FOLDER trace.py|state.py|state.pvsm
"""
import json
import os
import runpy
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import cartan_testing
from plugin_testing import pixels

folder, script = sys.argv[1:3]
with open(os.path.join(folder, "replay.json"), encoding="utf-8") as file:
    saved = json.load(file)
expected = numpy.load(os.path.join(folder, "points.npy"), allow_pickle=True)
if script.endswith(".pvsm"):
    simple.LoadPlugin(cartan_testing.plugin_path(), remote=False)
    simple.LoadState(os.path.join(folder, script))
else:
    # Scripts load the plugin by themselves.
    runpy.run_path(os.path.join(folder, script))
source = simple.FindSource(saved["source"])
source.UpdatePipeline()
points = vtk_to_numpy(servermanager.Fetch(source).GetPoints().GetData())
size = numpy.ptp(expected, axis=0).max()
difference = abs(points - expected).max() / size if points.shape == expected.shape else numpy.inf
print(f"{script}: {len(points)} points differ by {difference:g} of the size", flush=True)
if not difference <= 1e-12:
    sys.exit(f"{script} gives another surface")
picture = os.path.join(folder, "picture.png")
if script.endswith(".pvsm") and os.path.exists(picture):
    again = os.path.join(folder, "replayed.png")
    simple.SaveScreenshot(again, simple.GetRenderViews()[0], ImageResolution=[300, 200])
    difference = abs(pixels(again).astype(int) - pixels(picture)).max()
    print(f"{script}: pixels differ by {difference} of 255", flush=True)
    if difference > 2 or pixels(picture).std() < 10:
        sys.exit(f"{script} gives another picture")
