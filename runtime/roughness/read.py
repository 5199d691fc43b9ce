"""Reading measured topographies, in any format that SurfaceTopography knows."""

import codecs
import contextlib
import io
import os
import re
import warnings
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import InputError
from ..extras import require
from ..files import path_of
from ..inputs.checks import number, sequence
from .lines import refuse_damaged_lines
from .scan import Scan, ScanWarning
from .units import Units, lacks_lengths, units_of

#: share of points that are filled without a warning: their roughness is missing from the levels
_FEW = 0.02
#: part of their steps by which positions may be uneven, as numbers of few digits are
_EVEN = 0.05
#: mean steps of a line beyond which a step is a gap, which holds waves that its levels count
_GAP = 4.0
#: a number with a decimal comma or without decimals, or an undefined one
_NUMBER = re.compile(rb"[-+]?\d+(,\d+)?(e[-+]?\d+)?|nan|bad", re.IGNORECASE)
#: how SDF files, as text or binary, began before ISO 25178-71
_OLD_SDF = re.compile(rb"([ab])BCR-1\.0")
#: a line of a matrix
_OF_MATRIX = re.compile(rb"[-+\d.eE\s,;]*(?:nan[-+\d.eE\s,;]*)*", re.IGNORECASE)
#: bytes of a file in which decimal commas are looked for
_HEAD = 100_000


def read_surface(
    path: str | os.PathLike[str],
    *,
    channel: str | None = None,
    unit: str | None = None,
    sizes: tuple[float, ...] | None = None,
    height_factor: float | None = None,
) -> Scan:
    """Read a scan with SurfaceTopography (extra ``roughness``).

    Points that the instrument left undefined are filled by its harmonic interpolation, which is smooth: their share is
    in ``Scan.filled``, and beyond 2 % there is a :class:`ScanWarning`. A line with uneven steps is interpolated to even
    ones; of steps longer than four mean ones the points count as undefined. Text may have decimal commas. ``Scan.units``
    says what heights and lengths were taken for.

    Parameters
    ----------
    path : the file; its format is found out
    channel : name of the channel; the file's default without it
    unit : length unit of all that the file states no unit of: heights, lengths, or both. Where it states both, either
        the same or None
    sizes : lengths of the scan, one for each direction, in ``unit``, for a file that does not say; of a matrix as text the one
        along its rows comes first
    height_factor : what heights in the file have to be multiplied with to be in their unit, for a file that does not say

    Raises
    ------
    InputError : the file cannot be read, lacks something, contradicts what is given, or has no defined point; names it
    MissingExtra : SurfaceTopography is not installed
    """
    with _quiet():
        topographies = require("SurfaceTopography", "roughness", "reading a measured surface")
    where = str(path_of(path, "path", "a file with a measured surface"))
    if not os.path.isfile(where):
        is_other = ": this is a folder, a pipe or a device" if os.path.exists(where) else ""
        raise InputError(where, where, f"a file with a measured surface{is_other}")
    try:
        with _quiet(), _opened(topographies, where) as reader:
            found = reader.default_channel if channel is None else _channel(reader, channel, where)
            _refuse_lists(found.nb_grid_pts, where)
            options: dict[str, Any] = {} if found.index == reader.default_channel.index else {"channel_index": found.index}
            options |= _lengths(found, sizes, where)
            units = units_of(reader, found, unit, where)
            if height_factor is not None:
                options["height_scale_factor"] = _factor(height_factor, where)
                units = replace(units, said=f"{units.said}, times {height_factor:g}")
            if found.unit is None:
                options["unit"] = units.heights
            elif found.height_scale_factor is None and (per_unit := units.heights_in(found.unit)) != 1:
                options["height_scale_factor"] = per_unit * options.get("height_scale_factor", 1.0)
            return _even(reader.topography(**options), units, where)
    except InputError as error:
        if error.field in ("scan.heights", "scan.sizes"):
            error = InputError(f"{where}, {error.field.removeprefix('scan.')}", error.value, error.allowed)
        raise error from None
    except Exception as error:  # readers of forty formats end in errors of as many kinds
        said = (str(error).strip() or type(error).__name__).splitlines()[0]
        allowed = "a measured surface, with sizes and unit in the file or else given (--size, --unit), not both"
        if type(error).__name__ == "CannotDetectFileFormat":
            said = "no format that SurfaceTopography knows"
            allowed += "; a matrix as text has blanks, tabs, commas or semicolons between numbers and nan for undefined points"
        raise InputError(where, said, allowed) from None


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Without what readers that look for their format in another one's file warn of, and of packages they do without."""
    with warnings.catch_warnings():
        for category in (RuntimeWarning, ImportWarning):
            warnings.simplefilter("ignore", category)
        yield


