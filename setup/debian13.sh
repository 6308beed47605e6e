#!/bin/sh
# Try the package on Debian 13, inside a folder of this machine (needs root and debootstrap):
#
#   setup/debian13.sh [--wheel] FOLDER [COMMAND...]
#
# Makes a Debian 13 system in FOLDER (once), copies the project there as it stands, runs `make setup`
# and then the quick tests, or COMMAND in the activated environment, in the project's folder.
# With --wheel the environment is another one, without Debian's DOLFINx: the wheels from PyPI.
# SUITE=bookworm in the environment makes a bare Debian 12 instead.
set -eu

suite=${SUITE:-trixie}
environment=.venv
if [ "${1:-}" = --wheel ]; then environment=.venv-wheel; shift; fi
[ $# -ge 1 ] || { sed -n 's/^# \{0,1\}//p' "$0" | sed -n 2,9p >&2; exit 2; }
mkdir -p "$1"
root=$(cd "$1" && pwd)
shift
project=$(cd "$(dirname "$0")/.." && pwd)
home=/opt/morphing-wing        # the project's folder inside

say() { echo "debian: $*"; }
[ "$(id -u)" = 0 ] || { echo "debian: needs root, for debootstrap and chroot" >&2; exit 2; }

# One run at a time in a folder: the next one waits.
exec 9>"$root.lock"
flock 9

# Where this machine gets Debian from, there the new system does too.
mirror() {
    apt-get indextargets --format '$(LABEL) $(REPO_URI)' 'Created-By: Packages' |
        sed -n 's/^Debian //p' | head -n 1
}

if ! [ -e "$root/etc/debian_version" ]; then
    command -v debootstrap >/dev/null || { apt-get -qq update; apt-get -qq -y install debootstrap; }
    say "making $suite in $root"
    debootstrap --variant=minbase --include=ca-certificates,make "$suite" "$root" "$(mirror)" \
        >"$root.log"
fi

# What this machine needs to reach its package servers: names, proxies, certificates.
cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
grep -lsE '^ *Acquire' /etc/apt/apt.conf.d/* | xargs -r cp -t "$root/etc/apt/apt.conf.d"
if [ -e /etc/pip.conf ]; then cp -L /etc/pip.conf "$root/etc/"; fi
find /usr/local/share/ca-certificates -name '*.crt' -exec \
    cp -Lt "$root/usr/local/share/ca-certificates" {} +
chroot "$root" update-ca-certificates >/dev/null 2>&1

# The project as it stands, uncommitted changes and all, over what an earlier run left there.
mkdir -p "$root$home"
find "$root$home" -mindepth 1 -maxdepth 1 ! -name '.venv*' -exec rm -r {} +
(cd "$project" && git ls-files -z --cached --others --exclude-standard |
    tar --create --null --files-from - --ignore-failed-read 2>/dev/null) |
    tar --extract --directory "$root$home" --no-same-owner

# Run a command inside. Mounts live in a name space of their own: they end with the command.
inside() {
    unshare --mount sh -euc '
        root=$1; shift
        mount -t proc proc "$root/proc"
        mount -t sysfs -o ro sysfs "$root/sys"
        mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
        mount -t tmpfs tmpfs "$root/dev/shm"
        exec chroot "$root" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
            DEBIAN_FRONTEND=noninteractive OMP_NUM_THREADS=1 \
            OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
            PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe \
            ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
            ${no_proxy:+no_proxy="$no_proxy"} ${PIP_INDEX_URL:+PIP_INDEX_URL="$PIP_INDEX_URL"} \
            ${PIP_CERT:+PIP_CERT="$PIP_CERT"} \
            ${OPENBLAS_CORETYPE:+OPENBLAS_CORETYPE="$OPENBLAS_CORETYPE"} \
            "$@"' sh "$root" "$@"
}

inside make --no-print-directory -C $home setup
if [ $environment = .venv-wheel ]; then
    inside sh $home/setup/wheel.sh
fi

if [ $# = 0 ]; then
    set -- sh -c 'python -m pytest -m quick &&
        mpirun -n 2 python -m pytest -x -p no:cacheprovider -m quick tests/parallel'
fi
say "in $root$home with $environment: $*"
inside sh -c 'cd '$home' && . '$environment'/bin/activate && exec "$@"' sh "$@"
