"""What becomes of accepted results, and which are not accepted."""

import json
import shutil

import numpy as np
import pytest
from tests.repository import commit, git

from bouncing_ball import datasets
from bouncing_ball.artifacts import Product, text


def made_at(project, name):
    return datasets.read(project.top / "figures" / f"{name}.nc").attrs["commit"]


def numbers(project, name):
    return datasets.read(project.top / "figures" / f"{name}.nc").max_height.values


def test_accepted_results_are_the_reference(project):
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 2.5]")
    head = commit(project.top, "edit")
    project.run()
    # The datasets that agree name the commit, too.
    datasets_made = [f"figures/{name}.nc" for name in ("claims", "heavy", "light")]
    assert project.accept() == [*datasets_made, "paper.md"]
    assert project.lines() == ["All 5 files agree with the reference."]
    assert [made_at(project, name) for name in ("heavy", "light", "claims")] == [head] * 3
    assert numbers(project, "light").max() == 2.5
    assert project.accept() == []
    commit(project.top, "reference")
    assert project.accept() == []


def test_what_agrees_keeps_its_numbers_and_renews_its_provenance(project):
    """As on another processor."""
    before = numbers(project, "heavy")
    old = made_at(project, "heavy")
    project.edit("src/model.py", "GRAVITY = 1.0", "GRAVITY = 1.0 + 1e-12")
    head = commit(project.top, "edit")
    project.run()
    assert project.lines() == ["All 5 files agree with the reference."]
    assert made_at(project, "heavy") == old
    assert project.accept() == [f"figures/{name}.nc" for name in ("claims", "heavy", "light")]
    assert np.array_equal(numbers(project, "heavy"), before)
    assert made_at(project, "heavy") == head
    # What changed before is no cause any more.
    commit(project.top, "reference")
    project.edit("src/study.py", "1 / ratio", "1.1 / ratio")
    project.run()
    assert "changed: src/study.py (not committed)" in project.lines()[0]


def test_one_figure_after_another_is_accepted_at_the_same_commit(project):
    project.edit("config/config.yaml", "[0.5, 1.0]", "[0.5, 1.01]")
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 1.6]")
    head = commit(project.top, "edit")
    project.run()
    assert project.accept("heavy") == ["figures/heavy.md", "figures/heavy.nc"]
    assert project.accept("light") == ["figures/light.nc", "paper.md"]
    assert made_at(project, "heavy") == made_at(project, "light") == head


def test_a_later_accepted_figure_changes_no_other_cause(project):
    project.edit("config/config.yaml", "[0.5, 1.0]", "[0.5, 1.01]")
    project.edit("src/table.py", "height", "heights")
    commit(project.top, "edit")
    project.run()
    project.accept("heavy")
    commit(project.top, "reference of one")
    project.edit("src/study.py", "1 / ratio", "1.4 / ratio")
    changed = commit(project.top, "another edit")[:7]
    project.run()
    cause = f"changed: src/study.py (on this branch, {changed})"
    for names in (["light"], ["heavy", "light"], []):
        (line,) = [each for each in project.lines(*names) if each.startswith("light: ")]
        assert line.endswith(f"; {cause}"), line


def test_claims_change_only_with_the_dataset_that_decides_them(project):
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 2.5]")
    commit(project.top, "edit")
    project.run()
    claims = project.results / "figures" / "claims.nc"
    shutil.copyfile(project.top / "figures" / "claims.nc", claims)
    with pytest.raises(ValueError, match="it changes the claims; make and accept all results"):
        project.accept("light")
    assert numbers(project, "light").max() == 1.5
    project.follow()
    assert project.accept("light") == ["figures/claims.nc", "figures/light.nc", "paper.md"]


def test_only_what_follows_from_an_accepted_figure_is_made_anew(project):
    """The table of another figure, whose code changed as well, stays as it is."""
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 2.5]")
    project.edit("src/table.py", 'height"', 'heights"')
    commit(project.top, "edits")
    project.run()
    verdicts = text(
        "figures/verdicts.md", ("claims",), lambda data: " ".join(data["claims"].verdict.values)
    )
    files = ["figures/claims.nc", "figures/light.nc", "figures/verdicts.md", "paper.md"]
    assert project.accept("light", further=[verdicts]) == files
    assert (project.top / "figures/heavy.md").read_text().startswith("height\n")


def test_what_a_killed_acceptance_left_is_removed(project):
    left = [project.top / "figures/.light.nc.part.7", project.top / ".paper.md.part.7"]
    for path in left:
        path.write_text("half of it")
    assert project.accept() == []
    assert not any(path.exists() for path in left)


def test_a_picture_is_drawn_anew_by_the_matplotlib_of_today(project):
    def draw(data, folder):
        height = float(data["light"].max_height.max())
        (folder / "figures/light.svg").write_text(f"<svg>{height}</svg>")

    def other_matplotlib(side):
        versions = json.dumps(datasets.versions() | {"matplotlib": "3.10.0"})
        project.change("light", side, lambda data: data.assign_attrs(versions=versions))

    picture = Product(("figures/light.svg",), ("light",), draw, (project.top / "src/table.py",))
    data = {"light": datasets.read(project.results / "figures/light.nc")}
    draw(data, project.results)
    (project.top / "figures/light.svg").write_text("<svg>drawn otherwise</svg>")
    other_matplotlib(project.top)
    commit(project.top, "another matplotlib")
    assert project.accept("light", further=[picture]) == ["figures/light.nc", "figures/light.svg"]
    other_matplotlib(project.results)
    with pytest.raises(ValueError, match=r"pictures were drawn by matplotlib 3\.10\.0"):
        project.accept("light", further=[picture])


def test_nothing_is_accepted_that_does_not_follow_from_committed_code(project):
    path = project.top / "figures" / "light.nc"
    before = path.read_bytes()

    def refused(match):
        with pytest.raises(ValueError, match=match):
            project.accept()
        assert path.read_bytes() == before

    paper = project.results / "paper.md"
    paper.write_text(paper.read_text().replace("The", "A"))
    refused("paper.md in the results is not what today's code makes of its data")
    paper.unlink()
    refused("paper.md in the results is missing")
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 2.5]")
    refused("commit first: config/config.yaml")
    commit(project.top, "edit")
    refused("light: stale: the configuration")
    project.run()
    (project.top / "src/new.py").write_text("")
    refused("commit first: src/new.py")
    shutil.rmtree(project.top / ".git")
    refused("the commit of the code is unknown")


def test_a_stale_dataset_that_the_reference_lacks_is_not_accepted(project):
    git(project.top, "rm", "-q", "figures/light.nc")
    project.edit("src/study.py", "1 / ratio", "1.1 / ratio")
    commit(project.top, "without")
    with pytest.raises(ValueError, match=r"stale: it was made by other code than today's: .*study"):
        project.accept()
    assert not (project.top / "figures/light.nc").exists()
