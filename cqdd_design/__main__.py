"""Entry point of the console script and of ``python -m cqdd_design``.

It imports nothing before it can answer Ctrl-C, so an interruption is quiet at any moment.
"""

import gc
import os
import sys

from cqdd_design.cli import interruption


def _start_lightly() -> None:
    """Spare a short process what only long ones need.

    Pydantic looks through every installed distribution for plugins, of which none is used here;
    threads of numpy's and scipy's linear algebra, whose matrices here are small, wait for the next
    product by turning in circles, a tenth of all the processor's time; and the cyclic collector
    walks all imported modules again and again.
    """
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(100_000, 20, 100)


def main() -> int:
    """Run the command line; returns the exit code."""
    try:
        interruption.listen()
        _start_lightly()
        from cqdd_design.cli.main import run

        return run(sys.argv[1:])
    except BaseException:
        code = interruption.exit_code()
        if code is None:
            raise
        sys.stderr.write("cqdd-design: interrupted\n")
        return code
    finally:
        # What is alive now dies with the process: spare it the collector's last walks.
        gc.freeze()


if __name__ == "__main__":
    sys.exit(main())
