"""Optimisation of any scene: the best design between bounds, searched cheaply, checked finely.

.. code-block:: python

    from morphing_wing.optimization import optimize, read_problem

    found = optimize(read_problem("spar"))
    print(found.rungs(), found.best())
    found.save("output/spar")            # design.toml is a scene file
"""

from .optimum import Optimum, optimize
from .problem_file import read_problem

__all__ = ["Optimum", "optimize", "read_problem"]
