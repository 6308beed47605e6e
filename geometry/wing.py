"""The wing of the paper's Section 5.1: aerofoil-shaped pneumatic spar, ribs, skin, cables."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace

import numpy as np

from morphing_wing.errors import InputError, is_count, is_number, require

from .aerofoil import Aerofoil
from .rib import RibGeometry

_LENGTHS = ("chord", "cavity_length", "wall_length", "top_thickness", "middle_thickness",
            "side_thickness", "nose_length", "skin_thickness", "foot_height", "foot_width",
            "tail_bond_length")
# How the skin may be built, defaults first.
_OPTIONS = {
    "skin_root": ("clamped", "free"),
    "tip_wall": (False, True),
    "skin_over_spar": (False, True),
    "skin_slit": ("none", "lower", "trailing_edge"),
}


@dataclass(frozen=True)
class WingGeometry:
    """Dimensions of the wing in mm (paper: Section 5.1; its symbols below).

    Attributes
    ----------
    chord
        Chord length; the paper is silent, 150 mm makes the chambers about 6 mm high.
    aerofoil
        NACA four digits.
    spar_fraction
        Part of the chord that the spar takes, from the leading edge.
    n_cells
        Chambers in each row, N.
    cavity_length, wall_length
        Chamber and wall along the span, l_c and l_s; both end walls are ``wall_length`` thick.
    top_thickness, middle_thickness
        Walls above and below the chambers, h_t, and layer between the rows.
    side_thickness
        Rear wall, w_s2.
    nose_length
        Solid nose in front of the chambers.
    skin_thickness
        Skin around the trailing edge's pocket; None: no skin. It is as long as the spar, closed
        where its two sides meet, open at the tip.
    skin_root
        Whether the skin's edge at the root, behind the spar, is "clamped" with the root section
        or "free".
    tip_wall
        Whether an elastomer wall, as thick as the end walls, closes the pocket's tip. It ends
        where the pocket is only as high as the skin is thick.
    skin_over_spar
        Whether the skin also lies over the spar: the chambers are lower by its thickness.
    skin_slit
        "none"; "lower": the lower skin is cut along the span right behind the spar, up to a tip
        wall; "trailing_edge": its two sides are not joined behind the pocket. Limits of a skin
        that is slack or not bonded; the sides of a slit do not feel each other.
    skin_prestretch
        Stretches along the chord (x) and the span (z) with which the skin behind the spar is
        built in, 1 or more. Where nothing holds it, it contracts.
    rib
        Pantographic rib; None: no ribs.
    rib_positions
        Where each rib stands, as a part of the span.
    foot_height, foot_width
        Foot plate of each rib on the spar's rear wall, along y and z. None: as high and as wide
        as the rib.
    tail_bond_length
        Chordwise length of the rigid tail block that is glued to both skins behind the rib's end.
    glue_stiffness
        Traction per separation of the glue in N/mm^3.
    cable_guide
        From a rib's tail to the guide of its cable (dx, dy, dz).
    """

    chord: float = 150.0
    aerofoil: str = "0012"
    spar_fraction: float = 0.5
    n_cells: int = 18
    cavity_length: float = 5.0
    wall_length: float = 2.0
    top_thickness: float = 2.0
    middle_thickness: float = 1.5
    side_thickness: float = 2.0
    nose_length: float = 5.0
    skin_thickness: float | None = 1.0
    skin_root: str = "clamped"
    tip_wall: bool = False
    skin_over_spar: bool = False
    skin_slit: str = "none"
    skin_prestretch: tuple[float, float] = (1.0, 1.0)
    rib: RibGeometry | None = field(
        default_factory=lambda: RibGeometry.prototype(section="square", bosses=True)
    )
    rib_positions: tuple[float, ...] = (1 / 6, 1 / 2, 5 / 6)
    foot_height: float | None = None
    foot_width: float | None = None
    tail_bond_length: float = 6.0
    glue_stiffness: float = 50.0
    cable_guide: tuple[float, float, float] = (0.0, -100.0, 0.0)

    def __post_init__(self) -> None:
        """Refuse what cannot be built."""
        names = {f.name for f in fields(self)}
        for name in names & set(_LENGTHS):
            value = getattr(self, name)
            if value is None and name.startswith(("foot_", "skin_")):
                continue
            require(is_number(value) and value > 0, name, value, "mm", "greater than 0 mm")
        require(is_count(self.n_cells), "n_cells", self.n_cells, "", "a whole number of at least 1")
        ok = is_number(self.spar_fraction) and 0.1 <= self.spar_fraction <= 0.9
        require(ok, "spar_fraction", self.spar_fraction, "", "between 0.1 and 0.9")
        ok = is_number(self.glue_stiffness) and self.glue_stiffness > 0
        require(ok, "glue_stiffness", self.glue_stiffness, "N/mm^3", "greater than 0 N/mm^3")
        self._check_options()
        self._check_chambers()
        if self.skin_thickness is not None:
            self._check_skin()
        if self.rib is not None:
            self._check_ribs(self.rib)

    @classmethod
    def prototype(cls, **changes: object) -> WingGeometry:
        """Return the paper's prototype (Section 5.1), with changes."""
        return cls(**changes)  # type: ignore[arg-type]

    @property
    def section(self) -> Aerofoil:
        """The aerofoil at its chord."""
        return Aerofoil(self.aerofoil, self.chord)

    @property
    def span(self) -> float:
        """Span in mm: every chamber with its walls, an end wall on both sides."""
        return self.n_cells * (self.cavity_length + self.wall_length) + self.wall_length

    @property
    def spar_end(self) -> float:
        """Chordwise end of the spar in mm: where ribs are glued."""
        return self.spar_fraction * self.chord

    @property
    def cavity_end(self) -> float:
        """Chordwise end of the chambers in mm."""
        return self.spar_end - self.side_thickness

    @property
    def outer_wall(self) -> float:
        """Thickness in mm between a chamber and the outer contour: top wall, skin where there."""
        return self.top_thickness + (self.skin_thickness if self.skin_over_spar else 0.0)

    @property
    def is_prestretched(self) -> bool:
        """Whether the skin is built in stretched."""
        return tuple(self.skin_prestretch) != (1.0, 1.0)

    @property
    def pocket_end(self) -> float:
        """Chordwise place in mm where the two sides of the skin meet."""
        if self.skin_thickness is None:
            raise InputError("skin_thickness = None: must be a length for a pocket to end")
        return self.section.x_where_half_thickness(self.skin_thickness, front=False)

    @property
    def tip_wall_end(self) -> float:
        """Chordwise end of a tip wall in mm: from there the pocket is lower than the skin."""
        assert self.skin_thickness is not None
        return self.section.x_where_half_thickness(1.5 * self.skin_thickness, front=False)

    def without_skin(self) -> WingGeometry:
        """Return the same wing without a skin and what goes with it."""
        defaults = {name: allowed[0] for name, allowed in _OPTIONS.items()}
        return replace(self, skin_thickness=None, skin_prestretch=(1.0, 1.0), **defaults)

    def rib_roots(self) -> np.ndarray:
        """Return the root of each rib, shape (n_ribs, 3), mm."""
        y = float(self.section.camber(self.spar_end))
        return np.array([(self.spar_end, y, part * self.span) for part in self.rib_positions])

    def foot(self) -> tuple[float, float]:
        """Return height and width in mm of a rib's foot plate."""
        assert self.rib is not None
        height = self.foot_height or self.rib.height + self.rib.shaft_width
        width = self.foot_width or self.rib.depth
        return height, width

    def _check_chambers(self) -> None:
        section, half = self.section, self.middle_thickness / 2.0
        ok = self.nose_length < self.cavity_end - 1.0
        require(ok, "nose_length", self.nose_length, "mm",
                f"less than {self.cavity_end - 1.0:.4g} mm, or no chamber fits in the spar")
        ends = np.array([self.nose_length, self.cavity_end])
        room = float(section.half_thickness(ends).min()) - half
        if room <= 0.2:
            raise InputError(
                f"chord = {self.chord:g} mm with aerofoil {self.aerofoil}: must be thicker at both "
                "ends of the chambers, or they are taller than the aerofoil"
            )
        room -= 0.1 + self.outer_wall - self.top_thickness
        require(self.top_thickness < room, "top_thickness", self.top_thickness, "mm",
                f"less than {room:.4g} mm, or the chambers are taller than the aerofoil")

    def _check_options(self) -> None:
        for name, allowed in _OPTIONS.items():
            value, default = getattr(self, name), allowed[0]
            ok = type(value) is type(default) and value in allowed
            require(ok, name, value, "", " or ".join(map(repr, allowed)))
            ok = self.skin_thickness is not None or value == default
            require(ok, name, value, "", f"{default!r} in a wing without skin")
        given = self.skin_prestretch if isinstance(self.skin_prestretch, (tuple, list)) else ()
        ok = len(given) == 2 and all(is_number(s) and s >= 1.0 for s in given)
        require(ok, "skin_prestretch", self.skin_prestretch, "", "two stretches of 1 or more")
        ok = self.skin_thickness is not None or not self.is_prestretched
        require(ok, "skin_prestretch", given, "", "(1, 1) in a wing without skin")

    def _check_skin(self) -> None:
        value = self.skin_thickness
        require(value < self.outer_wall, "skin_thickness", value, "mm",
                f"greater than 0 mm and less than top_thickness = {self.top_thickness:g} mm")
        edge, front = (float(self.section.half_thickness(x)) for x in (self.chord, self.spar_end))
        require(edge < value, "skin_thickness", value, "mm",
                f"more than {edge:.4g} mm, half the trailing edge's thickness")
        ok = value < front and self.pocket_end > self.spar_end + 1.0
        require(ok, "skin_thickness", value, "mm", "so thin that a pocket remains behind the spar")
        ok = 1.5 * value < front and self.tip_wall_end > self.spar_end + 1.0
        require(ok or not self.tip_wall, "skin_thickness", value, "mm",
                "so thin that a tip wall fits in the pocket")

    def _check_ribs(self, rib: RibGeometry) -> None:
        places = self.rib_positions if isinstance(self.rib_positions, (tuple, list)) else ()
        ok = all(is_number(p) and 0 < p < 1 for p in places) and places
        require(bool(ok), "rib_positions", self.rib_positions, "",
                "one or more parts of the span between 0 and 1")
        height, _ = self.foot()
        wall = 2.0 * float(self.section.half_thickness(self.spar_end))
        require(height <= wall, "foot_height", height, "mm",
                f"at most the rear wall's height of {wall:.4g} mm")
        end = self.chord if self.skin_thickness is None else self.pocket_end
        room = end - self.spar_end
        require(rib.length < room, "rib.n_cells", rib.n_cells, "",
                f"at most {int(room / rib.pitch - 1e-9)}, or the rib is longer than the pocket "
                f"({rib.length:.4g} mm against {room:.4g} mm)")
        guide = self.cable_guide if isinstance(self.cable_guide, (tuple, list)) else ()
        bond = self.chord - self.spar_end - rib.length
        require(self.tail_bond_length <= bond, "tail_bond_length", self.tail_bond_length, "mm",
                f"at most {bond:.4g} mm, from the rib's end to the trailing edge")
        ok = len(guide) == 3 and all(is_number(c) for c in guide)
        require(bool(ok) and any(guide), "cable_guide", self.cable_guide, "mm",
                "three lengths, not all zero")

