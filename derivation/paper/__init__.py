"""The paper's sixteen equations as printed, each read and compared with what is derived."""

from .compare import Comparison, comparisons

__all__ = ["Comparison", "comparisons"]
