"""Strips on a foundation with several relaxation times: the extremal orbit of a state of n dimensions."""
