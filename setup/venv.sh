#!/bin/sh
# Make .venv on Debian's own Python and install the package into it, editable, with the tests' tools.
#
# Does nothing the second time, unless pyproject.toml, this script or Debian's numpy has changed.
set -eu
cd "$(dirname "$0")/.."

python=/usr/bin/python3
venv=.venv
stamp=$venv/morphing-wing.stamp

say() { echo "setup: $*"; }

# What the environment was made from; equal to the stamp, there is nothing to do.
recipe=$(cat pyproject.toml setup/venv.sh | cksum; pwd; readlink -f $python
         dpkg-query --show --showformat '${Package} ${Version}\n' python3-numpy python3-dolfinx-real)
if [ -x $venv/bin/python ] && [ -f $stamp ] && [ "$(cat $stamp)" = "$recipe" ]; then
    exit 0
fi

if ! grep -qs '^include-system-site-packages = true' $venv/pyvenv.cfg || ! [ -x $venv/bin/pip ]; then
    say "making $venv on $($python --version), which sees Debian's DOLFINx"
    $python -m venv --clear --system-site-packages $venv
fi

# petsc4py, mpi4py and DOLFINx are compiled against Debian's numpy: any numpy that pip brings must not
# be older, nor of the next major version, whose binary interface is another. pip keeps Debian's own
# numpy wherever that is new enough for the other packages.
constraints=$venv/constraints.txt
$python - >$constraints <<'END'
import numpy
print(f"numpy>={numpy.__version__},<{int(numpy.__version__.split('.')[0]) + 1}")
END

say "installing the package and what it needs from PyPI, with $(cat $constraints)"
$venv/bin/pip install --quiet --disable-pip-version-check --constraint $constraints \
    --editable '.[test]'

say "checking that DOLFINx, petsc4py and mpi4py work with this numpy"
$venv/bin/python setup/check.py

echo "$recipe" >$stamp
say "done: '. $venv/bin/activate' makes it yours"
