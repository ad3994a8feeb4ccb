# SPDX-License-Identifier: BSD-3-Clause
"""Landmarks in the files of 3D Slicer, for vtkLandmarkHandles."""
import csv
import json
import pathlib

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkTable

# Old files number the systems.
SYSTEMS = {"0": "RAS", "1": "LPS", "RAS": "RAS", "LPS": "LPS"}


def _read_fcsv(path):
    """Rows of name and position, and the coordinate system."""
    system = "RAS"
    columns = ["id", "x", "y", "z", "ow", "ox", "oy", "oz", "vis", "sel", "lock", "label"]
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        key, _, value = line.lstrip("# ").partition("=")
        if not line.startswith("#"):
            lines.append(line)
        elif key.strip() == "CoordinateSystem":
            system = value.strip()
        elif key.strip() == "columns":
            columns = value.strip().split(",")
    rows = [dict(zip(columns, row)) for row in csv.reader(lines) if row]
    return [(row.get("label", ""), [float(row[axis]) for axis in "xyz"]) for row in rows], system


def _read_json(path):
    rows = []
    system = "LPS"
    for markup in json.loads(path.read_text(encoding="utf-8"))["markups"]:
        system = markup.get("coordinateSystem", "LPS")
        rows += [(point.get("label", ""), [float(value) for value in point["position"]])
                 for point in markup["controlPoints"]
                 if point.get("positionStatus", "defined") == "defined"]
    return rows, system


def read_landmarks(file_name, system="LPS"):
    """A vtkTable with the columns label, x, y, z of a file .fcsv or .mrk.json of 3D Slicer.

    system: "LPS" (left, posterior, superior; surfaces that Slicer writes) or "RAS". Positions are
    converted to it from the system that the file states. Raises ValueError for other files.
    """
    path = pathlib.Path(file_name)
    if system not in ("LPS", "RAS"):
        raise ValueError(f"The coordinate system is LPS or RAS; got {system}.")
    if path.suffix not in (".fcsv", ".json"):
        raise ValueError(f"{path.name} is neither .fcsv nor .mrk.json.")
    try:
        rows, stated = _read_fcsv(path) if path.suffix == ".fcsv" else _read_json(path)
        sign = 1.0 if SYSTEMS[stated] == system else -1.0
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path.name} is not a file of landmarks: {error!r}.") from error
    table = vtkTable()
    labels = vtkStringArray()
    labels.SetName("label")
    for label, _ in rows:
        labels.InsertNextValue(label)
    table.AddColumn(labels)
    for axis, factor in enumerate((sign, sign, 1.0)):
        column = vtkDoubleArray()
        column.SetName("xyz"[axis])
        for _, position in rows:
            column.InsertNextValue(factor * position[axis])
        table.AddColumn(column)
    return table
