"""Blind trials of the diagnosis: generator, seal, runner, scorer and peers. It imports nothing of the product."""

import sys
from importlib.util import find_spec

missing = [name for name in ("numpy", "scipy") if find_spec(name) is None]
if missing:
    sys.exit(f"{sys.executable} has no {' and no '.join(missing)}; call the programs of trials/ by name, as ./trials/score, or run ./scripts/install-dependencies trial")
