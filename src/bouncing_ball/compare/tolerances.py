"""What each variable may drift, and why: the content of ``config/tolerances.yaml``."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from fnmatch import fnmatchcase
from typing import Any

from bouncing_ball.datasets.variables import VARIABLES


class ToleranceError(ValueError):
    """A tolerance that makes no sense, in one line."""


class Mode(StrEnum):
    """How a variable is compared."""

    POINTWISE = "pointwise"
    CURVE = "curve"
    EXACT = "exact"
    IGNORED = "ignored"


@dataclass(frozen=True)
class Tolerance:
    """The tolerance of one variable.

    Parameters
    ----------
    mode : Mode
    source : str
        Where the budget, or the choice of the mode, comes from.
    budget : float
        Drift allowed, as a share of the scale. For modes that measure one.
    along : str
        Curve: the dimension along which it runs.
    abscissa : str
        Curve: the variable or coordinate on the other axis.
    axis_budget : float, optional
        Curve: half width of the tube along the abscissa, as a share of the
        abscissa's range; the budget itself if not given.
    scale : float or str, optional
        Pointwise: what a drift is a share of, a number or a variable of the
        same dataset. The range of the record's values if not given.

    Raises
    ------
    ToleranceError
        If a mode lacks what it needs, or has what it does not use.

    Examples
    --------
    >>> Tolerance(Mode.POINTWISE, "measured", budget=1e-9).budget
    1e-09
    >>> Tolerance(Mode.EXACT, "a count", budget=1e-9)
    Traceback (most recent call last):
    ...
    bouncing_ball.compare.tolerances.ToleranceError: mode exact has no budget
    """

    mode: Mode
    source: str
    budget: float | None = None
    along: str | None = None
    abscissa: str | None = None
    axis_budget: float | None = None
    scale: float | str | None = None

    @property
    def allowed(self) -> float:
        """The budget, of a mode that measures a drift."""
        if self.budget is None:
            raise ToleranceError(f"mode {self.mode} has no budget")
        return self.budget

    def __post_init__(self) -> None:
        needed = {
            Mode.POINTWISE: {"budget"},
            Mode.CURVE: {"budget", "along", "abscissa"},
        }.get(self.mode, set())
        possible = needed | {
            Mode.POINTWISE: {"scale"},
            Mode.CURVE: {"axis_budget"},
        }.get(self.mode, set())
        optional = ("budget", "along", "abscissa", "axis_budget", "scale")
        given = {name for name in optional if getattr(self, name) is not None}
        for name in sorted(needed - given):
            raise ToleranceError(f"mode {self.mode} needs {name}")
        for name in sorted(given - possible):
            raise ToleranceError(f"mode {self.mode} has no {name}")


@dataclass(frozen=True)
class Tolerances:
    """All tolerances of a record.

    Parameters
    ----------
    variables : mapping of str to Tolerance
        By the name of the variable.
    artifacts : mapping of str to mapping
        By artifact, then by variable; these win.
    pictures : Tolerance
        Pointwise; the budget is a root mean square in grey levels of 255.
    ignored_attributes : tuple of str
        Patterns of names of attributes that are never compared.
    """

    variables: Mapping[str, Tolerance]
    pictures: Tolerance
    artifacts: Mapping[str, Mapping[str, Tolerance]] = field(default_factory=dict)
    ignored_attributes: tuple[str, ...] = ()

    def of(self, artifact: str, variable: str) -> Tolerance | None:
        """The tolerance of a variable, or None if the file has no entry for it."""
        own = self.artifacts.get(artifact, {})
        return own.get(variable) or self.variables.get(variable)

    def ignores(self, attribute: str) -> bool:
        """Whether an attribute is never compared."""
        return any(fnmatchcase(attribute, pattern) for pattern in self.ignored_attributes)


def _tolerance(where: str, entry: Mapping[str, Any]) -> Tolerance:
    try:
        return Tolerance(**{**entry, "mode": Mode(entry["mode"])})
    except ToleranceError as error:
        raise ToleranceError(f"{where}: {error}") from None


def tolerances_from(content: Mapping[str, Any]) -> Tolerances:
    """Tolerances from the parsed file, whose keys and types are checked already.

    Raises
    ------
    ToleranceError
        One line that names the entry.
    """

    def entries(path: str, part: Mapping[str, Any]) -> dict[str, Tolerance]:
        for name, entry in part.items():
            used = (name, *(entry[key] for key in ("along", "abscissa", "scale") if key in entry))
            for word in used:
                if isinstance(word, str) and word not in VARIABLES:
                    raise ToleranceError(f"{path}.{name}: no dataset has a variable {word}")
        return {name: _tolerance(f"{path}.{name}", entry) for name, entry in part.items()}

    return Tolerances(
        variables=entries("variables", content["variables"]),
        artifacts={
            name: entries(f"artifacts.{name}", part)
            for name, part in content.get("artifacts", {}).items()
        },
        pictures=_tolerance("pictures", {"mode": "pointwise"} | content["pictures"]),
        ignored_attributes=tuple(content.get("ignored_attributes", {})),
    )
