"""README and its companions: their numbers, links and examples."""

import doctest
import re
import subprocess
from collections.abc import Callable

import numpy as np
import pytest
import yaml
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tests.checkout import ROOT
from tests.reference import ENTRIES, TOP, reference

import bouncing_ball
from bouncing_ball.spring_damper import contact_of_duration
from paper_replication import judgements, texts
from paper_replication.configuration import entries
from paper_replication.datasets import parameters

WRITTEN = ["paper.md", "supplement.md", "figures/README.md"]
"""What a run writes, and `make accept` judges before it is the reference."""
PAGES = ["README.md", "CONTRIBUTING.md", *WRITTEN]
PAGES += [f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))]


def text(page: str) -> str:
    folder = TOP if page in WRITTEN else ROOT
    return (folder / page).read_text("utf-8")


def words(page: str) -> str:
    """A page with single spaces: ends of lines do not matter."""
    return " ".join(text(page).split())


# The README is prose, and its numbers are those of the datasets


def numbers_of_readme() -> set[str]:
    """The decimal numbers that the datasets give to the README, as it prints them."""
    data = reference()
    judged = judgements.claims_of(data["claims"], "printed number")
    ends = [claim for claim in judged if claim["item"] == "Table 1"]
    validity_map = data["validity_map"]
    height = validity_map.sel(quantity="summit")
    return {
        texts.fixed(data["fig14"].error_threshold, 2),
        texts.fixed(data["fig16"].error_threshold, 2),
        texts.fixed(max(abs(end["deviation_units"]) for end in ends), 2),
        texts.fixed(100 * height.largest_error.max(), 2),
        *(texts.fixed(100 * share, 1) for share in validity_map.doubled_mean),
        *(texts.fixed(100 * share, 1) for share in validity_map.below_mean),
        texts.fixed(height.failing_up_to.max(), 2),
        *(texts.share_text(mean).strip("< %") for mean in height.failing_mean.values if mean > 0),
        f"{validity_map.restitution.min():g}",
        f"{validity_map.restitution.max():g}",
    }


def test_decimal_numbers_of_readme_are_those_of_the_datasets():
    """A number that its dataset no longer has is caught. Others are parameters of the ball that the
    pictures show.
    """
    prose = re.sub(r"```.*?```|Python [^)]*", "", text("README.md"), flags=re.DOTALL)
    typed = set(re.findall(r"(?<![\w.])\d+\.\d+(?![\w.]*\d)", prose))
    computed = numbers_of_readme()
    assert computed - typed == set()
    assert typed - computed <= {str(value) for value in parameters(reference()["fig12"]).values()}


def test_counts_of_readme_are_those_of_the_datasets():
    """A count that a new claim or orbit changes is caught. Each stands before its verdict."""
    data = reference()
    judged = judgements.claims_of(data["claims"], "printed number")
    ends = [claim for claim in judged if claim["item"] == "Table 1"]
    reproduced = [end for end in ends if end["verdict"] == "reproduced"]
    near = [end for end in ends if 0.5 < abs(end["deviation_units"]) <= 1]
    statements = judgements.counts(data["claims"])["statement"]
    counts = [
        (len(ends), "ends"),
        (len(reproduced), "reproduced"),
        (len(ends) - len(reproduced), "not"),
        (len(near), "within one unit"),
        (sum(statements.values()), "statements"),
        *((count, verdict) for verdict, count in statements.items() if count),
    ]
    readme = words("README.md").replace("*", "")
    missing = [
        (count, word)
        for count, word in counts
        if not re.search(rf"\b{count} (?:[a-z]+ ){{0,3}}{word}\b", readme)
    ]
    assert missing == []
    needed = data["validity_map"].enough_from.sel(quantity="summit")
    assert f"ϖ = {texts.fixed(needed.max(), 0)}" in readme
    stable = data["validity_map"].stable.sum().item()
    assert f" {stable} n-T orbits" in readme


def two_digits(values) -> list[float]:
    return sorted(float(f"{value:.2g}") for value in values)


