"""Blind tests of the diagnosis: effects hidden by the reference equations, and what is found.

plan.py      which cases, each from its own seed
case.py      one case: hide, diagnose, compare with the truth
run.py       all cases in parallel; a process that dies takes no other case with it
score.py     what the cases say together: blind_test.json
picture.py   confusion.png, calibration.png
table.py     the terminal
output.py    the files
command.py   `inerter blind-test`
"""
