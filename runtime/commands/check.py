"""``hystrip check``: is the checked-in solver what the derivation emits?"""

import typer

from .output import say


def command() -> None:
    """Compare the generated solver with a fresh one.

    Byte by byte; exits with 1 if they differ, or if a step does not verify, and names it. Needs the extra `regenerate`.
    """
    import hystrip.derivation

    from .progress import progress

    try:
        with progress("deriving") as report:
            drift = list(hystrip.derivation.check(progress=report))
    except hystrip.derivation.DerivationError as problem:
        say(f"hystrip: {problem}", err=True)
        raise typer.Exit(1) from None
    for record in drift:
        say(str(record))
    if drift:
        say(f"{len(drift)} generated file(s) differ from the derivation", err=True)
        raise typer.Exit(1)
    say("the generated files are what the derivation emits")
