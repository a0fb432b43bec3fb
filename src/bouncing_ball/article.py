"""The article and its supplement: templates filled in from datasets.

A template has text and names of numbers, and no numbers; the filters below print a number. The
article is about the run with the parameters of the paper. For another run, a few lines name the
differences instead.
"""

import json
from collections.abc import Iterable
from decimal import ROUND_HALF_EVEN, Decimal
from functools import cache, partial
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball import measures, origins, paper, restitution, spring_damper, tables
from bouncing_ball.datasets import Datasets, parameters
from bouncing_ball.drawing import share_text

TEMPLATES = Path(__file__).parents[2] / "workflow" / "templates"

STIFF_CURVES = ("fig05", "fig06", "fig10")
"""The figures along ϖ on whose curves the errors of the restitution model are compared."""


@cache
def environment(templates: Path, marked: bool = False) -> jinja2.Environment:
    """Return the Jinja environment of a folder of templates, with the filters for numbers.

    If `marked`, it marks what the expressions print (see `origins`).
    """
    found = jinja2.Environment(
        loader=jinja2.FileSystemLoader(templates, encoding="utf-8"),
        undefined=jinja2.StrictUndefined,
        autoescape=jinja2.select_autoescape(["html.j2"], default=False),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        extensions=[origins.Marks] if marked else [],
    )
    found.filters.update(fixed=fixed, percent=percent, share=share_text, short=short)
    found.filters.update(listed=listed, zip=zip, mark=origins.mark)
    return found


def filled_in(
    name: str, datasets: Datasets, kind: str = "md", marked: bool = False, **more: Any
) -> str:
    """Fill in a template, in Markdown or HTML.

    It knows the datasets of all figures, tables and claims by their names, and what `more` has.
    """
    judged = [row for group in tables.GROUPS for row in tables.claims_of(datasets["claims"], group)]
    template = environment(TEMPLATES, marked).get_template(f"{name}.{kind}.j2")
    return template.render(
        **datasets,
        titles={key: data.attrs["title"] for key, data in datasets.items()},
        given={key: parameters(data) for key, data in datasets.items()},
        code={key: next(iter(json.loads(data.attrs["code"]))) for key, data in datasets.items()},
        judged=judged,
        claim={row["claim"]: row for row in judged},
        error_limit=paper.LIMIT,
        stiff=paper.STIFF,
        **more,
    )


def written(name: str, datasets: Datasets) -> str:
    """Return the article ("paper") or its "supplement", with marks around what is computed.

    `origins.bare` removes the marks. If the run is not that of the paper, the text names the
    differences instead.
    """
    if differences := unlike_the_paper(datasets):
        return filled_in("others", datasets, part=name, differences=differences)
    return filled_in(
        name,
        datasets,
        marked=True,
        stiff_errors=measures.stiff_errors(**{name: datasets[name] for name in STIFF_CURVES}),
        other_contacts=other_contacts(datasets["hypotheses"]),
        others_with_82=others_with_82(datasets["hypotheses"]),
        stable_ranges=measures.stable_ranges,
        permanent_contact=spring_damper.permanent_contact,
        holmes_period_doubling=restitution.holmes_period_doubling,
        period_doubling_height=restitution.period_doubling_height,
        error_of_eq_8=measures.error_of_eq_8,
        departure=measures.departure,
        spread=measures.spread,
        durations=partial(durations, datasets),
        failing=partial(failing, datasets["validity_map"]),
        crossing=measures.crossing,
        summary=tables.summary,
        tables=tables.TABLES,
        markdown=tables.markdown,
    )


def unlike_the_paper(datasets: Datasets) -> list[str]:
    """Return what differs from the run of the paper: parameters, or numbers that are missing."""
    claims = datasets["claims"]
    unasked = claims.reason.values[claims.verdict.values == "not asked"]
    return paper.differences(datasets) or list(dict.fromkeys(unasked.tolist()))


