"""The stages: each artifact once, with all that the pipeline needs to know of it.

An artifact is a figure, a table or a dataset behind them. Its entry says which
study makes the dataset, from which section of the configuration, with which
settings of the whole run, and from which other datasets. The rules, the
convergence study, the check of the configuration and the tests read these
entries; studies are named and not imported, so that reading them is quick.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any


class Kind(Enum):
    """What is made from the dataset."""

    FIGURE = "figure"
    """A figure of the paper."""
    EXTENSION = "extension"
    """A figure beyond the paper."""
    TABLE = "table"
    PAGE = "page"
    """A page for the browser, which computes by itself."""
    DATASET = "dataset"
    """Nothing: other datasets and the article are made from it."""


@dataclass(frozen=True)
class Stage:
    """How one artifact is made: ``study([data,] parameters, *arguments)``."""

    name: str
    kind: Kind
    title: str
    study: str = ""
    """Function within the package, ``module.function``; none for a drawing without data."""
    section: str = ""
    """Place of its parameters in the configuration, ``figures.fig08``."""
    keys: str = ""
    """Its parameters, ``name`` or ``name:kind``; ``config/schema.yaml`` describes the kinds."""
    arguments: tuple[str, ...] = ()
    """Settings of the whole run: ``release``, ``continuation``."""
    reads: tuple[str, ...] = ()
    """Artifacts whose datasets the study takes first, as a mapping by name."""
    tabulated: bool = False
    """Whether the dataset of a figure is set as a table too."""
    cross_checked: bool = False
    """Whether it shows orbits or bifurcations, which other routes must confirm."""
    one_motion: bool = False
    """Whether the motion on one orbit is drawn for each ϖ, which so must be the ball's own."""
    nested: bool = True
    """Whether twice as many samples hold the old ones, so that the convergence study tries them."""

    @property
    def module(self) -> str:
        """Module of the study, within the package.

        Examples
        --------
        >>> STAGES["fig08"].module
        'studies.orbit_branches'
        """
        return self.study.rpartition(".")[0]

    @property
    def takes(self) -> dict[str, str]:
        """The kind of each of its parameters, by name.

        Examples
        --------
        >>> STAGES["fig11"].takes
        {'restitution': 'damped_restitution', 'frequency_ratio': 'span'}
        """
        pairs = (key.partition(":") for key in self.keys.split())
        return {name: kind or name for name, _, kind in pairs}

    def parameters(self, run: Mapping[str, Any]) -> Any:
        """Its section of the configuration, nothing if it has none.

        Examples
        --------
        >>> STAGES["fig02"].parameters({"figures": {"fig02": {"n": 1}}})
        {'n': 1}
        """
        part: Any = run
        for key in self.section.split(".") if self.section else ():
            part = part[key]
        return part if self.section else {}

    def settings(self, run: Mapping[str, Any]) -> dict[str, Any]:
        """The settings of the whole run that the study takes, by name.

        Examples
        --------
        >>> STAGES["fig05"].settings({"release": "force", "figures": {}})
        {'release': 'force'}
        """
        return {name: run[name] for name in self.arguments}


def _figure(
    number: int,
    title: str,
    study: str = "",
    keys: str = "",
    arguments: tuple[str, ...] = (),
    *,
    cross_checked: bool = False,
    one_motion: bool = False,
) -> Stage:
    name = f"fig{number:02d}"
    return Stage(
        name,
        Kind.FIGURE,
        f"Figure {number}: {title}",
        study,
        f"figures.{name}" if study else "",
        keys,
        arguments,
        cross_checked=cross_checked,
        one_motion=one_motion,
        # A cycle is split at the release, with half of the samples on either side, so
        # that a finer cycle has none of the old times.
        nested=not one_motion,
    )


def _corrected(
    name: str,
    title: str,
    study: str,
    keys: str,
    *,
    kind: Kind = Kind.EXTENSION,
    tabulated: bool = False,
    one_motion: bool = False,
    nested: bool = True,
) -> Stage:
    """An extension about the corrected restitution model."""
    return Stage(
        f"ext_{name}",
        kind,
        title,
        f"studies.model_errors.{study}",
        f"extensions.ext_{name}",
        keys,
        ("release",),
        tabulated=tabulated,
        one_motion=one_motion,
        nested=nested,
    )


