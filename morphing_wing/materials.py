"""Materials: the silicone of the spar and skin, the resin of the ribs.

``DRAGON_SKIN_30`` and ``RESIN`` carry the paper's constants; moduli are in MPa.
"""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass

import numpy as np

from morphing_wing.errors import InputError, is_number, require

__all__ = [
    "DRAGON_SKIN_30", "FRACTURE_STRETCH", "RESIN", "YIELD_MPA", "Adhesive", "Elastic", "Yeoh",
]

BULK_PER_SHEAR = 1000.0
"""Default bulk over initial shear modulus: nearly incompressible (Poisson's ratio 0.4995)."""


@dataclass(frozen=True)
class Yeoh:
    r"""Rubber after Yeoh: a polynomial in the first invariant, with any number of terms.

    .. math:: W = \sum_{i=1}^{n} C_{i0} (\bar I_1 - 3)^i + \frac{\kappa}{2} (J - 1)^2,
        \qquad \bar I_1 = J^{-2/3} \mathrm{tr}(F^T F)

    (Yeoh 1993). Higher coefficients may be negative, as the paper's second one is; the law then
    softens and stops being stable at a large stretch.

    Parameters
    ----------
    coefficients
        C10, C20, ... in MPa; the first must be positive, for the initial shear modulus is 2 C10.
    bulk
        Bulk modulus kappa in MPa; None: 1000 times the initial shear modulus; math.inf: exactly
        incompressible, which elements without a pressure of their own refuse.
    density
        In kg/m^3, greater than 0; matters to gravity and modes. Dragon Skin 30's unless given.

    Examples
    --------
    >>> Yeoh((0.117, -0.0006865)).shear_modulus
    0.234
    """

    coefficients: tuple[float, ...]
    bulk: float | None = None
    density: float = 1080.0

    def __post_init__(self) -> None:
        """Check the constants and fill in the default bulk modulus."""
        given = self.coefficients
        if isinstance(given, numbers.Real):
            given = (given,)
        is_sequence = hasattr(given, "__iter__") and not isinstance(given, str)
        given = tuple(given) if is_sequence else given
        require(
            is_sequence and len(given) > 0 and all(map(is_number, given)),
            "coefficients", given, "MPa", "one or more finite numbers C10, C20, ... in MPa",
        )  # fmt: skip
        coefficients = tuple(float(c) for c in given)
        shear = 2.0 * coefficients[0]
        require(shear > 0, "initial shear modulus 2 C10", shear, "MPa", "greater than 0 MPa")
        bulk = BULK_PER_SHEAR * shear if self.bulk is None else self.bulk
        if bulk != math.inf:
            require(is_number(bulk) and bulk > 0, "bulk", bulk, "MPa",
                    "greater than 0 MPa (math.inf: incompressible)")
        object.__setattr__(self, "coefficients", coefficients)
        object.__setattr__(self, "bulk", float(bulk))
        _check_density(self)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at zero strain, mu = 2 C10, in MPa."""
        return 2.0 * self.coefficients[0]

    def stability(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        r"""Return how stable the incompressible law is where two principal stretches are such.

        The smaller eigenvalue of the Hessian of :math:`W(\lambda_1, \lambda_2)`, whose gradient
        are the nominal stresses, over its value 4 C10 at rest: 1 there, 0 where under given forces
        it gives way. That is the largest force in uniaxial and in equibiaxial tension (for the
        paper's constants at stretches of 5.456 and 3.837), and shortly before it in planar tension.

        Parameters
        ----------
        first, second
            Principal stretches, the third is 1 over their product; of one shape.

        Returns
        -------
        Array of that shape, without unit.
        """
        a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
        excess = a**2 + b**2 + (a * b) ** -2 - 3.0
        slope = sum(i * C * excess ** (i - 1) for i, C in enumerate(self.coefficients, start=1))
        curvature = sum(i * (i - 1) * C * excess ** (i - 2)
                        for i, C in enumerate(self.coefficients[1:], start=2))
        by_a, by_b = 2 * (a - a**-3 * b**-2), 2 * (b - b**-3 * a**-2)
        aa = slope * (2 + 6 * a**-4 * b**-2) + curvature * by_a**2
        bb = slope * (2 + 6 * b**-4 * a**-2) + curvature * by_b**2
        ab = slope * 4 * (a * b) ** -3 + curvature * by_a * by_b
        smaller = 0.5 * (aa + bb) - np.hypot(0.5 * (aa - bb), ab)
        return smaller / (4.0 * self.coefficients[0])


@dataclass(frozen=True)
class Elastic:
    r"""Isotropic resin, by Young's modulus and Poisson's ratio.

    .. math:: G = \frac{E}{2 (1 + \nu)}, \qquad \lambda = \frac{E \nu}{(1 + \nu)(1 - 2 \nu)}

    The paper gives E = 2370 to 2640 MPa for its resin, which yields at 35 MPa.

    Parameters
    ----------
    E
        Young's modulus in MPa, greater than 0.
    nu
        Poisson's ratio, between -1 and 0.5, both excluded.
    density
        In kg/m^3, greater than 0; matters to gravity and modes. A printed resin's unless given.

    Examples
    --------
    >>> round(Elastic(E=2500.0, nu=0.35).shear_modulus, 1)
    925.9
    """

    E: float
    nu: float
    density: float = 1180.0

    def __post_init__(self) -> None:
        """Check both constants."""
        require(is_number(self.E) and self.E > 0, "E", self.E, "MPa", "greater than 0 MPa")
        require(
            is_number(self.nu) and -1.0 < self.nu < 0.5,
            "nu", self.nu, "", "greater than -1 and less than 0.5",
        )  # fmt: skip
        object.__setattr__(self, "E", float(self.E))
        object.__setattr__(self, "nu", float(self.nu))
        _check_density(self)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G in MPa."""
        return self.E / (2.0 * (1.0 + self.nu))

    @property
    def lame_modulus(self) -> float:
        """Lame's first modulus lambda in MPa."""
        return self.E * self.nu / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu))


