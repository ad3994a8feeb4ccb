# SPDX-License-Identifier: BSD-3-Clause
"""Every block of code of Documentation/Python.md runs as printed, and does what the page says."""
import os
import pathlib
import re
import shlex
import tempfile
import unittest

import numpy
from vtkcartan import filters
from vtkcartan.__main__ import main, read, write

PAGE = pathlib.Path(__file__).resolve().parents[2] / "Documentation" / "Python.md"


def blocks(language):
    """The blocks of code of the page in this language."""
    text = PAGE.read_text(encoding="utf-8")
    return re.findall(r"^```%s\n(.*?)^```$" % language, text, re.MULTILINE | re.DOTALL)


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.names = {}
        for number, block in enumerate(blocks("python")):
            exec(compile(block, "block %d of %s" % (number, PAGE.name), "exec"), cls.names)

    def test_no_block_is_left_out(self):
        self.assertGreater(len(blocks("python")), 7)
        fences = re.findall(r"^```\w+", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
        self.assertEqual(set(fences), {"```python", "```sh"})

    def test_landmarks_are_two_lines_and_imports(self):
        block = next(block for block in blocks("python") if "targets=" in block)
        lines = " ".join(block.split("\n")).replace("import deform ", "import deform\n").split("\n")
        self.assertLessEqual(len(lines), 2)
        moved, goals = self.names["moved"], self.names["goals"]
        self.assertEqual(len(goals), 30)
        self.assertLess(abs(moved[self.names["landmarks"]] - goals).max(), 1e-12)

    def test_the_tube_bends(self):
        points, bent = self.names["points"], self.names["bent"]
        top = points[:, 2] > 4.5
        turned = numpy.stack([points[:, 0], 5 - points[:, 2], points[:, 1] + 5], 1)
        self.assertLess(abs(bent[top] - turned[top]).max(), 1e-9)
        self.assertLess(abs(self.names["frames"][9] - bent).max(), 1e-12)
        self.assertEqual(self.names["film"].shape, (11,) + points.shape)
        self.assertTrue((self.names["film"][10] == bent).all())
        self.assertGreater(self.names["changes"].totals["EdgeLengthRMS"], 0)
        self.assertTrue(numpy.isnan(self.names["changes"].totals["RelativeVolumeChange"]))

    def test_the_shell(self):
        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(folder)
            try:
                write(filters.as_surface(self.names["points"], self.names["triangles"]), "tube.vtp")
                for line in "".join(blocks("sh")).splitlines():
                    words = shlex.split(line)
                    self.assertEqual(words[:3], ["python3", "-m", "vtkcartan"])
                    self.assertEqual(main(words[3:]), 0, line)
                self.assertTrue(read("changes.vtp").GetPointData().HasArray("AreaRatio"))
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
