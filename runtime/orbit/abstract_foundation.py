"""What levels and strips ask of a foundation, and what one relaxation time and several have in common: strips in SI units, the
flat strip apart, and the refusal of what could not be certified."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from types import ModuleType
from typing import Any

import numpy as np

from ..errors import InputError, SolverError
from ..inputs.materials import parameters
from ..numerics.rounding import LARGEST
from .at_rest import AT_REST, SLOW, solve_at_rest
from .batch import at_points
from .groups import TWO_PI, snaps_in
from .nonadhesive import Waves
from .regimes import CODE, ZONES
from .solved import Solved

#: a wave this much smaller than every other length is below their rounding
_NEGLIGIBLE = 1e-18


class Foundation(ABC):
    """A material with its generated solver: all that levels and strips ask of it. Arrays flat, (N,), SI unless said otherwise.

    ``parameters``: what the generated functions of a level take first, K among them. ``J``: instantaneous compliance times K.
    ``times``: of retardation and relaxation, s; ``longest_time``: the longest. ``lossiest_rate``: rate of the greatest loss
    modulus, 1/s; inf where that grows without bound. ``fastest``: the longest time over that of a passage, at a strip's ``pace``,
    up to which orbits are told from rounding; by default what emitted functions are certified for (generated/certificates.json).
    """

    fastest = 1e30

    kernel: ModuleType
    material: Any
    K: Any
    J: Any
    parameters: tuple
    times: tuple
    longest_time: Any

    @property
    @abstractmethod
    def lossiest_rate(self): ...

    @abstractmethod
    def flat(self, shape) -> Foundation:
        """The same for strips of this shape, flattened: array parameters are broadcast to it."""

    @abstractmethod
    def solve_strips(self, strips, unloading: bool) -> Solved:
        """Solve dimensionless strips; ``certified`` is false for every one that must not be used."""

    @abstractmethod
    def at_rate(self, rate) -> tuple:
        """The times of the foundation over those of strips at ``rate = k V``, 1/s, as the kernel's functions of it take them."""

    @abstractmethod
    def strips(self, rate, D, p_0, delta_0, edge: str, snaps) -> Any:
        """Dimensionless strips at ``rate = k V``, 1/s, the rest dimensionless; ``snaps``: where a step of w by ``J_0 p_0`` closes
        the gap (``groups.snaps_in``)."""

    @abstractmethod
    def fold(self, sequence: str, edges, strips) -> np.ndarray:
        """Of orbits of a ``sequence`` with a free part: zero at a fold, with a change of sign."""

    @abstractmethod
    def moduli(self, strips) -> tuple:
        """Storage and loss of the foundation over K, and its instantaneous compliance times K."""

    @abstractmethod
    def zones(self, sequence: str, edges, strips) -> Iterable[tuple]:
        """Zones of orbits of a ``sequence`` in the order met: letter, start, and what they begin with, (..., N)."""

    @abstractmethod
    def excess(self, start, entry, strips) -> tuple:
        """The constants of the kernel's ``excess_event`` in a contact that begins so."""

    @abstractmethod
    def gap(self, start, entry, pressure, strips) -> tuple:
        """The constants of the kernel's ``gap_event`` in a zone that begins so, under its constant pressure."""

    def pace(self, rate) -> np.ndarray:
        """Share of its speed at which a strip is solved: 1, or less where it is taken as the limit of infinite speed."""
        return np.ones_like(rate)

    def solve(self, l, A, D, V, p_0, delta_0, edge: str, branch: str) -> tuple[Solved, Any, dict]:  # noqa: E741
        """Solve strips: ``Solved`` (dimensionless), the dimensionless strips, and the scales back to SI.

        A strip whose wave is negligible, ``scales["flat"]``, is in units of K alone. ``edge`` has passed ``check_edge``. Raises
        ``SolverError`` for a strip that could not be certified."""
        shape, named, adhesion = D.shape, {"l": l, "A": A, "D": D, "V": V}, {"p_0": p_0, "delta_0": delta_0}
        l, A, D, V, p_0, delta_0 = map(once, (l, A, D, V, p_0, delta_0))  # noqa: E741
        with np.errstate(over="ignore", invalid="ignore"):  # refused by name
            k = 2 * np.pi / l
            rate = k * V
            longest, pace = rate * self.longest_time, self.pace(rate)
            fast = (longest > LARGEST) | (longest * pace > self.fastest)
        if fast.any():
            allowed = f"k V times the longest retardation time at most {self.fastest:g}"
            raise InputError("V", float(np.broadcast_to(V, fast.shape)[fast][0]), allowed)
        traction = p_0 / self.K
        # the amplitude does not count where nothing of the wave, stiffened by the motion, shows in the other lengths
        flat = A * (1 + longest) <= _NEGLIGIBLE * (np.abs(D) + traction + delta_0)
        unit = np.where(flat, 1.0, A) if flat.any() else A
        snaps = snaps_in(self.J * traction, delta_0)
        lengths = (every(v, shape) for v in (D / unit, traction / unit, delta_0 / unit))
        strips = self.strips(rate, *lengths, edge, every(snaps, shape))
        solved = self._solve(strips, every(flat, shape), every(longest, shape), branch == "unloading")
        bad = np.flatnonzero(~solved.certified)
        if bad.size:
            # an array that was spread over the strips in `flat` is not known by its own name any more
            of_material = {n: v for n, v in parameters(self.material, named | adhesion).items() if np.shape(v) in ((), shape)}
            inputs = (named | of_material | {"K": self.K} | adhesion).items()
            first = ", ".join(f"{n}={float(np.broadcast_to(v, shape)[bad[0]])!r}" for n, v in inputs)
            raise SolverError(
                f"{bad.size} of {solved.size} strips could not be certified; the first, strip {bad[0]}: "
                f"{first}, edge={edge!r}, branch={branch!r}"
            )
        if (pace < 1).any():
            # friction falls like 1/V then where nothing steps, that is but for adhesion that begins and ends and lets w step
            falls = np.isnan(solved.c) | (edge == "continuous")
            solved.tau_mean *= np.where(falls, pace, 1.0)
        scales = {"k": k, "A": A, "D": D, "p": self.K * unit, "length": unit, "flat": flat}
        return solved, strips, {name: every(v, shape) for name, v in scales.items()}

    def _solve(self, strips, flat, longest, unloading: bool) -> Solved:
        """Solve strips of which some are ``flat``, in units of K alone; ``longest``: longest time over that of their passage."""
        if not (flat.any() or (longest <= SLOW).any()):
            return self.solve_strips(strips, unloading)
        solved, moving = Solved.empty(strips.size), np.flatnonzero(~flat & (longest > AT_REST))
        solved.put(moving, self.solve_strips(strips.take(moving), unloading))
        rest = np.flatnonzero(~solved.certified & (flat | (longest <= SLOW)))
        solved.put(rest, solve_at_rest(self.kernel, strips.take(rest), flat[rest], unloading))
        # at rest nothing is lost but where adhesion ends
        solved.tau_mean[(longest == 0) & np.isnan(solved.c)] = 0.0
        return solved

    def waves(self, rate: np.ndarray) -> Waves:
        """Strips without adhesion at the rates ``k V`` (N,), 1/s."""
        none = np.zeros(rate.size)
        return Waves(self, self.strips(rate, none, none, none, "constitutive", none > 0), self.pace(rate))

    def entry(self, sequence: str, edges, strips) -> np.ndarray:
        """What contact begins with."""
        return next(entry for zone, _, entry in self.zones(sequence, edges, strips) if zone == "c")

    def fields(self, strips, solved: Solved, phase) -> tuple[np.ndarray, np.ndarray]:
        """Dimensionless pressure and gap at phases (points, N) of each strip; at an edge those of the zone which begins there."""
        p, gap = np.zeros((2, *phase.shape))
        for sequence, code in CODE.items():
            index = np.flatnonzero(solved.code == code)
            if not index.size:
                continue
            s, later = strips.take(index), phase[:, index]
            if sequence == "c":
                storage, loss, _ = self.moduli(s)
                p[:, index] = s.D - 1 + storage * np.cos(later) - loss * np.sin(later)
            elif sequence in ("a", "f"):
                p[:, index] = 0.0 if sequence == "f" else -s.p_0
                gap[:, index] = p[:, index] - self.kernel.profile(later, s.D)
            else:
                edges = [getattr(solved, name)[index] for name in ZONES[sequence][1]]
                later = edges[0] + np.mod(later - edges[0], TWO_PI)
                for zone, start, entry in self.zones(sequence, edges, s):
                    inside, at, none = later >= start, np.maximum(later, start), np.zeros(index.size)
                    if zone == "c":
                        excess = self.kernel.excess_event(at, *at_points(self.excess(start, entry, s)))[0]
                        pressure, open_ = excess - s.p_0, none
                    else:
                        pressure = -s.p_0 if zone == "a" else none
                        open_ = self.kernel.gap_event(at, *at_points(self.gap(start, entry, pressure, s)))[0]
                    p[:, index], gap[:, index] = np.where(inside, pressure, p[:, index]), np.where(inside, open_, gap[:, index])
        return p, gap

    def event(self, sequence: str, number: int, edges, strips) -> tuple:
        """Of orbits of a ``sequence`` the event function of a zone, and its constants: the excess pressure in contact, else the
        gap."""
        zone, start, entry = list(self.zones(sequence, edges, strips))[number]
        if zone == "c":
            return self.kernel.excess_event, self.excess(start, entry, strips)
        return self.kernel.gap_event, self.gap(start, entry, -strips.p_0 if zone == "a" else 0 * strips.p_0, strips)

    def modulus_ratio(self, rate) -> np.ndarray:
        """``|K*(i rate)|/K``."""
        return self.kernel.modulus_ratio(*self.at_rate(rate))

    def saturation(self, p_0, l, h, V) -> tuple[np.ndarray, np.ndarray]:  # noqa: E741
        """Nominal pressure, Pa, and penetration, m, from which a level is in saturated contact when unloading."""
        return self._of_level("pressure", l, h, V, p_0), self._of_level("penetration", l, h, V, p_0)

    def saturation_friction(self, l, h, V) -> np.ndarray:  # noqa: E741
        """Friction of a level in saturated contact, Pa."""
        return self._of_level("friction", l, h, V)

    def _of_level(self, name: str, l, h, V, *p_0) -> np.ndarray:  # noqa: E741
        shape = np.broadcast_shapes(np.shape(l), np.shape(V), (1,))
        l, h, V = (np.broadcast_to(v, shape).ravel() for v in (l, h, V))  # noqa: E741
        return getattr(self.kernel, f"level_saturation_{name}")(*self.parameters, *p_0, l, h, V).reshape(shape)

    def surely_saturated(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """A penetration above which every strip of a level has no orbit but saturated contact, m.

        The excess pressure is positive all along, whatever the state: with the creep behind it not above D the pressure is at
        least ``K_g u - (K_g - K) D``. Or, with one time, the forcing ``H + p_0`` is, so that contact once made is never left, and
        no strip is out of reach."""
        glassy = np.divide(h, self.J, out=np.full(np.shape(self.J), np.inf), where=np.asarray(self.J) > 0)
        return np.maximum(np.minimum(self._forced(l, h, V), glassy) - p_0 / self.K, h)

    def _forced(self, l, h, V):  # noqa: E741
        """Penetration above which contact is never left without adhesion, by the load harmonic."""
        return np.full(np.shape(V), np.inf)


def once(values) -> np.ndarray:
    """One element of a view of a single number, else the array itself: what is the same for all strips is worked out once."""
    values = np.asarray(values, float)
    return values[:1] if values.strides == (0,) else values


def every(values, shape) -> np.ndarray:
    """The values for all strips, left a view where they are a single number."""
    return values if np.shape(values) == shape else np.broadcast_to(values, shape)
