"""Suspension study: how much an inerter gains, and what its nonlinearities take back.

The linear part is exact: layouts as networks (`layouts`), a quarter-car as polynomials
(`quarter_car`), norms (`h2_norm`, `h_infinity_norm`), the indices J1, J3, J5 (`indices`), their
global optimum (`optimum`) over a range of stiffness (`sweep`).
"""