def test_the_table_of_your_ball_has_measured_times_where_the_ball_arrives_with_their_speeds():
    """By Newton's impact, the ball of the 1-T orbit arrives with g/((1 + r) · frequency)."""
    page = text("docs/your-ball.md")
    row = re.compile(r"\((\S+/experiments/\w+\.csv)\).* ([\d.]+) ± ([\d.]+) ms")
    measured = row.findall(page)
    for file, *typed in measured:
        times = re.findall(r"# contact time.*: (\S+) s", text(f"docs/{file}"))
        assert [f"{1e3 * float(time):.3g}" for time in times] == typed
    rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| ")][2:]
    assert (len(measured), len(rows)) == (2, 4)
    for ball, *cells in rows:
        numbers = [[float(number) for number in re.findall(r"\d[\d.]*", cell)] for cell in cells]
        (r, *_), (milliseconds, *_), frequency, ratio = numbers
        speeds = [float(speed) for speed in re.findall(r"[\d.]+", ball.rpartition(" at ")[2])]
        frequencies = np.array([9.80665 / ((1 + r) * speed) for speed in speeds])
        assert two_digits(frequencies) == sorted(frequency)
        if "Hertz" in cells[1]:
            continue  # the contact of the next test pulls
        contact = contact_of_duration(2e-3 * np.pi * frequencies * milliseconds, r, "force")
        assert two_digits(contact.frequency_ratio) == sorted(ratio)


def free_impact(damping: Callable, c: float, release: str, power: float = 1.5) -> tuple:
    """r and duration for the force x^power + c damping(x) v; force release: it ends with this."""

    def force(_, state):
        x = max(state[0], 0.0)
        return x**power + c * damping(x) * state[1]

    def end(_, state):
        return force(_, state) if release == "force" else state[0]

    end.terminal = True
    end.direction = -1
    path = solve_ivp(
        lambda time, state: [state[1], -force(time, state)],
        (0, 20),
        [1e-9, 1.0],
        events=end,
        method="DOP853",
        rtol=1e-9,
        atol=1e-12,
        max_step=0.05,
    )
    return -path.y[1, -1], path.t[-1]


def damped_duration(damping: Callable, r: float, release: str, power: float = 1.5) -> float:
    c = brentq(lambda c: free_impact(damping, c, release, power)[0] - r, 1e-3, 1.5, xtol=1e-6)
    return free_impact(damping, c, release, power)[1]


def test_how_long_contacts_last_depends_on_r_law_and_release():
    """docs/your-ball.md, by an integration of this test."""
    page = text("docs/your-ball.md")
    parts = re.findall(r"1/(\d+) at(?: r =)? ([\d.]+\d)", page)
    assert len(parts) == 3
    for part, r in parts:
        longest = damped_duration(np.ones_like, float(r), "force", power=1) / (2 * np.pi * 100)
        assert float(part) == np.ceil(1 / longest)
    for r in (0.9, 0.5, 0.3):
        pulling = damped_duration(np.ones_like, r, "displacement", power=1)
        assert pulling / (2 * np.pi / 200) > 100
    elastic = free_impact(np.ones_like, 0.0, "displacement")[1]
    # Dampings of Tsuji, of Kuwabara and Kono, and of Hunt and Crossley: powers of the depth.
    powers = (0.25, 0.5, 1.5)
    dampings = [lambda x, power=power: x**power for power in powers]
    pulling = damped_duration(dampings[0], 0.7, "displacement") / elastic
    ended = [damped_duration(damping, 0.7, "force") for damping in dampings]
    changes = [
        round(100 * float(change)) for change in [pulling - 1, *(np.array(ended) / elastic - 1)]
    ]
    typed = re.findall(r"(adds|takes off) (\d+) %", page)
    assert changes == [int(number) * (1 if does == "adds" else -1) for does, number in typed]
    # The steel ball, at the speed of its orbit: the table, and the picture at 1/200 of the period.
    compliance = 2 * (1 - 0.3**2) / 210e9
    mass = 7800 * np.pi / 6 * 0.01**3
    hertz = pulling * 2.87 * (mass**2 * compliance**2 / (0.005 * 0.072)) ** 0.2
    assert f"| {1e3 * hertz:.2g} ms, by the theory of Hertz, pulling | 80 Hz | 103 |" in page
    ratio = contact_of_duration(160 * np.pi * hertz, 0.7, "displacement").frequency_ratio
    assert ratio == pytest.approx(103, abs=0.6)


def test_the_journal_accepts_the_metadata():
    """Its converter measures addresses, LaTeX reads the texts, and an abstract has 250 words and
    stands alone.
    """
    metadata = yaml.safe_load(text("metadata.yaml"))
    assert all(isinstance(affiliation["address"], str) for affiliation in metadata["affiliations"])
    assert re.findall(r"(?<!\\)[%&#]", " ".join(map(str, metadata.values()))) == []
    article = words("paper.md").partition("## Abstract ")[2].partition(" ## ")[0]
    assert len(article.split()) <= 250 and "Section" not in article
    tex = {"%": r"\%", "ϖ": r"$\varpi$", "Λ": r"$\Lambda$", "≈": r"$\approx$"}
    assert metadata["abstract"].strip() == re.sub("[%ϖΛ≈]", lambda match: tex[match[0]], article)