_MODELS: tuple[Stage, ...] = (
    _figure(1, "the restitution model"),
    _figure(
        2,
        "n-T response of the restitution model",
        "studies.restitution_families.restitution_history",
        "n restitution amplitude periods samples",
        cross_checked=True,
    ),
    _figure(
        3,
        "existence and stability domains of the restitution model",
        "studies.restitution_families.restitution_orbits",
        "n:families restitution amplitude_max points",
        cross_checked=True,
    ),
    _figure(4, "the spring-damper model"),
    _figure(
        5,
        "apparent restitution along the frequency ratio, by restitution and amplitude",
        "studies.frequency_sweeps.apparent_restitution",
        "n cases frequency_ratio:span",
        ("release",),
        cross_checked=True,
    ),
    _figure(
        6,
        "apparent restitution along the frequency ratio, by amplitude",
        "studies.frequency_sweeps.apparent_restitution",
        "n cases frequency_ratio:span",
        ("release",),
        cross_checked=True,
    ),
    _figure(
        7,
        "one cycle of the spring-damper model",
        "studies.time_histories.contact_history",
        "n restitution amplitude frequency_ratio:ratio samples",
        ("release",),
        cross_checked=True,
        one_motion=True,
    ),
    _figure(
        8,
        "existence and stability domains of the spring-damper model, first family",
        "studies.orbit_branches.orbit_branches",
        "n restitution:lossy_restitution frequency_ratio:four_ratios amplitude_max points",
        ("release", "continuation"),
        cross_checked=True,
    ),
    _figure(
        9,
        "existence and stability domains of the spring-damper model, second family",
        "studies.orbit_branches.orbit_branches",
        "n restitution:lossy_restitution frequency_ratio:four_ratios amplitude_max points",
        ("release", "continuation"),
        cross_checked=True,
    ),
    _figure(
        10,
        "bouncing-off velocity along the frequency ratio",
        "studies.frequency_sweeps.frequency_sweep",
        "n restitution amplitude:amplitudes frequency_ratio:span",
        ("release",),
        cross_checked=True,
    ),
    _figure(
        11,
        "threshold of permanent contact along the frequency ratio",
        "studies.permanent_contact_curve.permanent_contact",
        "restitution:damped_restitution frequency_ratio:span",
        ("release",),
    ),
    _figure(
        12,
        "time histories of both models",
        "studies.time_histories.both_histories",
        "n restitution amplitude frequency_ratio:six_ratios samples",
        ("release",),
        cross_checked=True,
        one_motion=True,
    ),
    _figure(
        13,
        "Poincaré map of both models along the frequency ratio",
        "studies.frequency_sweeps.poincare_map",
        "n restitution amplitude:amplitudes frequency_ratio:span",
        ("release",),
        cross_checked=True,
    ),
    _figure(
        14,
        "greatest height of both models, and the threshold of the error",
        "studies.error_thresholds.height_error",
        "n restitution amplitude frequency_ratio:span tolerance",
        ("release",),
        cross_checked=True,
    ),
    _figure(
        15,
        "existence and stability domains of both models",
        "studies.orbit_branches.both_domains",
        "n restitution:lossy_restitution frequency_ratio:ratio amplitude_max points",
        ("release", "continuation"),
        cross_checked=True,
    ),
    _figure(
        16,
        "threshold of permanent contact of both models",
        "studies.error_thresholds.permanent_contact_error",
        "restitution:damped_restitution frequency_ratio:span tolerance",
        ("release",),
    ),
    Stage(
        "table1",
        Kind.TABLE,
        "Table 1: stability ranges over the amplitude",
        "studies.orbit_branches.stability_ranges",
        "tables.table1",
        "n:families restitution:lossy_restitution frequency_ratio:ratios amplitude_max",
        ("release", "continuation"),
        cross_checked=True,
    ),
    Stage(
        "thresholds",
        Kind.TABLE,
        "Frequency ratio from which the error of the restitution model is tolerable",
        "studies.error_thresholds.error_thresholds",
        "tables.thresholds",
        "n restitution amplitude quantities tolerances frequency_ratio:span",
        ("release",),
    ),
    Stage(
        "motions",
        Kind.DATASET,
        "Kinds of motion of the restitution model",
        "studies.kinds_of_motion.kinds_of_motion",
        "studies.motions",
        "n restitution:lossy_restitution amplitude:amplitudes ensemble",
    ),
    Stage(
        "ext_release",
        Kind.EXTENSION,
        "Bifurcations and thresholds under both release rules",
        "studies.release_rules.release_rules",
        "extensions.ext_release",
        "n:five_families restitution:lossy_restitution frequency_ratio:span"
        " thresholds:error_threshold",
        cross_checked=True,
    ),
    Stage(
        "ext_rattling",
        Kind.EXTENSION,
        "Stable windows of the orbits into which permanent contact continues",
        "studies.long_contacts.stable_windows",
        "extensions.ext_rattling",
        "restitution:lossy_restitutions frequency_ratio:span",
        ("release",),
    ),
    Stage(
        "ext_basins",
        Kind.EXTENSION,
        "Basins of permanent contact and of the stable orbits",
        "studies.long_contacts.basins",
        "extensions.ext_basins",
        "n:families restitution:lossy_restitution frequency_ratio:ratio amplitude:impact_amplitudes"
        " velocity_max starts impacts",
        ("release",),
    ),
    _corrected(
        "instant",
        "Flights before and after a contact meet at the centroid of its force",
        "meeting_flights",
        "n restitution amplitude frequency_ratio:ratio samples",
        one_motion=True,
    ),
    _corrected(
        "error_law",
        "The first-order error of the restitution model, and what the corrected one leaves",
        "error_law_table",
        "n restitution:lossy_restitution amplitude tolerance frequency_ratio:span",
        kind=Kind.TABLE,
    ),
    _corrected(
        "orders",
        "Order of convergence of the restitution model and of the corrected one",
        "orders",
        "n restitution:lossy_restitution amplitude frequency_ratio:span random:random_orbits",
        nested=False,  # more random orbits are others
    ),
    _corrected(
        "validity",
        "Frequency ratio from which each model is right",
        "validity",
        "n:families restitution:own_restitutions amplitude_ratio:amplitude_ratios tolerance"
        " frequency_ratio:span",
        tabulated=True,
    ),
    Stage(
        "ext_laws",
        Kind.EXTENSION,
        "Errors of the restitution model and of the corrected one on the contacts of engineers",
        "studies.contact_laws.law_errors",
        "extensions.ext_laws",
        "n restitution:law_restitution amplitude tolerance frequency_ratio:span",
        tabulated=True,
    ),
    Stage(
        "ext_hertz",
        Kind.EXTENSION,
        "Table 1 and Figures 8, 14 and 16 on contacts of other laws",
        "studies.contact_laws.figures_of_laws",
        "extensions.ext_hertz",
        "n:families restitution:law_restitution frequency_ratio:four_ratios amplitude_max"
        " points heights",
        tabulated=True,
    ),
)

