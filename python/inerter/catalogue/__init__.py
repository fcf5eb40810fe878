"""What a device can be, as far as records can tell, each thing declared once.

coordinates.py   what a fit searches over, and the parameters that it stands for
friction.py      the friction laws: their coordinates, and which holds which
effects.py       the effects that a diagnosis can name on a bench, their words and traits
vehicle.py       those of a vehicle

Data alone: how a model is built with an effect, and how it is judged, is the business of those who
read this.
"""
