"""Sweeps: a scene solved over any of its parameters, in batches that go to disk as they come."""

from .run import Sweep, sweep

__all__ = ["Sweep", "sweep"]
