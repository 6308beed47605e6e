"""``python -m morphing_wing``: the command line, as for ``python -m mpi4py.futures -m``."""

import sys

from morphing_wing.cli import main

if __name__ == "__main__":
    sys.exit(main())
