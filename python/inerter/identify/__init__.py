"""Identification: laws fitted to bench records, with errors, judged on held-out data."""
