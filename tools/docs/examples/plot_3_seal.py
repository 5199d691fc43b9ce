r"""
A soft seal that sticks: adhesion, pull-off, hysteresis
=======================================================

A soft lip with waves of 0.2 mm slides slowly over glass and sticks to it. How hard does it hold, where does it come off, and
what does a cycle of pressing in and pulling back cost?
"""

import numpy as np

import hystrip

material = hystrip.StandardLinearSolid(K=4e10, T_eps=5e-2, T_sigma=5e-3)
adhesion = hystrip.Dugdale(gamma=0.05, delta_0=200e-9)
level = hystrip.Level(l=200e-6, h=20e-6)

# %%
# The loop
# --------
#
# Pressed in from far above the lip touches late; pulled back from full contact it holds on into tension. Both branches are
# solutions at the same penetration: which one is met depends on where it comes from.

loop = hystrip.loading_loop(material, adhesion, level, V=1e-4)
print(loop)

# %%

drawn = loop.plot()

# %%
# Under load control the lip comes off at the dot, the least mean pressure of the upper branch. Sliding faster changes that:

for V in (1e-5, 1e-4, 1e-3):
    at = hystrip.loading_loop(material, adhesion, level, V=V, rtol=1e-2)
    print(f"V = {V:g} m/s: pull-off at {at.pull_off / 1e3:.3g} kPa, a cycle costs {at.work:.2e} J/m^2")

# %%
# Friction over the load
# ----------------------
#
# The coefficient tells little here: there is friction at zero pressure, and in tension. So stress, contact and penetration
# are drawn first, and the coefficient without a line through its pole.

result = hystrip.solve(material, adhesion, [level], pressure=np.linspace(1.2, -2.5, 61) * loop.pull_off, velocity=1e-4, rtol=1e-2)
over_load = result.plot()

# %%
# The contact in tension
# ----------------------

pulled = hystrip.solve_level(material, adhesion, level, V=1e-4, pressure=0.6 * loop.pull_off, rtol=1e-3)
print(pulled)

# %%

in_tension = pulled.plot()
