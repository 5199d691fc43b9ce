r"""What a function says of the quantity that it derives: sentence, equation and number in the paper, read from its docstring.

Of one quantity the docstring says it at its beginning, of several each in a paragraph that begins with the quantity's name:

    Eq. 5: In contact w = u is given.                 gap_after: Gap at s_1 when it was gap_0 at s_0.

    .. math:: w = u                                   .. math:: g(s_1) = g_0 + \dots
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any

PARAGRAPH = re.compile(r"(?:(\w+)(?:, )?)??(Eq\. \d+(?:, \d+)*)?: (?=\S)")
MATH = ".. math:: "


def said(by: Callable[..., Any], name: str) -> tuple[str, str, str]:
    """(sentence, LaTeX, number in the paper) of the quantity ``name``; the last two empty where there is none."""
    paragraphs = [" ".join(text.split()) for text in (inspect.getdoc(by) or "").split("\n\n")]
    own = [n for n, text in enumerate(paragraphs) if (mark := PARAGRAPH.match(text)) and mark[1] == name] or [0]
    first, *rest = paragraphs[own[0] :]
    mark = PARAGRAPH.match(first)
    marked = mark is not None and mark[1] in (None, name)
    equation = next((text.removeprefix(MATH) for text in rest[:1] if text.startswith(MATH)), "")
    return (first[mark.end() :] if marked else first), equation, (mark[2] or "") if marked else ""
