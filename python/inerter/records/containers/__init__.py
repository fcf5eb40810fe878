"""Readers of binary formats of others; they run in a process of their own, see `isolated`.

Nothing here may import Polars: the process has little memory.
"""
