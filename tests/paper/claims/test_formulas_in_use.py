"""A wrong edit in any formula with which a stage computes shows in the row of this formula."""

import compileall
import json
import multiprocessing
import re
import runpy
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from bouncing_ball import paper
from bouncing_ball.paper.claims.formulas import formulas
from bouncing_ball.pipeline.job import typed

PACKAGE = Path(paper.__file__).parents[1]
PARAMETERS = {"samples": 16, "seed": 2011}
# Imported once, in a process of which those with an edited package are forks. Nothing of this
# package is among them.
LIBRARIES = [
    *("pytest", "xarray", "pydantic", "pint", "yaml"),
    *("scipy.linalg", "scipy.optimize.elementwise", "scipy.special"),
]
# The rows that do not agree, as a run with the package of this folder finds them.
FIND = f"""
import json, sys, warnings
from pathlib import Path

warnings.simplefilter("ignore")
here = Path(__file__).parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(here))
import bouncing_ball

assert Path(bouncing_ball.__file__).parent == here / "bouncing_ball"
from bouncing_ball.paper.claims.formulas import formulas
from bouncing_ball.pipeline.job import typed
data = typed(formulas)({PARAMETERS})
right = (data.disagreement <= data.budget) & (data.disagreement_in_use <= data.budget)
found = json.dumps(data.formula.values[~right.values].tolist())
(here / "found.json").write_text(found, encoding="utf-8")
"""


class Edit(NamedTuple):
    """A formula of a module, a wrong one in its place, and the row that shows this."""

    module: str
    right: str
    wrong: str
    row: str


FLIGHT = "models/flight.py"
RIGID = "models/restitution.py"
CONTACT = "models/spring_damper.py"
PERMANENT = "models/permanent_contact.py"
ORBIT = "periodic/orbit.py"
BRANCH = "periodic/spring_damper_branch.py"
RIGID_BRANCH = "periodic/restitution_branch.py"
CONTINUED = "periodic/continuation.py"
EDITS = [
    Edit(FLIGHT, "* (self.velocity - time / 2)", "* (self.velocity - time)", "Eq. 4"),
    Edit(
        FLIGHT,
        "slowing = self.y * sine + self.x * versine",
        "slowing = self.y * sine",
        "Eq. 5",
    ),
    Edit(RIGID, "rebound = -self.restitution * velocity\n", "rebound = -0.9 * velocity\n", "Eq. 2"),
    Edit(
        RIGID_BRANCH,
        "sign * np.sqrt((lam - level) * (lam + level))",
        "sign * np.sqrt(lam * lam + level)",
        "Eq. 6",
    ),
    Edit(
        RIGID_BRANCH,
        "* np.pi * (1 - r) / (1 + r)\n",
        "* np.pi * (1 - r) / (1 + 0.9 * r)\n",
        "Eq. 7",
    ),
    Edit(
        RIGID_BRANCH, "return np.ones_like(r)", "return 2 * np.ones_like(r)", "Eq. 8, Holmes' map"
    ),
    Edit(
        RIGID_BRANCH, "2 * (1 + r * r) / (1 + r) ** 2", "(1 + r * r) / (1 + r)", "Eq. 8, corrected"
    ),
    Edit(RIGID, "arctangent(1.0, np.sqrt(", "arctangent(0.9, np.sqrt(", "Eq. 9"),
    Edit(PERMANENT, "RESTITUTION_THRESHOLD = 1.0", "RESTITUTION_THRESHOLD = 1.1", "Eq. 9"),
    Edit(
        CONTACT,
        "+ loss * np.asarray(rate)",
        "+ loss / 2 * np.asarray(rate)",
        "ϖ = Ω/ω, Ω of the contact",
    ),
    Edit(CONTACT, "+ y * in_phase - gravity", "+ y * in_phase + gravity", "Eqs. 12-13"),
    Edit(ORBIT, "+ velocity) / 2 * since", "+ velocity) * since", "Eqs. 14-15"),
    Edit(
        "models/damping.py", "/ np.sqrt(np.pi * np.pi + decrement * decrement)", "/ np.pi", "Eq. 16"
    ),
    Edit(
        "models/damping.py",
        "exponential(-rule.free_angle(",
        "exponential(-0.9 * rule.free_angle(",
        "Eq. 16",
    ),
    Edit(
        ORBIT,
        "return -self.relative_bounce_velocity /",
        "return -self.bounce_velocity /",
        "Eq. 17",
    ),
    Edit(
        ORBIT,
        "return 2 * np.pi * self.n - self.contact_duration",
        "return 2 * np.pi * self.n",
        "Eqs. 18-20",
    ),
    Edit(BRANCH, "g + flight],", "g + 0.9 * flight],", "Eqs. 21-26"),
    Edit(
        BRANCH,
        "return point.test(Bifurcation.SADDLE_NODE)",
        "return point.test(Bifurcation.SADDLE_NODE) - 0.01",
        "Eqs. 21-26",
    ),
    Edit(
        BRANCH,
        "return point.test(Bifurcation.PERIOD_DOUBLING)",
        "return point.test(Bifurcation.PERIOD_DOUBLING) - 0.01",
        "Eqs. 21-26",
    ),
    Edit(CONTINUED, "gap + omega * lag * leaving,", "gap + leaving,", "Eqs. 21-26"),
    Edit(
        ORBIT,
        "return self.impact_velocity + self.flight_time",
        "return self.impact_velocity",
        "Eq. 27",
    ),
    Edit(PERMANENT, "hypot(detuning, 2 * zeta", "hypot(detuning, zeta", "Eq. 33"),
    Edit(PERMANENT, "(centre + root) / divisor", "(centre + 0.9 * root) / divisor", "Eq. 34"),
    Edit(PERMANENT, "1 / (centre + root)", "1 / (centre - root)", "Eq. 35"),
    Edit(PERMANENT, "omega = 1 / np.sqrt(x)", "omega = 1.1 / np.sqrt(x)", "Eq. 36"),
    Edit(ORBIT, "rising * rising / 2", "rising * rising / 4", "Eqs. 37-38"),
    Edit("accuracy/errors.py", "quantities) - base) / base", "quantities) - base)", "Eqs. 37-38"),
    Edit(
        "accuracy/thresholds.py",
        "np.exp(np.where(root.success, root.x, end))",
        "np.where(root.success, root.x, end)",
        "Eqs. 37-38",
    ),
]


