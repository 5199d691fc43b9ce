"""One strip: its regimes, its extremal periodic orbit, its means and fields (physics: one wave, one phase)."""
