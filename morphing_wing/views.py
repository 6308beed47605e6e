"""Views of a deformed structure, whole and cut: grids in, images out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from morphing_wing.carried_bars import carried
from morphing_wing.drawing import Cut, Drawing
from morphing_wing.mirror import mirrored
from morphing_wing.renderer import choose_renderer
from morphing_wing.tubes import tubes

if TYPE_CHECKING:
    import pyvista

__all__ = ["View"]

_CUT_EYES = {"x": (-1.0, 0.45, 0.45), "z": (-0.12, 0.2, 1.0)}
_OUTLINE = {"color": "#8d99a6", "line_width": 1.6, "lighting": False}
_EDGES = {"color": "#2d3640", "line_width": 1.8, "lighting": False,
          "render_lines_as_tubes": True}


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
        self.solids = [g for g in grids.values() if _dimension(g) > 1]
        self.lines = {name: carried(g, drawing.bars[name]) if name in drawing.bars else g
                      for name, g in grids.items() if _dimension(g) == 1}
        if drawing.mirror_x is not None:
            self.solids = [mirrored(grid, drawing.mirror_x) for grid in self.solids]
        self._all = (*self.solids, *self.lines.values())

    @property
    def quantity(self) -> str:
        """What the colours show, one of `Drawing.colour_by`: lines alone never show stretch."""
        chosen = self.drawing.colour_by
        return chosen if self.solids or chosen != "stretch" else "displacement"

    @property
    def _vector(self) -> str:
        """The vector whose length the colours show where they do not show stretch."""
        return "mode" if self.drawing.colour_by == "mode" else "displacement"

    def values(self) -> np.ndarray:
        """Return what the colours show, at the points of the solids (of the lines without any)."""
        if self.quantity == "stretch":
            return np.concatenate([grid.point_data["stretch"] for grid in self.solids])
        return np.concatenate([
            np.linalg.norm(grid.point_data[self._vector], axis=1)
            for grid in self.solids or self.lines.values()])

    def cuts(self) -> list[Cut]:
        """Return the cuts to be drawn beside the whole."""
        if not self.solids:
            return []
        if self.drawing.cuts is not None:
            return list(self.drawing.cuts)
        x = np.concatenate([grid.points[:, 0] for grid in self.solids])
        mirror = self.drawing.mirror_x
        return [Cut("x", 0.5 * (x.min() + x.max()) if mirror is None else mirror)]

    def extent(self, cut: Cut | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Return lower and upper corner of what is drawn, in the viewer's plane, mm."""
        clouds = [g.points + by * g.point_data["displacement"] for g in self._all for by in (0, 1)]
        clouds += [np.asarray(cable) for cable in self.drawing.cables if cut is None]
        right, up, _ = self._axes(cut)
        flat = np.concatenate(clouds) @ np.stack([right, up], axis=1)
        thick = max((np.max(self._radius(name)) for name in self.lines), default=0.0)
        return flat.min(axis=0) - thick, flat.max(axis=0) + thick

    def _radius(self, name: str) -> float | np.ndarray:
        return self.drawing.radius.get(name, 0.6)

    def image(
        self, size: tuple[int, int], scale: float, colours: dict[str, Any], cut: Cut | None = None,
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
            Take away what lies before it, so that chambers show.
        centre
            Centre of the picture in the viewer's plane, mm; None: of what is drawn.
        outline
            Whether to draw the edges of the undeformed structure.
        """
        choose_renderer()
        import pyvista

        plotter = pyvista.Plotter(off_screen=True, window_size=size, lighting="none")
        plotter.set_background("white")
        plotter.add_light(pyvista.Light(light_type="headlight", intensity=0.6))
        plotter.add_light(pyvista.Light(
            position=(-0.6, 1.0, 0.8), light_type="camera light", intensity=0.45))
        for grid in self.solids:
            self._add_solid(plotter, grid, colours, cut)
            if outline:
                outside = _surface(grid, deformed=False, subdivision=0).connectivity("largest")
                plotter.add_mesh(_edges(outside), **_OUTLINE)  # without the chambers' edges
        for name, grid in self.lines.items():
            self._add_lines(plotter, name, grid, colours, cut, outline)
        for cable in self.drawing.cables if cut is None else ():
            plotter.add_mesh(pyvista.lines_from_points(np.asarray(cable, dtype=float)),
                             color="black", line_width=2.5)
        if centre is None:
            centre = 0.5 * np.sum(self.extent(cut), axis=0)
        self._aim(plotter, size, scale, centre, cut)
        plotter.enable_anti_aliasing("ssaa")
        picture = plotter.screenshot(return_img=True)
        plotter.close()
        return picture

    def _axes(self, cut: Cut | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the viewer's right, up and forward."""
        forward = -np.array(self.drawing.eye if cut is None else _CUT_EYES[cut.axis], dtype=float)
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, (0.0, 1.0, 0.0))
        right /= np.linalg.norm(right)
        return right, np.cross(right, forward), forward

    def _aim(
        self, plotter: pyvista.Plotter, size: tuple[int, int], scale: float, centre: np.ndarray,
        cut: Cut | None,
    ) -> None:
        right, up, forward = self._axes(cut)
        depth = np.concatenate([g.points for g in self._all]) @ forward
        focus = centre[0] * right + centre[1] * up + 0.5 * (depth.min() + depth.max()) * forward
        camera = plotter.camera
        camera.position = focus - 10.0 * scale * max(size) * forward
        camera.focal_point, camera.up = focus, up
        camera.parallel_projection = True
        camera.parallel_scale = 0.5 * size[1] * scale
        plotter.reset_camera_clipping_range()

    def _add_solid(
        self, plotter: pyvista.Plotter, grid: pyvista.UnstructuredGrid, colours: dict,
        cut: Cut | None,
    ) -> None:
        surface = _surface(_without(grid, cut), deformed=True, subdivision=0 if cut else 2)
        surface.point_data["magnitude"] = np.linalg.norm(surface.point_data[self._vector], axis=1)
        look = {"split_sharp_edges": True, "feature_angle": 30.0}
        if self.lines and cut is None:
            # Ribs show through the skin; of the chambers only the edges.
            plotter.add_mesh(_edges(surface), **_EDGES | {"line_width": 1.0})
            surface = surface.clean().connectivity("largest")
            look = {"opacity": 0.38}
        plotter.add_mesh(_edges(surface), **_EDGES)
        if "opacity" in look:
            surface = _far_to_near(surface, self._axes(cut)[2])
        plotter.add_mesh(
            surface, scalars="stretch" if self.quantity == "stretch" else "magnitude",
            show_scalar_bar=False, smooth_shading=True, ambient=0.36, diffuse=0.72, specular=0.1,
            specular_power=12.0, **look, **colours)

    def _add_lines(
        self, plotter: pyvista.Plotter, name: str, grid: pyvista.UnstructuredGrid, colours: dict,
        cut: Cut | None, outline: bool,
    ) -> None:
        radius = self._radius(name)
        look: dict[str, Any] = {"smooth_shading": True, "specular": 0.3}
        if self.solids:
            look["color"] = "#16407c"
            keep = np.nonzero(_kept(grid.cell_centers().points, cut))[0]
            grid = grid.extract_cells(keep)
        else:
            look |= {"scalars": "magnitude", "show_scalar_bar": False, **colours}
            if outline:
                thin = 0.15 * np.min(radius)
                plotter.add_mesh(tubes(grid, thin, deformed=False), color="#aab3bd")
        if grid.n_cells:
            plotter.add_mesh(tubes(grid, radius, deformed=True, shown=self._vector), **look)


