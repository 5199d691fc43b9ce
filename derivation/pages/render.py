"""Pages and JSON from the content."""

import base64
import json
import re
from typing import Any

from markupsafe import Markup, escape

from ..emit import rendered
from ..outcome import Derivation
from .content import content, identity
from .latex import mathml

INDEX = "index.html"
FORMULA = re.compile(r"\$([^$]+)\$")


def audit_files(
    derivations: tuple[Derivation, ...], files: dict[str, str], certificates: dict[str, Any], measured: dict[str, Any]
) -> dict[str, str]:
    """Text of every page and table, by its path in the audit's folder.

    ``certificates`` holds the certified functions of each model, ``measured`` what was measured and drawn for each.
    """
    pages = {}
    models = []
    for derivation in derivations:
        name = derivation.model.name
        page = content(derivation, files, certificates.get(name, {}).get("functions", {}))
        pages[f"{name}.json"] = json.dumps(page, indent=1, sort_keys=True, default=vars) + "\n"
        pages[f"{name}.html"] = _render("page", page=page, measured=measured.get(name, {}))
        models.append(page)
    pages[INDEX] = _render("index", models=models, identity=identity(files))
    return pages


def _render(kind: str, **values: Any) -> str:
    filters = {"mathml": mathml, "anchor": anchor, "picture": _picture, "prose": _prose}
    return rendered(f"audit/{kind}.html.jinja", filters, **values)


def anchor(name: str) -> str:
    """A name as the identifier of an element."""
    return re.sub(r"[^a-z0-9_.]+", "-", name.lower()).strip("-")


def _picture(svg: str) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()


def _prose(text: str) -> Markup:
    """Text in which ``$...$`` is an equation."""
    parts = FORMULA.split(text)
    return Markup("").join(mathml(part) if n % 2 else escape(part) for n, part in enumerate(parts))
