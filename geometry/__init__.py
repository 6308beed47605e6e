"""Geometry: parameters to points, cells and named regions; numpy and gmsh only."""
