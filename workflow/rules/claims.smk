# The paper under audit: its formulas, Table 1, every orbit by three routes, and its claims. Each
# dataset has a row for each formula, hypothesis, orbit or claim.

from bouncing_ball.claims import ledger, witness

CLAIMS = {
    "formulas": "claims.formulas.formulas",
    "forensics": "claims.forensics.forensics",
    "witness": "claims.witness.witness",
    "claims": "claims.ledger.ledger",
}
# The artifacts with orbits or bifurcations, which other routes must confirm, and the datasets that
# decide the claims.
READS |= {"witness": list(witness.SHOWN), "claims": ledger.READS}


use rule study as audit with:
    wildcard_constraints:
        artifact=stage(CLAIMS),
