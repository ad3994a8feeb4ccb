# SPDX-License-Identifier: BSD-3-Clause
"""The filters for files of surfaces.

    python3 -m vtkcartan deform in.vtp out.vtp --handle 1=box:-1,-1,4,2,2,9 --handle 2=ids:0,5,7 \\
        --turn 1=90,1,0,0
    python3 -m vtkcartan morph first.vtp last.vtp out.vtp --parameter 0.5
    python3 -m vtkcartan measure deformed.vtp rest.vtp
    python3 -m vtkcartan prepare in.stl out.vtp

Files: .vtp, .ply, .stl, .obj; .vtp, .ply and .stl are written.
"""
import argparse
import pathlib
import sys
import warnings

import numpy
from vtkmodules.vtkCommonDataModel import vtkBox, vtkPlane, vtkSphere
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

from . import filters
from .vtkCartan import (vtkCurvatureError, vtkHandleMotion, vtkMarkHandle, vtkPrepareSurface,
                        vtkSurfaceMorph, vtkVolumeChange)

READERS = {".vtp": vtkXMLPolyDataReader, ".ply": vtkPLYReader, ".stl": vtkSTLReader,
           ".obj": vtkOBJReader}
WRITERS = {".vtp": vtkXMLPolyDataWriter, ".ply": vtkPLYWriter, ".stl": vtkSTLWriter}


def read(path):
    """The surface in a file."""
    kind = READERS.get(pathlib.Path(path).suffix.lower())
    if kind is None:
        raise ValueError(f"{path}: the file's name must end in one of {', '.join(READERS)}.")
    if not pathlib.Path(path).is_file():
        raise ValueError(f"{path}: there is no such file.")
    reader = kind()
    reader.SetFileName(str(path))
    filters.Listener(reader).update()
    return reader.GetOutput()


def write(surface, path):
    """Writes a surface to a file."""
    kind = WRITERS.get(pathlib.Path(path).suffix.lower())
    if kind is None:
        raise ValueError(f"{path}: the file's name must end in one of {', '.join(WRITERS)}.")
    writer = kind()
    writer.SetFileName(str(path))
    writer.SetInputData(surface)
    if hasattr(writer, "SetDataModeToBinary"):
        writer.SetDataModeToBinary()
    if not writer.Write():
        raise ValueError(f"{path} cannot be written.")


def run(algorithm, *surfaces):
    """The output of a filter."""
    for port, surface in enumerate(surfaces):
        algorithm.SetInputDataObject(port, surface)
    filters.Listener(algorithm).update()
    return algorithm.GetOutput()


