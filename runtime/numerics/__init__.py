"""Numerical methods on batches, without physics: bracketed roots, Chebyshev series, quadrature, linear systems.

Values are (m, q), several quantities at once. What else is in the batch changes no digit of them: work can be left out.
"""
