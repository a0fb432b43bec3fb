"""The site of `make docs` as Chromium shows it: no dead link, no missing picture, no request."""

import json
import re
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlparse

import pytest

pytestmark = pytest.mark.docs

SITE = Path(__file__).parents[1] / "results" / "site"
# Loads the pages one after another and writes down what the browser made of each.
OBSERVER = Path(__file__).with_name("site_observer.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def seen(browse, tmp_path_factory):
    """What the browser makes of every page, by the page's path."""
    pages = sorted(str(page.relative_to(SITE)) for page in SITE.rglob("*.html"))
    assert "beyond/article.html" in pages, "make docs has not been run"
    pages = [page for page in pages if "_" not in page[:1] and page != "index.html"]
    folder = tmp_path_factory.mktemp("site")
    observer = folder / "observer.html"
    urls = json.dumps([(SITE / page).as_uri() for page in pages])
    observer.write_text(OBSERVER.replace("PAGES", urls), encoding="utf-8")
    dom = browse(folder, observer, "--dump-dom", "--virtual-time-budget=600000")
    found = re.search(r'<pre id="seen">(.*?)</pre>', dom, re.DOTALL)[1]
    assert found
    found = json.loads(found.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))
    assert len(found) == len(pages)
    return {Path(unquote(urlparse(url).path)): page for url, page in found.items()}


def test_no_picture_is_missing_and_nothing_comes_from_the_network(seen):
    for path, page in seen.items():
        assert page["title"], path
        assert page["missing"] == [], path
        assert page["unread"] == [], path
        assert [url for url in page["fetched"] if not url.startswith("file:")] == [], path


def test_no_link_is_dead(seen):
    dead = []
    for path, page in seen.items():
        for url in set(page["links"]):
            target, place = urldefrag(url)
            if urlparse(target).scheme != "file":
                assert urlparse(target).scheme in ("https", "mailto"), (path, url)
                continue
            file = Path(unquote(urlparse(target).path))
            known = seen.get(file, {"ids": [place]})["ids"]
            if not file.is_file() or (place and unquote(place) not in known):
                dead.append((path.name, url))
    assert dead == []


def links_of(seen, page):
    """The files to which a page of the site links."""
    return {Path(unquote(urlparse(url).path)) for url in seen[SITE / f"{page}.html"]["links"]}


def test_it_opens_with_the_page_of_readme_and_has_all_parts(seen):
    assert "README.html" in (SITE / "index.html").read_text(encoding="utf-8")
    links = links_of(seen, "README")
    wanted = [
        "beyond/docs/inherited/gallery",
        *("beyond/README", "beyond/article", "beyond/docs/lesson", "beyond/figures/ext_laws"),
        *("contacts/README", "contacts/docs/design", "contacts/docs/measured"),
        "beyond/results/api/bouncing_ball_beyond/modules",
    ]
    assert {SITE / f"{name}.html" for name in wanted} <= links
    assert SITE / "explorer.html" in links_of(seen, "beyond/figures/README")
