import sys
from pathlib import Path

# The scenes made up by formulas stand beside the tests, and tests/parallel uses them too.
sys.path.insert(0, str(Path(__file__).parent))
