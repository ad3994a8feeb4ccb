# SPDX-License-Identifier: BSD-3-Clause
"""Every Python script of every page runs as printed.

A page's blocks run one after the other in a folder that has the files that pages name. Where a
page goes on from something that is said in words, `marked` for example, it is given here.
Python.md has a test of its own, Testing/Python/TestPythonPage.py.
"""
import os
import pathlib
import re
import sys
import tempfile
import unittest

import cartan_testing
import vtkcartan
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkBox
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkFiltersSources import vtkCubeSource

from plugin_testing import load_plugin, open_bar, write

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = sorted(page for page in [ROOT / "README.md", *(ROOT / "Documentation").glob("*.md")]
               if page.name != "Python.md")


def blocks(page):
    """The blocks of Python of a page."""
    return re.findall(r"^```python\n(.*?)^```$", page.read_text(encoding="utf-8"),
                      re.MULTILINE | re.DOTALL)


def mark(connection, handle, low, high):
    """Marks the points between two bounds along x."""
    box = vtkBox()
    box.SetBounds(low, high, -9, 9, -9, 9)
    marked = vtkcartan.vtkMarkHandle()
    marked.SetInputConnection(connection)
    marked.SetRegion(box)
    marked.SetHandleId(handle)
    return marked


def given(page, number):
    """The names that a block starts with."""
    if page == "RestoreSurface.md":
        names = {"reader": vtkCubeSource(), "prepare": vtkcartan.vtkPrepareSurface(),
                 "mark": mark(None, 1, -9, 0),
                 "deform": vtkcartan.vtkRotationInvariantDeformation()}
        exec("from vtkcartan import vtkRestoreSurface", names)
        return names
    if page == "MarkHandle.md" and number == 0:
        return {"surface": cartan_testing.bar(20, 10, 10, 1.0, 1.0, 0.9)}
    if page == "MarkHandle.md":
        return {**vars(simple), "surface": open_bar("TestPages")}
    source = mark(bar.GetOutputPort(), 1, 4.4, 9)
    return {"marked": mark(source.GetOutputPort(), 2, -9, 0.6)}


def lay_out(folder):
    """The files that pages name."""
    plugin = cartan_testing.plugin_path()
    places = [folder, folder / "lib/paraview-5.11/plugins/CartanPlugin",
              folder / "build/lib/paraview-5.11/plugins/CartanPlugin"]
    for place in places:
        place.mkdir(parents=True, exist_ok=True)
        (place / "CartanPlugin.so").symlink_to(plugin)
    (folder / "build/demo").mkdir()
    scripts = "".join(block for page in PAGES for block in blocks(page))
    scans = {"build/demo/%s-before" % mesh: mesh
             for mesh in re.findall(r"build/demo/(\w+)-before", scripts)}
    for name, mesh in {**scans, "armadillo": "armadillo", "bent": "camel",
                       "original": "camel"}.items():
        path = write(cartan_testing.read_off(mesh), "TestPages-%s.vtp" % mesh)
        (folder / (name + ".vtp")).symlink_to(path)


class Pages(unittest.TestCase):
    def test_there_are_scripts(self):
        self.assertGreater(sum(len(blocks(page)) for page in PAGES), 20)

    def test_scripts_run(self):
        for page in PAGES:
            for number, block in enumerate(blocks(page)):
                with self.subTest(page=page.name, block=number):
                    print(page.name, number, flush=True)
                    exec(compile(block, "%s, block %d" % (page.name, number), "exec"),
                         given(page.name, number))


load_plugin()
bar = vtkTrivialProducer()
bar.SetOutput(cartan_testing.bar(20, 4, 4, 5.0, 1.0, 1.0))
with tempfile.TemporaryDirectory() as there:
    lay_out(pathlib.Path(there))
    os.chdir(there)
    result = unittest.main(exit=False).result
    os.chdir(ROOT)
sys.exit(not result.wasSuccessful())
