"""Fixtures that the tests of all houses share: references, the command line, the browser.

The references use nothing of the package: they are a matrix exponential, the paper's
solution of the contact, Brent's method, and free flight.
"""

import contextlib
import gc
import io
import json
import math
import os
import shutil
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from scipy.linalg import expm
from scipy.optimize import brentq

from bouncing_ball_beyond.inherited.cli import patience
from bouncing_ball_beyond.inherited.cli.main import main

# A helper's assertion that fails shows its values, as one of a test does.
pytest.register_assert_rewrite(
    "answer_checks",
    "gallery_checks",
    "labels_of_arguments",
    "page_checks",
    "patience_checks",
    "random_arguments",
    "random_mistakes",
    "surveys_of_balls",
)

# Programs that the tests start keep what they have compiled, whatever the shell says: else
# each start takes twice as long.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Folders whose tests take longest: those of the root, and of beyond.
LONG_FOLDERS = {"workflow", "explorer"}

# The lines of commands that take long depend on the load of the machine, and tests compare what is
# printed. Tests of these lines set another time.
patience._FIRST = 3600.0

settings.register_profile(
    "deterministic",
    derandomize=True,
    deadline=None,
    max_examples=40,
    database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("deterministic")


def pytest_collection_modifyitems(items):
    """With several workers the long tests first, so that none runs alone at the end."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        items.sort(key=lambda item: LONG_FOLDERS.isdisjoint(item.path.parts))


def pytest_collection_finish():
    """What all tests share remains; the collector of garbage does not go through it again, and
    seldom through what they make, of which little is in cycles.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000)


def _contact_state(s, d0, v0, phase, lam, omega, zeta):
    """(δ, δ′) after a time s in contact, by the exponential of a 5 × 5 matrix.

    The state (ϖδ, δ′, 1, sin τ, cos τ) makes the equation autonomous; the
    factor ϖ balances the matrix.
    """
    matrix = np.zeros((5, 5))
    matrix[0, 1] = omega
    matrix[1] = [-omega, -2 * zeta * omega, -1.0, lam, 0.0]
    matrix[3, 4] = 1.0
    matrix[4, 3] = -1.0
    start = [omega * d0, v0, 1.0, np.sin(phase), np.cos(phase)]
    # expm alone loses e^|matrix| roundings up to a norm of four; below one half
    # it loses none, and squaring loses one for each of the parts.
    parts = 2 ** max(0, math.ceil(math.log2(2 * np.abs(matrix).sum(axis=1).max() * s)))
    whole = np.linalg.matrix_power(expm(matrix * (s / parts)), parts)
    scaled_d, v, *_ = whole @ start
    return scaled_d / omega, v


def _paper_contact(u, phase, lam, omega, zeta):
    """(δ, δ′) as a function of time, from the paper's Eqs. 12-13 (ζ < 1, no resonance)."""
    gamma = (omega**2 - 1) ** 2 + (2 * zeta * omega) ** 2
    p = omega**2 - 1
    q = 2 * zeta * omega
    a = zeta * omega
    omega_d = omega * math.sqrt(1 - zeta**2)

    def steady(s):
        sin = math.sin(s + phase)
        cos = math.cos(s + phase)
        return (
            -1 / omega**2 + lam * (p * sin - q * cos) / gamma,
            lam * (p * cos + q * sin) / gamma,
        )

    d0, v0 = steady(0.0)
    b1 = -d0
    b2 = (u - v0 - a * d0) / omega_d

    def state(s):
        sin = math.sin(omega_d * s)
        cos = math.cos(omega_d * s)
        decay = math.exp(-a * s)
        free = decay * (b1 * cos + b2 * sin)
        rate = decay * omega_d * (b2 * cos - b1 * sin) - a * free
        d, v = steady(s)
        return d + free, v + rate

    return state


