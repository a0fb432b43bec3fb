"""The replication of one paper, from the models in `bouncing_ball` with `paper_replication`.

`paper`
    what the paper prints, and the parameters of its figures
`variables`
    meaning, units and tolerance of the variables of the datasets
`stages`
    the functions that compute the datasets
`curves`, `figures`, `tables`
    the figures and tables
`measures`, `claims`, `choices`
    numbers that follow from datasets, the claims that they decide, and what they depend on
`article`, `index`
    the article, its supplement and the page of the results
"""
