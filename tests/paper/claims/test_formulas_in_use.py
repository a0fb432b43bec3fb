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
from bouncing_ball.pipeline.configuration import typed

PACKAGE = Path(paper.__file__).parents[1]
PARAMETERS = {"samples": 16, "seed": 2011}
# Imported once, in a process of which those with an edited package are forks. Nothing of this
# package is among them.
LIBRARIES = [
    *("pytest", "xarray", "pydantic", "pint", "yaml", "scipy.integrate", "scipy.interpolate"),
    *("scipy.linalg", "scipy.optimize.elementwise", "scipy.special", "scipy.stats"),
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
from bouncing_ball.pipeline.configuration import typed
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


RIGID = "periodic/one_impact/restitution_branch.py"
BRANCH = "periodic/one_impact/spring_damper_branch.py"
ENDS = "periodic/one_impact/spring_damper_bifurcations.py"
LINEAR = "models/linear_contact.py"
PERMANENT = "models/permanent_contact.py"
ORBIT = "periodic/orbits/orbit.py"
IMPACTS = "periodic/orbits/impacts.py"
EDITS = [
    Edit("models/flight.py", "(self.velocity - _HALF * time)", "(self.velocity - time)", "Eq. 4"),
    Edit("models/flight.py", "slowing = y * sine + x * versine", "slowing = y * sine", "Eq. 5"),
    Edit(
        "models/restitution.py",
        "velocity = -r * impact.velocity\n        level",
        "velocity = -0.9 * r * impact.velocity\n        level",
        "Eq. 2",
    ),
    Edit(RIGID, "np.sqrt((lam - fold) * (lam + fold))", "np.sqrt(lam * lam + fold)", "Eq. 6"),
    Edit(RIGID, "* np.pi * (1 - r) / (1 + r)\n", "* np.pi * (1 - r) / (1 + 0.9 * r)\n", "Eq. 7"),
    Edit(RIGID, "return np.ones_like(r)", "return 2 * np.ones_like(r)", "Eq. 8, Holmes' map"),
    Edit(RIGID, "2 * (1 + r * r) / (1 + r) ** 2", "(1 + r * r) / (1 + r)", "Eq. 8, corrected"),
    Edit("models/sticking.py", "arctangent(1.0, lift", "arctangent(0.9, lift", "Eq. 9"),
    Edit(PERMANENT, "RESTITUTION_THRESHOLD = 1.0", "RESTITUTION_THRESHOLD = 1.1", "Eq. 9"),
    Edit(
        "models/spring_damper.py",
        "omega * penetration + 2 * self.damping_ratio * rate",
        "omega * penetration + self.damping_ratio * rate",
        "ϖ = Ω/ω, Ω of the contact",
    ),
    Edit(
        "models/linear_flow.py",
        "+ v0 * g.value - G",
        "+ v0 * g.value + G",
        "Eqs. 12-13",
    ),
    Edit(ORBIT, "+ (bounce + velocity) / 2 * s", "+ bounce * s", "Eqs. 14-15"),
    Edit(
        "models/damping.py",
        "np.pi * np.pi + decrement * decrement",
        "np.pi * np.pi + 0.9 * decrement * decrement",
        "Eq. 16",
    ),
    Edit(
        "models/damping.py",
        "exponential(-angle * under",
        "exponential(-0.9 * angle * under",
        "Eq. 16",
    ),
    Edit(
        IMPACTS,
        "self._shaped(-self._leaving / closing)",
        "self._shaped(self._bounces / closing)",
        "Eq. 17",
    ),
    Edit(
        IMPACTS,
        "return self._shaped(self._flights)",
        "return self._shaped(self._intervals)",
        "Eqs. 18-20",
    ),
    Edit(LINEAR, "self.a = self.start + (_ONE /", "self.a = self.start - (_ONE /", "Eqs. 21-26"),
    Edit(BRANCH, "right=end.g + flight,", "right=end.g + 0.9 * flight,", "Eqs. 21-26"),
    # No contact of the sample has a saddle-node then.
    Edit(BRANCH, "(x * d_x + y * d_y) / (u", "(x * d_x - y * d_y) / (u", "Eqs. 21-26"),
    Edit(ENDS, "return point.saddle_node", "return point.saddle_node - 0.01", "Eqs. 21-26"),
    Edit(
        ENDS,
        "return Bifurcation.PERIOD_DOUBLING.test(point.trace,",
        "return Bifurcation.PERIOD_DOUBLING.test(0.9 * point.trace,",
        "Eqs. 21-26",
    ),
    Edit(
        "periodic/orbits/problem.py",
        "landing.velocity.reshape(shape) - ",
        "0.9 * landing.velocity.reshape(shape) - ",
        "Eqs. 21-26",
    ),
    Edit(
        "periodic/one_impact/paper_unknowns.py",
        "inner[..., 1] -= lam",
        "inner[..., 1] += lam",
        "Eqs. 21-26",
    ),
    Edit(
        IMPACTS,
        "return np.roll(self.velocities, -1, axis=-1) + self._flights",
        "return np.roll(self.velocities, -1, axis=-1) + self._intervals",
        "Eq. 27",
    ),
    Edit(PERMANENT, "loss = 2 * zeta / omega", "loss = zeta / omega", "Eq. 33"),
    Edit(PERMANENT, "(centre + root) / divisor", "(centre + 0.9 * root) / divisor", "Eq. 34"),
    Edit(PERMANENT, "1 / (centre + root)", "1 / (centre - root)", "Eq. 35"),
    Edit(PERMANENT, "omega = 1 / np.sqrt(x)", "omega = 1.1 / np.sqrt(x)", "Eq. 36"),
    Edit(ORBIT, "rising * rising / 2", "rising * rising / 4", "Eqs. 37-38"),
    Edit(
        "accuracy/errors.py",
        "dtype=float) - base) / base",
        "dtype=float) - base) / value",
        "Eqs. 37-38",
    ),
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


# The first edit of each row; the others, weekly.
FIRST = {edit.row: edit for edit in reversed(EDITS)}.values()
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
    # The first is a printed form itself; `LinearContactDynamics.depart` computes with the second.
    apart = {
        "paper.claims.as_printed.steady_displacement",
        "models.linear_contact.ClosedFormMotion",
    }
    assert index - apart == used - {""}


def test_every_row_with_a_form_in_use_has_a_wrong_edit():
    data = typed(formulas)(PARAMETERS)
    used = {str(name) for name in data.formula.values[data.used.values != ""]}
    assert {edit.row for edit in EDITS} == used
