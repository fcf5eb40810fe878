"""Quarter-cars with nonlinear inerters in the time domain, on the MuJoCo models."""
