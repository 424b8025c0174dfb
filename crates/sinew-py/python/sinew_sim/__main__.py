"""The whole command: `sinew-sim run scene.toml`, or `python -m sinew_sim run scene.toml`."""

import signal
import sys

from ._core import _command


def main() -> None:
    """Runs the command with the arguments of the process, and ends with its exit code."""
    # The command has an answer of its own to Ctrl-C.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_command(["sinew-sim", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
