"""The best law of an identification, fitted once more by simulation.

Several runs: those fitted before, judged on the one held out. A single run: its first seven tenths,
judged on the rest, for a simulation cannot leave out blocks.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np

from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.model import NUISANCES
from inerter.identify.result import Estimate, Identification, Motion
from inerter.identify.simulated import Simulator, device_from, fit_simulated, start_from

SHARE = 0.7
"""Of a single run, what is fitted."""


def simulated(result: Identification) -> Identification:
    """The identification with the parameters and the displacement error of a simulation.

    Raises
    ------
    ValueError
        A run that cannot be simulated (not uniform, too short, or the bench fit diverges).
    """
    begin, best = time.perf_counter(), result.best
    simulators = [Simulator(record) for record in result.records]
    single = len(simulators) == 1
    fitted = [i for i in range(len(simulators)) if single or result.split.fit[i].any()]
    until = SHARE * result.records[0].duration if single else None
    fit = fit_simulated([simulators[i] for i in fitted], start_from(best.model), until)
    if single:
        part = result.records[0].time - result.records[0].time[0] > until
        rest = [(result.records[0].displacement - fit.displacement[0])[part]]
    else:
        held = [simulators[i] for i in range(len(simulators)) if i not in fitted]
        rest = [each.residuals([fit.model])[0] for each in held]
    error = float(np.sqrt(np.mean(np.concatenate([r - r.mean() for r in rest]) ** 2)))
    spread = float(np.std(np.concatenate([s.record.displacement for s in simulators])))
    pairs = parameter_errors(Fit(fit.model, [], fit.covariance, fit.evaluations))
    parameters = {
        name: Estimate(
            value, stderr, value - 1.96 * stderr, value + 1.96 * stderr, best.parameters[name].unit
        )
        for name, (value, stderr) in pairs.items()
        if name not in NUISANCES and name in best.parameters
    }
    names = [list(best.parameters).index(name) for name in parameters]
    better = replace(
        best,
        law=f"{best.law}, simulated",
        device=device_from(fit),
        delay=0.0,
        parameters=parameters,
        correlation=best.correlation[np.ix_(names, names)],
        motion=Motion(fit.error, error, error / spread if spread else math.nan),
        model=fit.model,
        seconds=best.seconds + time.perf_counter() - begin,
    )
    return replace(result, results=(better, *result.results))
