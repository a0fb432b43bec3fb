"""A design with units: is a restitution coefficient enough for this ball on this shaker?"""

import textwrap

import matplotlib.pyplot as plt

import bouncing_ball_contacts

found = bouncing_ball_contacts.assess_contact(
    bouncing_ball_contacts.Table(frequency="50 Hz", acceleration="0.8 g"),
    bouncing_ball_contacts.Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85),
)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for errors, marker in ((found.judged.errors, "o"), (found.judged.corrected_errors, "D")):
    axes.semilogx(errors.values(), [name.replace("_", " ") for name in errors], marker)
axes.legend(["restitution model", "corrected restitution model"])
axes.axvline(0.01, color="grey", linestyle=":")
axes.set(xlabel=f"relative error of the {found.n}-T orbit (dotted: 1 %)")
axes.set_title(textwrap.fill(found.verdict, 75), fontsize=10)
figure.savefig("design_with_units.png")
