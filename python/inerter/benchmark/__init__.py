"""What inerters cost to compute here: the essential comparisons, for `inerter benchmark`.

The checkout's `benchmarks/` (`make bench`) compares more, with the same timing.
"""
