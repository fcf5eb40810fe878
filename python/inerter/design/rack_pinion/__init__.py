"""The rack-and-pinion inerter: a gear train with its inertias, play, elasticity and losses."""
