"""The audit: the derivation as pages that a reader of the paper can check, and the same content as JSON.

content (from the SymPy objects) -> JSON and HTML. What a computer has to measure or draw is measured apart, by ``hystrip audit``,
and stored; pages are made from the store, so that their text stays the same until somebody measures anew.
"""

from .render import audit_files

__all__ = ["audit_files"]
