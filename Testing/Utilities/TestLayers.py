"""Utilities/check_layers.py refuses what runs against the layers, and nothing else."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "Utilities"))
sys.dont_write_bytecode = True
import check_layers

KERNEL = pathlib.Path("Filters/Kernel")


class Includes(unittest.TestCase):
    def expect(self, folder, header, why=None, is_quoted=True):
        found = check_layers.problem(pathlib.Path(folder), header, is_quoted)
        if why is None:
            self.assertIsNone(found)
        else:
            self.assertIn(why, found or "accepted")

    def test_arrows_run_down(self):
        for layer, below in check_layers.LAYERS.items():
            for other in check_layers.LAYERS:
                is_allowed = other in (layer, "Base", *below)
                self.expect(KERNEL / layer, other + "/Some.h",
                            None if is_allowed else layer + " does not stand on " + other)

    def test_layers_below_are_complete(self):
        # What a layer stands on, it may use with all that this stands on.
        for layer, below in check_layers.LAYERS.items():
            for other in below:
                self.assertLessEqual(set(check_layers.LAYERS[other]), set(below), layer)
                self.assertNotIn(layer, check_layers.LAYERS[other])

    def test_every_folder_of_the_kernel_is_a_layer(self):
        folders = {path.name for path in (ROOT / KERNEL).iterdir() if path.is_dir()}
        self.assertLessEqual(folders, set(check_layers.LAYERS))
        self.expect(KERNEL / "Unknown", "Base/Types.h", "not a layer")
        self.expect(KERNEL, "Base/Types.h", "not a layer")

    def test_the_kernel_does_not_know_vtk(self):
        self.expect(KERNEL / "Mesh", "vtkPolyData.h", "nothing of VTK")
        self.expect(KERNEL / "Mesh", "vtkPolyData.h", "nothing of VTK", is_quoted=False)
        self.expect(KERNEL / "Mesh", "TriangleMesh.h", "names the layer")
        self.expect(KERNEL / "Algebra", "Eigen/SparseCore", is_quoted=False)
        self.expect(KERNEL / "Algebra", "vector", is_quoted=False)

    def test_the_bridge_stands_below_the_filters(self):
        self.expect("Filters/Bridge", "vtkSurfaceMorph.h", "below the filters")
        self.expect("Filters/Bridge", "vtkHandleMotion.h")
        self.expect("Filters/Bridge", "vtkPolyData.h")
        self.expect("Filters/Bridge", "Kernel/Mesh/TriangleMesh.h")

    def test_filters_use_everything_and_the_plugin_no_algorithm(self):
        for header in ("Bridge/FilterRun.h", "Kernel/Mesh/TriangleMesh.h"):
            self.expect("Filters", header)
            self.expect("Plugin", header, "no algorithm")
        self.expect("Plugin", "Eigen/Core", "no algorithm", is_quoted=False)
        self.expect("Plugin", "pqPropertyWidget.h")


class Script(unittest.TestCase):
    def test_names_the_line_and_fails(self):
        # A copy of the script in a tree with one wrong line among right ones.
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for folder in ("Utilities", "Plugin", KERNEL / "Mesh"):
                (root / folder).mkdir(parents=True)
            script = root / "Utilities" / "check_layers.py"
            script.write_bytes((ROOT / "Utilities" / "check_layers.py").read_bytes())
            source = root / KERNEL / "Mesh" / "Some.h"
            source.write_text('#include "Base/Types.h"\n#include <vector>\n')
            self.assertEqual(self.run_script(script), (0, ""))
            source.write_text('#include "Base/Types.h"\n  #  include "Morph/LinearMorph.h"\n')
            code, text = self.run_script(script)
            self.assertEqual(code, 1)
            self.assertIn("Filters/Kernel/Mesh/Some.h", text)
            self.assertIn("Mesh does not stand on Morph", text)

    def run_script(self, script):
        done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True)
        lines = done.stdout.splitlines()
        return done.returncode, "\n".join(lines[:-1])  # without the line that counts


if __name__ == "__main__":
    unittest.main()
