"""Reading a table of numbers as instruments export it: any of four separators, decimal point or comma, one row of names."""

import csv
import itertools
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..errors import InputError
from ..files import path_of, read_at_most

_LARGEST = 1 << 24  # bytes; a master curve has a few thousand
_SEPARATORS = {"\t": "tab", ";": "semicolon", ",": "comma"}
_BLANKS = "blanks"
#: rows of remarks that an instrument may write above the names
_PREAMBLE = 200
#: of so many cells a row is no table
_WIDEST = 10_000
#: of more words a line is no row of names that blanks part
_MOST_WORDS = 300
_HINTS = {
    "comma": "; with a decimal comma, parted by semicolon or tab",
    _BLANKS: "; parted by semicolon or tab where some are empty or hold blanks",
}
_SWAPPED = str.maketrans(".,", ",.")
_THOUSANDS = {sign: re.compile(rf"[-+]?[1-9]\d{{0,2}}(\{sign}\d{{3}})+") for sign in ",."}
#: thousands parted by blanks or apostrophes, which no decimal sign looks like
_PARTED = re.compile(r"[-+\u2212]?\d{1,3}([\s'’])\d{3}(\1\d{3})*([.,]\d*)?([eE][-+]?\d+)?")
_IN_BRACKETS = re.compile(r"[\[({<][^\[\](){}<>]*[\])}>]")
#: what stands where there is no number, if anything
NO_NUMBER = re.compile(r"-*|\u2013|\u2014|n/?a|null|none", re.IGNORECASE)
#: a line that only rules off what stands above it
_RULE = re.compile(r"\s*[-=_*]{4}[-=_*\s]*")
#: a number, in whatever signs
_DIGITS = re.compile(r"[-+\u2212]?[\d.,\s'’]+([eE][-+]?\d+)?")


@dataclass(frozen=True)
class Table:
    """A table of text: ``names`` of the columns, the rows below as (line number, cells), what parts the cells, and the
    ``line`` of the names, the lines above it, and of how many tables with the same names the rows are."""

    where: str
    names: list[str]
    rows: list[tuple[int, list[str]]]
    separator: str
    line: int
    remarks: tuple[str, ...] = ()
    times: int = 1

    def cell(self, row: Sequence[str], column: int) -> str:
        """A cell, empty beyond the end of its row."""
        return row[column] if column < len(row) else ""

    def number(self, row: Sequence[str], column: int) -> str:
        """A cell that is to hold a number, without blanks or apostrophes between thousands."""
        text = self.cell(row, column)
        parted = _PARTED.fullmatch(text)
        return text.replace(parted[1], "") if parted else text


def read_table(path: str | os.PathLike[str], lacking: Callable[[list[str]], tuple[int, str]]) -> Table:
    """The table in a text file, from the first row of names on that lacks nothing.

    ``lacking`` : of a row of names, how many of the columns that are needed are not there, and these in words

    Raises ``InputError`` naming the file: not readable, not text, without such a row, or with more cells in a row than names;
    where blanks part them, with fewer.
    """
    where = str(path_of(path, "path", "a text file with a table"))
    lines = ["" if _RULE.fullmatch(line) else line for line in _text(where).splitlines()]
    nearest = (lacking([])[0], "", 0, [])
    # first line by line: a quotation mark in a remark opens no cell of many lines; names behind the sign of a remark at last
    for marked, whole, separator in itertools.product((False, True), (False, True), _SEPARATORS):
        rows = _rows(where, lines, separator, whole)
        for at, (line, cells) in enumerate(rows[:_PREAMBLE]):
            names = [cells[0].lstrip("#% "), *cells[1:]]
            count, words = lacking(names if marked else cells)
            if not count:
                below, times = _joined(cells, _unmarked(rows[at + 1 :]) if marked else rows[at + 1 :])
                return _checked(Table(where, names, below, _SEPARATORS[separator], line, tuple(lines[: line - 1]), times))
            if count < nearest[0]:
                nearest = (count, f"in this row of names also {words}", line, cells)
    # blanks stand in names and remarks too: only where nothing else parts the cells
    texts = [(line, text.strip(" \t")) for line, text in enumerate(lines, 1) if text.strip()]
    for marked, (at, (line, text)) in itertools.product((False, True), enumerate(texts[:_PREAMBLE])):
        for names in _parted_by_blanks(text.lstrip("#% ")) if marked == text.startswith(("#", "%")) else ():
            count, words = lacking(names)
            head = [_cells(below.lstrip("#% "), len(names)) for _, below in texts[at + 1 : at + 3]]
            fits = any(len(cells) == len(names) and _numeric(cells, 3) for cells in head)
            fits &= all(lacking(cells)[0] for cells in head)  # or it is a remark above the names
            if fits and not count:
                rows = [(line, _cells(below, len(names))) for line, below in texts[at + 1 :]]
                below, times = _joined(names, _unmarked(rows, len(names)) if marked else rows)
                return _checked(Table(where, names, below, _BLANKS, line, tuple(lines[: line - 1]), times))
            if fits and count < nearest[0]:
                nearest = (count, f"in this row of names also {words}", line, names)
            if not count:  # but no such rows below; names that are parted finer would be others
                unfit = "as many names as numbers below, two blanks or more between them or each with its unit in brackets"
                nearest = min(nearest, (2, unfit, line, names), key=lambda each: each[0])
                break
    _, allowed, line, cells = nearest
    if cells:
        raise InputError(f"{where}, line {line}", cells, allowed)
    first = next((line for line in lines if line.strip()), "")
    if not first:
        raise InputError(where, "no text", "a row of names (frequency, storage and loss modulus, with units), then numbers")
    allowed = "a row of names, in one of them frequency or omega, in two of them storage, loss (E', E'' or G', G'') or tan delta"
    allowed += f"; separated by comma, semicolon or tab, or by blanks; among the first {_PREAMBLE} rows"
    raise InputError(where, first, allowed)