_EXPLORER = Stage(
    "explorer",
    Kind.PAGE,
    "A page to explore the models, and the orbits that it checks itself against",
    "studies.reference_orbits.reference_orbits",
    "extensions.explorer",
    "frequency_ratio:span seed",
    nested=False,
)

# What decides the claims: the keys of claims.parameters.PARAMETERS.
_DECIDING = (
    *(f"fig{k:02d}" for k in (3, 5, 6, 8, 9, 10, 11, 13, 14, 15, 16)),
    *("table1", "thresholds", "ext_release", "motions", "formulas", "forensics", "witness"),
)

_AUDIT = (
    Stage(
        "formulas",
        Kind.TABLE,
        "The printed formulas against a second computation",
        "claims.formulas.formulas",
        "studies.formulas",
        nested=False,  # other random parameters
    ),
    Stage(
        "forensics",
        Kind.TABLE,
        "Table 1 under readings of what the authors may have done",
        "claims.forensics.forensics",
    ),
    Stage(
        "witness",
        Kind.TABLE,
        "Continuation, formula and simulation for every orbit shown",
        "claims.witness.witness",
        reads=tuple(stage.name for stage in _MODELS if stage.cross_checked),
    ),
    Stage(
        "claims",
        Kind.TABLE,
        "Verdicts on the paper's claims",
        "claims.ledger.ledger",
        reads=_DECIDING,
    ),
)

ENTRIES = (*_MODELS, _EXPLORER, *_AUDIT)
"""All entries, in the order in which they are listed everywhere."""

STAGES: Mapping[str, Stage] = {stage.name: stage for stage in ENTRIES}
"""The entries by name."""


def names(*kinds: Kind) -> list[str]:
    """Artifacts of these kinds.

    Examples
    --------
    >>> names(Kind.EXTENSION)[0]
    'ext_release'
    """
    return [stage.name for stage in STAGES.values() if stage.kind in kinds]


def tables() -> list[str]:
    """Artifacts that are set as tables, those with a figure included.

    Examples
    --------
    >>> tables()[:2], "ext_validity" in tables()
    (['table1', 'thresholds'], True)
    """
    return [name for name, stage in STAGES.items() if stage.kind is Kind.TABLE or stage.tabulated]


def studied() -> Iterator[Stage]:
    """Entries that have a dataset."""
    return (stage for stage in STAGES.values() if stage.study)
