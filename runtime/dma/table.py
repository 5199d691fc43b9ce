"""Reading a table of numbers as instruments export it: any of three separators, decimal point or comma, one row of names."""

import csv
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..errors import InputError
from ..files import path_of, read_at_most

_LARGEST = 1 << 24  # bytes; a master curve has a few thousand
_SEPARATORS = {"\t": "tab", ";": "semicolon", ",": "comma"}
#: rows of remarks that an instrument may write above the names
_PREAMBLE = 200
#: of so many cells a row is no table
_WIDEST = 10_000
_SWAPPED = str.maketrans(".,", ",.")
_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+")


@dataclass(frozen=True)
class Table:
    """A table of text: ``names`` of the columns, the rows below as (line number, cells), what parts the cells, and the
    ``line`` of the names, and the lines above it."""

    where: str
    names: list[str]
    rows: list[tuple[int, list[str]]]
    separator: str
    line: int
    remarks: tuple[str, ...] = ()

    def cell(self, row: Sequence[str], column: int) -> str:
        """A cell, empty beyond the end of its row."""
        return row[column] if column < len(row) else ""


def read_table(path: str | os.PathLike[str], is_header: Callable[[list[str]], bool]) -> Table:
    """The table in a text file, from the first row on that ``is_header``.

    Raises ``InputError`` naming the file: not readable, not text, or without such a row.
    """
    where = str(path_of(path, "path", "a text file with a table"))
    lines = _text(where).splitlines()
    for separator in _SEPARATORS:
        rows = _rows(where, lines, separator)
        for at, (line, cells) in enumerate(rows[:_PREAMBLE]):
            if is_header(cells):
                return Table(where, cells, rows[at + 1 :], _SEPARATORS[separator], line, tuple(lines[: line - 1]))
    first = next((line for line in lines if line.strip()), "")
    if not first:
        raise InputError(where, "no text", "a row of names (frequency, storage and loss modulus, with units), then numbers")
    allowed = "a row of names, in one of them frequency or omega, in two of them storage, loss (E', E'' or G', G'') or tan delta"
    raise InputError(where, first, f"{allowed}; separated by comma, semicolon or tab")


def decimal_comma(where: str, cells: Sequence[str], given: str | None) -> bool:
    """Whether a comma in these cells is the decimal sign. Raises ``InputError`` where both readings are possible.

    ``given``: ``"."`` or ``","`` decides; None: from the cells themselves.
    """
    if given is not None:
        if given not in (".", ","):
            raise InputError("decimal", given, "'.' or ','")
        return given == ","
    with_comma = [cell for cell in cells if "," in cell]
    if not with_comma:
        return False
    both = [cell for cell in with_comma if "." in cell]
    if both:  # the sign further to the right is the decimal one
        return both[0].rfind(",") > both[0].rfind(".")
    if any(not _THOUSANDS.fullmatch(cell) for cell in with_comma):
        return True
    if any("." in cell for cell in cells):  # 1,000 beside 2.5
        return False
    raise InputError(where, with_comma[0], 'a number that can be read in one way; say decimal="," or "." (--decimal)')


def as_number(text: str, comma: bool) -> float:
    """The number in a cell, NaN for an empty one. Raises ``ValueError``."""
    text = text.replace("\u2212", "-")
    if comma:
        text = text.translate(_SWAPPED)
    if "," in text:  # between thousands alone
        if not _THOUSANDS.fullmatch(text.partition(".")[0]):
            raise ValueError(text)
        text = text.replace(",", "")
    if "_" in text:
        raise ValueError(text)
    return float(text or "nan")


def _text(where: str) -> str:
    try:
        data = read_at_most(where, _LARGEST)
    except OSError as error:
        raise InputError(where, where, f"a file that can be read ({error.strerror or error})") from None
    if len(data) > _LARGEST:
        raise InputError(where, where, f"a text file of at most {_LARGEST >> 20} MiB")
    encodings = ("utf-16",) if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252")
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise InputError(where, where, "a text file (UTF-8, UTF-16 or Windows-1252)")


def _rows(where: str, lines: list[str], separator: str) -> list[tuple[int, list[str]]]:
    """Rows that hold something, with their line numbers."""
    found = []
    try:
        reader = csv.reader(lines, delimiter=separator)
        for row in reader:
            if len(row) > _WIDEST:
                raise InputError(where, f"{len(row)} columns in line {reader.line_num}", f"at most {_WIDEST}")
            cells = [cell.strip() for cell in row]
            if any(cells):
                found.append((reader.line_num, cells))
    except csv.Error as error:
        raise InputError(where, where, f"a table of text ({error})") from None
    return found
