"""README and its companions: their numbers, links, code and words."""

import doctest
import os
import re
import shutil
import subprocess
from collections import Counter
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
TEMPLATES = [f"workflow/templates/{path.name}" for path in ROOT.glob("workflow/templates/*.j2")]


def text(page: str) -> str:
    return (ROOT / page).read_text("utf-8")


def dataset(name: str) -> xr.Dataset:
    return read(ROOT / "figures" / f"{name}.nc")


def words(page: str) -> str:
    """A page with single spaces, so that ends of lines do not matter."""
    return " ".join(text(page).split())


def test_numbers_of_readme_are_those_of_the_datasets():
    judged = dataset("claims")
    numbers = tables.claims_of(judged, "printed number")
    ends = [claim for claim in numbers if claim["item"] == "Table 1"]
    count = Counter(end["verdict"] for end in ends)
    units = max(abs(end["deviation_units"]) for end in ends)
    share = max(abs(end["deviation"]) for end in ends)
    by = tables.counts(judged)["statement"]
    own = int((judged.own_sense == "holds").sum())
    curves = claims.stiff_errors(**{name: dataset(name) for name in article.STIFF_CURVES})
    highest = article.percent(curves.sel(measure="max_height").max(), 2, "up")
    found = dataset("validity_map")
    most = found.enough_from.sel(quantity="max_height").max()
    worst = {
        name: article.percent(found.stiff_error.sel(quantity=name).max(), 2, "up")
        for name in ("max_height", "bounce_velocity", "apparent_restitution")
    }
    branch = dataset("fig08").isel(frequency_ratio=-1)
    (low, high), *_ = claims.stable_ranges(branch)
    sentences = [
        f"is *reproduced*: {article.fixed(dataset('fig14').error_threshold, 2)}, printed 82.",
        f"is *not reproduced*: {article.fixed(dataset('fig16').error_threshold, 2)}, printed 6.",
        f"Of the {len(ends)} ends of stability ranges in Table 1, {count['reproduced']} are "
        f"*reproduced*, {count['near']} are *near* and {count['not reproduced']} are *not "
        f"reproduced*, off by up to {article.fixed(units, 2, 'up')} units of the last digit, and "
        f"by up to {article.percent(share, 2, 'up')}.",
        f"with n = {article.listed(found.n.values)} and r from {found.restitution.min():g} to "
        f"{found.restitution.max():g}. It does not do so beside the saddle-node, for "
        f"{article.failing(found, 'max_height')}, where up to ϖ = "
        f"{article.fixed(most, 0, 'up')} is needed.",
        f"velocity 100 is not enough for {article.failing(found, 'bounce_velocity')}, and for the "
        f"apparent restitution for {article.failing(found, 'apparent_restitution')}.",
        f"on the orbits of the figures (off by at most {highest}), and not on all stable orbits "
        f"(off by up to {worst['max_height']}, beside the saddle-node), nor for the bouncing-off",
        f"velocity (off by up to {worst['bounce_velocity']}) and the apparent restitution (up to "
        f"{worst['apparent_restitution']}):",
        f"Of the {sum(by.values())} statements that we judged, {by['reproduced']} are "
        f"*reproduced*, {by['by construction']} are right *by construction*, {by['by reading']} "
        f"are right *by reading* ({own} of them in the sense of the paper's own sentence, and the "
        f"others, the advice itself among them, in another sense only), "
        f"{by['undecidable']} are *undecidable*, and {by['contradicted']} is",
        f"stable again for Λ = {article.fixed(low, 5, 'up')} to {article.fixed(high, 5, 'down')}, "
        f"and ends at Λ = {article.fixed(branch.amplitude[0], 6)} in permanent contact",
    ]
    readme = words("README.md")
    assert [sentence for sentence in sentences if sentence not in readme] == []
    answer = readme.partition(" enough? ")[2].partition(" A ball bounces")[0]
    verdicts = readme.partition("## The verdicts ")[2].partition("## Read it")[0]
    assert len(answer) > 100 and len(verdicts) > 1000
    typed = re.findall(r"\d+\.\d+", answer + verdicts)
    # A dip at Λ = 1.2, and the r of the branch, which are the paper's.
    known = [number for number in typed if not any(number in each for each in sentences)]
    assert known == ["1.2", "0.85"]


