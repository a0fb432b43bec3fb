"""Random arguments of beyond's calls: also balls on contact laws and on the corrected model."""

from collections.abc import Callable
from typing import Any

from declared_arguments import arguments_of
from hypothesis import strategies as st
from random_arguments import Calls, Draw

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import Range
from bouncing_ball_beyond.models.named_laws import LAWS
from bouncing_ball_beyond.periodic.branches.labelled import BranchDataset, FollowedBranch
from bouncing_ball_beyond.periodic.law_balls import _RANGES as OF_LAWS

arguments = arguments_of(bouncing_ball_beyond, FollowedBranch, BranchDataset)
"""The declared arguments of a public function of beyond by its name."""


class CallsOfBeyond(Calls):
    """Calls of beyond's public functions with random arguments."""

    def __init__(self, draw: Draw) -> None:
        super().__init__(draw, bouncing_ball_beyond, arguments)

    def makers(self) -> tuple[Callable[[], Any], ...]:
        return *super().makers(), self.on_law, self.corrected

    def on_law(self) -> Any:
        """A ball on a law with its parameters, or with a free impact."""
        law = self.draw(st.sampled_from(sorted(LAWS)))
        if self.draw(st.booleans()):
            loss = self.value(arguments("rigid")["restitution"])
            allowed = {k: v for k, v in arguments("contact_law").items() if k != "release"}
            given = self.some(allowed, "duration", restitution=loss)
            return self.call("contact_law", law, **given)
        names = LAWS[law].parameter_names()
        fields = {name: self.value(OF_LAWS.get(name, Range())) for name in names}
        return self.call("contact_law", law, **fields)

    def corrected(self) -> Any:
        return self.call("corrected", self.draw(st.sampled_from([self.spring, self.on_law]))())
