"""Every difference between the DOLFINx generations 0.5, 0.9 and 0.11, and nothing else.

The rest of the package calls these functions; each decides by the features that it finds, not by
version numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import dolfinx
import dolfinx.fem.petsc
import dolfinx.plot
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc
from scipy.sparse import bsr_matrix, csr_matrix

from .compilation import compiling

# Hyperelastic kernels are long; optimising them halves assembly. -Ofast would defeat NaN checks.
_JIT_OPTIONS = {"cffi_extra_compile_args": ["-O3", "-march=native"], "cffi_libraries": ["m"]}
# Points' kernels are one long list of sums that compilers take many minutes to optimise, in vain.
_JIT_OPTIONS_OF_POINTS = _JIT_OPTIONS | {"cffi_extra_compile_args": ["-O0"]}
_JIT_KEYWORD = "jit_options" if "jit_options" in fem.form.__code__.co_varnames else "jit_params"
_HAS_BASIX_UFL = hasattr(fem, "functionspace")
if _HAS_BASIX_UFL:
    import basix.ufl
    from dolfinx import default_scalar_type as scalar_type
else:
    scalar_type = PETSc.ScalarType


# -- meshes -----------------------------------------------------------------------------------


def create_mesh(
    comm: MPI.Comm, cell: str, cells: np.ndarray, points: np.ndarray,
    groups: np.ndarray | None = None,
) -> Any:
    """Distribute a mesh of first-order cells, or of second-order tetrahedra.

    Parameters
    ----------
    comm
        Communicator; every rank calls, the cells of rank 0 are used.
    cell
        ``"hexahedron"`` (tensor-product vertex order), ``"interval"`` or ``"tetrahedron"``.
    cells
        Vertices of each cell, then the middles of its edges if they are curved, in the order of
        finite elements, shape (n_cells, n_nodes).
    points
        Coordinates in mm, shape (n_points, 3).
    groups
        Which group each cell is of, from 0: one rank gets all of a group. Intervals that
        branch must be of one group: some DOLFINx make two points of one that ranks share.
    """
    degree = 2 if cells.shape[1] == 10 else 1
    options = {} if groups is None else {"partitioner": _partitioner(comm, groups)}
    if comm.rank != 0:
        cells, points = cells[:0], points[:0]
    cells = np.ascontiguousarray(cells, dtype=np.int64)
    points = np.ascontiguousarray(points, dtype=np.float64)
    with compiling(comm):
        if _HAS_BASIX_UFL:
            element = basix.ufl.element("Lagrange", cell, degree, shape=(3,))
            arguments = (element, points) if _cells_then_element() else (points, element)
            return dolfinx.mesh.create_mesh(comm, cells, *arguments, **options)
        # FFCx gives coordinate elements without a variant one in place, at the first compilation;
        # arguments made before and after that would then count as different.
        shape = ufl.Cell(cell, geometric_dimension=3)
        domain = ufl.Mesh(ufl.VectorElement("Lagrange", shape, degree, variant="equispaced"))
        ghosts = dolfinx.mesh.GhostMode.none
        return dolfinx.mesh.create_mesh(comm, cells, points, domain, ghosts, **options)


def _partitioner(comm: MPI.Comm, groups: np.ndarray) -> Callable[..., Any]:
    """Return what tells DOLFINx the rank of each cell of rank 0, all of a group the same one."""
    given = groups if comm.rank == 0 else groups[:0]
    ranks = np.asarray(given * comm.size // (groups.max(initial=0) + 1), dtype=np.int32)
    starts = np.arange(len(ranks) + 1, dtype=np.int32)
    return lambda *_: dolfinx.cpp.graph.AdjacencyList_int32(ranks, starts)


def _cells_then_element() -> bool:
    names = dolfinx.mesh.create_mesh.__code__.co_varnames[:4]
    return names.index("e") < names.index("x") if "e" in names else False


def constant(mesh: Any, value: Any) -> Any:
    """Return a number or an array of them that forms hold without being compiled for its value."""
    return fem.Constant(mesh, np.asarray(value, dtype=scalar_type))


def original_cells(mesh: Any) -> np.ndarray:
    """Return the index in the input array of each local cell (owned and ghosted)."""
    return np.asarray(mesh.topology.original_cell_index)


def facet_tags(mesh: Any, facets: np.ndarray, values: np.ndarray) -> Any:
    """Return mesh tags on local facets; repeated facets keep their first value."""
    facets, first = np.unique(np.asarray(facets, dtype=np.int32), return_index=True)
    values = np.asarray(values, dtype=np.int32)[first]
    return dolfinx.mesh.meshtags(mesh, mesh.topology.dim - 1, facets, values)


def cell_tags(mesh: Any, values: np.ndarray) -> Any:
    """Return mesh tags on all local cells, one value each."""
    cells = np.arange(len(values), dtype=np.int32)
    return dolfinx.mesh.meshtags(mesh, mesh.topology.dim, cells, np.asarray(values, np.int32))


def cell_facets(mesh: Any) -> np.ndarray:
    """Return the local facets of each local cell, shape (n_cells, facets per cell)."""
    tdim = mesh.topology.dim
    mesh.topology.create_connectivity(tdim, tdim - 1)
    mesh.topology.create_connectivity(tdim - 1, tdim)
    connectivity = mesh.topology.connectivity(tdim, tdim - 1)
    n_cells = mesh.topology.index_map(tdim).size_local + mesh.topology.index_map(tdim).num_ghosts
    return connectivity.array.reshape(n_cells, -1) if n_cells else np.empty((0, 1), np.int32)


# -- spaces -----------------------------------------------------------------------------------


def vector_space(mesh: Any, degree: int, size: int = 3) -> Any:
    """Return continuous Lagrange vectors (Q or P by the cell) with ``size`` components."""
    with compiling(mesh.comm):
        if _HAS_BASIX_UFL:
            return fem.functionspace(mesh, ("Lagrange", degree, (size,)))
        return fem.VectorFunctionSpace(mesh, ("Lagrange", degree), dim=size)


def discontinuous_space(mesh: Any, degree: int, shape: tuple[int, ...] = ()) -> Any:
    """Return discontinuous Lagrange scalars, or tensors of a shape."""
    with compiling(mesh.comm):
        if _HAS_BASIX_UFL:
            return fem.functionspace(mesh, ("DG", degree, shape) if shape else ("DG", degree))
        family = (_discontinuous(mesh), degree)
        if not shape:
            return fem.FunctionSpace(mesh, family)
        if len(shape) == 1:
            return fem.VectorFunctionSpace(mesh, family, dim=shape[0])
        return fem.TensorFunctionSpace(mesh, family, shape=shape)


def _discontinuous(mesh: Any) -> str:
    """Return the family that UFL would make of "DG" itself, but with a warning on the screen."""
    return "DQ" if mesh.ufl_cell().cellname() == "hexahedron" else "DG"


def displacement_pressure_space(mesh: Any, degree: int, pressure: tuple[str, int]) -> Any:
    """Return the mixed space of a continuous displacement and a pressure.

    ``pressure`` is ``("DPC", 1)`` (P1 in each cell), ``("DG", 0)`` or ``("Lagrange", 1)``.
    """
    if _HAS_BASIX_UFL:
        options = _pressure_options(pressure)
        p = basix.ufl.element(pressure[0], mesh.basix_cell(), pressure[1], **options)
    else:
        family = _discontinuous(mesh) if pressure[0] == "DG" else pressure[0]
        p = ufl.FiniteElement(family, mesh.ufl_cell(), pressure[1])
    return _with_displacement(mesh, degree, p)


def displacement_modes_space(mesh: Any, degree: int, n_modes: int) -> Any:
    """Return the mixed space of a continuous displacement and ``n_modes`` numbers a cell."""
    if _HAS_BASIX_UFL:
        modes = basix.ufl.element("DG", mesh.basix_cell(), 0, shape=(n_modes,))
    else:
        modes = ufl.VectorElement(_discontinuous(mesh), mesh.ufl_cell(), 0, dim=n_modes)
    return _with_displacement(mesh, degree, modes)


def _with_displacement(mesh: Any, degree: int, other: Any) -> Any:
    with compiling(mesh.comm):
        if _HAS_BASIX_UFL:
            u = basix.ufl.element("Lagrange", mesh.basix_cell(), degree, shape=(3,))
            return fem.functionspace(mesh, basix.ufl.mixed_element([u, other]))
        u = ufl.VectorElement("Lagrange", mesh.ufl_cell(), degree)
        return fem.FunctionSpace(mesh, ufl.MixedElement([u, other]))


def _pressure_options(pressure: tuple[str, int]) -> dict[str, Any]:
    if pressure[0] == "DPC":
        return {"dpc_variant": basix.DPCVariant.legendre, "discontinuous": True}
    return {}


def interpolation_points(space: Any) -> np.ndarray:
    """Return the points of a Lagrange space's dofs in the reference cell, in the cell's order."""
    points = space.element.interpolation_points
    return points() if callable(points) else points


def interpolated(space: Any, expression: Any, points: np.ndarray) -> Any:
    """Return the function of a space with an expression's values at its points in each cell."""
    function = fem.Function(space)
    with compiling(space.mesh.comm):
        function.interpolate(fem.Expression(expression, points))
    return function


