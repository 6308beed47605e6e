"""One case of a bench in a process of its own, for its own peak of memory."""

import json
import os
import resource
import subprocess
import sys


def in_a_child(script, *case, ranks=1, environment=None):
    """Run ``script --one CASE`` and return the figures that it prints, on any number of ranks.

    ``environment`` goes over the present one.

    Raises
    ------
    RuntimeError
        If it ends with an error; the message is what it said.
    """
    # Open MPI refuses root, and more ranks than cores, unless told that this is meant.
    allowed = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe", "OMP_NUM_THREADS": "1"}
    command = [sys.executable, script, "--one", *map(str, case)]
    if ranks > 1:
        command = ["mpirun", "-n", str(ranks), *command]
    own = {name: str(value) for name, value in (environment or {}).items()}
    done = subprocess.run(command, capture_output=True, text=True, env=allowed | os.environ | own)
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:])
    return json.loads(done.stdout.splitlines()[-1])


def say(comm, figures):
    """Print a case's figures as JSON, on one rank; ``comm`` is None for codes without MPI."""
    if comm is None or comm.rank == 0:
        print(json.dumps(figures), flush=True)


def peak_MB(comm):
    """Return the peak of memory in MB, summed over the ranks; ``comm`` is None without MPI."""
    mine = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return mine if comm is None else comm.allreduce(mine)
