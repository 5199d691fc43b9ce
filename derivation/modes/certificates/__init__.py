"""Certificates of a model with n modes: how far each emitted function is from its SymPy expression.

As for one mode (:mod:`...certify`): the reference is the derived expression, evaluated with mpmath on exact inputs; the error is
counted in ulp of the function's natural scale, |f| + sum |x df/dx|. Inputs are the parameters, the phases, the state, and
every entry of the material's arrays, which the function is given rounded. A sum over modes or over zones is as exact as
its parts: the scale is that of each part, added up.
"""

from .certify import certify_modes, measured_names

__all__ = ["certify_modes", "measured_names"]
