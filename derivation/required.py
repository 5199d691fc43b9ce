"""What the extra ``regenerate`` installs, loaded before any module here needs it: a missing package is an error that names it."""

from hystrip.extras import require

for module in ("sympy", "jinja2", "ruff", "latex2mathml", "lark"):
    require(module, "regenerate", "the derivation")
