"""The cuboid pneumatic spar of the paper's Section 3: two rows of chambers, one middle layer."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from morphing_wing.errors import is_count, is_number, require

from .hexmesh import HexMesh, breakpoints, geometric, swept_blocks, two_sided, uniform


@dataclass(frozen=True)
class SparMeshing:
    """Intervals of each piece of the spar, as breakpoints in [0, 1].

    Attributes
    ----------
    cavity_length, wall_length : (n,) arrays
        Along the span, within one chamber and one wall between chambers.
    cavity_width, side_thickness : (n,) arrays
        Along x: half a chamber from the symmetry plane to the side wall, and the side wall.
    top_thickness, cavity_height, middle_thickness : (n,) arrays
        Along y.
    """

    cavity_length: np.ndarray
    wall_length: np.ndarray
    cavity_width: np.ndarray
    side_thickness: np.ndarray
    top_thickness: np.ndarray
    cavity_height: np.ndarray
    middle_thickness: np.ndarray

    @classmethod
    def plain(cls) -> SparMeshing:
        """Return the mesh on which other codes' figures are known: 1228 cells for 20 chambers."""
        return cls(
            cavity_length=uniform(2),
            wall_length=uniform(1),
            cavity_width=geometric(3, 0.5),
            side_thickness=uniform(1),
            top_thickness=uniform(1),
            cavity_height=uniform(2),
            middle_thickness=uniform(1),
        )

    @classmethod
    def graded(cls, level: int = 1) -> SparMeshing:
        """Return a mesh graded towards the re-entrant chamber corners, along span and height."""
        return cls(
            cavity_length=two_sided(2 * level + 2, 3.0),
            wall_length=two_sided(2 * level, 3.0),
            cavity_width=geometric(2 + level, 0.5),
            side_thickness=uniform(level),
            top_thickness=uniform(level),
            cavity_height=two_sided(level + 2, 4.0),
            middle_thickness=uniform(level),
        )

    @classmethod
    def cornered(cls, level: int = 1) -> SparMeshing:
        """Return a mesh graded towards the chamber corners from all sides of the solid."""
        return cls(
            cavity_length=two_sided(2 * level + 2, 3.0),
            wall_length=two_sided(2 * level + 2, 3.0),
            cavity_width=geometric(2 * level + 2, 0.5),
            side_thickness=uniform(level),
            top_thickness=uniform(2 * level),
            cavity_height=two_sided(2 * level + 4, 3.0),
            middle_thickness=two_sided(2 * level + 2, 3.0),
        )

    def shortened(self, longest: float) -> SparMeshing:
        """Return the meshing with no interval along a chamber longer than this part of it."""
        lengths = np.diff(self.cavity_length)
        parts = np.ceil(lengths / longest - 1e-9).astype(int)
        steps = np.repeat(lengths / parts, parts)
        return replace(self, cavity_length=np.concatenate([[0.0], np.cumsum(steps)]))

    def split(self, parts: int) -> SparMeshing:
        """Return the meshing with each interval in equal parts: its uniform refinement."""
        return SparMeshing(*(
            np.interp(np.arange(parts * (len(line) - 1) + 1) / parts, np.arange(len(line)), line)
            for line in (getattr(self, field.name) for field in fields(self))))


