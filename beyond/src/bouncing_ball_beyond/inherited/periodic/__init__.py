"""The n-T orbits of both models: one impact in n periods of the table (Eqs. 6-8, 18-27).

============================ ====================================================================
:mod:`.orbit`                an n-T orbit: its observables, its motion, stability, admissibility
:mod:`.restitution_branch`   all orbits of the restitution model in closed form (Eqs. 6-8)
:mod:`.spring_damper_branch` all orbits of the spring-damper model in closed form
:mod:`.explicit`             either of both, and why there is no orbit at some Λ
:mod:`.continuation`         a branch by continuation in the paper's six unknowns (Eqs. 21-26)
:mod:`.branches`             branches with their special orbits as datasets; the call ``branch``
:mod:`.calls`                the calls ``orbit``, ``orbits`` and ``limits``
============================ ====================================================================

There are two routes to an orbit: its branch in closed form, and continuation. They share the
equations of the impact and of the flight, and the trace and the determinant of the monodromy. A
continuation also starts from an orbit in closed form, which Newton's method corrects by the six
equations. A simulation of the ball is the third route.
"""