# -- forms and assembly -----------------------------------------------------------------------


def form(expression: Any) -> Any:
    """Compile a UFL form with optimised kernels; those of sums over points as they are."""
    comm = expression.ufl_domains()[0].ufl_cargo().comm
    of_points = all(integral.metadata().get("quadrature_degree") == 0
                    for integral in expression.integrals())
    options = _JIT_OPTIONS_OF_POINTS if of_points else _JIT_OPTIONS
    with compiling(comm):
        return fem.form(expression, **{_JIT_KEYWORD: options})


def assemble_scalar(comm: MPI.Comm, functional: Any) -> float:
    """Assemble a compiled functional over all ranks."""
    return comm.allreduce(float(np.real(fem.assemble_scalar(functional))), op=MPI.SUM)


def assemble_vector(functional: Any, out: np.ndarray) -> None:
    """Add a compiled linear form's rank-local contributions (owned and ghosted) to ``out``."""
    fem.assemble_vector(out, functional)


def add_ghosts(function: Any) -> None:
    """Add ghost values to their owners', then give ghosts the owners' sums."""
    x = function.x
    mode = dolfinx.la.InsertMode.add if hasattr(dolfinx.la, "InsertMode") else (
        dolfinx.la.ScatterMode.add)
    x.scatter_reverse(mode)
    x.scatter_forward()


