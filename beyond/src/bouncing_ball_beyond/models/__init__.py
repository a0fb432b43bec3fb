"""Models of the impact, and the simulation of balls from impact to impact (Eqs. 1-5, 9, 12-15).

The modules in reading order:

``flight``                    the table, free flight and the landing that ends it
``contact``, ``deviations``   the interface of a contact, and how small deviations of a ball grow
``contacts_and_flights``      what a model says of them, for simulations and for periodic orbits
``sequence``, ``dynamics``    simulated impacts, and the simulation by contacts and flights
``restitution``, ``sticking``      impacts with a restitution coefficient, rest on the table
``damping``, ``oscillator``   the formulas of a linear contact, and of its motion for any damping
``resumption``                flight below the table's level, after a contact
``laws``                      contact laws, of which the linear one is a case
``linear_contact``            linear contacts to their release
``permanent_contact``, ``approach_threshold``   the Λ up to which a ball stays on the table
``instant``                   a contact seen from outside, as an impact at an instant
``ball``, ``model``           what all balls share, and the interface of every model
``rigid``, ``restitution_by_speed``   models with instantaneous impacts
``spring_damper``             the paper's contact
``named_laws``                the contact laws by their names
``contact_model``             balls on a contact of any law
``given_ball``                the ball that a user gives, also one of the inherited library
``makers``                    balls by their parameters, which a user calls
``history``                   the motion of a ball over time
``as_text``                   models as text, from which they come back exactly

The package ``corrected`` has the corrected model.
"""
