"""
The paper's figures
===================

Friction over velocity of one of the paper's surfaces.
"""

import hystrip

result = hystrip.load_scene("paper_fig7").solve()
figure = result.plot()
