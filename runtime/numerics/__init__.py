"""Numerical methods on batches, without physics: bracketed roots, Chebyshev series, quadrature, piecewise functions, adaptivity.

Shapes: a batch has ``members``; points are flat arrays (m,) with the member that each belongs to; values are (m, q), several
quantities at once. Nothing depends on what else is in the batch, so that leaving work out never changes a digit of the rest.
"""
