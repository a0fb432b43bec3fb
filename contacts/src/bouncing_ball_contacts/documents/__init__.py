"""The data of the docs: what the time steps of engines cost, bounces, and measured impacts.

``contacts/docs/make_data.py`` makes and draws them; the docs themselves read no other numbers.
"""
