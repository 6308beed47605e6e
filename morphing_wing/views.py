"""Views of a deformed structure: what is drawn, from where, and the images that come out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from morphing_wing.renderer import choose_renderer
from morphing_wing.tubes import tubes

if TYPE_CHECKING:
    import pyvista

__all__ = ["Drawing", "View", "default_drawing"]

# From where each kind of scene is seen (x chordwise, y up, z along the span): spar and wing from
# the front with the root at the left and the tip at the right, the rib from the tip's side.
_EYES = {"spar": (-1.0, 0.75, 0.55), "wing": (-0.55, 0.75, 1.0), "rib": (0.3, 0.45, 1.0)}
_OUTLINE = {"color": "#8d99a6", "line_width": 1.6, "opacity": 0.75, "lighting": False}
_EDGES = {"color": "#2d3640", "line_width": 1.3, "opacity": 0.85, "lighting": False}


@dataclass(frozen=True)
class Drawing:
    """How a scene wants to be drawn; a scene's ``drawing(state)`` may return one.

    Attributes
    ----------
    eye
        Direction from the structure to the viewer.
    mirror_x
        Plane x = constant (mm, undeformed) in which a half model is mirrored; None: whole model.
    section_x
        Where the cut along the span lies (mm, undeformed); None: the middle, or the mirror plane.
    radius
        Radius in mm of each function on intervals by name: one number, or one for each cell.
    cables
        Deformed polylines of the cables, each of shape (n, 3) in mm; needed on rank 0 only.
    colour_by
        ``"stretch"`` or ``"displacement"``; solids are coloured by it.
    """

    eye: tuple[float, float, float] = _EYES["spar"]
    mirror_x: float | None = None
    section_x: float | None = None
    radius: Mapping[str, float | np.ndarray] = field(default_factory=dict)
    cables: Sequence[np.ndarray] = ()
    colour_by: str = "stretch"


def default_drawing(scene: Any) -> Drawing:
    """Return the drawing of a scene that says nothing: by its name and its multiplicity."""
    mirror = 0.0 if getattr(scene, "multiplicity", 1) == 2 else None
    return Drawing(eye=_EYES.get(scene.name, _EYES["spar"]), mirror_x=mirror)


class View:
    """The grids of one state, ready to be drawn whole and cut. Rank 0 only.

    Parameters
    ----------
    grids
        From `morphing_wing.fields.scene_grids`.
    drawing
        How to draw them.
    """

    def __init__(self, grids: Mapping[str, pyvista.UnstructuredGrid], drawing: Drawing) -> None:
        self.drawing = drawing
        self.solids = [g for g in grids.values() if g.n_cells and g.GetCell(0).GetCellDimension() > 1]
        self.lines = {n: g for n, g in grids.items()
                      if g.n_cells and g.GetCell(0).GetCellDimension() == 1}
        forward = -np.array(drawing.eye, dtype=float)
        self.forward = forward / np.linalg.norm(forward)
        right = np.cross(self.forward, (0.0, 1.0, 0.0))
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.forward)
        self._wholes = [self._mirrored(grid) for grid in self.solids]

    def values(self) -> np.ndarray:
        """Return what the colours show, at the points of the solids (of the lines without any)."""
        if self.solids and self.drawing.colour_by == "stretch":
            return np.concatenate([grid.point_data["stretch"] for grid in self.solids])
        grids = self.solids or list(self.lines.values())
        return np.concatenate(
            [np.linalg.norm(grid.point_data["displacement"], axis=1) for grid in grids])

    @property
    def shows_stretch(self) -> bool:
        """Whether the colours show stretch (else displacement, mm)."""
        return bool(self.solids) and self.drawing.colour_by == "stretch"

    def section_x(self) -> float:
        """Return where the cut lies, mm in the undeformed structure."""
        if self.drawing.section_x is not None:
            return self.drawing.section_x
        if self.drawing.mirror_x is not None:
            return self.drawing.mirror_x
        x = np.concatenate([grid.points[:, 0] for grid in self.solids])
        return 0.5 * (x.min() + x.max())

    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Return lower and upper corner of all that is drawn, in the viewer's plane, mm."""
        clouds = [grid.points for grid in (*self._wholes, *self.lines.values())]
        clouds += [g.points + g.point_data["displacement"]
                   for g in (*self._wholes, *self.lines.values())]
        flat = np.concatenate(clouds) @ np.stack([self.right, self.up], axis=1)
        return flat.min(axis=0), flat.max(axis=0)

    def image(
        self, size: tuple[int, int], scale: float, colours: dict[str, Any], cut: bool = False,
        centre: np.ndarray | None = None, outline: bool = True,
    ) -> np.ndarray:
        """Draw, and return the picture as an array of shape (height, width, 3).

        Parameters
        ----------
        size
            Width and height in pixels.
        scale
            mm per pixel.
        colours
            ``cmap`` and ``clim`` for pyvista.
        cut
            Take away what lies before the cut along the span, so that chambers show.
        centre
            Centre of the picture in the viewer's plane, mm.
        outline
            Whether to draw the edges of the undeformed structure.
        """
        choose_renderer()
        import pyvista

        plotter = pyvista.Plotter(off_screen=True, window_size=size)
        plotter.set_background("white")
        for grid in self._wholes:
            self._add_solid(plotter, self._cut(grid) if cut else grid, colours, cut)
            if outline:
                plotter.add_mesh(_edges(_surface(grid, deformed=False, subdivision=0)), **_OUTLINE)
        if not cut:
            for name, grid in self.lines.items():
                self._add_lines(plotter, name, grid, colours)
            for cable in self.drawing.cables:
                plotter.add_mesh(pyvista.lines_from_points(np.asarray(cable, dtype=float)),
                                 color="black", line_width=2.0)
        if centre is None:
            centre = 0.5 * np.sum(self.extent(), axis=0)
        focus = centre[0] * self.right + centre[1] * self.up
        focus = focus + self.forward * (self._middle() @ self.forward)
        reach = 10.0 * scale * max(size)
        plotter.camera.position = focus - reach * self.forward
        plotter.camera.focal_point = focus
        plotter.camera.up = self.up
        plotter.camera.parallel_projection = True
        plotter.camera.parallel_scale = 0.5 * size[1] * scale
        plotter.reset_camera_clipping_range()
        plotter.enable_anti_aliasing("ssaa")
        picture = plotter.screenshot(return_img=True)
        plotter.close()
        return picture

    def _middle(self) -> np.ndarray:
        points = np.concatenate([g.points for g in (*self._wholes, *self.lines.values())])
        return 0.5 * (points.min(axis=0) + points.max(axis=0))

    def _mirrored(self, grid: pyvista.UnstructuredGrid) -> pyvista.UnstructuredGrid:
        if self.drawing.mirror_x is None:
            return grid
        other = grid.copy()
        other.points[:, 0] = 2 * self.drawing.mirror_x - other.points[:, 0]
        other.point_data["displacement"] = other.point_data["displacement"] * (-1.0, 1.0, 1.0)
        return grid.merge(other, merge_points=True)  # one skin: no face left in the mirror plane

    def _cut(self, grid: pyvista.UnstructuredGrid) -> pyvista.UnstructuredGrid:
        x = grid.points[:, 0]
        keep = x if self.drawing.eye[0] <= 0 else -x
        level = self.section_x() if self.drawing.eye[0] <= 0 else -self.section_x()
        grid = grid.copy()
        grid.point_data["keep"] = keep
        # Just off the plane: a cut exactly through faces leaves slivers.
        return grid.clip_scalar("keep", value=level + 1e-4 * np.ptp(x), invert=False)

    def _add_solid(
        self, plotter: pyvista.Plotter, grid: pyvista.UnstructuredGrid, colours: dict, cut: bool
    ) -> None:
        surface = _surface(grid, deformed=True, subdivision=0 if cut else 2)
        seen_through = bool(self.lines) and not cut
        plotter.add_mesh(
            surface, scalars="stretch" if self.shows_stretch else "magnitude",
            opacity=0.4 if seen_through else 1.0, show_scalar_bar=False, smooth_shading=True,
            split_sharp_edges=True, feature_angle=30.0, ambient=0.25, diffuse=0.75, specular=0.15,
            specular_power=12.0, **colours)
        plotter.add_mesh(_edges(surface), **_EDGES)
        if seen_through:
            plotter.enable_depth_peeling(8)

    def _add_lines(
        self, plotter: pyvista.Plotter, name: str, grid: pyvista.UnstructuredGrid, colours: dict
    ) -> None:
        radius = self.drawing.radius.get(name, 0.6)
        look: dict[str, Any] = {"smooth_shading": True, "specular": 0.3}
        if self.solids:
            look["color"] = "#39424e"
        else:
            look |= {"scalars": "magnitude", "show_scalar_bar": False, **colours}
            plotter.add_mesh(tubes(grid, 0.12 * np.min(radius), deformed=False), color="#aab3bd")
        plotter.add_mesh(tubes(grid, radius, deformed=True), **look)


def _surface(
    grid: pyvista.UnstructuredGrid, deformed: bool, subdivision: int
) -> pyvista.PolyData:
    grid = grid.copy()
    displacement = grid.point_data["displacement"]
    grid.point_data["magnitude"] = np.linalg.norm(displacement, axis=1)
    if deformed:
        grid.points = grid.points + displacement
    return grid.extract_surface(nonlinear_subdivision=subdivision, algorithm="dataset_surface")


def _edges(surface: pyvista.PolyData) -> pyvista.PolyData:
    return surface.extract_feature_edges(
        30.0, boundary_edges=True, manifold_edges=False, non_manifold_edges=False)
