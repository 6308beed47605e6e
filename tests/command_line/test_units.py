"""Text with units: what is read, and that nothing else is."""

import math

import pytest

from morphing_wing.units import KINDS, quantity

pytestmark = pytest.mark.quick


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("25 kPa", "pressure", 0.025),
        ("25kPa", "pressure", 0.025),
        ("-1e2 Pa", "pressure", -1e-4),
        ("0.3 bar", "pressure", 0.03),
        ("4 psi", "pressure", 4 * 0.006894757293168361),
        ("0.1 N/mm^2", "pressure", 0.1),
        ("1.2 mm", "length", 1.2),
        (".12 cm", "length", 1.2),
        ("1e-3 m", "length", 1.0),
        ("200 mN", "force", 0.2),
        ("5 N mm", "torque", 5.0),
        ("5 N*mm", "torque", 5.0),
        ("0.005 N m", "torque", 5.0),
        ("70 deg", "angle", 70.0),
        ("70°", "angle", 70.0),
        (f"{math.pi} rad", "angle", 180.0),
        ("50 N/mm^3", "stiffness per area", 50.0),
        ("50 MPa/mm", "stiffness per area", 50.0),
        ("1080 kg/m^3", "density", 1080.0),
        ("1.08 g/cm^3", "density", 1080.0),
    ],
)
def test_text_becomes_the_packages_unit(text, kind, value):
    assert quantity(text, kind) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_the_example_in_a_refusal_is_accepted_itself(kind):
    with pytest.raises(ValueError, match="must be an? ") as refusal:
        quantity(1.0, kind)
    assert quantity(str(refusal.value).split('"')[1], kind) > 0.0


@pytest.mark.parametrize(
    "text",
    ["5", 5, 5.0, True, None, "", "mm", "5 foo", "5 kPa", "5 mm mm", "1 + 4 mm", "5 mm; 6", "5 _mm",
     "5 5 mm", "5 mm.real", "(5) mm", "5 mm\n6 mm", "5 degC", "0x5 mm", ["5 mm"], {"mm": 5}],
)  # fmt: skip
def test_what_is_no_length_is_refused(text):
    with pytest.raises(ValueError, match="must be a length as text with its unit"):
        quantity(text, "length")


@pytest.mark.parametrize("text", ["nan mm", "inf mm", "-inf mm", "1e400 mm", "1e300 Ym"])
def test_a_length_that_is_not_finite_is_refused(text):
    with pytest.raises(ValueError, match="must be a finite length"):
        quantity(text, "length")
