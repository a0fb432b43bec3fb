"""The numbers of a contact that the results about it have, each of them read from its case."""

from typing import Annotated, Any

from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.rows import Listed


class NumbersOfContact:
    """What any result about a contact says of it, in SI units.

    The r of a free impact holds at speeds above ``slowed_speed``: there, on a table at rest,
    gravity lowers √(h′/h) by 1 %, and at slower impacts by more. It is 0 if gravity does so at no
    speed, as without damping, and None if it lowers it by more at every speed. ``law`` has the
    ``name`` of a contact law and its parameters, whose units are powers of kg, m and s; it is None
    for a spring and a damper.
    """

    case: ResolvedContact

    @property
    def mass(self) -> Annotated[float, Listed("mass in kg")]:
        """m in kg."""
        return self.case.mass

    @property
    def stiffness(self) -> Annotated[float, Listed("stiffness", "N/m")]:
        """k in N/m."""
        return self.case.stiffness

    @property
    def release(self) -> str:
        """The name of the release rule."""
        return str(self.case.equivalent.release)

    @property
    def slowed_speed(
        self,
    ) -> Annotated[
        float | None,
        Listed("gravity lowers r by 1 % at", "m/s", none="every speed", zero="no speed"),
    ]:
        """The impact speed in m/s at which gravity lowers r by 1 %."""
        return self.case.slowed_speed

    @property
    def law(self) -> dict[str, Any] | None:
        """The name of a contact law and its parameters in SI units."""
        return self.case.law_in_si


class NumbersOfImpact(NumbersOfContact):
    """What a result says of a contact whose loss is known, also of its free impact.

    ``frequency_ratio`` and ``damping_ratio`` are ϖ and ζ. ``measured_restitution`` is the r of a
    free impact under the release rule of the contact.
    """

    @property
    def frequency_ratio(self) -> Annotated[float, Listed("frequency ratio ϖ")]:
        """ϖ = ω/Ω."""
        return float(self.case.equivalent.frequency_ratio)

    @property
    def damping_ratio(self) -> Annotated[float, Listed("damping ratio ζ")]:
        """ζ = c/(2√(km))."""
        return float(self.case.equivalent.damping_ratio)

    @property
    def damping(self) -> Annotated[float, Listed("damping", "N s/m")]:
        """c in N s/m."""
        return self.case.damping

    @property
    def contact_time(self) -> Annotated[float, Listed("contact time", "s")]:
        """Duration of a free impact in s."""
        return self.case.contact_time

    @property
    def measured_restitution(self) -> Annotated[float, Listed("restitution of a free impact")]:
        """r of a free impact."""
        return self.case.restitution
