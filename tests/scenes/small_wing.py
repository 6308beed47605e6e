"""A wing of two cells and one rib, coarse enough for seconds."""

from dataclasses import replace

from mpi4py import MPI

from morphing_wing.geometry.wing import WingGeometry
from morphing_wing.geometry.wing_mesh import WingMeshing
from morphing_wing.wing import Wing

GEOMETRY = WingGeometry.prototype(n_cells=2, rib_positions=(0.5,))
MESHING = WingMeshing.of(cavity_width=3, pocket=5)
NO_RIBS = {"rib": None}
NO_SKIN = {"skin_thickness": None}
SPAR = NO_RIBS | NO_SKIN


def small_wing(comm, element="Q1 enhanced", geometry=GEOMETRY, **options):
    """Return the wing with all its parts on a communicator."""
    return Wing(geometry, meshing=MESHING, element=element, comm=comm, **options)


def move_elastomer(scene, motion):
    """Give the elastomer the displacement ``motion`` of its points, both (n, 3) in mm."""
    body = scene.body
    part = body.displacement_part(body.function)
    part.interpolate(lambda x: motion(x.T).T)


def wing(contact=True, adhesive=None, **changes):
    """Return the wing with changes of its geometry, on this rank alone."""
    return small_wing(MPI.COMM_SELF, geometry=replace(GEOMETRY, **changes), contact=contact,
                      adhesive=adhesive)


def actuated(scene, **loads):
    """Lead a wing through loads, all of which must be reached; return the path."""
    path = scene.actuate(**loads)
    assert path.converged, path.reason
    return path


def angles(state):
    """Return all angles of a state by name."""
    return {name: value for name, value in state.measures.items() if name.endswith("_deg")}
