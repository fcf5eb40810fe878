"""Estimation: search variables, bounded least squares, covariance; what every fit here runs on.

variables.py       coordinates by name as a vector of search variables, within bounds
least_squares.py   the fits themselves
covariance.py      errors that allow for correlated residuals
"""
