"""A diagnosis for people: an HTML page, a summary in the terminal, a picture for a README."""
