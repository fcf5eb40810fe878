"""Signal preparation of records: clock, channel delay, denoising, derivatives, resampling.

What a fit needs is in `inerter.records.motion`, and a diagnosis prepares its records by itself:
this is for people who want to see, plot or export clean signals. See docs/records.md for what
denoising costs.
"""