def _unmarked(rows: list[tuple[int, list[str]]], width: int = 0) -> list[tuple[int, list[str]]]:
    """Rows below names behind the sign of a remark: one of units has the sign, too. A row of numbers keeps it: it is no data.

    ``width`` : of rows that blanks part, so many names"""
    for line, cells in rows[:1]:
        units = [cells[0].lstrip("#% "), *cells[1:]]
        units = _cells(" ".join(units).strip(), width) if width else units
        if not _numeric(units):
            return [(line, units), *rows[1:]]
    return rows


def _joined(names: list[str], rows: list[tuple[int, list[str]]]) -> tuple[list[tuple[int, list[str]]], int]:
    """Rows of tables with the same names, one below the other, without the names, units and remarks above each but the first;
    and how many tables there are."""
    joined: list[tuple[int, list[str]]] = []
    times, above = 1, False
    for line, cells in rows:
        if cells == names:
            times, above = times + 1, True
            while joined and not _numeric(joined[-1][1]):
                joined.pop()
        elif not (above and cells == rows[0][1] and not _numeric(cells)):
            joined.append((line, cells))
            above = False
    return joined, times


def _numeric(cells: Sequence[str], least: int = 1) -> bool:
    """Whether so many of the cells are numbers."""
    return sum(_DIGITS.fullmatch(cell) is not None for cell in cells) >= least


def _parted_by_blanks(text: str) -> list[list[str]]:
    """The cells of a row of names, in each way that blanks may part them, the surest first: by two or more, or all behind
    brackets, or wherever they stand. Blanks within brackets, before them and beside a slash part none."""
    if len(text.split()) > _MOST_WORDS:
        return []
    held = _IN_BRACKETS.sub(lambda found: re.sub(r"[ \t]", "\0", found[0]), text)
    held = re.sub(r"(?<![ \t])[ \t]+(?:(?=[\[({<])|(/|in)[ \t]+)", lambda found: f"\0{found[1]}\0" if found[1] else "\0", held)
    ways = (re.split(blanks, held) for blanks in (r"[ \t]{2,}|\t", r"(?<=[\])}>])[ \t]+", r"[ \t]+"))
    return [[name.replace("\0", " ") for name in way] for way in ways]


def _cells(text: str, count: int) -> list[str]:
    """The cells of a row that blanks part, as many as there are names; all of it in one if it has not so many."""
    cells = re.split(r"[ \t]+", text)
    return cells if len(cells) == count else next((way for way in _parted_by_blanks(text) if len(way) == count), [text])


