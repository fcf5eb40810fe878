"""The fluid inerter's bench experiment from end to end: sweeps, noise, identification, figures."""