@pytest.fixture(scope="module")
def disagreeing():
    """The rows of the formulas that do not agree in another process with a package."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(LIBRARIES)

    def disagreeing(package: Path) -> set[str]:
        script = package.with_name("find.py")
        found = package.with_name("found.json")
        found.unlink(missing_ok=True)
        script.write_text(FIND, encoding="utf-8")
        process = context.Process(target=runpy.run_path, args=(str(script),))
        process.start()
        process.join()
        assert process.exitcode == 0
        return {*json.loads(found.read_text(encoding="utf-8"))}

    return disagreeing


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package, to be edited."""
    folder = tmp_path_factory.mktemp("edited") / "bouncing_ball"
    shutil.copytree(PACKAGE, folder)
    # Once, and not in the process of every edit; what is compiled already stays.
    compileall.compile_dir(folder, quiet=2)
    return folder


@pytest.fixture(scope="module")
def wrong_in_the_paper(copy, disagreeing):
    return disagreeing(copy)


# The first edit of each module; the others, weekly.
FIRST = {edit.module: edit for edit in reversed(EDITS)}.values()
TRIED = [edit if edit in FIRST else pytest.param(edit, marks=pytest.mark.long) for edit in EDITS]


@pytest.mark.slow
@pytest.mark.parametrize("edit", TRIED, ids=lambda edit: f"{edit.row}: {edit.wrong}")
def test_a_wrong_edit_shows_in_the_row_of_its_formula(edit, copy, disagreeing, wrong_in_the_paper):
    path = copy / edit.module
    text = path.read_text(encoding="utf-8")
    assert text.count(edit.right) == 1
    path.write_text(text.replace(edit.right, edit.wrong), encoding="utf-8")
    try:
        found = disagreeing(copy)
    finally:
        path.write_text(text, encoding="utf-8")
    assert edit.row in found - wrong_in_the_paper


def test_the_index_of_equations_names_the_functions_that_are_compared():
    index = {name for name in re.findall(r"``([\w.]+)``", paper.__doc__) if "." in name}
    used = {name for text in typed(formulas)(PARAMETERS).used.values for name in text.split(", ")}
    printed = {name for name in index if name.startswith("paper.claims.as_printed.")}
    # The residual of the six equations uses it.
    apart = {"periodic.continuation.PaperEquations.point"}
    assert index - printed - apart == used - {""}


def test_every_row_with_a_form_in_use_has_a_wrong_edit():
    data = typed(formulas)(PARAMETERS)
    used = {str(name) for name in data.formula.values[data.used.values != ""]}
    assert {edit.row for edit in EDITS} == used
