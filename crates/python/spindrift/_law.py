"""Laws of attitude in Python: what a law is told at a tick, and how its answer goes back."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Columns of the numbers of a run, in the order of `src/law.rs`.
_PARTS = {
    "sample": 1,
    "time_s": 1,
    "period_s": 1,
    "error": 4,
    "rate_rad_s": 3,
    "target_rate_rad_s": 3,
    "momentum_n_m_s": 3,
    "attitude": 4,
    "position_m": 3,
    "velocity_m_s": 3,
    "gyro_bias_rad_s": 3,
    "wheel_rates_rad_s": 8,
}


class Measurement:
    """What a sensor has delivered last, of all runs that are at a tick."""

    values: NDArray[np.float64]
    """A row for each run, in the order of the sensor's columns of telemetry; NaN before the first measurement, and where it gives nothing."""
    age_s: NDArray[np.float64]
    """How long ago it was measured; NaN before the first."""

    def __init__(self, numbers: NDArray[np.float64]) -> None:
        self.age_s, self.values = numbers[:, 0], numbers[:, 1:]


class Tick:
    """What flight software knows at a tick of control, of all runs that are at one: arrays with a row for each run. Never the truth.

    Vectors are in the frame of the spacecraft, F_s, where nothing else is said; quaternions are scalar first.
    """

    sample: NDArray[np.int64]
    """The run: 0 is the nominal one. What a law remembers of a run is kept by it."""
    time_s: NDArray[np.float64]
    """Since the start of the run."""
    period_s: NDArray[np.float64]
    """Since the last tick; zero at the first tick of a phase, where a law begins anew."""
    error: NDArray[np.float64]
    """The attitude relative to the target, F_s to F_t."""
    rate_rad_s: NDArray[np.float64]
    """The angular velocity as estimated."""
    target_rate_rad_s: NDArray[np.float64]
    """The angular velocity of the target."""
    momentum_n_m_s: NDArray[np.float64]
    """The angular momentum with the wheels."""
    attitude: NDArray[np.float64]
    """The attitude as estimated, F_s to F_e."""
    position_m: NDArray[np.float64]
    """The centre of mass as estimated, in F_e."""
    velocity_m_s: NDArray[np.float64]
    """Its velocity as estimated, in F_e."""
    gyro_bias_rad_s: NDArray[np.float64]
    """The bias of the gyro as estimated."""
    wheel_rates_rad_s: NDArray[np.float64]
    """The rates of the wheels, in their order; zero beyond."""

    measurements: dict[str, Measurement]
    """By the names of the sensors; empty where the loop has none."""

    def __init__(self, sensors: list[tuple[str, int]], numbers: NDArray[np.float64]) -> None:
        first = 0
        for name, width in _PARTS.items():
            part = numbers[:, first] if width == 1 else numbers[:, first : first + width]
            setattr(self, name, part)
            first += width
        self.sample = numbers[:, 0].astype("int64")
        self.measurements = {}
        for name, width in sensors:
            self.measurements[name] = Measurement(numbers[:, first : first + 1 + width])
            first += 1 + width

    def __len__(self) -> int:
        return len(self.sample)


Control = Callable[[Tick], Any]
"""A law of attitude: from a tick to the torque on the body that each run wants, in F_s, N m: an array of as many rows as the tick has, and three columns."""


def answered(control: Control) -> Callable[[list[tuple[str, int]], bytes], bytes]:
    """`control` as the extension asks it: from sensors (names, and how many numbers each measures) and the bytes of numbers to the bytes of torques."""
    try:
        import numpy
    except ImportError as error:
        raise ImportError("control= needs NumPy: pip install numpy") from error

    width = sum(_PARTS.values())

    def ask(sensors: list[tuple[str, int]], numbers: bytes) -> bytes:
        measured = sum(1 + count for _, count in sensors)
        tick = Tick(sensors, numpy.frombuffer(numbers).reshape(-1, width + measured))
        torque = numpy.asarray(control(tick), dtype=numpy.float64)
        if torque.shape != (len(tick), 3):
            raise ValueError(f"control returned an array of shape {torque.shape}; it must be {(len(tick), 3)}: the torque on the body of each run, in N m")
        return torque.tobytes()

    return ask
