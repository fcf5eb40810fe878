"""What the tests of hidden cases look at."""

import numpy as np
from inerter.reference import HiddenCase, HiddenRun


def forces(case: HiddenCase) -> np.ndarray:
    return np.concatenate([run.force for run in case.runs])


def extra(case: HiddenCase, run: HiddenRun) -> np.ndarray:
    """What is in a run's noise-free force beside b a."""
    return run.truth.force - case.device.inertance * run.truth.acceleration
