"""What the replication of a paper needs, whatever the paper.

`configuration`
    judgement of a configuration by its schema, and what rules make of its entries
`datasets`, `provenance`
    netCDF files, the meaning and the tolerance of their variables, and how they were made; where a
    replication lies
`drawing`
    style, legends and labels of figures, and picture files
`verdicts`, `judgements`
    how a claim of the paper is judged; the verdicts on all claims as a dataset and as tables
`texts`, `templates`
    numbers and tables as texts, and the templates that print them
`origins`, `pages`
    the expression and the dataset behind each number of a text; texts as pages for a browser
`runs`, `differences`, `compare`, `acceptance`
    records and files of a run, what differs in the contents of a file, comparison of results with a
    reference or of two runs, and results that become the reference
"""
