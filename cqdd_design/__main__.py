"""Entry point of the console script and of ``python -m cqdd_design``.

It imports nothing before it can answer Ctrl-C, so an interruption is quiet at any moment.
"""

import signal
import sys
from types import FrameType


def _terminate(number: int, frame: FrameType | None) -> None:
    # As an exception, so that temporary files are removed on the way out.
    raise SystemExit(128 + number)


def main() -> int:
    """Run the command line; returns the exit code."""
    try:
        signal.signal(signal.SIGTERM, _terminate)
        from cqdd_design.cli.main import run

        return run(sys.argv[1:])
    except KeyboardInterrupt:
        sys.stderr.write("\ninterrupted\n")
        return 130


if __name__ == "__main__":
    sys.exit(main())
