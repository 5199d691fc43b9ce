"""Docstrings as numpydoc and napoleon read them.

``name : what it is`` stands where they expect a type after the colon: it gets a line of its own. A paragraph below such a list
ends it; they would read it as one more name, but for a second empty line. What stands before a colon in a property's docstring
they take for its type: that one is left as it is written.
"""

import re

_SECTION = ("Parameters", "Attributes", "Returns", "Raises", "Warns")
_ENTRY = re.compile(r"^(?P<names>[\w*]+(?:, [\w*]+)*) : (?P<text>.+)$")
_written = {}


def process(app, what, name, obj, options, lines):
    _written[name] = list(lines)
    out, section = [], ""
    for number, line in enumerate(lines):
        following = lines[number + 1] if number + 1 < len(lines) else ""
        if following and set(following) == {"-"}:
            section = line
        match = _ENTRY.match(line) if section in _SECTION else None
        if section in _SECTION and not line and following[:1].strip() and not _ENTRY.match(following):
            section = ""
            out += ["", ""]
        elif match:
            out += [match["names"], "    " + match["text"]]
        else:
            out.append(line)
    lines[:] = out


def restore(app, what, name, obj, options, lines):
    if what == "property":
        lines[:] = _written[name]


def setup(app):
    # napoleon listens in between, with the default priority
    app.connect("autodoc-process-docstring", process, priority=400)
    app.connect("autodoc-process-docstring", restore, priority=600)
    return {"parallel_read_safe": True}
