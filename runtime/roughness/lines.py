"""Lines of a scan as text that its reader would pass over."""

from collections import Counter

from ..errors import InputError

_SPACED, _UNDEFINED = bytes.maketrans(b",;", b"  "), (b"bad", b"infinite")
#: words of a line from which on it is no heading, if half of them are numbers
_WIDE = 8
#: lines of numbers in a row from which on they are no heading
_RUN = 3


def refuse_damaged_lines(text: bytes, form: str, where: str) -> None:
    """Raise ``InputError`` for a line among the numbers in which something is none: readers drop it, and in a list of points
    (``form`` xyz) all above, as if the rest were all there is."""
    lines = [(at, line.strip()) for at, line in enumerate(text.splitlines(), 1) if line.strip()]
    if form != "xyz":
        lines = [(at, line) for at, line in lines if not line.startswith(b"#")]
    words = [line.translate(_SPACED).split() for _, line in lines]
    numbers = [_count(each, form) for each in words]
    counts = [count if count == len(each) else 0 for each, count in zip(words, numbers, strict=True)]
    width, often = max(Counter(filter(None, counts)).items(), key=lambda each: each[1], default=(0, 0))
    runs = [at for at in range(len(lines)) if counts[at : at + _RUN] == [width] * _RUN]
    if not runs or 2 * often < len(lines):  # no table
        return
    first, last = runs[0], runs[-1] + _RUN - 1
    for at, ((line, shown), each) in enumerate(zip(lines, words, strict=True)):
        most, whole = 2 * numbers[at] >= width, len(each) == width
        among = first < at < last and (form == "xyz" or whole or most)
        beside = at in (first - 1, last + 1) and width >= _WIDE and whole and most
        if counts[at] != width and (among or beside):
            allowed = "numbers alone, nan for an undefined point"
            raise InputError(f"{where}, line {line}", shown.decode(errors="replace"), allowed)


def _count(words: list[bytes], form: str) -> int:
    """How many of the words are numbers, or stand for an undefined one in the files of this form."""
    try:
        return len([*map(float, words)])
    except ValueError:
        return sum(_is_number(word) or (form == "asc" and word.lower() in _UNDEFINED) for word in words)


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
