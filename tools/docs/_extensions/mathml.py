"""Formulas as MathML, which every browser draws by itself: the site needs no network."""

import html

import latex2mathml.converter


def _convert(latex, display):
    try:
        return latex2mathml.converter.convert(latex, display=display)
    except Exception as error:  # whatever the converter makes of a slip of the pen: say where
        raise ValueError(f"formula {latex!r}: {error}") from error


def inline(self, node):
    import docutils.nodes

    self.body.append(f'<span class="math">{_convert(node.astext(), "inline")}</span>')
    raise docutils.nodes.SkipNode


def block(self, node):
    import docutils.nodes

    number = f'<span class="eqno">({html.escape(str(node["number"]))})</span>' if node.get("number") else ""
    self.body.append(f'<div class="math">{number}{_convert(node.astext(), "block")}</div>')
    raise docutils.nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True}
