"""The pantographic rib of the paper's Section 3.2 as a frame of shafts and pivots.

x is chordwise, y is the height, z is spanwise, along the pivots. Bars incline by
beta = alpha/2 to x; joints are T_i = (i p, h/2), B_i = (i p, -h/2), i = 0..n, and bars cross in
C_i = ((i - 1/2) p, 0), i = 1..n, with the pitch p = l_rs cos(beta) and height h = l_rs sin(beta).
The layer z = 0 has bars B_(i-1) T_i, the layers z = -s and z = s have T_(i-1) B_i; the mirror
cancels out-of-plane distortion. Cylindrical pivots join the layers: blue ones at T_i and B_i,
i = 1..n-1, black ones at C_i. The pantograph that the paper calls legacy is two of these layers,
one of each kind, moved to z = -s/2 and z = s/2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from morphing_wing.errors import is_count, is_number, require

from .frame import Frame, local_axes
from .section import Circle, Rectangle, Section, Stiffened

KINDS = ("shaft", "boss", "pivot", "centre_pivot", "socket", "arm", "root", "tail")
SECTIONS = ("flush", "square")
HALF = (0, 1)
"""The layers of a half rib, z > 0."""

LAYERS = {2: (0, 1), 3: (-1, 0, 1)}
"""Of each number of layers, which there are: layer 0 rises along x, the others fall."""


@dataclass(frozen=True)
class RibGeometry:
    """Dimensions of a pantographic rib (paper: Section 3.2, Figure 4; symbols below).

    Attributes
    ----------
    shaft_length
        Length of a bar between its two outer pivots, l_rs, mm.
    shaft_thickness
        Thickness of a bar, T_rs, mm.
    pivot_diameter
        Diameter of the cylinders, D_cs, mm.
    pivot_length
        Length of a cylinder between two layers, l_cs, mm.
    crossing_angle
        Angle between crossing bars that opens along x, alpha, degrees.
    n_cells
        Number of crossings along the chord, n.
    section
        How the paper's missing figure is read. ``"flush"``: bars are T_rs deep along z and as
        wide as the cylinders, l_cs from midplane to midplane. ``"square"``: bars are T_rs x T_rs,
        l_cs from face to face. The first fits the paper's Table 3 better.
    bosses
        Where cylinders are wider than the bars (only ``"square"``): True: they run through them,
        and there a bar is as wide as the cylinder; False: they end at the bars' faces. See the
        README's trade for how frames compare with solids of either kind.
    layers
        3: the paper's rib, its own mirror image in z = 0. 2: one rising and one falling layer, as
        pantographs had before, with the pivots of one gap; z = 0 lies midway between them, so
        that root and tail stay at the centre of the section and loads there have no lever.
    """

    shaft_length: float
    shaft_thickness: float
    pivot_diameter: float
    pivot_length: float
    crossing_angle: float
    n_cells: int
    section: str = "flush"
    bosses: bool = False
    layers: int = 3

    def __post_init__(self) -> None:
        """Refuse what cannot be built."""
        for field in fields(self)[:4]:
            value = getattr(self, field.name)
            ok = is_number(value) and value > 0
            require(ok, field.name, value, "mm", "a finite length greater than 0 mm")
        angle, n = self.crossing_angle, self.n_cells
        require(is_number(angle) and 0 < angle < 180.0, "crossing_angle", angle, "degrees",
                "between 0 and 180 degrees, both excluded")  # fmt: skip
        require(is_count(n), "n_cells", n, "", "a whole number of at least 1")
        require(self.section in SECTIONS, "section", self.section, "", "'flush' or 'square'")
        require(isinstance(self.bosses, bool), "bosses", self.bosses, "", "True or False")
        require(is_count(self.layers) and self.layers in LAYERS, "layers", self.layers, "",
                "2 or 3")  # fmt: skip
        room = min(self.shaft_length / 2.0, self.height, self.pitch)
        require(self.pivot_diameter < room, "pivot_diameter", self.pivot_diameter, "mm",
                f"less than {room:.4g} mm, or neighbouring pivots overlap")  # fmt: skip
        deep = self.section == "flush" and self.shaft_thickness >= self.pivot_length
        require(not deep, "shaft_thickness", self.shaft_thickness, "mm",
                f"less than the layers' distance of {self.spacing:.4g} mm")  # fmt: skip

    @classmethod
    def validation(cls, section: str = "flush", bosses: bool = False) -> RibGeometry:
        """Return the set with which the paper validates its formulas (Section 3.3)."""
        return cls(6.5, 1.2, 1.5, 5.4, 90.0, 6, section, bosses)

    @classmethod
    def prototype(
        cls, n_cells: int = 17, section: str = "flush", bosses: bool = False
    ) -> RibGeometry:
        """Return the set of the paper's wing (Section 5.1); it does not state ``n_cells``."""
        return cls(4.0, 1.0, 1.5, 6.0, 70.0, n_cells, section, bosses)

    @property
    def pitch(self) -> float:
        """Chordwise distance of joints, p = l_rs cos(alpha/2), mm."""
        return self.shaft_length * math.cos(math.radians(self.crossing_angle) / 2.0)

    @property
    def height(self) -> float:
        """Height between lower and upper joints, h = l_rs sin(alpha/2), mm."""
        return self.shaft_length * math.sin(math.radians(self.crossing_angle) / 2.0)

    @property
    def length(self) -> float:
        """Chordwise length between root and tail, n p, mm."""
        return self.n_cells * self.pitch

    @property
    def spacing(self) -> float:
        """Distance s between midplanes of neighbouring layers, mm."""
        return self.pivot_length + (self.shaft_thickness if self.section == "square" else 0.0)

    @property
    def depth(self) -> float:
        """Depth of all layers along z, from face to face, mm."""
        return (self.layers - 1) * self.spacing + self.shaft_thickness

    @property
    def shaft_width(self) -> float:
        """In-plane width of a bar, mm."""
        return self.pivot_diameter if self.section == "flush" else self.shaft_thickness

    @property
    def runs_through(self) -> bool:
        """Whether cylinders go on through the bars: with bosses, or where bars are as wide."""
        return self.bosses or self.shaft_width > 0.999 * self.pivot_diameter

    @property
    def volume(self) -> float:
        """Volume of shafts and pivots in mm^3, without foot plate and tail block.

        Shafts count from pivot axis to pivot axis, pivots between the shafts' faces.
        """
        return self.frame().volume("shaft", "boss", "pivot", "centre_pivot")

    def frame(self) -> Frame:
        """Return the rib as a frame with one root and one tail point.

        Each bar is cut at its crossing. The half thickness of bar at either end of a pivot holds
        the cylinder, so there the pivot is a nearly rigid ``socket``. Where bosses are wider than
        the bar it has the width w_b of the same bending flexibility: w_b^-3 is the mean of w^-3
        over the circle's chords w that are wider than the bar.

        The joints of either end, one a layer, are held by nearly rigid ``arm`` bars, a foot plate
        and a tail block, which end in a short ``root`` or ``tail`` bar, so that the points
        (0, 0, 0) and (n p, 0, 0) each belong to one bar alone.
        """
        reach, width = self._boss()
        build = _Builder()
        layers = LAYERS[self.layers]
        for layer in layers:
            for i in range(1, self.n_cells + 1):
                start, end = self.bar_ends(layer, i)
                crossing = build.point(("C", i, layer), self.joint("C", i, layer))
                for key in (start, end):
                    joint = build.point((*key, layer), self.joint(*key, layer))
                    build.line(joint, crossing, "shaft", "boss", reach)
        for name, count in (("T", self.n_cells), ("B", self.n_cells), ("C", self.n_cells + 1)):
            for i in range(1, count):
                for layer in layers:
                    if layer == 0:
                        continue
                    pair = [build.keys[name, i, 0], build.keys[name, i, layer]]
                    kind = "centre_pivot" if name == "C" else "pivot"
                    build.line(*pair, kind, "socket", self.shaft_thickness / 2.0)
        inset = 0.1 * self.shaft_length
        root = self._block(build, "root", 0.0, inset)
        tail = self._block(build, "tail", self.length, -inset)
        points, bars = np.array(build.points), np.array(build.bars)
        return Frame(
            points=points,
            bars=bars,
            kinds=np.array([KINDS.index(kind) for kind in build.kinds]),
            names=KINDS,
            axes=local_axes(points, bars),
            sections=(self._sections(width),),
            ribs=np.zeros(len(bars), dtype=int),
            roots=np.array([root]),
            tails=np.array([tail]),
        )

    def _block(self, build: _Builder, kind: str, x: float, inset: float) -> int:
        """Add the arms of one end, which meet beside the end point; return that point."""
        hub = build.point((kind, "hub"), (x + inset, 0.0, 0.0))
        i = 1 if kind == "root" else self.n_cells
        for layer in LAYERS[self.layers]:
            key = self.bar_ends(layer, i)[0 if kind == "root" else 1]
            build.bar(build.keys[(*key, layer)], hub, "arm")
        end = build.point((kind, "end"), (x, 0.0, 0.0))
        build.bar(hub, end, kind)
        return end

    @staticmethod
    def bar_ends(layer: int, i: int) -> tuple[tuple[str, int], tuple[str, int]]:
        """Return the joints of bar i: it rises in layer 0 and falls in the others."""
        return (("B", i - 1), ("T", i)) if layer == 0 else (("T", i - 1), ("B", i))

    def joint(self, name: str, i: int, layer: int = 0) -> tuple[float, float, float]:
        """Return where a joint T_i, B_i or C_i is in a layer (-1, 0, 1), in mm."""
        y = {"T": 0.5, "B": -0.5, "C": 0.0}[name] * self.height
        x = (i - 0.5 if name == "C" else i) * self.pitch
        middle = 0.5 if self.layers == 2 else 0.0
        return x, y, (layer - middle) * self.spacing

    def _boss(self) -> tuple[float, float]:
        """Return how far from its axis a cylinder is wider than the bar, and the width w_b."""
        R, half = self.pivot_diameter / 2.0, self.shaft_width / 2.0
        if R <= half or not self.bosses:
            return 0.0, self.shaft_width
        reach = math.sqrt(R**2 - half**2)
        # The mean of (R^2 - x^2)^(-3/2) over 0 < x < b is 1/(R^2 sqrt(R^2 - b^2)).
        return reach, 2.0 * (R**2 * half) ** (1.0 / 3.0)

    def _sections(self, boss_width: float) -> dict[str, Section]:
        pivot, depth = Circle(self.pivot_diameter), self.shaft_thickness
        stiff = Stiffened(pivot)
        return {
            "shaft": Rectangle(self.shaft_width, depth), "boss": Rectangle(boss_width, depth),
            "pivot": pivot, "centre_pivot": pivot,
            "socket": stiff, "arm": stiff, "root": stiff, "tail": stiff,
        }  # fmt: skip


class _Builder:
    """Points by key, bars by kind."""

    def __init__(self) -> None:
        self.points: list[tuple[float, ...]] = []
        self.keys: dict[tuple, int] = {}
        self.bars: list[tuple[int, int]] = []
        self.kinds: list[str] = []

    def point(self, key: tuple, x: tuple[float, ...]) -> int:
        if key not in self.keys:
            self.keys[key] = len(self.points)
            self.points.append(x)
        return self.keys[key]

    def bar(self, a: int, b: int, kind: str) -> None:
        self.bars.append((a, b))
        self.kinds.append(kind)

    def line(self, a: int, b: int, kind: str, end_kind: str, reach: float) -> None:
        """Add a bar; where ``reach`` > 0, its first and last ``reach`` mm are of ``end_kind``."""
        if reach == 0.0:
            return self.bar(a, b, kind)
        x, y = np.array(self.points[a]), np.array(self.points[b])
        step = reach / np.linalg.norm(y - x) * (y - x)
        inner = [len(self.points), len(self.points) + 1]
        self.points += [tuple(x + step), tuple(y - step)]
        self.bar(a, inner[0], end_kind)
        self.bar(inner[0], inner[1], kind)
        return self.bar(inner[1], b, end_kind)
