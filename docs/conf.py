"""The site: README, docs, article, tables and docstrings, as they are in the repository.

The repository is Sphinx's source folder, so that relative links and pictures are those of the
files. Nothing is loaded from the network, neither when the site is built nor when it is read:
formulas are MathML, and the explorer is a separate page.
"""

import os
import re
from pathlib import Path

import xarray as xr
from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

import bouncing_ball

ROOT = Path(__file__).parents[1]
EXPLORER = "figures/beyond/explorer.html"

project = "Bouncing ball"
author = "The bouncing-ball maintainers"
version = release = bouncing_ball.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.apidoc"]
root_doc = "README"
include_patterns = ["*.md", "docs/**.md", "config/README.md", "figures/**.md", "results/api/*.rst"]
exclude_patterns = [".*", "results/[!a]*", "src", "tests", "workflow"]
apidoc_modules = [
    {
        "path": "../src/bouncing_ball",
        "destination": "results/api",
        "separate_modules": True,
        "module_first": True,
    }
]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = "A ball on a vibrating table"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_extra_path = [f"../{EXPLORER}"]
html_show_sourcelink = False
html_copy_source = False
html_math_renderer = "mathml"
# Public names are documented twice, at the top and in their modules.
suppress_warnings = ["ref.python"]

PARTS = {
    "Replication": [
        "paper",
        "supplement",
        "motions",
        "figures/*",
        "docs/datasets",
        "config/README",
        "docs/record",
    ],
    "Beyond the paper": ["docs/beyond", "figures/beyond/*"],
    "Theory": [
        "docs/how-an-orbit-is-found",
        "docs/impact-as-an-instant",
        "docs/error-law",
        "docs/closed-form",
        "docs/proofs",
    ],
    "Use": [
        "docs/lesson",
        "docs/gallery",
        "docs/python",
        "docs/periodic-orbits",
        "docs/thesis",
        "docs/design",
        "docs/engines",
        "docs/bounces",
        "docs/contact-laws",
        "docs/measured",
        "docs/speed",
    ],
    "Code": ["results/api/modules", "CONTRIBUTING", "CHANGELOG"],
}


def title_of(table):
    """The title of a table of the record: that of its dataset, or of an accepted one."""
    sample = ROOT / "config" / f"{Path(table).name}.nc"
    with xr.open_dataset(sample if sample.exists() else ROOT / f"{table}.nc") as data:
        return data.attrs["title"]


def prepare(app, name, text):
    """What the forge's pages have and a site has not: links to folders, tables without a title."""
    folder = Path(name).parent

    def link(found):
        path, _, place = found[2].partition("#")
        if not path:
            return found[0]
        target = Path(os.path.normpath(folder / path))
        if str(target) == EXPLORER:
            up = os.path.relpath("explorer.html", folder)
            return f'<a href="{up}{"#" * bool(place)}{place}">{found[1]}</a>'
        return found[1] if (ROOT / target).is_dir() else found[0]

    text[0] = re.sub(r"(?<!!)\[([^]]*)\]\(([^):\s]+)\)", link, text[0])
    if not text[0].lstrip().startswith("#") and folder.name != "api":
        text[0] = f"# {title_of(name)}\n\n{text[0]}"
    if name == root_doc:
        for caption, pages in PARTS.items():
            glob = ":glob:\n" if any("*" in page for page in pages) else ""
            listed = "\n".join(f"/{page}" for page in pages)
            text[0] += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n{glob}\n{listed}\n```\n"
    # The scripts of the gallery in full, in place of links to them.
    text[0] = re.sub(
        r"^\[(\w+\.py)\]\((gallery/.*)\)$", r"```{literalinclude} \2\n```", text[0], flags=re.M
    )


def plain(app, what, name, of, options, lines):
    """In docstrings |x| is a modulus, and to docutils it would be a substitution."""
    lines[:] = [
        x if x.lstrip().startswith((">>>", "...")) else x.replace("|", r"\|") for x in lines
    ]


def mathml(as_block):
    """How a formula is written into a page."""

    def write(writer, node):
        writer.body.append(tex2mathml(node.astext(), as_block=as_block))
        raise SkipNode

    return write, None


def home(app, failure):
    """The site's folder opens with the page of README."""
    page = (
        '<!doctype html><title>Bouncing ball</title><meta http-equiv="refresh" content="0; url={}">'
    )
    Path(app.outdir, "index.html").write_text(page.format(f"{root_doc}.html"), encoding="utf-8")


def setup(app):
    """Called by Sphinx."""
    app.connect("source-read", prepare)
    app.connect("autodoc-process-docstring", plain)
    app.connect("build-finished", home)
    app.add_html_math_renderer("mathml", mathml(False), mathml(True))
