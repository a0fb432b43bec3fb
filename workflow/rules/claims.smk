# The paper under audit: its formulas, Table 1, every orbit by three routes, and its claims.

from bouncing_ball.claims.ledger import READS as READS_OF_CLAIMS

CLAIMS = {
    "formulas": "claims.formulas.formulas",
    "forensics": "claims.forensics.forensics",
    "witness": "claims.cross_check.cross_check",
    "claims": "claims.ledger.ledger",
}
# What shows orbits or bifurcations, which other routes must confirm.
READS["witness"] = [f"fig{k:02d}" for k in (2, 3, 5, 6, 7, 8, 9, 10, 12, 13, 14, 15)]
READS["witness"] += ["table1", "ext_release"]
# What decides the claims.
READS["claims"] = READS_OF_CLAIMS


use rule study as audit with:
    wildcard_constraints:
        artifact=stage(CLAIMS),
