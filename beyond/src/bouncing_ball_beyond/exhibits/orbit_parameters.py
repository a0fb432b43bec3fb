"""Types of parameters that require an orbit: amplitudes and contacts on which one exists.

A type reads the parameters that are declared before it in its class: that of an amplitude reads n
and r, and that of a contact the amplitude and the release rule of the run as well.
"""

from typing import Annotated, Any

from pydantic import AfterValidator, Strict, ValidationInfo

from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.datasets.parameters import (
    Amplitude,
    Family,
    FrequencyRatio,
    Many,
    Parameters,
    Restitution,
    Span,
    Tolerance,
)
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t


def _has_orbit(amplitude: float, info: ValidationInfo) -> float:
    given = info.data
    # If n or r is missing or wrong, that mistake is reported instead.
    if not {"n", "restitution"} <= given.keys():
        return amplitude
    lowest = float(restitution_saddle_node(given["n"], given["restitution"]))
    if amplitude < lowest:
        raise ValueError(
            f"must be at least {lowest:.6g}, the saddle-node of the {given['n']}-T restitution "
            f"orbit at r = {given['restitution']:g} (Eq. 7)"
        )
    return amplitude


def _on_contact(ratio: float, info: ValidationInfo) -> float:
    given = info.data
    run: Any = info.context or {}
    rule = run.get("release")
    # If a parameter is missing or wrong, that mistake is reported instead.
    is_known = {"n", "restitution", "amplitude"} <= given.keys()
    if not is_known or rule not in [*map(str, Release)]:
        return ratio
    contact = SpringDamper.from_restitution(given["restitution"], ratio, Release(rule))
    orbit = n_t.orbit(ContactModel(contact), given["n"], given["amplitude"])
    if not (orbit.exists and orbit.is_admissible()):
        raise ValueError(
            f"must be the ϖ of a contact with a {given['n']}-T orbit at r = "
            f"{given['restitution']:g} and Λ = {given['amplitude']:g}"
        )
    return ratio


OrbitAmplitude = Annotated[Amplitude, AfterValidator(_has_orbit)]
"""Λ at which the restitution model has the orbit."""
ContactRatio = Annotated[FrequencyRatio, AfterValidator(_on_contact)]
"""ϖ of a contact that has an admissible orbit of the family at Λ."""


class OrbitParameters(Parameters):
    """One orbit by its family, r and Λ, at which the restitution model has an orbit too."""

    n: Family
    restitution: Restitution
    amplitude: OrbitAmplitude


class OrbitOnContact(OrbitParameters):
    """One orbit on one contact."""

    frequency_ratio: ContactRatio


class OrbitsAlongRatio(OrbitParameters):
    """One orbit of the restitution model, on contacts along a grid of ϖ."""

    frequency_ratio: Span


class OrbitErrors(OrbitsAlongRatio):
    """One orbit along ϖ, and the tolerated relative error of a simple model."""

    tolerance: Tolerance


class ComparedQuantities(OrbitErrors):
    """One orbit along ϖ, the quantities compared on it, and the tolerated relative error."""

    quantities: Many[Annotated[Quantity, Strict(False)]]
