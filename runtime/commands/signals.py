"""Signals that end a command."""

import signal

#: exit status of a command that SIGTERM ended
TERMINATED = 143


class Terminated(SystemExit):
    """SIGTERM, as an exception: what is half done is undone, workers are ended."""


def raise_on_sigterm() -> None:
    """Have SIGTERM raise :class:`Terminated`, unless whoever started the command has it ignored."""
    if signal.getsignal(signal.SIGTERM) == signal.SIG_DFL:
        signal.signal(signal.SIGTERM, _terminate)


def ignore_interrupts() -> None:
    """Have Ctrl-C do nothing from here on."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _terminate(*_: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # once is enough
    raise Terminated(TERMINATED)
