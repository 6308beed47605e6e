"""How far ranks may differ."""

WORK = 1e-6
"""Of external work, relative: the compliance in it is the tangent's inverse, and rounding of stiff
parts in the tangent's sums, which each number of ranks adds up in its own order, is as large as
1e-6 of what soft ribs yield. Equilibrium itself does not feel it."""
