"""Benchmarks: comparisons taken in turn within one run, as ratios. Run `make bench`.

A module has `run(quick) -> list[dict]` (rows as in `inerter.benchmark.rows`, timed by
`inerter.benchmark.timing`) and, where it helps, `picture(rows, path)`; `__main__.BENCHMARKS` lists
it.
"""
