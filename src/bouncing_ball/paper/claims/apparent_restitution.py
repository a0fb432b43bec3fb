"""Claims about the apparent restitution, Figs. 5 and 6."""

from bouncing_ball.paper.claims import evidence
from bouncing_ball.paper.claims import explanations as why
from bouncing_ball.paper.claims.claim import claim
from bouncing_ball.paper.claims.verdict import at_least, at_most


@claim("Fig. 5", meant=True)
def closer_with_stiffness(data):
    r"""the stiffer the contact, the closer the apparent restitution is to r

    Condition: on no curve of Figs. 5 and 6 does the difference from r grow again by more than is
    visible

    Remark: it grows again where the apparent restitution sinks below r. For a stiff contact
    $r_a - r = -\zeta(1+r)^2(1-\Lambda\sin\varphi)/(n\pi\varpi)$ to first order, so that it comes
    from below r exactly where $\Lambda\sin\varphi < 1$, which is below the amplitude of Eq. 8

    Answer: the sentence describes the figure, on whose scale the curves do approach r
    """
    seen = {"a hundredth is visible": 0.01, "a thousandth is visible": 0.001}
    return {reading: at_most(evidence.rebound(data), limit) for reading, limit in seen.items()}


@claim("Fig. 6")
def depends_on_amplitude(data):
    """the apparent restitution depends on the amplitude

    Condition: the three curves are at least 1 % apart somewhere
    """
    curve = data["fig06"].apparent_restitution
    return at_least((curve.max("case") - curve.min("case")).max(), 0.01)


@claim("Fig. 6", id="dip at 1.2", explanation=why.swapped_labels)
def dip_at_12(data):
    """at an amplitude of 1.2 the apparent restitution first decreases slightly, then rises

    Condition: the curve of that amplitude sinks below r by a visible amount

    Answer: the curve described may be that of 0.7, with the labels swapped
    """
    seen = {"a thousandth is visible": 0.001, "a hundredth is visible": 0.01}
    return {reading: at_least(evidence.dip(data, 1.2), limit) for reading, limit in seen.items()}


@claim("Fig. 6", printed="0.81", id="compliant end of 1.2")
def compliant_end_of_12(data):
    """at an amplitude of 1.2 the apparent restitution tends to this value at a frequency ratio of 1

    Remark: the value has the same digits at the other two amplitudes
    """
    return data["fig06"].apparent_restitution.sel(case=2, frequency_ratio=1.0)


@claim("Figs. 5 and 6")
def negligible_above_100(data):
    """the apparent restitution differs negligibly from r above a frequency ratio of 100

    Condition: the difference is below a hundredth on every curve from that frequency ratio on

    Remark: the paper speaks of the difference; its share of r is part of the claim *safe above 100*
    """
    return at_most(evidence.worst_when_stiff(abs(evidence.apparent(data))), 0.01)
