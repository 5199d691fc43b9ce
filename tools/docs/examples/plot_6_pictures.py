r"""
All pictures, side by side
==========================

Every kind of picture that the library draws, at its final size: the width of a journal's column.
"""

import numpy as np

import hystrip

material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
levels = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]

# %%
# Curves: one level and six, over velocity and over the load
# -----------------------------------------------------------

many = [hystrip.Level(l=1e-5 / 3**i, h=1e-6 / 3**i) for i in range(6)]
none = hystrip.Dugdale(gamma=0)
six = hystrip.solve(material, none, many, pressure=5e6, velocity=np.geomspace(1e-5, 1, 61))
picture_1, picture_2 = six.plot("mu"), six.plot("tau")

# %%

load = hystrip.solve(material, adhesion, levels[1:], pressure=np.linspace(-1000, 6000, 57), velocity=5e-3, rtol=1e-3)
picture_3, picture_4, picture_5 = load.plot(), load.plot("mu"), load.plot("contact")

# %%
# The contact
# -----------

two = hystrip.solve(material, adhesion, levels, pressure=100.0, velocity=5e-3, rtol=1e-2)
picture_6, picture_7 = two.plot("map"), two.plot("map", level=2)

# %%

picture_8, picture_9 = two.plot("strip"), two.plot("strip", y=2.5e-6)

# %%

picture_10, picture_11 = two.plot("loop"), two.plot("loop", level=2)

# %%
# A strip, a level, a law of friction
# -----------------------------------

strip = hystrip.solve_strip(material, adhesion, l=1e-5, A=5e-7, D=6e-7, V=5e-3)
level = hystrip.solve_level(material, adhesion, levels[1], V=1e-3, pressure=-300.0, rtol=1e-3)
law = hystrip.friction_law(material, none, levels[1], V=5e-3, rtol=1e-3)
picture_12, picture_13, picture_14 = strip.plot(), level.plot(), law.plot()