def _opened(topographies: Any, where: str) -> Any:
    """The file, opened; a matrix of numbers that commas or semicolons part as if tabs did."""
    try:
        source = _with_points(where)
        reader = topographies.open_topography(source)
        # terrain has no sign but its size: whatever has twice a square number of bytes would be one
        if reader.format() == "hgt" and not where.lower().endswith(".hgt") and os.path.getsize(where):
            reader.close()
            raise topographies.Exceptions.CannotDetectFileFormat
        if (form := reader.format()) in ("asc", "xyz"):
            refuse_damaged_lines(_content(where) if source is where else source.getvalue(), form, where)
        return reader
    except topographies.Exceptions.CannotDetectFileFormat:
        lines = _content(where).removeprefix(codecs.BOM_UTF8).splitlines()
        rows = [line for line in lines if not line.startswith(b"#")]
        separator = next((each for each in (b";", b",") if any(each in line for line in rows)), None)
        if separator is None or not all(map(_OF_MATRIX.fullmatch, rows)):
            refuse_damaged_lines(b"\n".join(lines), "", where)
            raise
        if separator == b"," and not any(b"." in line for line in rows):
            allowed = "decimal points, or blanks, tabs or semicolons between numbers: these commas may be decimal signs"
            raise InputError(where, "whole numbers parted by commas", allowed) from None
        tabbed = b"\n".join(line if line.startswith(b"#") else _with_tabs(line, separator) for line in lines) + b"\n"
        refuse_damaged_lines(tabbed, "asc", where)
        return topographies.open_topography(io.BytesIO(tabbed))


def _content(where: str) -> bytes:
    with open(where, "rb") as file:
        return file.read()


def _with_tabs(line: bytes, separator: bytes) -> bytes:
    """A line of a matrix with tabs between its numbers, and nan where there is none but at the end."""
    cells = [cell.strip() for cell in line.split(separator)]
    return b"\t".join(cell or b"nan" for cell in (cells if cells[-1] else cells[:-1]))


def _with_points(where: str) -> Any:
    """The file; of one with decimal commas, or a byte order mark, which would hide the first number, a copy without; of an SDF
    file that begins as before the standard one that begins as it says."""
    with open(where, "rb") as file:
        head = file.read(_HEAD)
        commas, sdf = any(map(_has_decimal_commas, head.splitlines())), _OLD_SDF.match(head)
        if not (commas or sdf or head.startswith(codecs.BOM_UTF8)):
            return where
        data = head.removeprefix(codecs.BOM_UTF8) + file.read()
        if sdf:
            return io.BytesIO(sdf[1] + b"ISO-1.0" + data[sdf.end() :])
        return io.BytesIO(data.replace(b",", b".").replace(b";", b"\t") if commas else data)


def _has_decimal_commas(line: bytes) -> bool:
    words = line.replace(b";", b" ").split()
    return len(words) > 1 and b"," in line and all(_NUMBER.fullmatch(word) for word in words)


def _refuse_lists(shape: tuple[int, ...], where: str) -> None:
    """Refuse what a reader takes for a matrix of few columns: points that fill no grid; and a file without a point."""
    if 0 in shape:
        raise InputError(where, "no point", "a file with a measured surface")
    if len(shape) == 2 and min(shape) <= 3 < max(shape):
        allowed = "a matrix of at least 8 x 8; rows of x, y, height fill an even grid, what was not measured as nan"
        raise InputError(where, f"a matrix of {shape[0]} x {shape[1]}", allowed)


def _refuse_positions(heights: np.ndarray, where: str) -> None:
    """Refuse a first row or column that counts evenly, as numbers of rows and positions beside a matrix do."""
    for lines in (heights, heights.T):
        first, second = (np.diff(line[1:]) for line in lines[:2])  # a corner between both belongs to neither
        goes_on, turns = np.ptp(first) < _EVEN * np.abs(first).max(), np.ptp(second) > np.abs(second).max()
        if goes_on and turns:
            shown = ", ".join(f"{each:g}" for each in lines[0, 1:4])
            raise InputError(
                where, f"a first row or column of {shown}, ...", "heights alone, without positions or numbers of lines"
            )


