#!/bin/sh
# Install with apt what Debian has of the package's foundations, and only what is missing.
#
# Debian 12 brings DOLFINx 0.5.2, Debian 13 brings 0.9.0. Does nothing the second time.
set -eu

# DOLFINx, PETSc with real scalars and MPI; a compiler and Python's headers, because DOLFINx compiles
# every form when it meets it; the virtual environment's tools.
packages="python3-dolfinx python3-dolfinx-real python3-petsc4py-real python3-mpi4py openmpi-bin
          gcc g++ libc6-dev python3-dev python3-venv python3-numpy python3-scipy"
# A BLAS that is several times faster than the reference one that PETSc would take otherwise. The
# serial one: every MPI rank is one thread.
packages="$packages libopenblas0-serial"
# gmsh, and the X libraries that it and PyVista load.
packages="$packages python3-gmsh libgl1 libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1"
# EGL and Mesa's software renderer: pictures without a display or a graphics card.
packages="$packages libegl1 libegl-mesa0 libgl1-mesa-dri"

say() { echo "setup: $*"; }
fail() { echo "setup: $*" >&2; exit 1; }

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    fail "this is not Debian: install FEniCSx by the README's conda-forge way instead."

installed=$(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' $packages \
            2>/dev/null | sed -n 's/^installed //p') || true
missing=""
for package in $packages; do
    case "
$installed
" in
        *"
$package
"*) ;;
        *) missing="$missing $package" ;;
    esac
done

if [ -n "$missing" ]; then
    as_root=""
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null ||
            fail "these Debian packages are missing and need root or sudo to install:$missing"
        as_root="sudo"
    fi
    say "installing with apt:$missing"
    # One list of all is small beside what is installed, and an old list names packages that are gone.
    $as_root apt-get update --quiet=2
    $as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install --quiet=2 --yes --no-install-recommends $missing >/dev/null
    say "Debian's packages are installed"
fi

# An administrator's own choice of BLAS stays, but is worth a word if it is the slow one.
blas=$(readlink -f /usr/lib/*/libblas.so.3 | head -n 1)
case "$blas" in
    */blas/libblas.so.3*)
        say "warning: PETSc will use the reference BLAS ($blas), which is about four times slower;" \
            "choose OpenBLAS with: update-alternatives --config libblas.so.3-$(uname -m)-linux-gnu" ;;
esac
