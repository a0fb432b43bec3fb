"""The page of the claims: the meaning of the columns, the table, and what decides each claim."""

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.formats import to_markdown
from bouncing_ball.figures.tables.rows import claims

_COLUMNS = """\
# The claims of the paper, and the verdict on each

Carbonelli et al. (2011) compare two models of a ball that bounces on a vibrating table. In the
*restitution model* an impact is an instant, after which the relative velocity is −r times what it
was before. In the *spring-damper model* an impact is a contact of finite duration with a spring
and a damper. Λ is the largest acceleration of the table over gravity, ϖ the natural frequency of
the contact over the frequency of the table (a stiff contact has a large ϖ), and ζ the damping
ratio of the contact. An n-T orbit is a motion that repeats after n periods of the table, with one
impact. Its family begins at an amplitude Λ called the saddle-node, and is stable up to one called
the period doubling.

A row of the table is one claim of the paper:

- **claim**: the name by which this repository refers to the claim.
- **where**: the place in the paper, for example an equation or a figure.
- **what the paper says**: the claim in our words. For a printed number it says what the number
  is.
- **printed or required**: the number with the digits that the paper prints. For a formula or a
  statement, a condition on a computed number, such as "≤ 0.01". The last part of this page says
  which number.
- **found**: the number that the replication computes. Where it is as small as rounding, only its
  bound is given, because two processors do not round alike.
- **deviation**: the number found less the printed one, in units of the last printed digit, and in
  brackets in per cent. It is empty where nothing was printed.
- **verdict**:
  - *reproduced*: the number rounds to the printed one, or the condition holds;
  - *close*: the number is off by no more than {close_units:g} units of the last printed digit;
  - *contradicted*: it is off by more, or the condition does not hold;
  - *undecidable*: the verdict depends on how the claim is read;
  - *not asked*: this run was made with other parameters than those of the paper.

"""


_DECIDED = """
## What decides each claim

A printed number is compared with the computed one, and a restored formula with a second
computation of the same quantity. A statement is turned into a condition, which is given here. In
brackets are the datasets, which are the files `.nc` beside this page.

"""
_WHY = "\n## Why claims are close or contradicted\n\n"


def page(data: xr.Dataset) -> str:
    """The page in Markdown, from the dataset of the claims."""
    about: dict[str, list[str]] = {}
    for one in each(data, "claim"):
        about.setdefault(_notes(one), []).append(one.claim.item())
    decided = [f"- **{'; '.join(names)}** {notes}\n" for notes, names in about.items()]
    why = [
        f"- **{one.explanation.item()}**: {one.explanation_text.item()} "
        f"{'Its checks hold' if one.explanation_holds else 'Its checks do not hold'}: "
        f"{one.explanation_checks.item()}.\n"
        for one in each(data, "explanation")
    ]
    table = to_markdown(*claims(data))
    return "".join([_COLUMNS.format(**data.attrs), table, _DECIDED, *decided, _WHY, *why])


def _notes(claim: xr.Dataset) -> str:
    """The datasets that decide a claim, and sentences about it."""
    said = {name: str(claim[name].item()) for name in claim.data_vars if not claim[name].ndim}
    open_claim = said["verdict"] in ("close", "contradicted")
    found = {
        "Condition: {}": said["condition"],
        "This says the claim *{}* again": said["restates"],
        "The verdict {}": said["reason"],
        "Remark: {}": said["remark"],
        "The explanation is *{}*, below": said["explained_by"] if open_claim else "",
    }
    texts = (sentence.format(text) + "." for sentence, text in found.items() if text)
    return " ".join([f"({said['decided_by'] or 'none'}).", *texts])
