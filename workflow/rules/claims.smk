# The paper under audit: its formulas, Table 1, every orbit by three routes, and its claims.

from bouncing_ball.claims.ledger import READS as READS_OF_CLAIMS
from bouncing_ball.claims.witness import SHOWN

CLAIMS = {
    "claims.formulas.formulas": {
        "formulas": "The printed formulas against a second computation",
    },
    "claims.forensics.forensics": {
        "forensics": "Table 1 under readings of what the authors may have done",
    },
    "claims.witness.witness": {
        "witness": "Continuation, formula and simulation for every orbit shown",
    },
    "claims.ledger.ledger": {
        "claims": "Verdicts on the paper's claims",
    },
}
# What shows orbits or bifurcations, which other routes must confirm.
READS["witness"] = list(SHOWN)
# What decides the claims.
READS["claims"] = READS_OF_CLAIMS


use rule study as audit with:
    wildcard_constraints:
        artifact=stages(CLAIMS),