@dataclass(frozen=True)
class Adhesive:
    """Glue, by traction against separation; see `morphing_wing.forms.adhesive`.

    Parameters
    ----------
    stiffness
        Traction per opening in N/mm^3, greater than 0; perfect glue is the limit of large values.
    strength
        Largest traction in MPa that a pull reaches; None: the glue is elastic and never fails.
    toughness
        Fracture energy in N/mm (1 N/mm is 1000 J/m^2); given with ``strength``.
    shear_strength
        Largest traction in MPa along the face; None: that of a pull.
    """

    stiffness: float
    strength: float | None = None
    toughness: float | None = None
    shear_strength: float | None = None

    def __post_init__(self) -> None:
        """Check all constants."""
        given = {"stiffness": "N/mm^3", "strength": "MPa", "toughness": "N/mm",
                 "shear_strength": "MPa"}
        for name, unit in given.items():
            value = getattr(self, name)
            if value is not None or name == "stiffness":
                require(is_number(value) and value > 0, name, value, unit, f"greater than 0 {unit}")
        if self.strength is None:
            for name in ("toughness", "shear_strength"):
                if getattr(self, name) is not None:
                    raise InputError(f"{name}: is given without strength, must stand with it")
        elif self.toughness is None:
            raise InputError("toughness: is missing, must be given with strength")
        if self.fails:
            require(self.last > 1.0, "toughness", self.toughness, "N/mm",
                    f"more than {self.onset:.4g} N/mm, what is stored when the strength is reached")

    @property
    def fails(self) -> bool:
        """Whether the glue can fail."""
        return self.strength is not None

    @property
    def shear_stiffness(self) -> float:
        """Traction per sliding k_t in N/mm^3."""
        if self.strength is None or self.shear_strength is None:
            return self.stiffness
        return self.stiffness * (self.shear_strength / self.strength) ** 2

    @property
    def onset(self) -> float:
        """Energy e_0 in N/mm stored where the strength is reached."""
        assert self.strength is not None
        return self.strength**2 / (2.0 * self.stiffness)

    @property
    def last(self) -> float:
        """The lambda_f at which the glue has let go."""
        assert self.toughness is not None
        return self.toughness / self.onset


def _check_density(material: Yeoh | Elastic) -> None:
    value = material.density
    require(is_number(value) and value > 0, "density", value, "kg/m^3", "greater than 0 kg/m^3")
    object.__setattr__(material, "density", float(value))


DRAGON_SKIN_30 = Yeoh((0.117, -0.0006865))
"""Dragon Skin 30 silicone, the paper's fit: C10 = 0.117, C20 = -0.0006865 MPa; 1080 kg/m^3."""

FRACTURE_STRETCH = 4.64
"""The paper's silicone tears at 364 % strain."""

RESIN = Elastic(E=2500.0, nu=0.35)
"""The ribs' printed resin: the middle of the paper's 2370 to 2640 MPa; 1180 kg/m^3."""

YIELD_MPA = 35.0
"""The paper's resin yields at this stress."""
