"""What inerters cost to compute here: the essential comparisons, for `inerter bench`.

The checkout's `benchmarks/` (`make bench`) compares more, with the same timing.
"""
