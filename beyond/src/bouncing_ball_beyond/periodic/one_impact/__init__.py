"""n-T orbits: those with one impact in n periods of the table.

In reading order:

``n_t``                          the orbits of any model, their saddle-nodes and period doublings
``orbits_of_model``              the interface of all formulas and searches for them
``closed_forms``                 those of the models that have a closed form
``restitution_branch``           that of the restitution model
``corrected_branch``             that of the corrected model
``spring_damper_branch``         the explicit curve of the spring-damper model
``spring_damper_bifurcations``   the bifurcations on this curve, and its orbits at a given Λ
``searched_orbits``              the search for the orbits of models without a closed form
``law_at_orbit``                 orbits on the contact law that has a given r and D at their impacts
``paper_unknowns``               the equations in the unknowns of the paper
``whole_branch``                 a whole branch, from one end to the other
"""
