"""The command `spindrift` that comes with the package."""

import signal
import sys

from . import _native


def main() -> int:
    """Does what the arguments of this process say, as the program does; the exit code."""
    # signals are the program's: the first lets runs under way end
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main(["spindrift", *sys.argv[1:]])
