"""The quantities compared between the models, as a title calls them."""

NAMES = {
    "max_height": r"greatest height $\max\,z$",
    "bounce_velocity": r"bouncing-off velocity $z'_b$",
    "phase": r"phase of impact $\varphi$",
    "apparent_restitution": r"apparent restitution $r_a$",
    "saddle_node": r"saddle-node $\Lambda_{SN}$",
    "period_doubling": r"period doubling $\Lambda_{PD}$",
    "permanent_contact": r"permanent contact",
}