@dataclass(frozen=True)
class SparGeometry:
    """Dimensions of the cuboid spar in mm (paper: Section 3.1, Figure 3).

    Attributes
    ----------
    cavity_length
        Length of a chamber along the span, l_c.
    wall_length
        Thickness of the wall between two chambers, l_s1; also of both end walls.
    top_thickness
        Thickness of the top and of the bottom wall, h_t.
    cavity_height
        Height of a chamber, h_c.
    middle_thickness
        Thickness of the layer between the two rows, h_m.
    side_thickness
        Thickness of the walls along the span, w_s2.
    cavity_width
        Chordwise width of a chamber, w_c.
    n_cells
        Number of chambers in each of the two rows, N.
    wall_lengths
        Thickness of each wall across the span, N + 1 from root to tip, where they differ; None:
        all are ``wall_length``.
    """

    cavity_length: float
    wall_length: float
    top_thickness: float
    cavity_height: float
    middle_thickness: float
    side_thickness: float
    cavity_width: float
    n_cells: int
    wall_lengths: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be built."""
        for field in fields(self)[:-2]:
            value = getattr(self, field.name)
            ok = is_number(value) and value > 0
            require(ok, field.name, value, "mm", "a finite length greater than 0 mm")
        require(is_count(self.n_cells), "n_cells", self.n_cells, "", "a whole number of at least 1")
        given = self.wall_lengths
        if given is not None:
            given = tuple(given) if isinstance(given, (list, np.ndarray)) else given
            ok = isinstance(given, tuple) and len(given) == self.n_cells + 1 and all(
                is_number(wall) and wall > 0 for wall in given)
            require(ok, "wall_lengths", given, "mm",
                    f"n_cells + 1 = {self.n_cells + 1} finite lengths greater than 0 mm")
            object.__setattr__(self, "wall_lengths", tuple(map(float, given)))

    @classmethod
    def validation(cls, n_cells: int = 20) -> SparGeometry:
        """Return the set with which the paper validates its formulas (Section 3.3)."""
        return cls(
            cavity_length=2.8,
            wall_length=2.2,
            top_thickness=1.0,
            cavity_height=6.0,
            middle_thickness=2.8,
            side_thickness=1.2,
            cavity_width=40.0,
            n_cells=n_cells,
        )

    @property
    def pitch(self) -> float:
        """Length in mm of the cell that repeats where walls are alike: one chamber and one wall."""
        return self.cavity_length + self.wall_length

    @property
    def length(self) -> float:
        """Span in mm: every chamber with its walls, an end wall on both sides."""
        return self.n_cells * self.cavity_length + float(self.walls.sum())

    @property
    def walls(self) -> np.ndarray:
        """Thickness in mm of each wall across the span, shape (N + 1,), from root to tip."""
        if self.wall_lengths is None:
            return np.full(self.n_cells + 1, self.wall_length)
        return np.array(self.wall_lengths, dtype=float)

    @property
    def height(self) -> float:
        """Height in mm over all."""
        return 2 * (self.top_thickness + self.cavity_height) + self.middle_thickness

    @property
    def width(self) -> float:
        """Chordwise width in mm over all."""
        return self.cavity_width + 2 * self.side_thickness

    @property
    def volume(self) -> float:
        """Volume of the elastomer in mm^3, chambers left out."""
        chamber = self.cavity_length * self.cavity_height * self.cavity_width
        return self.length * self.height * self.width - 2 * self.n_cells * chamber

    def chamber_of(self, z: np.ndarray) -> np.ndarray:
        """Return the number, from 0 at the root, of the chamber at each place along the span."""
        ends = np.cumsum(self.walls[:-1] + self.cavity_length)
        return np.searchsorted(ends, z)

    def mesh(self, meshing: SparMeshing | None = None, half: bool = True) -> HexMesh:
        """Return swept hexahedra; x from the symmetry plane, y up from the middle, z from the root.

        Faces: ``root`` (z = 0), ``tip``, ``upper_chambers``, ``lower_chambers``, and ``symmetry``
        (x = 0) of the half model, which holds x >= 0.
        """
        parts = meshing or SparMeshing.graded()
        cavity = (self.cavity_length, parts.cavity_length)
        walls = [(wall, parts.wall_length) for wall in self.walls]
        along = breakpoints(walls[0], *(piece for wall in walls[1:] for piece in (cavity, wall)))
        return self._swept(parts, along, half, ("root", "tip"))

    def cell_mesh(self, meshing: SparMeshing | None = None) -> HexMesh:
        """Return a quarter of the cell that repeats: half as wide, and half as long.

        Faces as in `mesh`, but ``wall_middle`` (z = 0) and ``chamber_middle`` in place of root and
        tip.
        """
        parts = meshing or SparMeshing.graded()
        wall, cavity = parts.wall_length, parts.cavity_length
        along = breakpoints(
            (self.wall_length / 2, 1.0 - 2.0 * _first_half(1.0 - wall[::-1])[::-1]),
            (self.cavity_length / 2, 2.0 * _first_half(cavity)))
        return self._swept(parts, along, True, ("wall_middle", "chamber_middle"))

    def _swept(
        self,
        parts: SparMeshing,
        along: tuple[np.ndarray, np.ndarray],
        half: bool,
        ends: tuple[str, str],
    ) -> HexMesh:
        """Return the mesh of breakpoints along the span, whose odd pieces have chambers."""
        x, x_piece = breakpoints(
            (self.cavity_width / 2, parts.cavity_width), (self.side_thickness, parts.side_thickness)
        )
        inside_x = x_piece == 0
        if not half:
            x = np.concatenate([-x[:0:-1], x])
            inside_x = np.concatenate([inside_x[::-1], inside_x])
        y, y_piece = breakpoints(
            (self.top_thickness, parts.top_thickness),
            (self.cavity_height, parts.cavity_height),
            (self.middle_thickness, parts.middle_thickness),
            (self.cavity_height, parts.cavity_height),
            (self.top_thickness, parts.top_thickness),
        )
        z, z_piece = along
        kind = np.ones((len(inside_x), len(y_piece), len(z_piece)), dtype=int)
        for row, value in ((3, -1), (1, -2)):
            kind[np.ix_(inside_x, y_piece == row, z_piece % 2 == 1)] = value
        names = {1: "elastomer", -1: "upper_chambers", -2: "lower_chambers"}

        def faces(midpoints: np.ndarray, normals: np.ndarray) -> dict[str, np.ndarray]:
            named = {ends[0]: normals[:, 2] < 0, ends[1]: normals[:, 2] > 0}
            if half:
                named["symmetry"] = (normals[:, 0] < 0) & (np.abs(midpoints[:, 0]) < 1e-9)
            return named

        return swept_blocks((x, y - self.height / 2, z), kind, names, faces=faces)


def _first_half(line: np.ndarray) -> np.ndarray:
    """Return the breakpoints up to one half, which becomes one if it was none."""
    return np.append(line[line < 0.5 - 1e-9], 0.5)