def origins_of(name: str, datasets: Datasets) -> list[origins.Origin]:
    """Return the origin of each expression of "paper" or "supplement", in their order."""
    source = (TEMPLATES / f"{name}.md.j2").read_text("utf-8")
    return origins.origins(source, datasets)


# Numbers as text


def fixed(value: float, digits: int, shift: int = 0) -> str:
    """Round a number to a number of decimals, with the decimal point moved by `shift`.

    >>> fixed(82.1774, 2), fixed(-0.25, 1), fixed(-0.001, 2), fixed(np.nan, 2)
    ('82.18', '−0.2', '0.00', '–')
    """
    if not np.isfinite(value):
        return "–"
    # The shortest decimal number that is this binary one: 0.01 is 1 % and no other share.
    number = Decimal(repr(float(value))).scaleb(shift)
    rounded = number.quantize(Decimal(1).scaleb(-digits), rounding=ROUND_HALF_EVEN)
    # Zero has no sign.
    return str(rounded + 0).replace("-", "−")


def percent(value: float, digits: int | None = None) -> str:
    """Print a share in per cent, with all its digits if `digits` is None.

    >>> percent(0.01), percent(0.005), percent(0.02673, 1)
    ('1 %', '0.5 %', '2.7 %')
    """
    text = short(100 * value) if digits is None else fixed(value, digits, shift=2)
    return text if text == "–" else f"{text} %"


def short(value: float) -> str:
    """Print a parameter with all its digits, and large powers of ten as such.

    >>> short(0.85), short(10.0), short(1e4)
    ('0.85', '10', '10⁴')
    """
    number = float(value)
    exponent = round(np.log10(number)) if number > 0 else 0
    if exponent > 3 and number == 10.0**exponent:
        return "10" + str(exponent).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{number:g}".replace("-", "−")


def listed(values: Iterable, digits: int | None = None) -> str:
    """List words or numbers, with "and" before the last.

    >>> listed([1.0, 2.5, 4.0]), listed(["one", "two"]), listed([1.234], 2)
    ('1, 2.5 and 4', 'one and two', '1.23')
    """
    texts = [each if isinstance(each, str) else word(each, digits) for each in values]
    *first, last = texts
    return f"{', '.join(first)} and {last}" if first else last


def word(value: float, digits: int | None) -> str:
    """Print a number of a list, with all its digits if `digits` is None."""
    return short(value) if digits is None else fixed(value, digits)


# Numbers that several datasets give together


def durations(datasets: Datasets, ratio: float) -> NDArray:
    """Return the durations of all contacts of Figs. 8 and 9 at a frequency ratio."""
    figures = [datasets[name].contact_duration for name in ("fig08", "fig09")]
    return np.concatenate(
        [np.ravel(measures.at(figure, frequency_ratio=ratio)) for figure in figures]
    )


def failing(validity_map: xr.Dataset, quantity: str) -> str:
    """Print for which n, and up to which r, the advised frequency ratio is too small."""
    r = validity_map.restitution.values
    parts = []
    for up_to in validity_map.failing_up_to.sel(quantity=quantity):
        if up_to == r[-1]:
            parts.append(f"n = {up_to.n.item()} at every r")
        elif np.isfinite(up_to):
            parts.append(f"n = {up_to.n.item()} up to r ≈ {fixed(up_to, 2)}")
    return listed(parts) if parts else "no n"


def other_contacts(hypotheses: xr.Dataset) -> list[str]:
    """Return the hypotheses with another contact than the restored equations."""
    return sorted({*hypotheses.contact_of.values.tolist()} - {"", "equations as they stand"})


def others_with_82(hypotheses: xr.Dataset) -> list[str]:
    """Return the other contacts that reproduce the printed 82."""
    agrees = hypotheses.agrees.sel(number="height threshold")
    return [name for name in other_contacts(hypotheses) if agrees.sel(hypothesis=name)]
