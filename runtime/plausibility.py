"""What about a result may be beyond the model or its material: said, not enforced."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .inputs.fitted import POOR

if TYPE_CHECKING:
    from .inputs.materials import Material
    from .inputs.surface import Level
    from .typing import Floats

#: slopes of Eq. 4 reach k h/2, about 1 here: the model is linear in them
STEEP = 0.3
#: m: beyond, inertia and the size of a sample matter; below, a continuum does not hold
LONGEST, SHORTEST = 0.1, 1e-9
#: K: no rubber slides below or above; degrees taken for kelvin come out there, and kelvin taken for degrees
COLDEST, HOTTEST = 100.0, 473.15


def notes(material: Material, levels: Sequence[Level], velocity: Floats, temperature: float | None = None) -> list[str]:
    """Warnings about surface, material, velocities (m/s) and temperature (K), one sentence each; none where nothing is odd."""
    said = [*_surface(levels), *_frequencies(material, levels, velocity)]
    if temperature is not None and temperature < COLDEST:
        said.append(f"a temperature of {temperature:g} K, below {COLDEST:g} K: degrees have to be given with their unit, or in K")
    if temperature is not None and temperature > HOTTEST:
        said.append(f"a temperature of {temperature:g} K, above {HOTTEST:g} K: no rubber lasts there")
    return said


def excited_band(levels: Sequence[Level], velocity: Floats) -> tuple[float, float] | None:
    """Lowest and highest frequency ``k V/2 pi`` at which levels move the material, Hz; None if nothing slides."""
    V = np.asarray(velocity, dtype=float)
    V = V[V > 0]
    if not V.size:
        return None
    l = [level.l for level in levels]  # noqa: E741
    return float(V.min() / max(l)), float(V.max() / min(l))


def excited(material: Material, levels: Sequence[Level], velocity: Floats) -> str:
    """What part of the frequencies a fitted material is known at, and how well; empty for a material that is not fitted."""
    fit, band = getattr(material, "fit", None), excited_band(levels, velocity)
    if fit is None or band is None:
        return ""
    error = fit.error_between(*band)
    known = "nowhere fitted" if error is None else f"where fitted the series is off by at most {100 * error:.2g} % rms"
    return f"k V/2 pi of all levels {band[0]:.3g} .. {band[1]:.3g} Hz; fitted {fit.low:.3g} .. {fit.high:.3g} Hz; {known}"


def _surface(levels: Sequence[Level]) -> list[str]:
    said = []
    for i, level in enumerate(levels, start=1):
        if level.h / level.l > STEEP:
            said.append(f"level {i}: h/l = {level.h / level.l:.2g} is above {STEEP}: the model takes slopes as small")
        if level.l > LONGEST:
            said.append(f"level {i}: a wavelength of {level.l:.3g} m, above {LONGEST} m")
        if level.l < SHORTEST:
            said.append(f"level {i}: a wavelength of {level.l:.3g} m, below 1 nm: no continuum")
    return said


def _frequencies(material: Material, levels: Sequence[Level], velocity: Floats) -> list[str]:
    fit, band = getattr(material, "fit", None), excited_band(levels, velocity)
    if fit is None or band is None:
        return []
    said = []
    # a limit that was converted differs by rounding
    if band[0] < fit.low * (1 - 1e-9) or band[1] > fit.high * (1 + 1e-9):
        said.append(
            f"k V/2 pi goes from {band[0]:.3g} to {band[1]:.3g} Hz, beyond the {fit.low:.3g} to {fit.high:.3g} Hz over which the "
            "material was fitted: extrapolated there"
        )
    error = fit.error_between(*band)
    if error is not None and error > POOR:
        said.append(
            f"the series of the material is up to {100 * error:.2g} % rms off what was measured, where k V of the levels lies"
        )
    return said