def _dimension(grid: pyvista.UnstructuredGrid) -> int:
    return grid.GetCell(0).GetCellDimension() if grid.n_cells else 0


def _depth(points: np.ndarray, cut: Cut) -> np.ndarray:
    """Return how far behind the cut points lie, mm."""
    return points[:, 0] - cut.level if cut.axis == "x" else cut.level - points[:, 2]


def _kept(points: np.ndarray, cut: Cut | None) -> np.ndarray:
    return np.ones(len(points), dtype=bool) if cut is None else _depth(points, cut) > 0.0


def _without(grid: pyvista.UnstructuredGrid, cut: Cut | None) -> pyvista.UnstructuredGrid:
    if cut is None:
        return grid
    grid = grid.copy()
    grid.point_data["depth"] = _depth(grid.points, cut)
    # Just off the plane: a cut exactly through faces leaves slivers.
    return grid.clip_scalar(
        scalars="depth", value=1e-4 * np.ptp(grid.point_data["depth"]), invert=False)


def _surface(
    grid: pyvista.UnstructuredGrid, deformed: bool, subdivision: int
) -> pyvista.PolyData:
    grid = grid.copy()
    displacement = grid.point_data["displacement"]
    if deformed:
        grid.points = grid.points + displacement
    return grid.extract_surface(nonlinear_subdivision=subdivision, algorithm="dataset_surface")


def _far_to_near(surface: pyvista.PolyData, forward: np.ndarray) -> pyvista.PolyData:
    """Return a surface in triangles sorted for blending: OpenGL blends in the order of drawing."""
    import pyvista

    surface = surface.triangulate().compute_normals(
        split_vertices=True, feature_angle=30.0, cell_normals=False, consistent_normals=False)
    order = np.argsort(-(surface.cell_centers().points @ forward))
    triangles = surface.faces.reshape(-1, 4)[order]
    ordered = pyvista.PolyData(surface.points, faces=triangles.ravel())
    for name, values in surface.point_data.items():
        ordered.point_data[name] = values
    ordered.point_data.active_normals_name = "Normals"
    return ordered


def _edges(surface: pyvista.PolyData) -> pyvista.PolyData:
    return surface.extract_feature_edges(
        30.0, boundary_edges=True, manifold_edges=False, non_manifold_edges=False)
