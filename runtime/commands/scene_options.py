"""What the commands that write a scene set in it."""

from typing import Any

from ..errors import InputError

STARTER = "starter"


def settings(scene: str, pressure: float | None, title: str | None, named: str) -> dict[str, Any]:
    """Keys above the tables of a scene that is written, with their values; ``scene``: what it is made from, "" for none.

    The starter's pressure and title are its own, not the user's: there a pressure has to be given, and the title is ``named``.
    Raises ``InputError`` where a pressure is missing.
    """
    if scene == STARTER and pressure is None:
        raise InputError("--pressure", None, 'the nominal pressure, such as "0.2 MPa"; or a --scene that has one')
    title = named if title is None and scene == STARTER else title
    return {key: each for key, each in (("title", title), ("pressure", pressure)) if each is not None}


def left_to_the_user(scene: str, replaced: str) -> list[str]:
    """What to say of a scene made from the starter: what else in it than the table that was ``replaced`` is not the user's."""
    if scene != STARTER:
        return []
    tables = ", ".join(each for each in ("material", "adhesion", "levels") if each != replaced)
    return [f"note       {tables}, velocity and rtol are those of `hystrip init`: edit them, or name a --scene of yours"]