@pytest.mark.parametrize("file", ["CITATION.cff", "metadata.yaml"])
def test_abstracts_are_that_of_the_article(file):
    abstract = words("paper.md").partition("## Abstract ")[2].partition(" ## ")[0]
    plain = re.sub(r"\$([^$]*)\$", r"\1", abstract.replace(r"$\varpi$", "ϖ"))
    assert yaml.safe_load(text(file))["abstract"].strip() == plain


def test_empty_fields_of_the_metadata_say_why():
    empty = re.findall(r"^[ -]*(\w+):(?: *#(.*))?$", text("metadata.yaml"), flags=re.MULTILINE)
    mappings = {"authors", "affiliations", "code", "data", "replication", "review", "contributors"}
    mappings |= {"dates", "article", "journal"}
    reasons = {reason.strip() for name, reason in empty if name not in mappings}
    assert reasons == {"not known", "given by the journal", "none: the references are in paper.md"}


def test_versions_agree():
    cited = yaml.safe_load(text("CITATION.cff"))
    assert bouncing_ball.__version__ == cited["version"]
    assert f'version = "{cited["version"]}"' in text("pyproject.toml")
    date = cited.get("date-released", "unreleased")
    assert f"## {cited['version']} ({date})\n" in text("CHANGELOG.md")


@pytest.mark.parametrize("folder", ["", "extras/beyond/", "extras/contacts/"])
def test_a_package_that_says_it_is_typed_has_the_mark(folder):
    project = text(f"{folder}pyproject.toml")
    (module,) = re.findall(r'\[tool.flit.module\]\nname = "(\w+)"', project)
    assert ("Typing :: Typed" in project) == (ROOT / folder / f"src/{module}/py.typed").is_file()


@pytest.mark.parametrize("extra", ["beyond", "contacts"])
def test_each_extra_has_a_readme_a_changelog_and_a_citation(extra):
    folder = f"extras/{extra}"
    cited = yaml.safe_load(text(f"{folder}/CITATION.cff"))
    assert f'version = "{cited["version"]}"' in text(f"{folder}/pyproject.toml")
    date = cited.get("date-released", "unreleased")
    assert f"## {cited['version']} ({date})\n" in text(f"{folder}/CHANGELOG.md")
    readme = text(f"{folder}/README.md")
    assert "CHANGELOG.md" in readme and "CITATION.cff" in readme


def test_a_release_needs_a_date(tmp_path):
    """Make in a copy of which git says that nothing has changed, and which is set up."""
    for name in ("Makefile", "CITATION.cff", "CHANGELOG.md"):
        shutil.copyfile(ROOT / name, tmp_path / name)
    for name in ("requirements.lock", "requirements-build.lock", ".venv/.installed"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/git").write_text("#!/bin/sh\necho git $* >&2\n", "utf-8")
    (tmp_path / "bin/git").chmod(0o755)
    path = f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}"

    def release() -> subprocess.CompletedProcess:
        command = ["make", "release", "MAKE=true"]
        environment = os.environ | {"PATH": path}
        return subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )

    cited = yaml.safe_load(text("CITATION.cff"))
    version = cited["version"]
    if "date-released" not in cited:
        assert "A release has a date: date-released: YYYY-MM-DD" in release().stdout
        with (tmp_path / "CITATION.cff").open("a") as file:
            file.write("date-released: 2030-01-02\n")
        assert f"CHANGELOG.md has no ## {version} (2030-01-02)." in release().stdout
        log = text("CHANGELOG.md").replace("(unreleased)", "(2030-01-02)")
        (tmp_path / "CHANGELOG.md").write_text(log, "utf-8")
    done = release()
    assert done.returncode == 0
    assert f"git archive --prefix=bouncing-ball-{version}/" in done.stderr


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
