"""How much a Chebyshev series misses, from the coefficients that it has.

Like ``standardChop`` of Aurentz & Trefethen, "Chopping a Chebyshev series" (ACM Trans. Math. Softw. 43, 2017, 33), this looks
at the envelope of the coefficients: how it falls from the middle of the series to its end, and the plateau of rounding where it
stops falling. Unlike that it has to say how large the rest is, with as few as seven coefficients: the envelope is continued at
the rate that it falls at, which for coefficients of quantities with a common singularity is the slowest of theirs.
"""

import numpy as np

_EPS = np.finfo(float).eps
#: rounding of a coefficient, in roundings of the largest one
_PLATEAU = 8.0
#: power of the size of the relatively largest quantity's last coefficients in that of every other one: of several quantities with
#: one singularity one has small last coefficients by chance; 0.5 would make all as large as the geometric mean
_COMMON = 0.2
#: how much larger the following coefficient is feared to be; and where the last ones are no smaller than this share of the
#: middle ones, so that they may fall like a power and come and go, as those of a kink do, how much larger still. With both, of
#: 2,400 integrals of tests/test_numerics.py 0.3 % err more than estimated and none more than is asked for, but for kinks and
#: roots that nobody marked: of 800 of those 18 % and 5 %
_SAFE, _SLOW, _POWER = 4.0, 1 / 16, 4.0


def following(c: np.ndarray, noise: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Bound of the first coefficient that follows on the series ``c`` (k, n, q), n >= 7, at least that of a rounded one, (k,
    q); and the rate (k,), below 1, at which coefficients fall from one to the next.

    ``noise`` (k, q): coefficients that small say nothing about the rate.
    """
    n = c.shape[1]
    size = np.abs(c)
    largest = size.max(axis=1)
    plateau = _PLATEAU * _EPS * largest
    above = np.maximum(size - plateau[:, None], 0.0)
    amplitude = largest + noise + np.finfo(float).tiny
    shape = (above / amplitude[:, None]).max(axis=2)
    # windows so wide that coefficients which come and go are not all small in them
    few, pair = max(3, n // 4), max(2, n // 8)
    start = max(1, n // 2 - few)
    last = shape[:, n - few :]
    since_middle = _ratio(last, shape[:, start : start + few])
    recently = _ratio(shape[:, n - pair :], shape[:, n - 2 * pair : n - pair])
    rate = np.minimum(np.maximum(since_middle ** (1 / (n - few - start)), recently ** (1 / pair)), 1 - 1 / n)
    # each of the last coefficients says what the next one after the series would be
    reach = rate[:, None] ** np.arange(few, 0, -1)
    own = (above[:, n - few :] * reach[:, :, None]).max(axis=1)
    common = (last * reach).max(axis=1)[:, None] * amplitude
    feared = _SAFE * np.where(since_middle > _SLOW, _POWER, 1.0)[:, None]
    return np.maximum(feared * own ** (1 - _COMMON) * common**_COMMON, plateau), rate


def _ratio(last, before):
    """Largest of the ``last`` coefficients over the largest ``before``, both (k, few), at most 1."""
    end, middle = last.max(axis=1), before.max(axis=1)
    return np.minimum(np.divide(end, middle, out=np.ones_like(end), where=middle > end), 1.0)
