"""The page of the claims: the meaning of the columns, the table, and what decides each claim."""

from pathlib import Path

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.formats import to_markdown
from bouncing_ball.figures.tables.rows import claims

_PAGE = Path(__file__).with_suffix(".md")


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
    return _PAGE.read_text(encoding="utf-8").format(
        table=to_markdown(*claims(data)), decided="".join(decided), why="".join(why), **data.attrs
    )


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
