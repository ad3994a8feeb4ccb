# SPDX-License-Identifier: BSD-3-Clause
"""What the demo does to which surface: handles, joints and cameras, in each
surface's own coordinates."""
import math
from dataclasses import dataclass, field

import numpy


@dataclass
class Sphere:
    """A region of points: those in a ball."""
    center: tuple
    radius: float


@dataclass
class Box:
    """A region of points: those in a box along the axes."""
    low: tuple
    high: tuple


@dataclass
class Joint:
    """A turn by `angle` degrees about `axis` through `center`."""
    center: tuple
    axis: tuple
    angle: float

    def matrix(self):
        axis = numpy.array(self.axis, dtype=float)
        x, y, z = axis / numpy.linalg.norm(axis)
        cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        angle = math.radians(self.angle)
        result = numpy.eye(4)
        result[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
        result[:3, 3] = self.center - result[:3, :3] @ self.center
        return result


@dataclass
class Handle:
    """A handle that turns about one joint after the other, like a hand about
    elbow and shoulder: all joints are given in the rest pose, the one next to
    the handle first. Without joints it is pinned."""
    name: str
    regions: list
    joints: list = field(default_factory=list)

    def motion(self):
        """The motion as the numbers of vtkHandleMotion: angle in degrees, axis,
        center, translation. The center is that of the last joint."""
        matrix = numpy.eye(4)
        for joint in self.joints:
            matrix = joint.matrix() @ matrix
        rotation = matrix[:3, :3]
        # The axis is what the rotation keeps, the angle what the trace says.
        values, vectors = numpy.linalg.eig(rotation)
        axis = numpy.real(vectors[:, numpy.argmin(abs(values - 1))])
        skew = numpy.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                            rotation[1, 0] - rotation[0, 1]])
        angle = math.degrees(math.atan2(skew @ axis, numpy.trace(rotation) - 1))
        center = numpy.array(self.joints[-1].center, dtype=float)
        translation = rotation @ center + matrix[:3, 3] - center
        return angle, tuple(axis), tuple(center), tuple(translation)


@dataclass
class Pose:
    mesh: str           # the name of the scanned mesh
    title: str
    handles: list       # handle k is the k-th, from 1
    view_from: tuple    # the direction in which the camera is
    view_up: tuple


X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)

TWIST = Joint((0, 28, 5), Y, -15)
SHOULDER = Joint((26, 56, 5), Z, 50)
HIP = Joint((-24, 8, 2), X, 60)

ARMADILLO = Pose(
    mesh="armadillo",
    title="Armadillo",
    view_from=(0.55, 0.1, -1),
    view_up=Y,
    handles=[
        Handle("hips and standing leg", [Box((-16, 10, -30), (16, 22, 40)),
                                         Box((5, -60, -60), (65, -25, 60))]),
        Handle("chest", [Box((-20, 40, -20), (20, 52, 40))], [TWIST]),
        Handle("head", [Box((-21, 58, -60), (21, 100, -12))], [Joint((0, 66, -8), Y, -30), TWIST]),
        Handle("raised hand", [Sphere((57, 74, -32), 19)],
               [Joint((50, 56, -8), Z, -35), SHOULDER, TWIST]),
        Handle("raised elbow", [Sphere((50, 56, -2), 9)], [SHOULDER, TWIST]),
        Handle("lowered hand", [Sphere((-57, 74, -32), 19)],
               [Joint((-50, 56, -8), Z, 75), Joint((-26, 56, 5), Z, 45), TWIST]),
        Handle("lifted knee", [Box((-65, -15, -60), (-15, -8, 25))], [HIP]),
        Handle("lifted foot", [Box((-65, -60, -60), (-5, -36, 60))],
               [Joint((-32, -25, 2), X, -80), HIP]),
    ])

CAMEL = Pose(
    mesh="camel",
    title="Camel",
    view_from=(1, 0.12, 0.25),
    view_up=Y,
    handles=[
        Handle("body", [Box((-0.2, 0.05, -0.36), (0.2, 0.5, 0.1))]),
        Handle("standing feet", [Box((-0.2, -0.5, 0.0), (0.0, -0.3, 0.2)),
                                 Box((0.0, -0.5, -0.5), (0.2, -0.2, -0.2))]),
        Handle("head", [Box((-0.2, 0.40, 0.36), (0.2, 0.55, 0.55))],
               [Joint((0, 0.2, 0.25), X, 30), Joint((0, 0.36, 0.33), Y, 50), Joint((0, 0.2, 0.25), Y, 45)]),
        Handle("lifted knee", [Box((0.0, -0.19, 0.0), (0.2, -0.12, 0.2))],
               [Joint((0.05, 0.0, 0.06), X, -65)]),
        Handle("lifted foot", [Box((0.0, -0.5, 0.0), (0.2, -0.29, 0.2))],
               [Joint((0.05, -0.235, 0.045), X, 105), Joint((0.05, 0.0, 0.06), X, -65)]),
        Handle("stepping foot", [Box((-0.2, -0.5, -0.5), (0.0, -0.26, -0.2))],
               [Joint((-0.05, -0.02, -0.36), X, 20)]),
    ])

DIPLODOCUS = Pose(
    mesh="diplodocus",
    title="Diplodocus",
    view_from=(0.15, 0.25, 1),
    view_up=Y,
    handles=[
        Handle("body and feet", [Box((-0.2, -0.5, -0.2), (0.19, 0.03, 0.2)),
                                 Box((0.1, -0.5, -0.2), (0.27, -0.12, 0.2)),
                                 Box((-0.35, -0.5, -0.2), (-0.19, -0.15, -0.05))]),
        Handle("head", [Box((0.36, 0.33, -0.2), (0.6, 0.5, 0.2))],
               [Joint((0.33, 0.36, 0.03), Z, -40), Joint((0.3, 0.2, 0.02), Z, 60),
                Joint((0.28, 0.1, 0.02), Y, -60)]),
        Handle("tip of the tail", [Box((-0.6, -0.40, -0.1), (-0.40, -0.30, 0.1))],
               [Joint((-0.36, -0.26, 0), Z, -120), Joint((-0.25, -0.1, 0), Z, -45)]),
    ])

LION = Pose(
    mesh="lion",
    title="Lion",
    view_from=(-0.1, 0.1, 1),
    view_up=Y,
    handles=[
        Handle("neck", [Box((-0.5, -0.6, -0.6), (0.5, 0.6, -0.32))]),
        Handle("head", [Box((-0.5, -0.45, 0.05), (0.5, 0.6, 0.6))],
               [Joint((0, 0.0, -0.1), Y, 60)]),
    ])

POSES = [ARMADILLO, CAMEL, DIPLODOCUS, LION]
