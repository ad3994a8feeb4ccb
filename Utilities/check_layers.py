#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Refuses include lines that run up, or across, the layers.

    Plugin -> Filters -> Filters/Bridge -> Filters/Kernel/<layer> -> Eigen

Prints one line per violation and exits with 1 if there is any.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
KERNEL = ROOT / "Filters" / "Kernel"

# What each kernel layer stands on, itself and Base left out.
LAYERS = {
    "Base": (),
    "Algebra": (),
    "Mesh": (),
    "Differential": ("Algebra", "Mesh"),
    "Measure": ("Differential", "Algebra", "Mesh"),
    "Deformation": ("Measure", "Differential", "Algebra", "Mesh"),
    "Morph": ("Measure", "Differential", "Algebra", "Mesh"),
    "Spectral": ("Differential", "Algebra", "Mesh"),
    "Compression": ("Spectral", "Differential", "Algebra", "Mesh"),
    "Merging": ("Deformation", "Measure", "Differential", "Algebra", "Mesh"),
    "Distributed": ("Algebra", "Mesh"),
}

# Public classes that are not filters.
PARAMETERS = ("vtkHandleMotion.h",)

INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


def problem(folder, header, is_quoted):
    """Why the file in `folder` (relative to the root) may not include `header`; None if it may."""
    parts = folder.parts
    layer = header.split("/")[0]
    if parts[:2] == ("Filters", "Kernel"):
        own = parts[2] if len(parts) > 2 else None
        if own not in LAYERS:
            return "the folder is not a layer of the kernel"
        if header.startswith(("vtk", "vtk/")):
            return "the kernel knows nothing of VTK"
        if is_quoted and layer not in LAYERS:
            return "an include of the kernel names the layer it enters"
        if layer in LAYERS and layer not in (own, "Base", *LAYERS[own]):
            return f"{own} does not stand on {layer}"
    elif parts[:2] == ("Filters", "Bridge"):
        if header.startswith("vtk") and header not in PARAMETERS and (ROOT / "Filters" / header).exists():
            return "the bridge stands below the filters"
    elif parts[:1] == ("Plugin",):
        if header.startswith(("Kernel/", "Bridge/", "Eigen/")):
            return "the plugin contains no algorithm"
    return None


def main():
    failures = 0
    files = sorted(path for folder in ("Filters", "Plugin")
                   for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cxx"))
    for path in files:
        folder = path.parent.relative_to(ROOT)
        for match in INCLUDE.finditer(path.read_text(encoding="utf-8")):
            header = match.group(1) or match.group(2)
            why = problem(folder, header, match.group(1) is not None)
            if why:
                failures += 1
                print(f"{path.relative_to(ROOT)}: {match.group(0).strip()}: {why}")
    print(f"{len(files)} files, {failures} includes against the layers")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