def _cycle(phase, u, n, lam, omega, zeta, duration, force_release=False):
    """One cycle from the start of contact: (landing phase, relative landing velocity).

    ``duration`` is a guess of the contact time; both events are bracketed
    around the guesses and located by Brent's method to the last digits.
    """

    state = _paper_contact(u, phase, lam, omega, zeta)

    def release(s):
        d, v = state(s)
        return omega * d + (2 * zeta * v if force_release else 0.0)

    s = brentq(release, 0.97 * duration, 1.03 * duration, xtol=1e-300, rtol=9e-16)
    d, v = state(s)
    z = d + lam * np.sin(phase + s)
    zdot = v + lam * np.cos(phase + s)
    flight = 2 * np.pi * n - duration

    def gap(t):
        return z + zdot * t - t * t / 2 - lam * math.sin(phase + s + t)

    t = brentq(gap, 0.97 * flight, 1.03 * flight, xtol=1e-300, rtol=9e-16)
    return phase + s + t, zdot - t - lam * np.cos(phase + s + t)


@pytest.fixture(scope="session")
def reference():
    """Independent implementations: ``contact_state``, ``paper_contact`` and ``cycle``."""
    return SimpleNamespace(contact_state=_contact_state, paper_contact=_paper_contact, cycle=_cycle)


@pytest.fixture(scope="session")
def described(declared):
    """Asserts that every variable and dimension of a dataset has a name and a description.

    A house whose tests have datasets of stages has a fixture ``declared``.
    """

    def check(dataset):
        for name in dataset.variables:
            attributes = dataset[name].attrs
            assert attributes.get("long_name"), name
            if dataset[name].dtype.kind in "fiu":
                assert attributes.get("units") in ("1", "rad"), name
            else:
                assert dataset[name].dtype.kind in "bU", name
        assert set(dataset.dims) <= set(declared)
        return dataset

    return check


@pytest.fixture
def hasty(monkeypatch):
    """A call that takes longer than some hundredths of a second says so."""
    monkeypatch.setattr(patience, "_FIRST", 0.05)
    monkeypatch.setattr(patience, "_NEXT", 0.1)


@pytest.fixture(scope="session")
def one_line():
    """Asserts that an exception's message is one line with the given parts."""

    def check(error, *parts):
        message = str(error.value)
        assert "\n" not in message, message
        for part in parts:
            assert part in message, message

    return check


@pytest.fixture(scope="session")
def refusal(one_line):
    """As ``pytest.raises``, with such a message: ``with refusal(ModelError, "part", …):``."""

    @contextlib.contextmanager
    def check(kind, *parts):
        with pytest.raises(kind) as error:
            yield
        one_line(error, *parts)

    return check


@pytest.fixture(scope="session")
def outcome():
    """Exit status, output and errors of a call."""

    def outcome(*arguments):
        status = 0
        with (
            contextlib.redirect_stdout(io.StringIO()) as out,
            contextlib.redirect_stderr(io.StringIO()) as err,
        ):
            try:
                main(list(arguments))
            except SystemExit as exit_:
                status = exit_.code
        return status, out.getvalue(), err.getvalue()

    return outcome


@pytest.fixture(scope="session")
def said(outcome):
    """The output of a call that succeeds."""

    def said(*arguments):
        status, out, err = outcome(*arguments)
        assert (status, err) == (0, "")
        return out

    return said


@pytest.fixture(scope="session")
def ask(said):
    """The JSON answer of a call that succeeds, which must be one line."""

    def ask(*arguments):
        out = said(*arguments, "--json")
        assert out.count("\n") == 1
        return json.loads(out)

    return ask


@pytest.fixture(scope="session")
def refused(outcome):
    """Exit status and the one line on standard error of a call that fails."""

    def refused(*arguments):
        status, out, err = outcome(*arguments)
        assert status != 0 and out == "" and err.count("\n") == 1
        return status, err.rstrip("\n")

    return refused


CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome"))),
    None,
)


def _browse(folder, url, *options):
    """Run the browser once, with a temporary folder for its profile."""
    done = subprocess.run(
        [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--hide-scrollbars",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            # The frame is a file as well, and is to be looked into.
            "--allow-file-access-from-files",
            f"--user-data-dir={folder / 'profile'}",
            *options,
            url.as_uri(),
        ],
        capture_output=True,
        text=True,
        # A hang, whatever else the machine does.
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def browse():
    """A browser without a window and without a network: ``browse(folder, url, *options)``."""
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")
    return _browse
