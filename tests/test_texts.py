"""README and its companions: their numbers, links, code and words."""

import doctest
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

import bouncing_ball
from bouncing_ball import article, claims, figures, tables
from bouncing_ball.datasets import printed_table, read
from bouncing_ball.drawing import style

ROOT = Path(__file__).resolve().parents[1]
PAGES = ["README.md", "CONTRIBUTING.md", "paper.md", "supplement.md", "figures/README.md"]
PAGES += [f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))]
TEMPLATES = [f"workflow/templates/{name}.md.j2" for name in ("paper", "supplement", "figures")]


def text(page: str) -> str:
    return (ROOT / page).read_text("utf-8")


def dataset(name: str) -> xr.Dataset:
    return read(ROOT / "figures" / f"{name}.nc")


def words(page: str) -> str:
    """A page with single spaces, so that ends of lines do not matter."""
    return " ".join(text(page).split())


def test_numbers_of_readme_are_those_of_the_datasets():
    numbers = tables.claims_of(dataset("claims"), "printed number")
    ends = [claim for claim in numbers if claim["item"] == "Table 1"]
    missed = [end for end in ends if end["verdict"] == "not to the digit"]
    judged = tables.counts(dataset("claims"))["statement"]
    errors = claims.stiff_errors(**{name: dataset(name) for name in article.STIFF_CURVES})
    worst = errors.max("orbit")
    branch = dataset("fig08").isel(frequency_ratio=-1)
    (low, high), *_ = claims.stable_ranges(branch)
    sentences = [
        f"is *reproduced*: {article.fixed(dataset('fig14').error_threshold, 2)}, printed 82.",
        f"is *contradicted*: {article.fixed(dataset('fig16').error_threshold, 2)}, printed 6.",
        f"Of the {len(ends)} ends of stability ranges in Table 1, {len(ends) - len(missed)} are "
        f"*reproduced*; {len(missed)} are *not to the digit*, all within "
        f"{article.at_most(max(abs(end['deviation']) for end in missed), 2)}.",
        f"greatest height ({article.at_most(worst.sel(measure='max_height'), 2)} at most",
        f"velocity ({article.percent(worst.sel(measure='bounce_velocity'), 2)}), the apparent "
        f"restitution ({article.percent(worst.sel(measure='apparent_restitution'), 2)}) and the "
        "phase of the impact relative to its own value "
        f"({article.percent(worst.sel(measure='phase'), 1)}).",
        f"Of the {sum(judged.values())} statements that we judged, {judged['reproduced']} are "
        f"*reproduced*, {judged['definition']} are *definitions*, {judged['by reading']} are right "
        f"*by reading*, {judged['undecidable']} are *undecidable*, and {judged['contradicted']} is",
        f"stable again for Λ = {article.fixed(low, 5)} to {article.fixed(high, 5)}, and ends at "
        f"Λ = {article.fixed(branch.amplitude[0], 6)} in permanent contact",
    ]
    readme = words("README.md")
    assert [sentence for sentence in sentences if sentence not in readme] == []
    verdict = readme.partition("## The verdict")[2].partition("## Run it")[0]
    typed = re.findall(r"\d+\.\d+", verdict)
    assert [number for number in typed if not any(number in each for each in sentences)] == ["1.2"]


@pytest.mark.parametrize("file", ["CITATION.cff", "metadata.yaml"])
def test_abstracts_are_that_of_the_article(file):
    abstract = words("paper.md").partition("## Abstract ")[2].partition(" ## ")[0]
    plain = re.sub(r"\$([^$]*)\$", r"\1", abstract.replace(r"$\varpi$", "ϖ"))
    assert yaml.safe_load(text(file))["abstract"].strip() == plain


def test_versions_agree():
    cited = yaml.safe_load(text("CITATION.cff"))
    assert bouncing_ball.__version__ == cited["version"]
    assert f'version = "{cited["version"]}"' in text("pyproject.toml")
    assert f"## {cited['version']} ({cited['date-released']})" in text("CHANGELOG.md")


@pytest.mark.parametrize("page", PAGES)
def test_links_and_pictures_exist(page):
    content = re.sub(r"```.*?```", "", text(page), flags=re.DOTALL)
    targets = re.findall(r"\]\(([^)\s]+)\)", content) + re.findall(r'src="([^"]+)"', content)
    folder = (ROOT / page).parent
    local = [target.partition("#")[0] for target in targets if "://" not in target]
    assert [target for target in local if not (folder / target).exists()] == []


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md", *PAGES[5:]])
def test_files_and_targets_that_are_named_exist(page):
    content = text(page)
    named = re.findall(r"`((?:workflow|src|config|tests|docs|\.ci)/[\w./-]+)`", content)
    assert [file for file in named if not (ROOT / file).exists()] == []
    targets = re.findall(r"^([\w-]+):", text("Makefile"), flags=re.MULTILINE)
    called = re.findall(r"(?:^|`)make ([a-z][\w-]*)", content, flags=re.MULTILINE)
    assert set(called) <= set(targets)


BANNED = r"\b(houses?|rooms?|exhibits?|witness\w*|forensics?|budgets?|is told|is asked)\b"


@pytest.mark.parametrize("page", [*PAGES, *TEMPLATES, "CITATION.cff", "metadata.yaml"])
def test_words_are_those_of_the_field(page):
    assert re.findall(BANNED, text(page), flags=re.IGNORECASE) == []


@pytest.mark.parametrize("page", PAGES[5:])
def test_examples_of_the_pages_run(page, monkeypatch):
    monkeypatch.chdir(ROOT / "docs")
    found = doctest.testfile(str(ROOT / page), module_relative=False, encoding="utf-8")
    assert found.failed == 0


def example(start: str) -> str:
    """The code of an example in CONTRIBUTING that begins with a line."""
    blocks = re.findall(r"```python\n(.*?)```", text("CONTRIBUTING.md"), flags=re.DOTALL)
    (block,) = (block for block in blocks if block.strip().startswith(start))
    indented = len(block) - len(block.lstrip())
    return "\n".join(line[indented:] for line in block.splitlines())


def test_recipe_of_a_figure_draws():
    names = dict(vars(figures))
    exec(example("def fig17"), names)
    with style():
        figure = names["fig17"](dataset("fig10"))
    assert np.array_equal(figure.axes[0].lines[0].get_ydata(), dataset("fig10").max_height[0])


def test_recipe_of_a_claim_is_judged(monkeypatch):
    monkeypatch.setattr(claims, "CLAIMS", [])
    exec(example("@claim"), dict(vars(claims)) | {"CLAIMS": claims.CLAIMS})
    printed = printed_table(ROOT / "config" / "table1_printed.csv")
    judged = claims.judge({"fig14": dataset("fig14")}, printed)
    assert judged.verdict.sel(claim="heights differ") == "reproduced"
