"""Configuration of the documentation site (Sphinx, MyST for Markdown, sphinx-gallery for executed examples)."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "_extensions"))

os.environ["DASK_LOGGING__DISTRIBUTED"] = "error"  # an example has a cluster; its log is no part of the page

import hystrip

project = "hystrip"
author = "the hystrip authors"
copyright = "the hystrip authors"
version = release = hystrip.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "mathml",
    "field_lists",
    "pictures",
]
exclude_patterns = ["examples", "_static", "_extensions"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
nitpicky = False

html_theme = "furo"
html_title = f"hystrip {version}"
html_static_path = ["_static"]
html_css_files = ["hystrip.css"]
html_copy_source = False
html_show_sphinx = False
html_math_renderer = "mathml"

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say shapes and units
napoleon_attr_annotations = False
napoleon_google_docstring = False

sphinx_gallery_conf = {
    "examples_dirs": ["examples"],
    "gallery_dirs": ["gallery"],
    "filename_pattern": r".*\.py",
    "image_scrapers": ("pictures.scrape",),
    "reset_modules": (),
    "abort_on_example_error": True,
    "only_warn_on_example_error": False,
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "remove_config_comments": True,
    "min_reported_time": 0,
    "write_computation_times": False,
    "within_subsection_order": "FileNameSortKey",
    "copyfile_regex": r".*\.(csv|toml)",
}