def test_the_authors_are_the_same_everywhere():
    names = [author["name"] for author in yaml.safe_load(text("metadata.yaml"))["authors"]]
    assert [author["name"] for author in yaml.safe_load(text("CITATION.cff"))["authors"]] == names
    assert f"\n\n{texts.listed(names)}.\n" in text("paper.md")


@pytest.mark.parametrize("folder", ["", "extras/beyond/", "extras/contacts/"])
def test_versions_agree(folder):
    """A file that a release, or the end of one, leaves behind is caught."""
    cited = yaml.safe_load(text(f"{folder}CITATION.cff"))
    assert f'version = "{cited["version"]}"' in text(f"{folder}pyproject.toml")
    date = cited.get("date-released", "unreleased")
    assert f"## {cited['version']} ({date})\n" in text(f"{folder}CHANGELOG.md")
    if not folder:
        assert bouncing_ball.__version__ == cited["version"]
        assert ("There is no release" in text("README.md")) == (date == "unreleased")
        notes = [ROOT / ".ci/release-notes", cited["version"]]
        assert subprocess.run(notes, capture_output=True).returncode == (date == "unreleased")


@pytest.mark.parametrize("page", PAGES)
def test_links_pictures_and_files_that_are_named_exist(page):
    """A file that was renamed, moved or removed is caught."""
    content = text(page)
    shown = re.sub(r"```.*?```", "", content, flags=re.DOTALL)
    targets = re.findall(r"\]\(([^)\s]+)\)", shown) + re.findall(r'src="([^"]+)"', shown)
    local = [target.partition("#")[0] for target in targets if "://" not in target]
    # Texts of a run link to its figures, and to pages of the checkout. A new figure is not in the
    # reference yet.
    folders = [(top / page).parent for top in (TOP, ROOT)]
    missing = [
        target for target in local if not any((folder / target).exists() for folder in folders)
    ]
    beyond = yaml.safe_load(text("extras/beyond/config/config.yaml"))
    made = (ROOT / "extras/beyond/workflow/templates").glob("*.md.j2")
    new = {*ENTRIES, *entries(beyond), *(path.name.partition(".")[0] for path in made)}
    assert [
        target for target in missing if target.rpartition("/")[2].partition(".")[0] not in new
    ] == []
    named = re.findall(r"`((?:workflow|src|config|tests|docs|\.ci)/[\w./-]+)`", content)
    assert [file for file in named if not (ROOT / file).exists()] == []


def slug(heading: str) -> str:
    """The anchor that a forge gives to a heading."""
    visible = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w -]", "", visible.lower()).replace(" ", "-")


def test_links_to_sections_lead_to_a_heading():
    """On the pages of all packages; a heading that was renamed or merged is caught."""
    folders = [folder for top in (ROOT, *ROOT.glob("extras/*")) for folder in (top, top / "docs")]
    written = {
        path.resolve(): re.sub(r"```.*?```", "", path.read_text("utf-8"), flags=re.DOTALL)
        for folder in folders
        for path in folder.glob("*.md")
    }
    anchors = {
        path: {slug(heading) for heading in re.findall(r"^#+ (.*)$", content, re.MULTILINE)}
        for path, content in written.items()
    }
    links = [
        (path, target, anchor)
        for path, content in written.items()
        for target, anchor in re.findall(r"\]\(((?:[^)\s#:]+\.md)?)#([^)\s]+)\)", content)
    ]
    assert len(links) > 40
    assert [
        (path.name, target, anchor)
        for path, target, anchor in links
        if anchor not in anchors.get((path.parent / target).resolve() if target else path, ())
    ] == []


@pytest.mark.parametrize("page", [page for page in PAGES if ">>> " in text(page)])
def test_examples_of_the_pages_run(page, monkeypatch):
    monkeypatch.chdir((ROOT / page).parent)
    examples = doctest.testfile(str(ROOT / page), module_relative=False, encoding="utf-8")
    assert examples.failed == 0


@pytest.mark.parametrize("page", ["docs/chapter.md", "docs/recipes.md"])
def test_scripts_of_a_page_run_as_written_and_make_what_it_names(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    (tmp_path / "figures").symlink_to(ROOT / "figures")
    scripts = re.findall(r"^```python\n(.*?)^```", text(page), re.MULTILINE | re.DOTALL)
    assert scripts
    for script in scripts:
        exec(script, {})
        named = re.findall(r'"(\w+\.(?:pdf|png|csv|tex))"', script)
        assert named and all((tmp_path / file).stat().st_size > 200 for file in named)
