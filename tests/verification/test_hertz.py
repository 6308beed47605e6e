"""A parabolic cylinder pressed on a rigid flat: Hertz' line contact.

References
----------
Johnson: Contact Mechanics, 1985, sections 4.2 (half width, pressure) and 5.6 (approach).
"""

import numpy as np
import pytest
from scipy.integrate import quad

from morphing_wing.geometry.hexmesh import breakpoints, geometric, swept_blocks, uniform
from morphing_wing.materials import Yeoh
from tests.verification.moved import Moved, pressing
from tests.verification.test_contact import side_by_side

RADIUS, SIZE, APART, STIFFNESS = 200.0, 30.0, 0.4, 500.0
MATERIAL = Yeoh((0.117,), bulk=1.17)
MU, KAPPA = MATERIAL.shear_modulus, MATERIAL.bulk
NU = (3 * KAPPA - 2 * MU) / (6 * KAPPA + 2 * MU)
PLANE_STRAIN = 2 * MU * (1 + NU) / (1 - NU**2)
ELEMENTS_OVER_B = 10


def parabola():
    """Half of a block, 1 mm of its length, that is finest within 1.5 mm of where it touches."""
    line, _ = breakpoints((1.5, uniform(15)), (SIZE - 1.5, geometric(12, 1.4)))

    def mapping(x):
        blend = 1.0 - x[:, 1] / SIZE
        return x + np.outer(APART + blend * x[:, 0] ** 2 / (2 * RADIUS), [0.0, 1.0, 0.0])

    def faces(midpoints, normals):
        return {"middle": normals[:, 0] < 0, "ends": normals[:, 2] != 0,
                "below": normals[:, 1] < 0, "top": normals[:, 1] > 0}

    n = len(line) - 1
    return swept_blocks((line, line, uniform(1)), np.ones((n, n, 1), int), {1: "body"}, mapping,
                        faces)


def flat():
    """A plate all of whose faces are clamped."""
    def faces(midpoints, normals):
        return {"flat": normals[:, 1] > 0, "still": np.abs(normals[:, 1]) >= 0}

    lines = np.array([-1.0, SIZE + 1.0]), np.array([-1.0, 0.0]), np.array([-0.5, 1.5])
    return swept_blocks(lines, np.ones((1, 1, 1), int), {1: "body"}, faces=faces)


class Line:
    """The block pressed on the flat by a displacement of its top in mm."""

    def __init__(self, by):
        scene = Moved(
            side_by_side(parabola(), flat()), MATERIAL, "Q1 enhanced",
            pressing(("below", "flat"), stiffness=STIFFNESS),
            clamped=("still",), symmetry={"middle": 0, "ends": 2, "top": 1})
        u = scene.body.displacement_part(scene.body.function)
        u.interpolate(lambda x: np.outer([0.0, 1.0, 0.0], np.where(x[1] > 1e-6, -APART, 0.0)))
        scene.move("top", 1, -APART - by)
        scene.solve(1e-4)
        self.scene = scene
        self.force = 2.0 * scene.part.total_force()  # of both halves, of 1 mm
        nodes = scene.part._sides[0].nodes
        gap = scene.part._found()[0][1]
        self.x, self.pressure = nodes.reference[:, 0], STIFFNESS * np.maximum(-gap, 0.0)
        self.share = scene.part._sides[0].area

    def half_width(self):
        """b in mm from the second moment of the pressure, F b^2 / 4."""
        weight = self.share * self.pressure
        return 2.0 * np.sqrt(np.sum(weight * self.x**2) / np.sum(weight))

    def sinking(self, depth):
        """Displacement in mm towards the flat at a depth on the axis, less that where it touches.

        The depth that is taken, that of the node next to ``depth``, is returned too.
        """
        u = self.scene.body.displacement()
        place = u.function_space.tabulate_dof_coordinates()
        axis = np.flatnonzero((np.abs(place[:, 0]) < 1e-9) & (place[:, 1] > 1e-6))
        y, moved = place[axis, 1] - APART, u.x.array[1::3][axis]
        there = np.abs(y - depth).argmin()
        return moved[np.abs(y).argmin()] - moved[there], y[there]


@pytest.fixture(scope="module")
def line():
    return Line(0.012)


def test_half_width_of_a_line_contact_is_hertz(line):
    b = np.sqrt(4.0 * line.force * RADIUS / (np.pi * PLANE_STRAIN))
    assert b > 0.1 * ELEMENTS_OVER_B * 0.9
    assert line.half_width() == pytest.approx(b, rel=0.03)
    touching = line.x[line.pressure > 0.0].max()
    assert touching == pytest.approx(b, abs=0.1)  # one element


def test_peak_and_course_of_the_pressure_of_a_line_contact_are_hertz(line):
    peak = np.sqrt(line.force * PLANE_STRAIN / (np.pi * RADIUS))
    b = np.sqrt(4.0 * line.force * RADIUS / (np.pi * PLANE_STRAIN))
    assert line.pressure.max() == pytest.approx(peak, rel=0.03)
    inside = line.x < 0.9 * b
    exact = peak * np.sqrt(1.0 - (line.x[inside] / b) ** 2)
    np.testing.assert_allclose(line.pressure[inside], exact, atol=0.03 * peak)


def test_sinking_of_the_axis_under_a_line_contact_is_the_half_spaces(line):
    b = np.sqrt(4.0 * line.force * RADIUS / (np.pi * PLANE_STRAIN))
    peak = 2.0 * line.force / (np.pi * b)
    found, depth = line.sinking(3.0)

    def strain(z):
        root = np.hypot(b, z)
        across = -peak / b * ((b**2 + 2 * z**2) / root - 2 * z)
        along = -peak * b / root
        return (along - NU / (1 - NU) * across) / PLANE_STRAIN

    exact = -quad(strain, 0.0, depth)[0]
    assert found == pytest.approx(exact, rel=0.03)
