# What a run prints under `make`: a line for each step, and all that is not named here, such as errors.
/^(Using (workflow specific profile|shell)|Assuming unrestricted|Building DAG|Provided cores|Rules claiming|Conda environments: ignored|Select jobs|Execute [0-9]+ jobs|Complete log|Elapsed time)/d
/^Job stats:/,/^total/d
/^Finished jobid: .*\(Rule: all\)/,/steps/d
# "Finished jobid: 3 (Rule: NAME)" and the next line, "5 of 20 steps (25%) done".
/^Finished jobid:/{
  N
  s/.*\(Rule: (\w+)\)\n([0-9]+ of [0-9]+) steps.*/\2  \1/
}
# The time of a step that is not that of an error, and empty lines.
/^\[.* [0-9]{4}\]$/{
  N
  /\n(Finished|[a-z]*rule |localrule )/!b
  D
}
/^$/d
