"""What a script gets from Snakemake."""


class Named(list):
    """The files of a job as Snakemake gives them to its script: a list with names."""

    def __init__(self, **files: str):
        super().__init__(files.values())
        self.__dict__.update(files)

    def __getitem__(self, name):
        return self.__dict__[name]
