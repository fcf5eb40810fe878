"""The fluid inerter: a piston that drives a liquid through a channel."""
