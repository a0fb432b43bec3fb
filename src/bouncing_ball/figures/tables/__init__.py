"""Tables of datasets as text: ``rows`` says what each shows, ``formats`` how it is written."""
