"""How pictures are drawn: colours, PNGs, interactive figures, curves thinned to what is seen."""
