"""The ball-screw inerter: friction of its balls, inertance against load."""
