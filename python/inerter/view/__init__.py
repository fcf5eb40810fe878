"""Looking at a device while it runs: its loops, with sliders for its parameters, in a browser."""