def assemble_matrix(matrix: PETSc.Mat, bilinear: Any) -> None:
    """Add a compiled bilinear form to a local reference of a matrix, without finalising it."""
    constants, coefficients = _packed(bilinear)
    _cpp_petsc().assemble_matrix(matrix, _cpp(bilinear), constants, coefficients, [], True)


def sparsity(comm: MPI.Comm, bilinear: Any) -> csr_matrix:
    """Return which entries a compiled bilinear form sets: this rank's rows, all columns.

    In DOLFINx's own numbers of dofs, of a global numbering that has rank after rank. Collective.
    """
    pattern = fem.create_sparsity_pattern(bilinear)
    (pattern.finalize if hasattr(pattern, "finalize") else pattern.assemble)()
    if comm.size > 1 and not hasattr(pattern, "column_index_map"):
        return _sparsity_by_petsc(bilinear)  # some do not tell what ghost columns stand for
    rows, graph = pattern.index_map(0), pattern.graph
    columns, starts = (graph.array, graph.offsets) if hasattr(graph, "array") else graph
    starts = starts[: rows.size_local + 1]  # ghosts' rows come after
    columns = columns[: starts[-1]]
    if comm.size > 1:
        held = pattern.column_index_map()
        number = np.concatenate([np.arange(*held.local_range), held.ghosts])
        columns = number[columns]
    n_columns = pattern.index_map(1).size_global
    sizes = [space.dofmap.index_map_bs for space in bilinear.function_spaces]
    shape = (rows.size_local * sizes[0], n_columns * sizes[1])
    if sizes == [1, 1]:
        return csr_matrix((np.ones(len(columns), dtype=bool), columns, starts), shape=shape)
    ones = np.ones((len(columns), *sizes), dtype=bool)
    return bsr_matrix((ones, columns, starts), shape=shape).tocsr()


def _sparsity_by_petsc(bilinear: Any) -> csr_matrix:
    try:
        matrix = _cpp_petsc().create_matrix(_cpp(bilinear))
    except TypeError:
        matrix = _cpp_petsc().create_matrix(_cpp(bilinear), None)
    constants, coefficients = _packed(bilinear)
    # What is never set is squeezed out of a PETSc matrix, so set everything once.
    _cpp_petsc().assemble_matrix(matrix, _cpp(bilinear), constants, coefficients, [])
    matrix.assemble()
    starts, columns, _ = matrix.getValuesCSR()
    shape = (len(starts) - 1, matrix.getSize()[1])
    matrix.destroy()
    return csr_matrix((np.ones(len(columns), dtype=bool), columns, starts), shape=shape)


def _cpp_petsc() -> Any:
    return dolfinx.cpp.fem.petsc


def _cpp(bilinear: Any) -> Any:
    return getattr(bilinear, "_cpp_object", bilinear)


def _packed(bilinear: Any) -> tuple[Any, Any]:
    if hasattr(dolfinx.cpp.fem, "pack_coefficients"):
        compiled = _cpp(bilinear)
        return dolfinx.cpp.fem.pack_constants(compiled), dolfinx.cpp.fem.pack_coefficients(compiled)
    return fem.pack_constants(bilinear), fem.pack_coefficients(bilinear)


# -- drawing ----------------------------------------------------------------------------------


def vtk_mesh(space: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return VTK topology, cell types and points of a Lagrange space, higher order kept."""
    plot = dolfinx.plot
    make: Callable = plot.vtk_mesh if hasattr(plot, "vtk_mesh") else plot.create_vtk_mesh
    return make(space)
