"""Diagnosis of a user's model in the loop: the recorded road drives it, its sensors are judged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from inerter.diagnose.doubt import doubted
from inerter.diagnose.result import Finding, ParameterValue, RecordSummary
from inerter.diagnose.statistics import gain_interval, win_shares
from inerter.diagnose.vehicle import wording
from inerter.diagnose.vehicle.build import UserModel, model_of_text
from inerter.diagnose.vehicle.chain import Link, chain_of, links_of
from inerter.diagnose.vehicle.curves import channel_curves
from inerter.diagnose.vehicle.drive import RecordedDrive, make_drive
from inerter.diagnose.vehicle.effects import Effects, Scale
from inerter.diagnose.vehicle.judging import block_squares, stacked_blocks
from inerter.diagnose.vehicle.mapping import Channels
from inerter.diagnose.vehicle.members import exchangeable, with_members
from inerter.diagnose.vehicle.model import TYRES, Added, VehicleModel
from inerter.diagnose.vehicle.outcome import ChannelError, SystemAccuracy, SystemDiagnosis
from inerter.diagnose.vehicle.polarity import polarity
from inerter.diagnose.vehicle.problem import ComparedChannel, DrivenProblem
from inerter.diagnose.vehicle.remainder import remainder
from inerter.diagnose.vehicle.search import (
    SCREENED,
    Step,
    VehicleScored,
    VehicleSearch,
)
from inerter.diagnose.vehicle.sensor_units import unit_of
from inerter.diagnose.vehicle.simulate import VehicleSimulator
from inerter.diagnose.vehicle.split import split_drives
from inerter.diagnose.vehicle.standing import standing_of, step_of
from inerter.diagnose.vehicle.values import NAMED, parameter_values
from inerter.diagnose.wording import doubts_of_records
from inerter.records.duplicates import repeats_another, without_copies
from inerter.records.record import RecordWarning, TimeRecord
from inerter.rig import quiet

Array = NDArray[np.float64]
Progress = Callable[[str], None]

# a finding that was surer than this when it was made is not compared again
SURE = 0.9
_METHOD = "not run: the simulation of the whole model is MuJoCo's"


def diagnose_system(
    records: Sequence[TimeRecord],
    user: UserModel,
    channels: Channels,
    holdout: Sequence[str] = (),
    progress: Progress = lambda text: None,
    threads: int = 0,
) -> SystemDiagnosis:
    """What a user's model lacks, on road it has not seen.

    Parameters
    ----------
    records : sequence of TimeRecord
        The runs.
    user : UserModel
        The model.
    channels : Channels
        Which column drives which actuator and is compared with which sensor.
    holdout : sequence of str
        Names of runs to hold out.
    progress : callable
        Told what is being done.
    threads : int
        0 for every processor.

    Raises
    ------
    ValueError
        Runs that cannot be split or simulated.
    """
    # trials go beyond what a step resolves, which the engine would tell each time
    with quiet(), threadpool_limits(limits=1, user_api="blas"):
        return _System(records, user, channels, holdout, progress, threads).run()


class _System:
    """One diagnosis, step by step."""

    def __init__(
        self,
        records: Sequence[TimeRecord],
        user: UserModel,
        channels: Channels,
        holdout: Sequence[str],
        progress: Progress,
        threads: int,
    ) -> None:
        self.all_records = list(records)
        self.records = without_copies(records, holdout)
        self.user, self.channels = user, channels
        self.progress = progress
        user.with_inputs(channels.inputs.values())
        self.simulator = VehicleSimulator(user, channels, threads)
        step = float(user.model.opt.timestep)
        drives = [make_drive(record, channels, step) for record in self.records]
        progress("simulating the model along the recorded inputs")
        self.warnings: dict[str, list[RecordWarning]] = {r.name: list(r.warnings) for r in records}
        self.notes: list[str] = []
        self.drives = self._checked(drives)
        self.whole = DrivenProblem(
            simulator=self.simulator, drives=self.drives, channels=self._channels()
        )
        fit, held, self.description = split_drives(self.drives, holdout)
        self.fit, self.held = self.whole.restricted(fit), self.whole.restricted(held)
        self.held_masks = held
        if min(self.fit.count, self.held.count) < 50:
            raise ValueError(
                f"{self.description}: too few samples after settling; record longer runs"
            )
        self.step_errors: dict[VehicleModel, float] = {}

    def run(self) -> SystemDiagnosis:
        """The whole procedure."""
        effects = Effects(self.user, self._scales(), self._loads(), *self._of_channels())
        search = VehicleSearch(self.fit, effects, self._step_error, self.progress)
        final = search.run()
        start = search.refit([(VehicleModel(), {})])[0]
        while True:
            chain = chain_of(search, start, final, self.progress)
            links = links_of(self.held, self.fit, chain, self._step_error)
            weak = [i for i, link in enumerate(links) if not link.stands]
            if not weak:
                return self._diagnosis(search, chain, links)
            effect = links[weak[-1]].added.effect
            self.progress(f"{effect} is not confirmed on held-out road: dropped")
            final = search.refit([search.without(final, weak[-1])])[0]

    # --- records -----------------------------------------------------------------------------

    def _checked(self, drives: list[RecordedDrive]) -> list[RecordedDrive]:
        """Runs with a tyre's force counted as the model does; odd signs and scales are told."""
        simulated = [self.simulator.outputs([VehicleModel()], drive)[0] for drive in drives]
        if not all(np.isfinite(each).all() for each in simulated):
            raise ValueError(
                f"{self.user.path}: the simulation of the recorded inputs fails (it diverges); "
                "check the inputs' units and the model's timestep"
            )
        signs, notes, warnings = polarity(self.channels.outputs, drives, simulated)
        self.notes += notes
        for record in self.records:
            self.warnings[record.name] += warnings
        return [replace(drive, measured=drive.measured * signs) for drive in drives]

    def _channels(self) -> list[ComparedChannel]:
        found = []
        for i, output in enumerate(self.channels.outputs):
            columns = [drive.measured[:, i] for drive in self.drives]
            power = np.mean(np.concatenate([(c - c.mean()) ** 2 for c in columns]))
            noise = np.mean(np.concatenate([np.diff(c, 3) ** 2 / 20 for c in columns]))
            # what differs from one sample to the next in a jerky channel is not all noise
            spread = float(np.sqrt(max(power - noise, 0.25 * power)))
            if not spread > 0:
                raise ValueError(
                    f"column {output.column!r} never changes; leave it out or record it again"
                )
            found.append(ComparedChannel(output.column, unit_of(self.user.model, output), spread))
        return found

    def _scales(self) -> dict[str, Scale]:
        motions = [self.simulator.device_motion(VehicleModel(), drive) for drive in self.drives]
        step = self.drives[0].step
        explicit = self.user.model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
        found = {}
        for name in motions[0]:
            parts = [motion[name] for motion in motions]
            x, v = (np.concatenate(channel) for channel in zip(*parts, strict=True))
            a = np.concatenate([np.gradient(part[1], step) for part in parts])
            device = self.user.device(name).device
            force = np.std(device.inertance * a + device.viscous * v)
            force = force or np.std(device.stiffness * x)
            if not force:
                # a device that does nothing yet: the force that would move the lightest body
                force = np.std(a) * float(np.min(self.user.model.body_mass[1:], initial=1.0))
            x_size, v_size, a_size = (
                float(np.sqrt(np.mean(c**2))) or 1e-9 for c in (x - x.mean(), v, a)
            )
            found[name] = Scale(
                force=float(force) or 1.0,
                x=x_size,
                v=v_size,
                a=a_size,
                largest=float(x.max()),
                smallest=float(x.min()),
                step=step,
                explicit=bool(explicit),
            )
        return found

    def _of_channels(
        self,
    ) -> tuple[dict[str, float], dict[str, str], bool, tuple[str, ...]]:
        channels, spacing = self.channels, float(np.median([d.spacing for d in self.drives]))
        shaken = self.simulator.axes_beside(channels.shaken(self.user.model), self.drives[0])
        inputs = list(channels.inputs)
        roads = self.user.road_inputs(list(channels.inputs.values()))
        names = tuple(inputs[i] for i in roads)
        return channels.spaced(spacing), shaken, bool(channels.speed), names

    def _loads(self) -> dict[str, float]:
        """Mass on each tyre [kg], the vehicle's shared equally."""
        tyres = self.user.parts.tyres
        share = float(self.user.model.body_mass.sum()) / max(len(tyres), 1)
        return {tyre.element: share for tyre in tyres}

    def _step_error(self, model: VehicleModel) -> float:
        """How much of a model's error is its step's: against half the step, per spread."""
        if model not in self.step_errors:
            records = {record.name: record for record in self.records}
            half = self.user.with_timestep(self.drives[0].step / 2)
            simulator = VehicleSimulator(half, self.channels, self.simulator.threads)
            part = self.held.part(SCREENED)
            square = count = 0.0
            for drive, mask in zip(part.drives, part.masks, strict=True):
                finer = make_drive(records[drive.name], self.channels, drive.step / 2)
                finer = finer.part(float(drive.time[-1] + drive.spacing / 2))
                coarse = self.simulator.outputs([model], drive)[0]
                fine = simulator.outputs([model], finer)[0]
                difference = (coarse - fine)[mask]
                square += float(np.nansum((difference / self.whole.spreads) ** 2))
                count += difference.size
            self.step_errors[model] = float(np.sqrt(square / count))
        return self.step_errors[model]

    def _finer(self, model: VehicleModel) -> Array | None:
        """The residual of what is fitted with steps half as long; None where that fails."""
        records = {record.name: record for record in self.records}
        half = self.user.with_timestep(self.drives[0].step / 2)
        drives = [
            replace(
                make_drive(records[drive.name], self.channels, drive.step / 2),
                measured=drive.measured,
            )
            for drive in self.fit.drives
        ]
        simulator = VehicleSimulator(half, self.channels, self.simulator.threads)
        row = replace(self.fit, simulator=simulator, drives=drives).stacked([model])[0]
        return row if np.isfinite(row).all() else None

    # --- effects -----------------------------------------------------------------------------

    def _findings(
        self,
        search: VehicleSearch,
        final: VehicleScored,
        links: Sequence[Link],
    ) -> list[tuple[Finding, str]]:
        """Findings, the most useful first, and where each of them is."""
        values = parameter_values(self.user, final, self._finer(final.model))
        several = len(self.user.devices) > 1
        found = []
        for i, added in enumerate(final.model.effects):
            step = step_of(search.steps, added, final)
            confidence, rivals = standing_of(step, added)
            chosen, others = (step.chosen, step.others) if step is not None else (final, [])
            if step is not None and i + 1 < len(final.model.effects) and confidence < SURE:
                # beside the effects found since, a rival may not be one any more
                self.progress(f"comparing {added.effect} with what else could explain the data")
                without, others = search.standing(final, i, step)
                shares = win_shares([final.squares, without.squares, *(s.squares for s in others)])
                confidence, rivals = standing_of(Step(without, final, others, shares), added)
                chosen = final
            same = exchangeable(chosen, added, others) if confidence < SURE else []
            finding = Finding(
                effect=added.effect,
                law=added.law,
                confidence=confidence,
                parameters=values[i],
                rmse_before=links[i].before,
                rmse_after=links[i].after,
                evidence="",
                rivals=rivals,
                gain_interval=gain_interval(*links[i].squares),
                seen_in_blocks=links[i].seen_in_blocks,
            )
            kind, _, name = added.element.partition(":")
            place = (name or kind) if (several and kind != "body") or kind in NAMED else ""
            finding = replace(finding, evidence=wording.evidence(finding, place))
            finding = with_members(finding, [self._own_values(each) for each in same])
            found.append((finding, place))
        return sorted(found, key=lambda pair: -pair[0].gain)

    def _own_values(self, scored: VehicleScored) -> tuple[Added, dict[str, ParameterValue]]:
        """What a fit adds, and the values that it would have."""
        assert scored.candidate is not None
        added = scored.candidate.added
        return added, parameter_values(self.user, scored)[scored.model.effects.index(added)]

    # --- the result --------------------------------------------------------------------------

    def _diagnosis(
        self,
        search: VehicleSearch,
        chain: Sequence[VehicleScored],
        links: Sequence[Link],
    ) -> SystemDiagnosis:
        final, blocks = chain[-1], stacked_blocks(self.held)
        residuals = self.held.stacked([chain[0].model, final.model])
        squares = [block_squares(row, blocks) for row in residuals]
        named = self._findings(search, final, links)
        findings, places = [f for f, _ in named], [place for _, place in named]
        before = self._accuracy(VehicleModel(), residuals[0], residuals[0])
        after = self._accuracy(final.model, residuals[-1], residuals[0])
        floor = self.held.noise(residuals[-1])
        curves = channel_curves(
            self.simulator, self.whole, self.held_masks, self.user.devices[0].name, final.model
        )
        remains = remainder(residuals[-1], self.held, floor, self._step_error(final.model))
        findings = [doubted(finding, remains.structure) for finding in findings]
        self.progress("simulating the extended model once more, as it is written")
        xml = self.user.xml(final.model)
        parameters = {n: value for f in findings for n, value in f.parameters.items()}
        return SystemDiagnosis(
            records=self._summaries(),
            baseline=before,
            findings=findings,
            extended=after,
            noise_floor=floor,
            unexplained=remains,
            engines={
                "mujoco": self._written_error(xml, final.model),
                "exudyn": None,
                "reference": None,
            },
            verdict=doubts_of_records(self._summaries())
            + wording.verdict(before, after, findings, places, remains, self.user.parts.unknown),
            parameters=parameters,
            method=self._method(),
            curves=curves,
            model_xml=xml,
            devices={d.name: self.user.device_of(d.name, final.model) for d in self.user.devices},
            gain_interval=gain_interval(squares[0], squares[-1]),
        )

    def _accuracy(self, model: VehicleModel, residual: Array, first: Array) -> SystemAccuracy:
        devices = {d.name: self.user.device_of(d.name, model).given for d in self.user.devices}
        given: dict[str, float | str] = {}
        for name, values in devices.items():
            prefix = f"{name}." if len(devices) > 1 else ""
            given |= {f"{prefix}{key}": value for key, value in values.items()}
        now, then = self._by_channel(residual), self._by_channel(first)
        channels = {
            channel.name: ChannelError(now[i], channel.unit, then[i])
            for i, channel in enumerate(self.whole.channels)
        }
        error = self.held.error(residual)
        return SystemAccuracy(given, error, error, channels=channels)

    def _by_channel(self, residual: Array) -> list[float]:
        """Rms error of every channel in its unit."""
        table = residual.reshape(-1, len(self.whole.channels))
        rms = np.sqrt(np.sum(table**2, axis=0) / self.held.count) * self.whole.spreads
        return list(map(float, rms))

    def _summaries(self) -> list[RecordSummary]:
        learnt = {drive.name for drive in self.fit.drives}
        held = {drive.name for drive in self.held.drives} - learnt
        return [
            RecordSummary(
                record.name,
                record.samples,
                record.sample_rate,
                self._role(record, held),
                [vars(w) for w in self.warnings[record.name]],
            )
            for record in self.all_records
        ]

    def _role(self, record: TimeRecord, held: set[str]) -> str:
        if repeats_another(record):
            return "unused"
        return "holdout" if record.name in held else "fit"

    def _written_error(self, xml: str, model: VehicleModel) -> float | None:
        """Held-out error of the model as written, read back from its text.

        What belongs to a channel or to the road under a tyre is in no model.
        """
        late = {n: v for n, v in model.values.items() if n.startswith(("channel:", f"{TYRES}."))}
        written = model_of_text(xml, self.user.path)
        written.with_inputs(self.channels.inputs.values())
        simulator = VehicleSimulator(written, self.channels, self.simulator.threads)
        row = replace(self.held, simulator=simulator).stacked([VehicleModel(late)])[0]
        error = self.held.error(row)
        return error if np.isfinite(error) else None

    def _method(self) -> dict:
        settled = [float(d.time[int(np.argmax(m))]) for d, m in zip(
            self.whole.drives, self.whole.masks, strict=True)]  # fmt: skip
        return {
            "model": self.user.path.name,
            "inputs": [f"{c} -> {a}" for c, a in self.channels.inputs.items()],
            "outputs": [f"{o.column} -> {o.sensor}" for o in self.channels.outputs],
            "error": "root mean square over the channels, each per its noise-free spread",
            "split": self.description,
            "held_out_samples": self.held.count,
            "settling_time": max(settled),
            "error_of_the_timestep": max(self.step_errors.values()),
            "simulations": self.simulator.count,
            "exudyn": _METHOD,
            "reference": _METHOD,
            **({"not_tried": self.user.parts.unknown} if self.user.parts.unknown else {}),
            **({"signs": self.notes} if self.notes else {}),
            **({"unused": list(self.channels.unused)} if self.channels.unused else {}),
        }
