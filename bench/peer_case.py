"""One case of `peers.py`, in a process that imports no more than its code needs."""

import argparse
import importlib
import resource
import time

from child import peak_MB, say


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--one", nargs=6, required=True,
                        metavar=("CODE", "ELEMENT", "CELLS", "MPA", "THREADS", "FILE"))
    code, element, n_cells, pressure, threads, file = parser.parse_args().one
    run = {"prepare": prepare, "import": imported, "ours": ours, "FElupe": felupe,
           "CalculiX": calculix}[code]
    run(element, int(n_cells), float(pressure), int(threads), file)


def prepare(element, n_cells, pressure, threads, file):
    """Write the mesh and the material for the other codes, and compile our forms."""
    import numpy as np

    from morphing_wing.geometry.spar import SparGeometry, SparMeshing
    from morphing_wing.materials import DRAGON_SKIN_30

    for name in ("Q1/P0", "Q2/P1disc"):
        solved(name, 1, 0.001)
    grid = SparGeometry.validation(n_cells).mesh(SparMeshing.plain())
    np.savez(file, points=grid.points, cells=grid.cells, yeoh=DRAGON_SKIN_30.coefficients,
             bulk=DRAGON_SKIN_30.bulk, **grid.facets)
    say(None, {})


def imported(module, n_cells, pressure, threads, file):
    importlib.import_module(module)
    say(None, {})


def ours(element, n_cells, pressure, threads, file):
    from mpi4py import MPI

    from morphing_wing import Spar  # noqa: F401  not counted as solving

    clock = time.perf_counter()
    found = solved(element, n_cells, pressure)
    seconds = time.perf_counter() - clock
    say(MPI.COMM_WORLD, found | {"solve": seconds, "peak_MB": peak_MB(MPI.COMM_WORLD)})


def solved(element, n_cells, pressure):
    from morphing_wing import Spar
    from morphing_wing.geometry.spar import SparGeometry, SparMeshing

    scene = Spar(SparGeometry.validation(n_cells), element=element, meshing=SparMeshing.plain())
    path = scene.inflate(upper=steps_to(pressure))
    return {"code": "ours", "angle": path[-1].measures["span_angle_deg"],
            "dofs": scene.dofs, "iterations": sum(state.newton_iterations for state in path)}


def felupe(element, n_cells, pressure, threads, file):
    import numpy as np
    import peer_felupe

    problem = np.load(file)
    clock = time.perf_counter()
    found = peer_felupe.solve(problem, element, steps_to(pressure), threads)
    seconds = time.perf_counter() - clock
    say(None, found | {"code": f"FElupe, {peer_felupe.SOLVER}", "solve": seconds,
                       "peak_MB": peak_MB(None)})


def calculix(element, n_cells, pressure, threads, file):
    import numpy as np
    import peer_calculix

    problem = np.load(file)
    clock = time.perf_counter()
    found = peer_calculix.solve(problem, steps_to(pressure))
    seconds = time.perf_counter() - clock
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    say(None, found | {"code": "CalculiX", "solve": seconds, "peak_MB": peak})


def steps_to(pressure):
    """Return load steps of 20 kPa at most."""
    count = max(1, round(pressure / 0.02))
    return [pressure * (i + 1) / count for i in range(count)]


if __name__ == "__main__":
    main()
