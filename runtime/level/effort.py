"""What a solution costs, and the limits that keep the work on every point bounded."""

from dataclasses import dataclass, field

import numpy as np

from ..orbit.solved import Solved

#: Strips of one average, and of all averages of one curve over penetration. Three levels at rtol 1e-9 take 600 and 50,000, six
#: at 1e-3 1,500 and 120,000, two at 1e-12 500 and 130,000; what takes more does not converge.
AVERAGE_LIMIT, CURVE_LIMIT = 10_000, 150_000
#: what came to the limit of a curve
NO_CURVE = "the curve over penetration did not converge"


@dataclass
class WorkCounters:
    """Work done so far: strips whose orbit was searched for, strips decided by a closed form alone, and
    steps of bisection where no equation told where a regime ends.

    ``limits``: for pairs of velocity and wavelength, the limit that ended the work there.
    """

    solved: int = 0
    decided: int = 0
    bisected: int = 0
    limits: dict[tuple[float, float], str] = field(default_factory=dict)

    def count(self, solved: Solved) -> None:
        """Add the strips of a batch."""
        searched = int(np.count_nonzero(solved.searched))
        self.solved += searched
        self.decided += solved.code.size - searched

    def limit_reached(self, V: np.ndarray, wavelength: float, what: str) -> None:
        """Record that the work at the velocities ``V`` (n,) on the level of this ``wavelength`` ended before it converged."""
        for v in np.unique(V).tolist():
            self.limits.setdefault((v, wavelength), what)

    def reason(self, V: float) -> str:
        """Why a point at velocity ``V`` did not converge, in words."""
        found = [f"{what} on the level with l = {length:g} m" for (v, length), what in self.limits.items() if v == V]
        return "; ".join(found) or "the errors of its averages and laws add up to more"
