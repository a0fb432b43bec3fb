# The paper under audit: its formulas, Table 1, every orbit by three routes, and its claims.

from bouncing_ball.claims.ledger import READS as READS_OF_CLAIMS
from bouncing_ball.claims.witness import SHOWN

CLAIMS = {
    "formulas": "claims.formulas.formulas",
    "forensics": "claims.forensics.forensics",
    "witness": "claims.witness.witness",
    "claims": "claims.ledger.ledger",
}
# What shows orbits or bifurcations, which other routes must confirm.
READS["witness"] = list(SHOWN)
# What decides the claims.
READS["claims"] = READS_OF_CLAIMS


use rule study as audit with:
    wildcard_constraints:
        artifact=stage(CLAIMS),
