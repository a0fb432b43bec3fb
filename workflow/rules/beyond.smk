# The stages beyond the paper, in the same form as those of the paper. A dataset with `accepted` is
# not part of a run: figures and texts read this file.

# Datasets that no study makes: what physics engines computed (`make test-engines`).
stage(
    "contacts.engines",
    engines=dict(title="Orbits that physics engines ran", accepted="config/engines.nc"),
    bounce_drivers=dict(
        title="One bounce in the driver of each engine, beside certified numbers",
        accepted="config/bounce_drivers.nc",
    ),
)
stage(
    "beyond.exhibits.bounces",
    ext_bounces=dict(
        title="The bounce that physics engines give where r is a number that the user sets",
        drawing="bounces",
        table="ext_bounces",
        accepted="config/ext_bounces.nc",
    ),
    ext_bounce_settings=dict(
        title="The bounce that physics engines give with other settings of their solvers",
        drawing="settings",
        table="ext_bounce_settings",
        accepted="config/ext_bounce_settings.nc",
    ),
)


use rule study as beyond_study with:
    """What all stages beyond the paper have in common. It makes nothing itself."""
    output:
        data="results/figures/beyond/{artifact}.nc",


use rule beyond_study as corrected_model_study with:
    """The corrected restitution model, and how fast its errors fall along the frequency ratio."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.corrected_model",
            ext_instant=dict(
                title="Flights before and after a contact meet at the centroid of its force",
                study="meeting_flights",
                drawing="meeting_flights",
            ),
            ext_orders=dict(
                title="Order of convergence of the restitution model and of the corrected one",
                study="orders",
                drawing="orders",
                table="ext_orders",
            ),
        ),


use rule beyond_study as stiffness_map_study with:
    """How stiff a contact must be for the greatest height, over all stable orbits."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.stiffness_map",
            ext_map=dict(
                title="How stiff a contact must be for the greatest height, over r and Λ",
                study="stiffness_map",
                drawing="stiffness_map",
            ),
        ),


use rule beyond_study as release_rules_study with:
    """Contacts with another release rule."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.release_rules",
            ext_release=dict(
                title="Bifurcations and thresholds under both release rules",
                study="release_rules",
            ),
            ext_impact=dict(
                title="Restitution and duration of a free impact, by damping and release rule",
                study="free_impacts",
                drawing="free_impacts",
            ),
        ),


use rule beyond_study as contact_laws_study with:
    """Contacts with other laws."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.contact_laws",
            ext_laws=dict(
                title="Errors of the restitution model and of the corrected one on the contacts of engineers",
                study="law_errors",
                drawing="contact_laws",
                table="ext_laws",
            ),
        ),


use rule beyond_study as measured_impacts_study with:
    """Measured impacts against every law."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.measured_impacts",
            ext_measured=dict(
                title="Measured impacts against every contact law",
                study="measured_impacts",
                drawing="measured_impacts",
                table="ext_measured",
            ),
            ext_shaker=dict(
                title="The balls of the experiments on shakers, and the cost of a constant r",
                study="on_shakers",
                table="ext_shaker",
            ),
        ),


use rule beyond_study as cascade_of_flights_study with:
    """Flights in a period above the threshold of permanent contact."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.cascade_of_flights",
            ext_flights=dict(
                title="From permanent contact to chattering: the cascade of flights in a period",
                study="cascade_of_flights",
                drawing="cascade_of_flights",
            ),
        ),


use rule beyond_study as engine_steps_study with:
    """Time steps of physics engines."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.engine_steps",
            ext_engines=dict(
                title="What the time steps of physics engines cost, beside the models",
                study="conformance",
                drawing="engines",
                table="ext_engines",
                reads=("engines",),
            ),
        ),


use rule beyond_study as explorer_orbits_study with:
    """Orbits with which the page of the explorer compares its results."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.explorer_orbits",
            explorer=dict(
                title="A page to explore the models, and the orbits that it checks itself against",
                study="reference_orbits",
                page=True,
            ),
        ),


use rule beyond_study as proofs_study with:
    """Numbers of the paper with intervals that certainly contain them."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.proofs",
            ext_proofs=dict(
                title="Printed numbers, certified by ball arithmetic",
                study="proofs",
                table="ext_proofs",
            ),
        ),


use rule beyond_study as certified_verdicts_study with:
    """The verdicts on printed numbers, decided by certified intervals."""
    wildcard_constraints:
        artifact=stage(
            "beyond.exhibits.certified_verdicts",
            ext_verdicts=dict(
                title="Verdicts on the printed numbers by certified intervals",
                study="certified_verdicts",
                table="ext_verdicts",
                reads=("ext_proofs", "claims"),
            ),
        ),
