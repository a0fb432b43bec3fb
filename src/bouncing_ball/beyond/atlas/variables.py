"""The variables of the atlas's datasets."""

from bouncing_ball.datasets.variables import Variable

VARIABLES = {
    "row": Variable("row of tiles: a release rule, an index n and a range of r"),
    "position": Variable(
        "place in the stable range of the restitution model, from its saddle-node at 0 to its "
        "period doubling at 1",
        symbol="(Λ - Λ_SN)/(Λ_PD - Λ_SN)",
    ),
    "threshold_bin": Variable(
        "lower end of a bin of thresholds; 0: at every ϖ scanned, infinity: at none", symbol="ϖ"
    ),
    "largest_threshold": Variable("ϖ from which the error of all nodes is tolerated", symbol="ϖ"),
    "threshold_counts": Variable("number of nodes by the ϖ from which their error is tolerated"),
    "holding": Variable("number of nodes whose error is tolerated from this ϖ on"),
    "exceeding": Variable("number of nodes whose error exceeds the tolerance at this ϖ"),
    "law_stated": Variable("number of nodes for which the error law is stated"),
    "law_exceeding": Variable("number of these beyond the stated remainder"),
    "unstable": Variable("number of nodes whose exact orbit is not stable"),
    "sought": Variable("number of orbits that the walk did not reach, looked for directly"),
    "limit_quantity": Variable("limit of the stable range, or of permanent contact"),
    "needed": Variable("ϖ from which the error of all nodes of a tile is tolerated", symbol="ϖ"),
    "limit_needed": Variable(
        "ϖ from which the error of all limits of a range of r is tolerated", symbol="ϖ"
    ),
    "needed_quantile": Variable(
        "ϖ from which the error of a share of nodes is tolerated", symbol="ϖ"
    ),
    "holding_share": Variable("share of nodes whose error is tolerated from this ϖ on"),
    "exceeding_share": Variable("share of nodes whose error exceeds the tolerance at this ϖ"),
    "failing_restitution": Variable(
        "r below which the error of the greatest height exceeds the tolerance", symbol="r"
    ),
    "unstable_share": Variable("share of nodes whose exact orbit is not stable"),
    "supremum": Variable("supremum of the relative error where the rule of thumb begins"),
    "supremum_quantity": Variable("quantity of an orbit, or limit"),
    "supremum_needed": Variable("ϖ from which the error of all orbits is tolerated", symbol="ϖ"),
    "restitution_edge": Variable("ends of the ranges of r", symbol="r"),
    "position_edge": Variable("ends of the ranges of positions"),
    "law_coefficient": Variable(
        "modulus of the error law's K in the middle of the tile", symbol="|K|"
    ),
    "sought_orbits": Variable("orbits that the walk did not reach, looked for directly"),
    "resolution": Variable("largest relative step of ϖ: a threshold lies within one"),
    "summary_tolerance": Variable("relative error tolerated in the summary"),
    "rule_of_thumb": Variable("frequency ratio that is said to be enough", symbol="ϖ"),
}
