"""One site for all packages: READMEs, docs, articles, tables and docstrings, as they are in the
repository. Of the replication and of contacts it has the pages alone, whichever there are.

The repository is Sphinx's source folder, so that relative links and pictures are those of the
files. Nothing is loaded from the network, neither when the site is built nor when it is read:
formulas are MathML, and the explorer is a separate page.
"""

import os
import re
import shutil
from pathlib import Path

import xarray as xr
import yaml
from docutils.nodes import SkipNode, make_id
from docutils.utils.math.latex2mathml import tex2mathml

import bouncing_ball_beyond
from carbonelli2011 import index
from paper_replication.datasets import read

ROOT = Path(__file__).parents[3]
EXPLORER = "extras/beyond/figures/explorer.html"

project = "Bouncing ball"
author = "The bouncing-ball maintainers"
version = release = bouncing_ball_beyond.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "README"
include_patterns = [
    "*.md",
    "docs/*.md",
    "figures/*.md",
    "extras/beyond/*.md",
    "extras/beyond/docs/*.md",
    "extras/beyond/figures/*.md",
    "extras/contacts/*.md",
    "extras/contacts/docs/*.md",
]
exclude_patterns = ["**/.*", "**/results", "**/src", "**/tests", "**/workflow"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = "A ball on a vibrating table"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
html_math_renderer = "mathml"
# Two classes have members of the same name, to which docstrings refer.
suppress_warnings = ["ref.python"]

PARTS = {
    "The replication": [
        "[a-z]*",
        "docs/*",
        "figures/*",
    ],
    "Beyond the paper": [
        "extras/beyond/README",
        "extras/beyond/article",
        "extras/beyond/appendix",
        "extras/beyond/phase",
        "extras/beyond/laid",
        "extras/beyond/figures/*",
        "extras/beyond/docs/first-hour",
        "extras/beyond/docs/answers",
        "extras/beyond/docs/orbits",
        "extras/beyond/docs/tables",
        "extras/beyond/docs/named-laws",
        "extras/beyond/docs/laws",
        "extras/beyond/docs/thesis",
        "extras/beyond/docs/gallery",
        "extras/beyond/docs/impact-as-an-instant",
        "extras/beyond/docs/equations",
        "extras/beyond/docs/impacts",
        "extras/beyond/docs/panels",
        "extras/beyond/docs/error-law",
        "extras/beyond/docs/speed",
        "extras/beyond/docs/api",
    ],
    "Contacts with units": [
        "extras/contacts/README",
        "extras/contacts/docs/design",
        "extras/contacts/docs/measured",
        "extras/contacts/docs/python",
        "extras/contacts/docs/add-an-engine",
        "extras/contacts/docs/engines",
        "extras/contacts/docs/files",
        "extras/contacts/docs/bounces",
        "extras/contacts/docs/interval",
        "extras/contacts/docs/validation",
    ],
    "Changes": [
        "CONTRIBUTING",
        "CHANGELOG",
        "extras/beyond/CHANGELOG",
        "extras/contacts/CHANGELOG",
    ],
}


def title_of(table):
    """The title of a table: that of the dataset beside it."""
    with xr.open_dataset(ROOT / f"{table}.nc") as data:
        return data.attrs["title"]


def prepare(app, name, text):
    """What the forge's pages have and a site has not: links to folders, pages to download, tables
    without a title.
    """
    folder = Path(name).parent

    def link(match):
        path, _, place = match[2].partition("#")
        if not path:
            return match[0]
        target = Path(os.path.normpath(folder / path))
        if str(target) == EXPLORER:
            up = os.path.relpath("explorer.html", folder)
            return f'<a href="{up}{"#" * bool(place)}{place}">{match[1]}</a>'
        return match[1] if (ROOT / target).is_dir() else match[0]

    text[0] = re.sub(r"(?<!!)\[([^]]*)\]\(([^):\s]+)\)", link, text[0])
    text[0] = text[0].replace("</a> (download and open it)", "</a>")
    if not text[0].lstrip().startswith("#"):
        text[0] = f"# {title_of(name)}\n\n{text[0]}"
    if name == root_doc:
        for caption, pages in PARTS.items():
            glob = ":glob:\n" if any("*" in page for page in pages) else ""
            listed = "\n".join(f"/{page}" for page in pages)
            text[0] += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n{glob}\n{listed}\n```\n"
    # A forge shows directives as text, so that they are in comments.
    text[0] = re.sub(r"<!-- autodoc\n(.*?)-->", r"```{eval-rst}\n\1```", text[0], flags=re.S)
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


def anchored(heading):
    """A heading of a page that replaces one of Sphinx, with the anchor of Sphinx's links to it."""
    return f'{heading[1]}<a id="{make_id(re.sub("<.*?>", "", heading[2]))}"></a>{heading[2]}'


def home(app, failure):
    """The front page and the article are the results of the replication, with their data."""
    folder = Path(app.outdir)
    names = sorted((ROOT / "figures").glob("*.nc"))
    config = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
    stages = [section for section in config.values() if isinstance(section, dict)]
    entries = {name: entry for stage in stages for name, entry in stage.items() if name != "title"}
    texts = index.pages({path.stem: read(path) for path in names}, entries, site=True)
    for name in (name for name in texts if name.endswith(".html")):
        # The tables in Markdown are pages of the site.
        page = re.sub(r'(href="figures/\w+)\.md"', r'\1.html"', texts[name])
        page = re.sub(r'(<h\d id="section-[^"]*">)(.*?)(?=</h)', anchored, page)
        (folder / name).write_text(page, encoding="utf-8")
    (folder / "figures").mkdir(exist_ok=True)
    for path in (ROOT / "figures").iterdir():
        if path.suffix in (".nc", ".csv", ".png", ".svg"):
            shutil.copyfile(path, folder / "figures" / path.name)


def explorer(app, failure):
    """The explorer is at the top of the site, where its ways out lead to pages of the site."""
    folder = Path(EXPLORER).parent

    def to_page(match):
        return f'href="{os.path.normpath(folder / match[1])}.html"'

    text = (ROOT / EXPLORER).read_text(encoding="utf-8")
    text = re.sub(r'href="(\.\./[^"]*)\.md"', to_page, text)
    (Path(app.outdir) / "explorer.html").write_text(text, encoding="utf-8")


def setup(app):
    """Called by Sphinx."""
    app.connect("source-read", prepare)
    app.connect("autodoc-process-docstring", plain)
    app.connect("build-finished", home)
    app.connect("build-finished", explorer)
    app.add_html_math_renderer("mathml", mathml(False), mathml(True))