def _channel(reader: Any, name: str, where: str) -> Any:
    names = [each.name for each in reader.channels]
    if name not in names:
        raise InputError(f"{where}, channel", name, f"one of {', '.join(map(repr, names))}")
    return reader.channels[names.index(name)]


def _lengths(channel: Any, sizes: tuple[float, ...] | None, where: str) -> dict[str, Any]:
    stated = channel.physical_sizes
    if stated is not None and len(stated) != channel.dim:
        allowed = f"{channel.dim} lengths, one for each direction: # Width and # Height above a matrix"
        raise InputError(f"{where}, sizes", [float(each) for each in stated], allowed)
    if lacks_lengths(channel) and sizes is None:
        allowed = "lengths of the scan, one for each direction, since the file does not say (--size, --unit)"
        raise InputError(f"{where}, sizes", None, allowed)
    if not lacks_lengths(channel) and sizes is not None:
        stated = " x ".join(f"{each:.6g}" for each in channel.physical_sizes or ()) or "where each point lies"
        raise InputError(f"{where}, sizes", sizes, f"none, since the file says: {stated} {channel.unit or ''}".rstrip())
    if sizes is None:
        return {}
    for each in (sizes := tuple(sequence(f"{where}, sizes", sizes, "one number for each direction of the scan"))):
        number(f"{where}, sizes", each, "", 0, strict=True)
    if len(sizes) != channel.dim:
        raise InputError(f"{where}, sizes", sizes, f"{channel.dim} of them (--size), one for each direction of the scan")
    _remark_on_order(sizes, channel.nb_grid_pts, where)
    return {"physical_sizes": sizes}


def _remark_on_order(sizes: tuple[float, ...], points: tuple[int, ...], where: str) -> None:
    """Warn of two lengths that would part the points evenly the other way round."""
    steps, others = (np.divide(lengths, points) for lengths in (sizes, sizes[::-1]))
    if np.ptp(steps) > _EVEN * steps.max() and np.ptp(others) < _EVEN * others.max():
        apart = f"{steps[0]:.4g} and {steps[1]:.4g} apart, and the other way round evenly: are they in the order of the points?"
        lengths, counts = (" x ".join(f"{each:g}" for each in of) for of in (sizes, points))
        warnings.warn(f"{where}, sizes: {lengths} for {counts} points puts these {apart}", ScanWarning, stacklevel=4)


def _factor(given: Any, where: str) -> float:
    factor = number(f"{where}, height_factor", given, "")
    if factor == 0:
        raise InputError(f"{where}, height_factor", given, "a finite number other than 0")
    return factor


def _even(topography: Any, units: Units, where: str) -> Scan:
    """The scan in metres, on an even grid without gaps."""
    if topography.dim == 2:
        _refuse_positions(np.ma.filled(topography.heights(), np.nan), where)
    topography, gaps = topography.to_unit("m"), 0.0
    if topography.dim == 1:
        x = topography.positions() * units.factors[0]
        steps = np.diff(x)
        back = np.flatnonzero(steps <= 0)
        if back.size:
            value = f"{x[back[0] + 1]:.6g} m after {x[back[0]]:.6g} m"
            raise InputError(f"{where}, positions", value, "positions along the line that grow from row to row")
        gaps = steps[steps > _GAP * steps.mean()].sum() / steps.sum()
    if not topography.is_uniform:
        topography = topography.to_uniform(nb_points=len(topography.heights()))
    filled = float(gaps + (1 - gaps) * np.mean(np.ma.getmaskarray(topography.heights())))
    if filled == 1:
        raise InputError(f"{where}, heights", "no defined point", "a scan with some")
    if filled:
        topography = topography.interpolate_undefined_data()
    if filled > _FEW:
        text = f"{where}: {100 * filled:.2g} % of the points were undefined and are filled smoothly: levels come out too low"
        warnings.warn(text, ScanWarning, stacklevel=3)
    lengths = zip(topography.physical_sizes, units.factors, strict=True)
    return Scan(
        np.array(topography.heights(), dtype=float),
        tuple(float(length * factor) for length, factor in lengths),
        bool(topography.is_periodic),
        filled=filled,
        units=units.said,
    )
