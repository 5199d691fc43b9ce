"""Docstrings say ``name : what it is`` where numpydoc expects a type after the colon: give it a line of its own."""

import re

_SECTION = ("Parameters", "Attributes", "Returns", "Raises")
_ENTRY = re.compile(r"^(?P<names>[\w*]+(?:, [\w*]+)*) : (?P<text>.+)$")


def process(app, what, name, obj, options, lines):
    out, section = [], ""
    for number, line in enumerate(lines):
        following = lines[number + 1] if number + 1 < len(lines) else ""
        if following and set(following) == {"-"}:
            section = line
        match = _ENTRY.match(line) if section in _SECTION else None
        if match:
            out += [match["names"], "    " + match["text"]]
        else:
            out.append(line)
    lines[:] = out


def setup(app):
    # before napoleon, which listens with the default priority
    app.connect("autodoc-process-docstring", process, priority=400)
    return {"parallel_read_safe": True}
