"""Where the command line starts. Every failure ends as one message on standard error and a non-zero status."""

from __future__ import annotations

import os
import signal
import sys
import warnings

from ..errors import HystripError, InputError, MissingExtra, printable
from ..extras import require

USAGE, FAILED, INTERRUPTED, TERMINATED = 2, 1, 130, 143


class Terminated(SystemExit):
    """SIGTERM, as an exception: what is half done is undone, workers are ended."""


def main() -> None:
    """Run the command line and exit: 0 done, 1 failed, 2 wrong input, 130 interrupted, 143 terminated."""
    with_handler = signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
    if with_handler:
        signal.signal(signal.SIGTERM, _terminate)
    status = _status()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # nothing is left to interrupt but the interpreter's own end
    sys.exit(status)


def _terminate(*_: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # once is enough
    raise Terminated(TERMINATED)


def _status() -> int:
    try:
        if hasattr(sys.stdout, "reconfigure"):  # a title may hold what the terminal's encoding lacks
            sys.stdout.reconfigure(errors="replace")
        warnings.showwarning = _show_warning
        require("typer", "cli", "the command line")
        from .app import build

        build()(prog_name="hystrip", standalone_mode=True)
    except Terminated:
        _say("terminated")
        return TERMINATED
    except SystemExit as end:
        _discard_closed_output()
        if end.code == INTERRUPTED:
            _say("interrupted")
        return end.code if isinstance(end.code, int) else FAILED if end.code else 0
    except KeyboardInterrupt:
        _say("interrupted")
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output, such as `head`, has had enough
        _discard_closed_output()
        return FAILED
    except (InputError, MissingExtra) as error:
        _say(str(error))
        return USAGE
    except HystripError as error:
        _say(str(error))
        return FAILED
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        _say(f"{place}{error.strerror or error}")
        return FAILED
    except MemoryError:
        _say("not enough memory for this scene: give fewer pressures or velocities")
        return FAILED
    return 0


def _say(text: str) -> None:
    print(f"hystrip: {printable(text, limit=4000)}", file=sys.stderr, flush=True)


def _show_warning(message: Warning | str, category: type[Warning], *_: object) -> None:
    """A warning as one line, without the place in the code."""
    ours = category.__module__.startswith("hystrip")
    _say(f"warning: {message}" if ours else f"warning: {category.__name__}: {message}")


def _discard_closed_output() -> None:
    """Keep the interpreter's last flush from complaining about a pipe that nobody reads."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