def numbers(text, count, what):
    """Numbers that are separated by commas."""
    try:
        values = [float(word) for word in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count:
        raise ValueError(f"{what}: {count} numbers, separated by commas, not {text!r}.")
    return values


def by_handle(text, what):
    """The id and the rest of ID=..."""
    handle, equals, rest = text.partition("=")
    if not equals or not handle.isdigit() or int(handle) < 1:
        raise ValueError(f"{what} {text}: begin with the id of a handle, 1 or more, and =.")
    return int(handle), rest


def mark(surface, text):
    """Marks a handle: ID=box:..., sphere:..., plane:... or ids:..."""
    handle, region = by_handle(text, "--handle")
    kind, _, values = region.partition(":")
    marking = vtkMarkHandle()
    marking.SetHandleId(handle)
    if kind == "box":
        low_high = numbers(values, 6, "box:xmin,ymin,zmin,xmax,ymax,zmax")
        function = vtkBox()
        function.SetXMin(low_high[:3])
        function.SetXMax(low_high[3:])
        marking.SetRegion(function)
    elif kind == "sphere":
        x, y, z, radius = numbers(values, 4, "sphere:x,y,z,radius")
        function = vtkSphere()
        function.SetCenter(x, y, z)
        function.SetRadius(radius)
        marking.SetRegion(function)
    elif kind == "plane":
        values = numbers(values, 6, "plane:x,y,z of a point,x,y,z of the normal")
        function = vtkPlane()
        function.SetOrigin(values[:3])
        function.SetNormal(values[3:])
        marking.SetRegion(function)
    elif kind == "ids":
        for index, word in enumerate(values.split(",")):
            if not word.isdigit():
                raise ValueError(f"--handle {text}: {word!r} is not the id of a point.")
            marking.SetPointId(index, int(word))
    else:
        raise ValueError(f"--handle {text}: regions are box:, sphere:, plane: and ids:.")
    return run(marking, surface)


def center_of(surface, handle):
    """The middle of a handle's points."""
    points = filters.points_of(surface)
    handles = numpy.array(surface.GetPointData().GetArray("Handle"))
    if not (handles == handle).any():
        raise ValueError(f"Handle {handle} has a motion, but no points.")
    return points[handles == handle].mean(axis=0)


def motions(surface, options):
    """The motions of --turn and --shift, by handle."""
    found = {}
    for text in options.turn:
        handle, values = by_handle(text, "--turn")
        count = 7 if values.count(",") > 3 else 4
        turn = numbers(values, count, "--turn ID=degrees,x,y,z of the axis[,x,y,z of a point on it]")
        motion = found.setdefault(handle, vtkHandleMotion())
        motion.SetAngle(turn[0])
        motion.SetAxis(turn[1:4])
        motion.SetCenter(turn[4:] if count == 7 else center_of(surface, handle))
    for text in options.shift:
        handle, values = by_handle(text, "--shift")
        found.setdefault(handle, vtkHandleMotion()).SetTranslation(
            numbers(values, 3, "--shift ID=x,y,z"))
    return found


def properties(options):
    """The properties of --set, as numbers where they are."""
    found = {}
    for text in options.set:
        name, equals, value = text.partition("=")
        if not equals:
            raise ValueError(f"--set {text}: write NAME=VALUE.")
        try:
            found[name] = int(value) if value.lstrip("-").isdigit() else float(value)
        except ValueError:
            found[name] = value
    return found


def deform(options):
    """Moves handles."""
    surface = read(options.input)
    for text in options.handle:
        surface = mark(surface, text)
    algorithm = filters.deformation_class(options.method)()
    filters.set_properties(algorithm, properties(options))
    for handle, motion in motions(surface, options).items():
        algorithm.SetHandleMotion(handle, motion)
    write(run(algorithm, surface), options.output)


def morph(options):
    """Interpolates between surfaces."""
    algorithm = vtkSurfaceMorph()
    filters.set_properties(algorithm, {"Method": options.method, **properties(options)})
    algorithm.SetParameter(options.parameter)
    for path in options.inputs:
        algorithm.AddInputData(read(path))
    write(run(algorithm), options.output)


def measure(options):
    """Prints what has changed, and writes the arrays if asked to."""
    surface, reference = read(options.input), read(options.reference)
    change, error = vtkVolumeChange(), vtkCurvatureError()
    surface = run(error, run(change, surface, reference), reference)
    for algorithm, names in (
            (change, ("RelativeVolumeChange", "RelativeAreaChange", "EdgeLengthRMS",
                      "EdgeLengthMax", "ShapeDistance")),
            (error, ("MeanCurvatureErrorRMS", "GaussianCurvatureErrorRMS"))):
        for name in names:
            print(f"{name:26}{getattr(algorithm, 'Get' + name)():.6g}")
    if options.output:
        write(surface, options.output)


def prepare(options):
    """Repairs a surface."""
    algorithm = vtkPrepareSurface()
    filters.set_properties(algorithm, properties(options))
    write(run(algorithm, read(options.input)), options.output)
    print(algorithm.GetReport())


def parser():
    """The command line."""
    result = argparse.ArgumentParser(prog="python3 -m vtkcartan", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = result.add_subparsers(required=True, metavar="COMMAND")
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--set", action="append", default=[], metavar="NAME=VALUE",
                        help="a property of the filter, such as LaplacianWeights=Uniform")

    one = commands.add_parser("deform", parents=[common], help="move handles")
    one.add_argument("input")
    one.add_argument("output")
    one.add_argument("--handle", action="append", default=[], metavar="ID=REGION",
                     help="box:xmin,ymin,zmin,xmax,ymax,zmax; sphere:x,y,z,radius; "
                          "plane:x,y,z,nx,ny,nz (behind it); ids:i,j,...; "
                          "a handle without a motion is pinned")
    one.add_argument("--turn", action="append", default=[], metavar="ID=DEGREES,AXIS[,POINT]",
                     help="turn a handle about an axis, through its middle or a point")
    one.add_argument("--shift", action="append", default=[], metavar="ID=X,Y,Z",
                     help="shift a handle")
    one.add_argument("--method", default="ShapePreserving",
                     help="the filter without vtk and Deformation; default: %(default)s")
    one.set_defaults(run=deform)

    one = commands.add_parser("morph", parents=[common], help="interpolate between surfaces")
    one.add_argument("inputs", nargs="+", metavar="input")
    one.add_argument("output")
    one.add_argument("--parameter", type=float, default=0.5,
                     help="0 is the first surface, 1 the last; default: %(default)s")
    one.add_argument("--method", default="DiscreteForms",
                     help="DiscreteForms, Isometric, DeformationGradient, PyramidCoordinates, "
                          "Linear")
    one.set_defaults(run=morph)

    one = commands.add_parser("measure", help="compare with a reference")
    one.add_argument("input")
    one.add_argument("reference")
    one.add_argument("--output", help="writes the surface with all arrays")
    one.set_defaults(run=measure)

    one = commands.add_parser("prepare", parents=[common], help="repair a surface")
    one.add_argument("input")
    one.add_argument("output")
    one.set_defaults(run=prepare)
    return result


def main(arguments=None):
    """Returns the exit code."""
    options = parser().parse_args(arguments)
    warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
    try:
        options.run(options)
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
