r"""
The paper's surfaces
====================

Makhovskaya's paper shows one, two and three levels of waviness. Its scenes come with the package, and
``hystrip figures`` draws its Figures 3 to 7; here are the ideas behind them, with a coarser tolerance.
"""

import numpy as np

import hystrip

# %%
# Two levels in partial contact
# -----------------------------
#
# A wave of 10 µm carries one of 500 nm. Each rubs most where a slide by :math:`1/k` takes as long as the foundation
# needs to follow, so friction over velocity has a peak for each level, here close together.

scene = hystrip.load_scene("paper_fig6")
two = hystrip.solve(
    scene.material, scene.adhesion, scene.levels, pressure=100.0, velocity=np.geomspace(1e-5, 1e-1, 41), rtol=1e-3
)
print(two)

# %%

friction = two.plot()

# %%
# Into the contact
# ----------------
#
# At the peak: the pressure of level 1 over its cell. Behind the contact, at the left, the foundation has not recovered
# yet; adhesion holds on there for longer than in front.

top = int(np.nanargmax(two.mu))
contact = two.plot("map", at=top)

# %%
# Along the crest of level 1: the pressure, the profile in the foundation, and what rubs. Level 2 rubs where level 1 is in
# contact, by the law of friction that it has at the pressure it meets there (Figure 5 of the paper).

along = two.plot("strip", at=top, y=0.0)

# %%
# Three levels in saturated contact
# ---------------------------------
#
# At 5 MPa all of the surface touches. Friction is then a sum over levels, in closed form:
#
# .. math:: \mu = \frac{3 \pi^2}{16} \frac{K V (T_\varepsilon - T_\sigma)}{p_1}
#    \sum_i \frac{h_i^2}{l_i^2 + 4 \pi^2 V^2 T_\sigma^2}
#
# The paper prints :math:`\pi^2 h_i` to the first power, which has a dimension; the audit shows the derivation.

three = hystrip.load_scene("paper_fig7").solve()
saturated = three.plot()
