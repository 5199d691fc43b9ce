"""The documentation site: pages, executed examples and the reference of the API, as HTML.

    python3 tools/docs.py [--out FOLDER] [OPTIONS OF sphinx-build]

Needs nothing but Python 3.11 or newer: it makes its own environment at the first run. A warning is an error, a broken
link inside the site and an example that fails too. Sources: tools/docs/.
"""

import html.parser
import os
import pathlib
import sys
import urllib.parse

import _environment

SOURCE = os.path.join(_environment.ROOT, "tools", "docs")


def main(arguments):
    out = os.path.join(_environment.ROOT, ".docs", "html")
    if arguments[:1] == ["--out"]:
        out, arguments = os.path.abspath(arguments[1]), arguments[2:]
    exe = _environment.python("docs", ["docs"])
    cache = os.path.join(_environment.ROOT, ".docs", "doctrees")
    options = ["-b", "html", "-d", cache, "--fail-on-warning", "--keep-going", "--quiet", *arguments]
    status = _environment.run(exe, "-m", "sphinx", *options, SOURCE, out)
    dead = dead_links(pathlib.Path(out)) if status == 0 else []
    for page, link in dead:
        print(f"{page}: dead link {link}", file=sys.stderr)
    if dead:
        return 1
    if status == 0:
        print("open " + os.path.relpath(os.path.join(out, "index.html")))
    return status


class _Page(html.parser.HTMLParser):
    """Links of a page, and the names that links can have for places in it."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places = [], {""}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("href", "src") and value:
                self.links.append(value)
            elif key == "id":
                self.places.add(value)


def dead_links(folder):
    """(page, link) of every link within a folder of pages to a file or a place in it that is not there.

    Sphinx looks at what the sources say, not at the links that it writes itself, such as those from the code to the reference.
    """
    pages = {path.resolve(): _Page(path) for path in sorted(folder.rglob("*.html"))}
    dead = []
    for path, page in pages.items():
        for link in dict.fromkeys(page.links):
            scheme, host, to, _, place = map(urllib.parse.unquote, urllib.parse.urlsplit(link))
            target = (path.parent / to).resolve() if to else path
            if not scheme and not host and not (target.exists() and (target not in pages or place in pages[target].places)):
                dead.append((path.relative_to(folder.resolve()).as_posix(), link))
    return dead


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
