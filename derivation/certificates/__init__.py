"""Certificates: how far each emitted function is from its SymPy expression, over a deterministic stress grid.

The reference is the *derived* expression (not the stable form) evaluated with mpmath, with so many digits that at least 50
are right. The error is counted in ulp of the function's natural scale,

    scale = |f| + sum over inputs |x df/dx|,

what a relative change of eps in the inputs may do to f, plus f itself. No formula can be expected to do better, and one
that cancels more than its inputs ask for shows here. Inputs are the parameters, the position of the first phase (at least
one radian of it), the *widths* of the zones (a zone of width 1e-9 is known to a relative eps), and with several relaxation
times every entry of the material's arrays, which the function is given rounded. A sum is as exact as its terms: its scale
is that of each, added up.
"""

from .certify import certificates_of, certified_names, modes_of
from .grid import WORDS, domain
from .measure import Certificate, measure

SCALE = "|f| + sum |x df/dx| over the parameters, the first phase (at least 1 rad) and the widths of the zones"

__all__ = ["SCALE", "WORDS", "Certificate", "certificates_of", "certified_names", "domain", "measure", "modes_of"]