def refuse_footer(table: Table, line: int) -> None:
    """Raise ``InputError`` for the row of this line if it is text, and no row of numbers follows it."""
    last, above = max(((at, row) for at, row in table.rows if _numeric(row, 3)), default=(0, []))
    row = next(row for at, row in table.rows if at == line)
    filled = [i for i, cell in enumerate(row) if cell]
    # a column of text has some in a row of numbers, too
    text = (row[filled[0]], table.cell(above, filled[0]) if len(filled) > 1 else "")
    if 0 < last < line and not _DIGITS.fullmatch(text[0]) and (not text[1] or _DIGITS.fullmatch(text[1])):
        beginning = " ".join(filter(None, row))[:40]
        allowed = (
            f"rows of numbers down to the end: delete the text below the last of them, line {last}, or keep it above the names"
        )
        raise InputError(f"{table.where}, line {line}", beginning, allowed)


def _checked(table: Table) -> Table:
    """Refuse rows of more cells than names, or of fewer where blanks part them: it is not known which stands below which name."""
    width = max(i for i, name in enumerate(table.names, 1) if name)
    for line, row in table.rows:
        if any(row[width:]) or (table.separator == _BLANKS and len(row) < width):
            refuse_footer(table, line)
            hint = _HINTS.get(table.separator, "")
            raise InputError(f"{table.where}, line {line}", row, f"{width} cells, as many as there are names{hint}")
        if table.separator == _BLANKS and any(cell.endswith((",", ";")) for cell in row):
            raise InputError(f"{table.where}, line {line}", row, "cells that are parted by blanks alone, as the names are")
    return table


def decimal_comma(table: Table, cells: Sequence[str], given: str | None) -> bool:
    """Whether a comma in these cells is the decimal sign. Raises ``InputError`` where both readings are possible.

    ``given``: ``"."`` or ``","`` decides; None: from the cells themselves.
    """
    if given is not None:
        if given not in (".", ","):
            raise InputError("decimal", given, "'.' or ','")
        return given == ","
    cells = [cell for cell in cells if _DIGITS.fullmatch(cell)]  # a text, such as one below the table, says nothing
    for cell in cells:
        if "," in cell and "." in cell:  # the sign further to the right is the decimal one
            return cell.rfind(",") > cell.rfind(".")
    having = {sign: [cell for cell in cells if sign in cell] for sign in ",."}
    for sign, found in having.items():
        if any(not _THOUSANDS[sign].fullmatch(cell) for cell in found):
            return sign == ","
    for sign, found in having.items():
        if any(cell.count(sign) > 1 for cell in found):
            return sign == "."
    for sign, found in having.items():
        if found and (sign, table.separator) != (".", "comma"):  # 2.100 between commas is no 2100
            raise InputError(table.where, found[0], 'a number that can be read in one way; say decimal="," or "." (--decimal)')
    return False


def as_number(text: str, comma: bool) -> float:
    """The number in a cell, NaN for one that is empty or says that there is none. Raises ``ValueError``."""
    text = "" if NO_NUMBER.fullmatch(text) else text.replace("\u2212", "-")
    if comma:
        text = text.translate(_SWAPPED)
    if "," in text:  # between thousands alone
        if not _THOUSANDS[","].fullmatch(text.partition(".")[0]):
            raise ValueError(text)
        text = text.replace(",", "")
    if "_" in text:
        raise ValueError(text)
    return float(text or "nan")


def last_digit(text: str, comma: bool) -> float:
    """What a one in the place of the last digit of a number is worth. Raises ``ValueError`` where that is no number."""
    mantissa, _, exponent = text.casefold().partition("e")
    return float(f"1e{int(exponent or 0) - len(mantissa.partition(',' if comma else '.')[2])}")


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
    kinds = "UTF-8, UTF-16 with its byte order mark, or Windows-1252"
    raise InputError(where, where, f"a text file ({kinds}); of a spreadsheet, one sheet saved as CSV")


def _rows(where: str, lines: list[str], separator: str, whole: bool) -> list[tuple[int, list[str]]]:
    """Rows that hold something, with their line numbers; ``whole``: a cell in quotes may go on in the next line."""
    found = []
    try:
        for above, part in enumerate([lines] if whole else ([line] for line in lines)):
            reader = csv.reader(part, delimiter=separator, strict=whole)
            for row in reader:
                if len(row) > _WIDEST:
                    raise InputError(where, f"{len(row)} columns in line {above + reader.line_num}", f"at most {_WIDEST}")
                cells = [cell.strip() for cell in row]
                if any(cells):
                    found.append((above + reader.line_num, cells))
    except csv.Error as error:
        if whole:
            return []
        raise InputError(where, where, f"a table of text ({error})") from None
    return found
