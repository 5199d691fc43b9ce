"""One strip: its regimes, its extremal periodic orbit, its means and fields (one wave, one phase)."""
