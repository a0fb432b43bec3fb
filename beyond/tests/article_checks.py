"""What tests of several articles ask of a template or of a text."""

import re

import numpy as np

from bouncing_ball_beyond.inherited.datasets.variables import ROUNDING
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

JINJA = re.compile(r"\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}", re.DOTALL)
DISPLAY = re.compile(r"\$\$.*?\$\$", re.DOTALL)
INLINE = re.compile(r"\$[^$]+\$")
CITATION = re.compile(r"\[@[^\]]+\]")
# The rounding error of a finite difference, √ε. The digits of a number up to this size may come
# from the processor and not from the model.
ROUNDING_SIZE = float(np.sqrt(np.finfo(float).eps))
CODE = re.compile(r"`[^`\n]*`")
SPAN = r"R?\d+(?:[-–]\d+)?"
NAMED = re.compile(rf"\b(?:Eq|Fig|Figure|Table|Eqs|Figs)s?\.? {SPAN}(?:(?:,| and|, and) {SPAN})*")
FAMILY = re.compile(r"\b\d-T\b")
HEADING = re.compile(r"^#+ .*$", re.MULTILINE)


def prose(text: str) -> str:
    """The text of a template without the parts that may hold a digit."""
    for pattern in (JINJA, DISPLAY, INLINE, CODE, CITATION, NAMED, FAMILY):
        text = pattern.sub(" ", text)
    return text


def mathematics(text: str) -> list[str]:
    text = JINJA.sub(" ", text)
    display = DISPLAY.findall(text)
    return [NAMED.sub(" ", part) for part in (*display, *INLINE.findall(DISPLAY.sub(" ", text)))]


def typed_numbers(text: str) -> list[str]:
    """Numbers in the prose, and numbers in formulas that no formula needs."""
    found = re.findall(r"\S*\d\S*", prose(text))
    for formula in mathematics(text):
        # Exponents and factors are single digits; numbers of equations are in \text.
        bare = re.sub(r"\\text\{[^}]*\}", " ", formula)
        found += re.findall(r"\d+\.\d+|\d{2,}|[5-9]", bare)
    return found


def literals(text: str) -> list[str]:
    """Decimal numbers written inside expressions, but for labels in quotes."""
    code = [re.sub(r"\"[^\"]*\"", " ", part) for part in JINJA.findall(text)]
    return [number for part in code for number in re.findall(r"\d+\.\d+|\d+e-?\d+", part)]


def statements_on_unread_works(article):
    """The sentences that cite a work that was not read.

    Such a work may be named where the text says that it was not read, or why it is named.
    """
    text, _, works = article.partition("## References")
    unread = set(re.findall(r"^(\d+)\. .*\((?:Not read)[^)]*\)", works, re.MULTILINE))
    said = r"could not read|found (no|neither) text|because the paper refers to|nothing is said of"
    found = []
    for sentence in text.splitlines():
        cited = {*re.findall(r"\d+", " ".join(re.findall(r"\[(\d[\d, ]*)\]", sentence)))}
        if cited & unread and not re.search(said, sentence):
            found.append(sentence)
    return found


def works_of(folder):
    """The works cited by the templates of a folder, and those in its list."""
    known = read_yaml(folder / "references.yaml")
    texts = "".join(path.read_text(encoding="utf-8") for path in folder.glob("*.md.j2"))
    cited = re.findall(r"@(\w+)", " ".join(re.findall(r"\[@[^]]+\]", texts)))
    return {*cited}, {work["id"] for work in known["references"]}


def plain(text):
    """A text without the signs of formulas."""
    return " ".join(text.replace("$", "").replace(r"\varpi", "ϖ").split())


def check_metadata(article, file):
    """A file has title, keywords and abstract of an article; how many numbers the abstract has."""
    about = read_yaml(file)
    assert article.startswith(f"# {about['title']}\n")
    assert f"\nKeywords: {about['keywords']}.\n" in article
    abstract = article.partition("## Abstract\n")[2].partition("\n## 1. ")[0]
    assert plain(abstract) == about["abstract"]
    return len({*re.findall(r"\d+(?:\.\d+)?", abstract)})


def perturbed(data, rng):
    """A dataset whose numbers are off by what rounding does to them.

    That is less than the least budget. A disagreement between two routes is rounding
    itself and may be anything within its budget.
    """
    other = data.copy(deep=True)
    for name, values in other.data_vars.items():
        if values.dtype.kind != "f" or name == "budget":
            continue
        finite = np.isfinite(values.values)
        size = np.abs(values.values[finite]).max(initial=0.0)
        noise = rng.uniform(-1, 1, values.shape) * ROUNDING * size
        if name == "disagreement":
            budget = other.budget.broadcast_like(values).transpose(*values.dims).values
            rounding = (values.values <= budget) & (("worst" in other) | (budget <= ROUNDING_SIZE))
            noise = np.where(rounding, rng.uniform(0, 1, values.shape) * budget - values.values, 0)
        other[name].values[finite] += noise[finite]
    return other


def moved(make, record, made):
    """The lines that differ if the datasets are perturbed."""
    rng = np.random.default_rng(0)
    noisy = {name: perturbed(data, rng) for name, data in record.items()}
    return [
        f"{name}: {old} → {new}"
        for name, text in make(noisy).items()
        for old, new in zip(made[name].splitlines(), text.splitlines(), strict=True)
        if old != new
    ]
