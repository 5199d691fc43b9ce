"""Hysteretic sliding friction of multiscale wavy surfaces by the strip method."""

__version__ = "0.1.0"
