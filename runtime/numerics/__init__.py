"""Numerical methods on batches, without physics: bracketed roots, Chebyshev series, quadrature, changes of variable.

Values are (m, q), several quantities at once. Nothing depends on what else is in the batch, so that leaving work out never
changes a digit of the rest.
"""
