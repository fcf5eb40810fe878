"""Tests without a model on what remains of a force, and the formula proposed for it.

learning.py   folds, ridge regression, probabilities
columns.py    what a residual may go with
periodic.py   periods along the stroke
lines.py      tones and harmonics
bursts.py     moments at which the residual is louder
battery.py    the tests together
library.py    terms of a formula
proposal.py   sparse regression
words.py      sentences
"""
