"""Benchmarks: comparisons taken in turn within one run, as ratios. Run `make bench`."""
