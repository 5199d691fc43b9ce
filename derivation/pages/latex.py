"""LaTeX to MathML, in pieces short enough for a narrow screen and for paper."""

import re

import latex2mathml.converter
from markupsafe import Markup

ROOM = 12  # characters of LaTeX from which a line may break before a sign
WIDE = 42  # visible characters from which it may break inside brackets too
SEPARATOR = re.compile(r",?\\q?quad|\\\\")
SIGN = re.compile(r" (?:[-+=]|\\[gl]e|\\cdot) ")
ARROW = r"\Rightarrow"
TOKEN = re.compile(rf"{SEPARATOR.pattern}|{SIGN.pattern}|\\(?:left|right)\s*(?:\\.|.)|\\[,;! ]|\\[A-Za-z]+|.", re.DOTALL)
OPENING = re.compile(r"[{(\[]|\\left\s*\S+")
CLOSING = re.compile(r"[})\]]|\\right\s*\S+")
SIZED = re.compile(r"\\(?:left|right)\s*([()\[\]])")
FUNCTION = re.compile(r"<mi>(sin|cos|tan|arctan|arccos)</mi>(?=<m[in]>)")  # they touch what follows without a bracket
LEADING = re.compile(r"(<math[^>]*><mrow>)<mo([^>]*)>(?=(?:&#x0002B;|&#x02212;|&#x0003D;|&#x022C5;|[+=−⋅])</mo>)")
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
        found += [piece] if _visible(piece) <= WIDE else _cut(SIZED.sub(r"\1", piece), inside=True)
    return found


def widest(latex: str) -> int:
    """About how many characters wide the widest piece is that cannot be cut."""
    return max(map(_visible, pieces(latex)), default=0)


def _cut(latex: str, inside: bool) -> list[str]:
    found, depth = [""], 0
    for token in TOKEN.findall(latex):
        if depth == 0 and SEPARATOR.fullmatch(token):
            found[-1] += token[: token.startswith(",")]
            found.append("")
            continue
        if depth == 0 and (token == ARROW or len(found[-1]) > ROOM and SIGN.fullmatch(token)):
            found.append("")
        found[-1] += token
        if token in "{}" or not inside:
            depth += bool(OPENING.fullmatch(token)) - bool(CLOSING.fullmatch(token))
    return [piece.strip() for piece in found if piece.strip()]


def _visible(latex: str) -> int:
    """About how many characters wide: of a fraction, the wider part counts, so commands count once and braces not."""
    return len(re.sub(r"\\[A-Za-z]+", "x", re.sub(r"\\(?:left|right|frac|tfrac|operatorname|mathrm|text)|[{}^_\s]", "", latex)))
