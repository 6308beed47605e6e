#!/bin/sh
# Make .venv-wheel: DOLFINx, PETSc and MPI as wheels from PyPI, nothing of Debian's but Python itself.
#
# Needs Python 3.12 or newer. The wheel carries PETSc, MUMPS and OpenBLAS, and brings MPICH.
set -eu
cd "$(dirname "$0")/.."

venv=.venv-wheel
stamp=$venv/morphing-wing.stamp
recipe=$(cat pyproject.toml setup/wheel.sh | cksum; pwd)
if [ -f $stamp ] && [ "$(cat $stamp)" = "$recipe" ]; then exit 0; fi

echo "setup: installing DOLFINx's wheel and the package into $venv"
${PYTHON:-python3} -m venv --clear $venv
$venv/bin/pip install --quiet --disable-pip-version-check dolfinx-solver-real gmsh --editable '.[test]'
$venv/bin/python setup/check.py
echo "$recipe" >$stamp
