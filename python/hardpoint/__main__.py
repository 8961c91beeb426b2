"""The command: `python -m hardpoint run MODEL`, the same as `hardpoint run MODEL`."""

from __future__ import annotations

import sys

from . import _native


def main() -> int:
    """Runs the command with the arguments of the process; returns its exit code."""
    if not hasattr(_native, "main"):
        sys.stderr.write("error: this build of the package has no command; build it with the feature `command`\n")
        return 2
    return _native.main(["hardpoint", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
