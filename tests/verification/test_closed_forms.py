"""The closed forms of ``morphing-wing verify`` against figures of other origin."""

import pytest

from morphing_wing.materials import DRAGON_SKIN_30, Yeoh
from morphing_wing.verification.elastica import exact_tip
from morphing_wing.verification.homogeneous import exact_stress
from morphing_wing.verification.thick_walls import exact_pressure

pytestmark = pytest.mark.quick


@pytest.mark.parametrize("shape, lam, pressure", [
    (3, 1.1, 0.067164), (3, 1.25, 0.128834), (3, 1.5, 0.175436), (3, 2.0, 0.184329),
    (2, 1.25, 0.064448), (2, 1.5, 0.099831), (2, 2.0, 0.132634)])
def test_pressures_of_thick_walls(shape, lam, pressure):
    assert exact_pressure(lam, shape) == pytest.approx(pressure, abs=6e-7)


@pytest.mark.parametrize("load, down, back", [(1.0, 0.30172, 0.05643), (10.0, 0.81061, 0.55500)])
def test_tip_of_the_elastica(load, down, back):
    assert exact_tip(load) == pytest.approx((down, back), abs=1e-5)


@pytest.mark.parametrize("lam, stress", [(1.5, 0.2453), (3.0, 0.6231), (4.64, 0.8357)])
def test_stress_of_incompressible_rubber(lam, stress):
    incompressible = Yeoh(DRAGON_SKIN_30.coefficients, bulk=1e6)
    assert exact_stress("uniaxial", incompressible, lam) == pytest.approx(stress, abs=6e-5)
