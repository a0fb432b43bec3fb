"""The replication of one paper, from the models in `bouncing_ball` with `paper_replication`.

`paper`
    what the paper prints, and the parameters of its figures
`variables`
    meaning, units and tolerance of the variables of the datasets
`curves`, `figures`, `tables`
    the figures and tables
`measures`, `claims`
    numbers that follow from datasets, and the claims that they decide
`article`, `index`
    the article, its supplement and the page of the results
"""
