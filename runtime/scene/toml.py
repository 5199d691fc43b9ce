"""Reading TOML that anybody may have written: of a size, length and depth that no scene exceeds."""

import re
import tomllib
from typing import Any

from .errors import SceneError

#: bytes of a scene at most; one has a few hundred
LARGEST = 1 << 19
#: values at most; Python's reader takes a second for some two hundred thousand
MOST = 25_000
#: brackets within brackets, and parts of a dotted key, at most; scenes have two of each. Python's reader takes a time that
#: grows with the square of either, and its stack ends at some hundred
_DEEPEST = 16
#: what may hold brackets and dots that mean nothing: texts, closed or not, and comments
_TEXTS = re.compile(
    r'"""(?:\\.|[^\\])*?(?:"""|\Z)'
    r"|'''.*?(?:'''|\Z)"
    r'|"(?:\\.|[^"\\\n])*+"?'
    r"|'[^'\n]*+'?"
    r"|\#[^\n]*+",
    re.DOTALL,
)


def parse_toml(text: str) -> dict[str, Any]:
    """Content of a TOML text. Raises SceneError for what is none, or is larger or deeper than any scene."""
    if len(text) > LARGEST:
        raise SceneError("", None, f"a TOML text of at most {LARGEST >> 10} KiB", "too large for a scene")
    bare = _TEXTS.sub("0", text)
    if bare.count(",") + bare.count("=") > MOST:
        raise SceneError("", None, f"at most {MOST} values", "too long for a scene")
    if _depth(bare) > _DEEPEST:
        raise SceneError("", None, f"lists and tables at most {_DEEPEST} deep", "nested too deeply for a scene")
    if max(part.count(".") for part in re.split(r"[=,\n\[\]{}]", bare)) >= _DEEPEST:
        raise SceneError("", None, f"a key of at most {_DEEPEST} parts", "a key with too many dots for a scene")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError("", None, "", f"not valid TOML: {error}") from None
    except ValueError:
        raise SceneError("", None, "integers of at most 4300 digits", "not valid TOML: an integer of too many digits") from None


def _depth(bare: str) -> int:
    depth = deepest = 0
    for each in re.findall(r"[\[\]{}]", bare):
        depth += 1 if each in "[{" else -1
        deepest = max(deepest, depth)
    return deepest
