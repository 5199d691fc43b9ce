"""LaTeX to MathML, in pieces short enough for a narrow screen and for paper."""

import re

import latex2mathml.converter
from markupsafe import Markup

ROOM = 12  # characters of LaTeX from which a line may break before a sign
WIDE = 42  # visible characters from which it may break inside brackets too
SEPARATORS = (r"\\", r",\quad", r",\qquad", r"\quad", r"\qquad")
SIGNS = (" + ", " - ", " = ", r" \ge ", r" \le ", r" \cdot ")
ARROW = r"\Rightarrow"
FUNCTION = re.compile(r"<mi>(sin|cos|tan|arctan|arccos)</mi>(?=<m[in]>)")  # they touch what follows without a bracket
LEADING = re.compile(r"(<math[^>]*><mrow>)<mo([^>]*)>(?=(?:&#x0002B;|&#x02212;|&#x0003D;|&#x022C5;|[+=−⋅])</mo>)")
TOKEN = re.compile(r"\\left\s*(?:\\.|.)|\\right\s*(?:\\.|.)|\\[,;! ]|\\\\|\\[A-Za-z]+|.", re.DOTALL)
SIZED = re.compile(r"\\(?:left|right)\s*([()\[\]])")


ROWS = re.compile(r"\\(?:begin|end)\{aligned\}|&")
NULL = re.compile(r"\\(?:left|right)\s*\.")


def mathml(latex: str) -> Markup:
    """MathML of an equation: one inline element for each piece, between which a browser may break the line."""
    if r"\begin{aligned}" in latex:  # its lines, with brackets that need not close in the line where they open
        latex = re.sub(r"\\(?:left|right)(?![a-z])", "", NULL.sub("", ROWS.sub("", latex)))
    if r"\begin{cases}" in latex:
        return Markup(latex2mathml.converter.convert(latex))
    made = [latex2mathml.converter.convert(piece) for piece in pieces(latex)]
    made = [text if n == 0 else LEADING.sub(r'\1<mo\2 form="infix">', text) for n, text in enumerate(made)]
    return Markup(" ").join(Markup(FUNCTION.sub(r'<mi>\1</mi><mspace width="0.17em"/>', text)) for text in made)


def pieces(latex: str) -> list[str]:
    """The equation cut after separators, and before signs once a line is long; inside brackets only where it must be."""
    found = []
    for piece in _cut(latex, inside=False):
        if _visible(piece) > WIDE:
            found += _cut(SIZED.sub(r"\1", piece), inside=True)
        else:
            found.append(piece)
    return found


def widest(latex: str) -> int:
    """About how many characters wide the widest piece is that cannot be cut."""
    return max(map(_visible, pieces(latex)), default=0)


def _cut(latex: str, inside: bool) -> list[str]:
    found, depth, position, start = [], 0, 0, 0
    while position < len(latex):
        if depth == 0:
            separator = next((mark for mark in sorted(SEPARATORS, key=len, reverse=True) if latex.startswith(mark, position)), "")
            if separator:
                found.append(latex[start : position + separator.startswith(",")])
                position += len(separator)
                start = position
                continue
            arrow = latex.startswith(ARROW, position)
            if arrow or position - start > ROOM and latex.startswith(SIGNS, position):
                found.append(latex[start:position])
                start = position
        token = TOKEN.match(latex, position).group()
        depth += _opens(token, inside)
        position += len(token)
    return [piece.strip() for piece in (*found, latex[start:]) if piece.strip()]


def _opens(token: str, inside: bool) -> int:
    if token in "{}":
        return 1 if token == "{" else -1
    if inside:
        return 0
    if token in ("(", "[") or re.match(r"\\left[\s(\[{\\|.]", token):
        return 1
    return -(token in (")", "]") or bool(re.match(r"\\right[\s)\]}\\|.]", token)))


def _visible(latex: str) -> int:
    """About how many characters wide: of a fraction, the wider part counts, so commands count once and braces not."""
    return len(re.sub(r"\\[A-Za-z]+", "x", re.sub(r"\\(?:left|right|frac|tfrac|operatorname|mathrm|text)|[{}^_\s]", "", latex)))
