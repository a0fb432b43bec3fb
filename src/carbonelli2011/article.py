"""The article and its supplement: templates filled in from datasets.

A template has text and names of numbers, and no numbers; the filters of `texts` print a
number. The article is about the run with the parameters of the paper. For another run, a few lines
name the differences instead.
"""

import traceback
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball import restitution, spring_damper
from carbonelli2011 import measures, paper
from paper_replication import origins
from paper_replication.datasets import Datasets, parameters
from paper_replication.judgements import claims_of, counted
from paper_replication.templates import environment
from paper_replication.texts import fixed, listed

TEMPLATES = Path(__file__).with_name("templates")

BEHIND = {
    "durations": ("fig08", "fig09"),
    "failing": ("validity_map",),
    "judged": ("claims",),
    "claim": ("claims",),
    "other_contacts": ("hypotheses",),
    "others_with_82": ("hypotheses",),
    "stiff_errors": ("fig05", "fig06", "fig10"),
}
"""The datasets behind the names that `text` gives to its templates."""

FUNCTIONS = (
    "carbonelli2011.measures",
    "carbonelli2011.article",
    "bouncing_ball.restitution",
    "bouncing_ball.spring_damper",
)
"""The modules of the functions that `text` gives to its templates."""

STIFF_CURVES = ("fig05", "fig06", "fig10")
"""The figures along ϖ on whose curves the errors of the restitution model are compared."""


def filled_in(
    name: str, datasets: Datasets, kind: str = "md", marked: bool = False, **more: Any
) -> str:
    """Fill in a template, in Markdown or HTML.

    It knows the datasets of all figures, tables and claims by their names, and what `more` has.
    The line of the template is a note of an exception that an expression raises.
    """
    judged = counted(datasets["claims"])
    own = claims_of(datasets["claims"], "own claim")
    template = environment(TEMPLATES, marked).get_template(f"{name}.{kind}.j2")
    try:
        return template.render(
            **datasets,
            given={key: parameters(data) for key, data in datasets.items()},
            judged=judged,
            claim={row["claim"]: row for row in [*judged, *own]},
            error_limit=paper.LIMIT,
            stiff=paper.STIFF,
            verdicts=environment(TEMPLATES).get_template("verdicts.md.j2").render().rstrip(),
            **more,
        )
    except Exception as error:
        for frame in traceback.extract_tb(error.__traceback__):
            if frame.filename.endswith(".j2"):
                error.add_note(f"{Path(frame.filename).name}, line {frame.lineno}")
        raise


def text(name: str, datasets: Datasets) -> str:
    """Return the article ("paper") or its "supplement", with marks around what is computed.

    `origins.bare` removes the marks. If the run is not that of the paper, the text names the
    differences instead.
    """
    if differences := unlike_the_paper(datasets):
        return filled_in("others", datasets, part=name, differences=differences)
    datasets = paper.of_paper(datasets)
    return filled_in(
        name,
        datasets,
        marked=True,
        stiff_errors=measures.stiff_errors(*(datasets[name] for name in STIFF_CURVES)),
        other_contacts=other_contacts(datasets["hypotheses"]),
        others_with_82=others_with_82(datasets["hypotheses"]),
        stable_ranges=measures.stable_ranges,
        laid_ranges=measures.laid_ranges,
        permanent_contact=spring_damper.permanent_contact,
        holmes_period_doubling=restitution.holmes_period_doubling,
        period_doubling_height=restitution.period_doubling_height,
        error_of_eq_8=measures.error_of_eq_8,
        departure=measures.departure,
        spread=measures.spread,
        restitution_at_rest=measures.restitution_at_rest,
        end_of_range=paper.end_of_range,
        durations=partial(durations, datasets),
        failing=partial(failing, datasets["validity_map"]),
        quantities=paper.QUANTITIES,
        crossing=measures.crossing,
        curve_errors=measures.curve_errors,
    )


def unlike_the_paper(datasets: Datasets) -> list[str]:
    """Return what differs from the run of the paper: parameters, or numbers that are missing."""
    judged = counted(datasets["claims"])
    unasked = [claim["reason"] for claim in judged if claim["verdict"] == "not asked"]
    return paper.changed_parameters(datasets) or list(dict.fromkeys(unasked))


def origins_of(name: str, datasets: Datasets) -> list[origins.Origin]:
    """Return the origin of each expression of "paper" or "supplement", in their order."""
    source = (TEMPLATES / f"{name}.md.j2").read_text("utf-8")
    return origins.origins(source, datasets, BEHIND)


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
        if up_to.isnull():
            parts.append(f"n = {up_to.n.item()} unknown")
        elif up_to == r[-1]:
            parts.append(f"n = {up_to.n.item()} at every r")
        elif up_to > 0:
            parts.append(f"n = {up_to.n.item()} up to r ≈ {fixed(up_to, 2)}")
    return listed(parts) if parts else "no n"


def other_contacts(hypotheses: xr.Dataset) -> list[str]:
    """Return the hypotheses with another contact than the restored equations."""
    return sorted({*hypotheses.contact_of.values.tolist()} - {"", "equations as they stand"})


def others_with_82(hypotheses: xr.Dataset) -> list[str]:
    """Return the other contacts that reproduce the printed 82."""
    agrees = hypotheses.agrees.sel(number="height threshold")
    return [name for name in other_contacts(hypotheses) if agrees.sel(hypothesis=name)]
