"""A diagnosis of a user's model: the common result, with channels and the extended MJCF."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from inerter.core import Device
from inerter.diagnose.result import Accuracy, Diagnosis


@dataclass(frozen=True)
class ChannelError:
    """Rms error of a channel on held-out data: now and before the extension, in its unit."""

    rmse: float
    unit: str
    before: float


@dataclass(frozen=True)
class SystemAccuracy(Accuracy):
    """Error of a model on held-out data: root mean square over channels, each per its spread.

    `rmse` and `nrmse` are the same share; `channels` has the errors in units.
    """

    channels: dict[str, ChannelError] = field(default_factory=dict)

    def json(self) -> dict[str, Any]:
        """As in the contract, with the channels."""
        channels = {name: vars(error) for name, error in self.channels.items()}
        return {**super().json(), "channels": channels}


@dataclass(frozen=True, kw_only=True)
class SystemDiagnosis(Diagnosis):
    """With the extended model as MJCF and its devices by name."""

    model_xml: str = ""
    devices: dict[str, Device] = field(default_factory=dict)
