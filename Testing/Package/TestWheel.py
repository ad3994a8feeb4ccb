"""What pyproject.toml says fits the project, and CMake lays a wheel out as Python needs it.

Whether pip's VTK accepts the wheel is not tested: that needs PyPI.
"""
import os
import pathlib
import re
import subprocess
import tempfile
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(ROOT / "pyproject.toml", "rb") as file:
            cls.project = tomllib.load(file)

    def test_the_version_is_cmakes(self):
        text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"^  VERSION +(\S+)", text, re.MULTILINE).group(1)
        self.assertEqual(self.project["project"]["version"], version)

    def test_one_version_of_vtk(self):
        sdk = next(r for r in self.project["build-system"]["requires"] if r.startswith("vtk-sdk=="))
        self.assertIn(sdk.replace("vtk-sdk", "vtk"), self.project["project"]["dependencies"])

    def test_layout(self):
        define = self.project["tool"]["scikit-build"]["cmake"]["define"]
        with tempfile.TemporaryDirectory() as build:
            subprocess.run(
                ["cmake", "-S", str(ROOT), "-B", build, "-DSKBUILD=2", "-DCMAKE_BUILD_TYPE=Release",
                 "-DVTK_DIR=" + os.environ["CARTAN_VTK_DIR"]]
                + ["-D%s=%s" % entry for entry in define.items()], check=True, stdout=subprocess.DEVNULL)
            cache = pathlib.Path(build, "CMakeCache.txt").read_text(encoding="utf-8")
            for name, value in define.items():
                self.assertRegex(cache, "(?m)^%s:BOOL=%s$" % (name, value))
            scripts = "\n".join(path.read_text(encoding="utf-8")
                                for path in pathlib.Path(build).rglob("cmake_install.cmake"))
        prefix = re.escape("${CMAKE_INSTALL_PREFIX}/")
        self.assertRegex(scripts, prefix + r'vtkcartan" TYPE SHARED_LIBRARY')
        self.assertRegex(scripts, prefix + r'\./vtkcartan" TYPE MODULE')
        self.assertRegex(scripts, prefix + r'\./vtkcartan" TYPE FILE')
        self.assertIn("$ORIGIN:$ORIGIN/../vtkmodules", scripts)
        components = set(re.findall(r'COMPONENT STREQUAL "(\w+)"', scripts))
        self.assertLessEqual(set(self.project["tool"]["scikit-build"]["install"]["components"]),
                             components)


if __name__ == "__main__":
    unittest.main()
