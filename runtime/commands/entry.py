"""Where the command line starts. Every failure ends as one message on standard error and a non-zero status."""

import os
import sys
import warnings
from typing import Any

from ..errors import HystripError, InputError, MissingExtra, printable
from ..extras import require
from .signals import TERMINATED, Terminated, ignore_interrupts, raise_on_sigterm

USAGE, FAILED, INTERRUPTED = 2, 1, 130


def main() -> None:
    """Run the command line and exit: 0 done, 1 failed, 2 wrong input, 130 interrupted, 143 terminated."""
    raise_on_sigterm()
    status = _status()
    ignore_interrupts()  # nothing is left to interrupt but the interpreter's own end
    sys.exit(status)


def _status() -> int:
    try:
        if sys.stderr is None:  # closed: what is said there is for nobody
            sys.stderr = open(os.devnull, "w", encoding="utf-8")
        if hasattr(sys.stdout, "reconfigure"):  # a title may hold what the terminal's encoding lacks
            sys.stdout.reconfigure(errors="replace")
        _show_warnings()
        require("typer", "cli", "the command line")
        from .app import build
        from .options import as_options

        with as_options({"out": "--out"}):  # most commands have it
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
    except HystripError as error:
        _say(str(error))
        return USAGE if isinstance(error, (InputError, MissingExtra)) else FAILED
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


def _show_warnings() -> None:
    """Warnings of ours as one line, once each, without the place in the code; those of others as ever."""
    others, said = warnings.showwarning, set[str]()

    def show(message: Warning | str, category: type[Warning], *rest: Any, **options: Any) -> None:
        if category.__module__.startswith("hystrip"):
            if str(message) not in said:
                _say(f"warning: {message}")
            said.add(str(message))
        else:
            others(message, category, *rest, **options)

    warnings.showwarning = show


def _discard_closed_output() -> None:
    """Keep the interpreter's last flush from complaining about a pipe that nobody reads."""
    if sys.stdout is None:  # started without one
        return
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
