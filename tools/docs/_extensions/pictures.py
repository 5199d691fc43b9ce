"""Pictures of the examples: every matplotlib Figure that a block of code made, in the order of its names."""

import matplotlib.figure
from sphinx_gallery.scrapers import figure_rst


def scrape(block, block_vars, gallery_conf):
    seen = block_vars.setdefault("pictures_seen", set())
    paths = []
    for value in list(block_vars["example_globals"].values()):
        if isinstance(value, matplotlib.figure.Figure) and id(value) not in seen:
            seen.add(id(value))
            path = next(block_vars["image_path_iterator"])
            value.savefig(path, dpi=200)
            paths.append(path)
    return figure_rst(paths, gallery_conf["src_dir"])


def setup(app):
    return {"parallel_read_safe": True}
