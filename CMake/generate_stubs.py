#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes type stubs of the wrapped classes, beside the extension module.

    generate_stubs.py PACKAGE-FOLDER MODULE

VTK's generator names classes of other modules without importing them; their imports are added.
Where the generator cannot run, because this Python cannot import the module, the stub says that
nothing is known, and the build goes on.
"""
import importlib
import pathlib
import re
import sys
import types

UNKNOWN = """from typing import Any

def __getattr__(name: str) -> Any: ...
"""


def imports_of(text, module):
    """The lines that import what the annotations of a stub name."""
    missing = set(re.findall(r"'(vtk\w+)'", text)) - set(vars(module))
    lines = []
    # The headers name data, parts of pipelines, and filters.
    for name in importlib.import_module("vtkmodules").__all__:
        if missing and name.startswith(("vtkCommon", "vtkFilters")):
            other = importlib.import_module("vtkmodules." + name)
            lines += [f"from vtkmodules.{name} import {known}"
                      for known in sorted(missing & set(vars(other)))]
            missing -= set(vars(other))
    return lines


def add_imports(path, module):
    text = path.read_text(encoding="utf-8")
    head, body = text.split("\n\n", 1)
    path.write_text("\n".join([head, *imports_of(text, module), "", body]),
                    encoding="utf-8")


def main(folder, module_name):
    # The package itself needs more than VTK, numpy for example.
    package = types.ModuleType(folder.name)
    package.__path__ = [str(folder)]
    sys.modules[package.__name__] = package
    stub = folder / (module_name + ".pyi")
    try:
        generator = importlib.import_module("vtkmodules.generate_pyi")
        module = importlib.import_module(f"{package.__name__}.{module_name}")
    except ImportError as error:
        print(f"{stub.name} describes nothing, because {sys.executable} cannot import it: {error}")
        stub.write_text(UNKNOWN, encoding="utf-8")
        return
    generator.main([sys.argv[0], "-p", package.__name__, "-o", str(folder), module_name])
    add_imports(stub, module)


main(pathlib.Path(sys.argv[1]), sys.argv[2])
