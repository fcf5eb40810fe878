"""What is large enough to be named: an effect that no measurement could show is no finding.

On records without noise every test of significance succeeds: the last digits of a simulated force,
the steps of its integrator and the corners of its motion are as certain as any effect. So a finding
must also be visible, whatever its standard errors.
"""

from __future__ import annotations

# an effect of a tenth of the noise, rms, adds sqrt(1 + 0.1^2) - 1 of the noise to the error
NOISE_SHARE = 0.005
# combined error of a good load cell (0.03 %): less of the force is not known to anyone
FORCE_SHARE = 3e-4
# a choice of this project, without a source. Below it a delay drowns in how records are treated:
# sample times within 2 % of the spacing count as uniform (records.motion.uniform), and the error of
# interpolating a force between samples is that of such a delay at 6.5 samples in a period (less
# where there are more)
SPACING_SHARE = 0.02


def visible(before: float, after: float, noise_floor: float, force: float) -> bool:
    """Whether an effect takes away more error than a measurement leaves in doubt.

    before, after: rms error on held-out data without and with it [N]; noise_floor and force: rms
    noise and rms of the measured force there [N].
    """
    return before - after > max(NOISE_SHARE * noise_floor, FORCE_SHARE * force)


def visible_delay(delay: float, spacing: float) -> bool:
    """Whether a delay [s] can be told from the treatment of samples `spacing` [s] apart."""
    return abs(delay) > SPACING_SHARE * spacing
