# What a newcomer types: make demo, make test. Each installs what is missing first.

python := .venv/bin/python
ranks ?= 2
# A rank that fails stops them all; they must not share pytest's cache.
parallel := $(python) -m pytest -x -p no:cacheprovider tests/parallel

# One thread a rank: MPI's ranks are what uses the cores.
export OMP_NUM_THREADS ?= 1
# Open MPI refuses root, and more ranks than cores, unless it is told that this is meant; the last
# two lines say the latter to Open MPI 4 and 5. (No option of mpirun: MPICH's knows none of them.)
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
export OMPI_MCA_rmaps_base_oversubscribe := 1
export PRTE_MCA_rmaps_default_mapping_policy := :oversubscribe

.PHONY: help setup demo test quick lint

help:
	@echo "make setup   install what is missing: Debian's packages, then .venv (does nothing twice)"
	@echo "make demo    solve the whole wing on $(ranks) ranks; pictures and curves in output/"
	@echo "make test    all tests, then the parallel ones on 2 and 3 ranks"
	@echo "make quick   the tests that take seconds"
	@echo "make lint    ruff"

setup:
	@sh setup/system.sh
	@sh setup/venv.sh

demo: setup
	mpirun -n $(ranks) $(python) demos/full_wing.py

test: setup
	$(python) -m pytest -n $(ranks) --dist loadfile --ignore=tests/parallel
	mpirun -n 2 $(parallel)
	mpirun -n 3 $(parallel)

quick: setup
	$(python) -m pytest -m quick
	mpirun -n 2 $(parallel) -m quick

lint: setup
	$(python) -m ruff check .
