"""What commands that derive have in common."""

from ..extras import require


def needed(purpose: str) -> None:
    """Check that the derivation can run. Raises MissingExtra, which names the extra."""
    for module in ("sympy", "jinja2", "ruff", "latex2mathml", "lark"):
        require(module, "regenerate", purpose)
