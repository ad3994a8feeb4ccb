"""The deformation methods beside the frame-based ones, through their proxies."""
import math

import vtkcartan
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

from plugin_testing import (
    Messages, check, check_close, load_plugin, mark_ends, open_bar, output, refresh)

# What decides how a method works, and what it can be.
CHOICES = {
    "AsRigidAsPossibleDeformation": ("Energy", ["Spokes", "Spokes And Rims",
                                                "Smoothed Rotations"]),
    "LaplacianDeformation": ("Rotations", ["None", "Estimated", "Implicit"]),
    "MultiresolutionDeformation": ("Smoothness", [1, 2, 3]),
    "PoissonDeformation": ("Propagation", ["Harmonic", "Geodesic"]),
    "SimilarityDeformation": ("Reconstruction", ["Affine", "Least Squares", "Edge Form"]),
}


def points_of(proxy):
    return vtk_to_numpy(output(proxy).GetPoints().GetData()).astype(float)


def difference(proxy, expected):
    return abs(points_of(proxy) - expected).max()


def set_motion(proxy, degrees, translation):
    """Turns handle 1, the active one, about the y axis through the bar's middle."""
    proxy.Motion.Center = [2.5, 0.5, 0.5]
    proxy.Motion.Axis = [0, 1, 0]
    proxy.Motion.Angle = degrees
    proxy.Motion.Translation = translation


def row(degrees, translation):
    """The same motion for handle 2."""
    return [2, 1, 1, 1, degrees, 0, 1, 0, 2.5, 0.5, 0.5] + translation


def turned(points, degrees, translation):
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, z = points[:, 0] - 2.5, points[:, 2] - 0.5
    result = points.copy()
    result[:, 0] = 2.5 + cosine * x + sine * z
    result[:, 2] = 0.5 - sine * x + cosine * z
    return result + translation


load_plugin()
bar = open_bar("TestDeformationMethods")
marked = mark_ends(bar)
rest = points_of(bar)
handle = vtk_to_numpy(output(marked).GetPointData().GetArray("Handle"))
SHIFT = [0.5, -1.0, 0.25]

for name, (choice, values) in CHOICES.items():
    proxy = getattr(simple, name)(Input=marked)
    algorithm = proxy.GetClientSideObject()
    check(isinstance(algorithm, getattr(vtkcartan, "vtk" + name)), name + " makes another class")
    bent = []
    for i, value in enumerate(values):
        where = "%s, %s %s" % (name, choice, value)
        setattr(proxy, choice, value)
        proxy.UpdateVTKObjects()
        first = 1 if choice == "Smoothness" else 0
        check(getattr(algorithm, "Get" + choice)() == first + i, where + " does not arrive")

        # A rigid motion of both handles moves all. Differential coordinates
        # without exact rotations follow translations.
        degrees = 0 if name == "LaplacianDeformation" else 50
        set_motion(proxy, degrees, SHIFT)
        proxy.MotionRows = row(degrees, SHIFT)
        check(difference(proxy, turned(rest, degrees, SHIFT)) < 1e-5, where + ": rigid motion")

        # One handle bends the bar.
        proxy.MotionRows = []
        set_motion(proxy, 40, SHIFT)
        bent.append(points_of(proxy))
        check_close(bent[-1][handle == 2].ravel(), rest[handle == 2].ravel(),
                    where + ": the pinned end")
        check_close(bent[-1][handle == 1].ravel(),
                    turned(rest, 40, SHIFT)[handle == 1].ravel(), where + ": the moved end", 1e-5)
        # Along a straight bar harmonic functions and distances are the same.
        differs = abs(bent[-1] - bent[0]).max() > 1e-4
        check(differs == (i > 0 and name != "PoissonDeformation"), where + ": the difference")
        refresh(proxy)
        check(proxy.NumberOfFreePoints == (handle == 0).sum(), where + ": free points")

    # Bad input.
    proxy.ActiveHandle = 7
    errors = Messages(proxy)
    surface = output(proxy)
    check(len(errors.texts) == 1 and "Handle 7" in errors.texts[0],
          "%s: errors: %s" % (name, errors.texts))
    check(surface is None or surface.GetNumberOfPoints() == 0, name + ": not empty")
    proxy.ActiveHandle = 1
    check(difference(proxy, bent[-1]) < 1e-6, name + ": a mistake can be mended")

# What only one of them has.
similarity = simple.SimilarityDeformation(Input=marked, ScaleFeatures=1, GenerateScaleFactor=1)
similarity.Motion.Scale = [2, 2, 2]
similarity.MotionRows = [2, 2, 2, 2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
check(difference(similarity, 2 * rest) < 1e-5, "scaled features")
scales = output(similarity).GetPointData().GetArray("ScaleFactor").GetRange()
check_close(scales, [2, 2], "ScaleFactor")
refresh(similarity)
check(similarity.NumberOfFlatPoints > 0, "the bar's sides are flat")

# Those that iterate.
for name, array in (("AsRigidAsPossibleDeformation", "RigidityEnergy"),
                    ("PyramidDeformation", "PyramidEnergy")):
    proxy = getattr(simple, name)(Input=marked)
    check(proxy.GetClientSideObject().GetClassName() == "vtk" + name, name)
    setattr(proxy, "Generate" + array, 1)
    set_motion(proxy, 60, SHIFT)
    energies = []
    for iterations in (0, 4, 40):
        proxy.MaximumIterations = iterations
        output(proxy)
        refresh(proxy)
        check(proxy.NumberOfIterations <= iterations, name + ": iterations")
        energies.append(proxy.FinalEnergy)
    check(energies[0] > energies[1] >= energies[2], "%s: energies %s" % (name, energies))
    energy = vtk_to_numpy(output(proxy).GetPointData().GetArray(array))
    check_close(energy.sum() / energies[2], 1, "the sum of " + array)
    for guess in ("Rest Shape", "Previous Result", "Rotation Invariant", "Shape Preserving"):
        proxy.InitialGuess = guess
        proxy.MaximumIterations = 2000
        proxy.Tolerance = 1e-10
        check(points_of(proxy).shape == rest.shape, name + ": " + guess)
        refresh(proxy)
        check_close(proxy.FinalEnergy / energies[2], 1,
                    "%s: the energy from %s" % (name, guess), 0.05)
