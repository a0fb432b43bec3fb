"""All texts and pages of a run: the article, the page of the results, the claims, the figures.

Templates show the same parts (`paper_replication.pages`).
"""

import re
from collections.abc import Mapping
from functools import partial

import numpy as np
import xarray as xr

from carbonelli2011 import article
from carbonelli2011.claims import CLAIMS, TABLE
from carbonelli2011.paper import QUANTITIES
from carbonelli2011.tables import TABLES
from paper_replication import judgements, texts
from paper_replication.datasets import Datasets, parameters
from paper_replication.origins import bare
from paper_replication.pages import PAGES, framed, numbers, page_of, parts, shown, unbroken


def pages(datasets: Datasets, entries: Mapping[str, Mapping], site: bool = False) -> dict:
    """Return all texts and pages of a run, by the names of their files.

    `entries` are the registered figures, tables and datasets by name. On a `site`, the explorer and
    the documentation are next to the pages.
    """
    marked = {name: article.text(name, datasets) for name in ("paper", "supplement")}
    origin = {name: article.origins_of(name, datasets) for name in marked}
    evidence = list_of_figures("html", datasets, entries, name="claims", site=site)
    texts_by_name = {
        "figures/README.md": list_of_figures("md", datasets, entries),
        "index.html": list_of_figures("html", datasets, entries, site=site),
        "claims.html": framed(evidence, "claims", [("", "The claims and the evidence")]),
        "numbers.html": numbers(
            marked, origin, datasets, functions=article.FUNCTIONS, elsewhere=TABLE
        ),
    }
    for name, text in marked.items():
        texts_by_name[f"{name}.md"] = bare(text)
        texts_by_name[f"{name}.html"] = page_of(text, name, origin[name])
    return texts_by_name


def list_of_figures(
    kind: str,
    datasets: Datasets,
    entries: Mapping[str, Mapping],
    name: str = "figures",
    site: bool = False,
) -> str:
    """Return the list of figures in Markdown ("md"), or the page of the results ("html").

    The evidence of the "claims" is HTML without a frame.
    """
    every = parts(datasets, entries, CLAIMS, TABLES, TABLE)
    formulas = judgements.claims_of(datasets["claims"], "restored formula")
    text = article.filled_in(
        name,
        datasets,
        kind,
        title="When is a restitution coefficient enough? Results of the replication",
        pages=PAGES,
        markdown=texts.markdown,
        exceptions=exceptions(datasets["validity_map"]),
        shifts=shifts(datasets["validity_map"]),
        failing=partial(article.failing, datasets["validity_map"]),
        formulas=judgements.chosen(judgements.SECTIONS["restored formula"], formulas),
        checked_by=formulas[0]["condition"],
        site=site,
        **shown(datasets, every),
    )
    return with_subscripts(unbroken(text)) if kind == "html" else text


def with_subscripts(page: str) -> str:
    """Set the indices of symbols below the line, in texts and not in tags.

    >>> with_subscripts('<td title="τ_b">φ + τ_b, r_a</td>')
    '<td title="τ_b">φ + τ<sub>b</sub>, r<sub>a</sub></td>'
    """
    return re.sub(r"([τφδϖΛζ′]|\br)_(\w+)(?=[^<>]*<)", r"\1<sub>\2</sub>", page)


def exceptions(validity_map: xr.Dataset) -> list[list[str]]:
    """Errors at the advised frequency ratio, as rows of texts, the header first.

    The last columns have, for each n, the share of the range of Λ on which the error exceeds the
    tolerance, averaged over r.
    """
    given = parameters(validity_map)
    advised = texts.short(given["advised"])
    limit = texts.percent(given["tolerance"])
    families = [f"n = {n}" for n in validity_map.n.values]
    heads = ["quantity", f"largest error at ϖ ≥ {advised}", f"above {limit} for some Λ"]
    rows = [[*heads, f"share: {families[0]}", *families[1:]]]
    for quantity in validity_map["quantity"].values:
        error = validity_map.largest_error.sel(quantity=quantity).max(skipna=False).item()
        of = " of a period" if quantity == "phase_in_periods" else ""
        largest = "unknown" if np.isnan(error) else f"{texts.percent(error, 2)}{of}"
        where = article.failing(validity_map, quantity)
        shares = map(texts.share_text, validity_map.failing_mean.sel(quantity=quantity).values)
        rows.append([QUANTITIES[quantity], largest, where, *shares])
    return rows


def shifts(validity_map: xr.Dataset) -> list[list[str]]:
    """Orbits that only one model has at the advised frequency ratio, as rows of texts.

    The last columns have, for each n, their part of Λ in units of the range, averaged over r.
    """
    advised = texts.short(parameters(validity_map)["advised"])
    families = [f"n = {n}" for n in validity_map.n.values]
    rows = [[f"spring-damper, ϖ = {advised}", "where", f"share: {families[0]}", *families[1:]]]
    ends = {
        "below": ("has stable orbits, the restitution model none", "below the saddle-node"),
        "doubled": ("has already doubled its period", "next to the period doubling"),
    }
    for name, (kind, side) in ends.items():
        where = positive(validity_map[f"{name}_share"], side)
        rows.append([kind, where, *map(texts.share_text, validity_map[f"{name}_mean"].values)])
    return rows


def positive(share: xr.DataArray, side: str) -> str:
    """Print for which n and r a share at one side of the range of Λ is positive.

    It is unknown if the share is missing for some n and r.
    """
    if share.isnull().any():
        return "unknown"
    if (share > 0).all():
        r = share.restitution
        ends = [texts.short(end) for end in (r.min(), r.max())]
        return f"every r from {' to '.join(ends)}, {side}"
    words = {False: "some", True: "every"}
    parts = [
        f"n = {of_n.n.item()} at {words[bool((of_n > 0).all())]} r" for of_n in share if of_n.any()
    ]
    return texts.listed(parts) if parts else "no n"
