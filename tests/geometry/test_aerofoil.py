"""NACA four-digit sections against the published tables."""

import numpy as np
import pytest

from morphing_wing.errors import InputError
from morphing_wing.geometry.aerofoil import Aerofoil

pytestmark = pytest.mark.quick

# Abbott, von Doenhoff: Theory of Wing Sections, appendix III: NACA 0012, % of the chord.
STATIONS = [1.25, 2.5, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 100]
ORDINATES = [1.894, 2.615, 3.555, 4.683, 5.737, 6.002, 5.803, 5.294, 4.563, 3.664, 2.623,
             1.448, 0.807, 0.126]


def test_naca_0012_has_the_published_ordinates():
    foil = Aerofoil("0012", 100.0)
    for x, y in zip(STATIONS, ORDINATES, strict=True):
        assert foil.half_thickness(x) == pytest.approx(y, abs=6e-4)


def test_thickness_grows_with_digits_and_chord():
    thin, thick = Aerofoil("0006", 100.0), Aerofoil("0018", 250.0)
    s = np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(
        thick.half_thickness(250 * s), 7.5 * thin.half_thickness(100 * s), rtol=1e-13)


def test_nose_has_its_radius():
    foil = Aerofoil("0012", 100.0)
    x = 1e-6
    assert foil.half_thickness(x) ** 2 / (2 * x) == pytest.approx(1.1019 * 0.12**2 * 100, rel=2e-3)


def test_naca_2412_has_its_largest_camber_of_2_percent_at_40_percent():
    foil = Aerofoil("2412", 100.0)
    x = np.linspace(0.0, 100.0, 2001)
    camber = foil.camber(x)
    assert x[np.argmax(camber)] == pytest.approx(40.0)
    assert camber.max() == pytest.approx(2.0)
    assert camber[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-12)
    # Slope of the mean line at the nose: 2 m/p.
    assert (camber[1] - camber[0]) / (x[1] - x[0]) == pytest.approx(0.1, rel=1e-3)


def test_symmetric_sections_have_no_camber():
    assert not Aerofoil("0012", 150.0).camber(np.linspace(0, 150, 7)).any()


@pytest.mark.parametrize("front", [True, False])
def test_place_of_a_thickness_inverts_the_thickness(front):
    foil = Aerofoil("0012", 150.0)
    x = foil.x_where_half_thickness(3.0, front)
    assert foil.half_thickness(x) == pytest.approx(3.0, abs=1e-9)
    assert (x < 45.0) == front


@pytest.mark.parametrize("digits", ["001", "00012", "NACA", "0000", "2012", "0412", 12, None, ""])
def test_what_is_no_aerofoil_is_refused_in_one_sentence(digits):
    with pytest.raises(InputError, match=r"^aerofoil = .*: must be four digits[^.]*$"):
        Aerofoil(digits, 150.0)


@pytest.mark.parametrize("chord", [0.0, -150.0, float("nan"), float("inf")])
def test_chords_that_are_no_lengths_are_refused_in_one_sentence(chord):
    with pytest.raises(InputError, match=r"^chord = .* mm: must be greater than 0 mm$"):
        Aerofoil("0012", chord)
