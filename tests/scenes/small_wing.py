"""A wing of two cells and one rib, coarse enough for seconds."""

from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.geometry.wing_mesh import WingMeshing
from morphing_wing.wing import Wing

GEOMETRY = WingGeometry.prototype(n_cells=2, rib_positions=(0.5,))
MESHING = WingMeshing.of(cavity_width=3, pocket=5)


def small_wing(comm, element="Q1 enhanced", geometry=GEOMETRY):
    """Return the wing with all its parts on a communicator."""
    return Wing(geometry, meshing=MESHING, element=element, comm=comm)


def move_elastomer(scene, motion):
    """Give the elastomer the displacement ``motion`` of its points, both (n, 3) in mm."""
    body = scene.body
    part = body.displacement_part(body.function)
    part.interpolate(lambda x: motion(x.T).T)
