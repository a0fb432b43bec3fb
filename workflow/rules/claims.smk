# The paper under audit: its formulas, Table 1, every orbit by three routes, and its claims.

from bouncing_ball.claims import ledger, witness

CLAIMS = {
    "formulas": "claims.formulas.formulas",
    "forensics": "claims.forensics.forensics",
    "witness": "claims.witness.witness",
    "claims": "claims.ledger.ledger",
}
# What shows orbits or bifurcations, which other routes must confirm; and what decides the claims.
READS |= {"witness": list(witness.SHOWN), "claims": ledger.READS}


use rule study as audit with:
    wildcard_constraints:
        artifact=stage(CLAIMS),
