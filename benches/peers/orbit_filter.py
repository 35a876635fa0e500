"""spindrift against SciPy on a closed loop in orbit with noise: drawn samples of campaigns/cubesat_nadir.toml.

    python benches/peers/orbit_filter.py --spindrift target/release/spindrift --sample 7

It flies a drawn scene as orbit_loop.py does, with a multiplicative extended Kalman filter that is written from
docs/control-formulas.md. Its measurements are those of its own state with the errors, noise and bias, of those of
`spindrift simulate`. The exit code is 1 if attitude or estimated attitude (rad), or wheel rates, estimated bias and
rate and commands, relative to their largest, differ by more than --limit.
"""

import argparse
import copy
import math
import pathlib
import sys
import tempfile
import tomllib

import numpy as np
import plates
import pyarrow.parquet as pq
from orbit_loop import CAMPAIGNS, Loop, product, spindrift

CAMPAIGN = CAMPAIGNS / "cubesat_nadir.toml"
NAMES = {"q": "wxyz", "wheels": ["w1", "w2", "w3", "w4"], "rods": ["mx", "my", "mz"], "axes": "xyz", "angles": "xy"}


def exponential(v):
    size = np.linalg.norm(v)
    return np.array([math.cos(size / 2), *(0.5 * np.sinc(size / (2 * math.pi)) * v)])


def logarithm(q):
    q = q if q[0] >= 0 else -q
    size = np.linalg.norm(q[1:])
    return 2 * math.atan2(size, q[0]) / size * q[1:] if size else np.zeros(3)


def skew(v):
    return np.cross(np.eye(3), v)


def axes_of(boresight):
    """The axes of a sensor in F_s: by the smallest rotation from s3."""
    b = np.array(boresight) / np.linalg.norm(boresight)
    if b[2] == -1:
        return np.diag([1.0, -1.0, -1.0])
    turn = skew(np.cross([0, 0, 1], b))
    return np.eye(3) + turn + turn @ turn / (1 + b[2])


class Filter:
    def __init__(self, loop, measured, states, rates):
        self.loop, self.measured, self.states, self.rates = loop, measured, states, rates
        control = loop.file["control"]
        self.sensors = {sensor["name"]: sensor for sensor in loop.file["sensors"]}
        self.q, self.omega, self.bias = loop.q, loop.omega, np.zeros(3)
        sigmas = [control["initial_attitude_sigma_rad"]] * 3 + [control["initial_bias_sigma_rad_s"]] * 3
        self.p = np.diag(sigmas) ** 2
        self.log = []

    def update(self, y, g, r):
        gain = self.p @ g.T @ np.linalg.inv(g @ self.p @ g.T + r)
        left = np.eye(6) - gain @ g
        self.p = left @ self.p @ left.T + gain @ r @ gain.T
        self.p = 0.5 * (self.p + self.p.T)
        self.q = product(self.q, exponential((gain @ y)[:3]))
        self.q /= np.linalg.norm(self.q)
        self.bias = self.bias + (gain @ y)[3:]

    def direction(self, found, vector, spread):
        """A found and an estimated vector in F_s; the columns of `spread` are errors of the found one at one sigma."""
        across = np.linalg.svd(found[None])[2][1:]
        noise = across @ spread
        self.update(-across @ vector, np.hstack([np.cross(across, vector), np.zeros((2, 3))]), noise @ noise.T)

    def propagate(self, turned, t):
        gyro = self.sensors["gyro"]
        sv, su = gyro["angular_random_walk_rad_sqrt_s"], gyro["bias_random_walk_rad_s_sqrt_s"]
        rho = turned - t * self.bias
        r, x, one = np.linalg.norm(rho), skew(rho), np.eye(3)
        n = one - (1 - math.cos(r)) / r**2 * x + (r - math.sin(r)) / r**3 * x @ x if r > 1e-6 else one - x / 2
        mixed = -0.5 * su**2 * t**2 * n
        f = np.block([[plates.dcm(exponential(rho)).T, -t * n], [np.zeros((3, 3)), one]])
        grown = [[(sv**2 * t + su**2 * t**3 / 3) * n @ n.T, mixed], [mixed.T, su**2 * t * one]]
        self.q, self.p = product(self.q, exponential(rho)), f @ self.p @ f.T + np.block(grown)

    def measurements(self, tick, q, rates):
        """What is delivered at a tick: of the own state, with the errors of the other's measurement of its own."""
        at, t = {name: values[tick] for name, values in self.measured.items()}, self.loop.period
        field = self.loop.field(tick * t, self.loop.orbit(tick * t)[None, :3])[0]
        back = lambda one: one * [1, -1, -1, -1]
        at["wheels"] = at["wheels"] - self.rates[tick] + rates
        at["field"] = at["field"] + (plates.dcm(q) - plates.dcm(self.states[tick])).T @ field
        axes = axes_of(self.sensors["sun"]["boresight"]).T
        seen = lambda q: np.arctan(
            (u := axes @ plates.dcm(q).T @ plates.sun(self.loop.field.days + tick * t / 86400))[:2] / u[2]
        )
        at["sun"] = at["sun"] + seen(q) - seen(self.states[tick])
        if tick:
            # that of the tick before
            at["tracker"] = product(self.before, product(back(self.states[tick - 1]), at["tracker"]))
            turned, other = (
                logarithm(product(back(self.before), q)),
                logarithm(product(back(self.states[tick - 1]), self.states[tick])),
            )
            at["gyro"] = at["gyro"] + (turned - other) / t
        self.before = q
        return at

    def command(self, tick, y, rates):
        """Estimates of a tick, and what the law commands for them."""
        loop, sensors, t = self.loop, self.sensors, self.loop.period
        at = self.measurements(tick, y[:4], rates)
        if tick:
            if not np.isnan(at["tracker"][0]):  # taken at the tick before, as the last of that tick
                noise = axes_of(sensors["tracker"]["boresight"]) * sensors["tracker"]["noise_rad"]
                y = logarithm(product(self.q * [1, -1, -1, -1], at["tracker"]))
                self.update(y, np.eye(3, 6), noise @ noise.T)
            self.propagate(at["gyro"] * t, t)
        field = loop.field(tick * t, loop.orbit(tick * t)[None, :3])[0]
        self.direction(at["field"], plates.dcm(self.q).T @ field, np.diag(sensors["magnetometer"]["noise_t"]))
        if not np.isnan(at["sun"][0]):
            own, slopes = axes_of(sensors["sun"]["boresight"]), np.tan(at["sun"])
            size = math.sqrt(1 + slopes @ slopes)
            seen = np.array([*slopes, 1.0]) / size
            turns = (np.eye(3) - np.outer(seen, seen))[:, :2] / size * (1 + slopes**2)
            sun = plates.sun(loop.field.days + tick * t / 86400)
            estimated = plates.dcm(self.q).T @ sun / np.linalg.norm(sun)
            self.direction(own @ seen, estimated, sensors["sun"]["noise_rad"] * own @ turns)
        if tick:
            self.omega = at["gyro"] - self.bias
        self.log.append([*self.q, *self.bias, *self.omega])
        return loop.law(tick, self.q, self.omega, at["wheels"], at["field"])


def drawn(plan, row):
    """The scene of a sample."""
    scene = copy.deepcopy(plan)
    vector = lambda name, unit, parts="xyz": [row[f"{name}_{part}{unit}"] for part in parts]
    scene["body"]["inertia_scale"] = row["body_inertia_scale"]
    scene["environment"]["density_scale"] = row["environment_density_scale"]
    scene["environment"]["magnetic_dipole_a_m2"] = vector("environment_magnetic_dipole", "_a_m2")
    scene["initial"]["attitude_orbital"] = vector("initial_attitude_orbital", "", "wxyz")
    scene["initial"]["angular_velocity_orbital_rad_s"] = vector("initial_angular_velocity_orbital", "_rad_s")
    scene["wheels"][0]["rate_rad_s"] = row["wheels_w1_rate_rad_s"]
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spindrift", required=True)
    parser.add_argument("--sample", type=int, default=7)
    parser.add_argument("--duration", type=float, default=5680.0, help="s; at least 1200")
    parser.add_argument("--limit", type=float, default=1e-9)
    options = parser.parse_args()
    settings = [f"campaign.duration_s={options.duration}", f"observe.points={round(options.duration * 4) + 1}"]
    words = [CAMPAIGN, *(word for one in [*settings, "integrator.tolerance=1e-13"] for word in ("--set", one))]
    plan = spindrift(options.spindrift, "check", "--plan", *words).split("\n== Plan (")[1]
    plan = tomllib.loads(plan.split("\n", 1)[1])
    with tempfile.TemporaryDirectory() as folder:
        out, inputs = (pathlib.Path(folder) / name for name in ("states.parquet", "inputs.parquet"))
        spindrift(options.spindrift, "simulate", *words, "--sample", str(options.sample), "--out", out)
        spindrift(options.spindrift, "sample", *words, "--samples", str(options.sample + 1), "--out", inputs)
        table, row = pq.read_table(out).to_pydict(), pq.read_table(inputs).to_pylist()[-1]
    columns = lambda name, parts: np.transpose([np.array(table[name.format(p)], dtype=float) for p in NAMES[parts]])
    measured = {
        "gyro": columns("measured_rate_s_{}_rad_s", "axes"),
        "tracker": columns("measured_q_es_{}", "q"),
        "sun": columns("measured_sun_angle_{}_rad", "angles"),
        "field": columns("measured_field_s_{}_t", "axes"),
        "wheels": columns("measured_rate_{}_rad_s", "wheels"),
    }
    flight = Filter(Loop(plan), measured, columns("q_es_{}", "q"), columns("rate_{}_rad_s", "wheels"))
    truth = Loop(drawn(plan, row))
    truth.command = flight.command
    found, log = truth.fly(0.25, np.array(table["time_s"])), np.array(flight.log)
    length = lambda v: np.linalg.norm(v, axis=1)
    angle = lambda one, other: 2 * np.minimum(length(one - other), length(one + other))
    share = lambda one, other: length(one - other) / length(other).max()
    apart = {
        "attitude": angle(columns("q_es_{}", "q"), found[:, :4]),
        "wheels": share(columns("rate_{}_rad_s", "wheels"), found[:, 7:11]),
        "estimate": angle(columns("estimated_q_es_{}", "q"), log[:, :4]),
        "bias": share(columns("estimated_gyro_bias_s_{}_rad_s", "axes"), log[:, 4:7]),
        "rate": share(columns("estimated_omega_se_s_{}_rad_s", "axes"), log[:, 7:]),
        "torques": share(columns("commanded_torque_{}_n_m", "wheels"), found[:, 14:18]),
        "dipoles": share(columns("commanded_dipole_{}_a_m2", "rods"), found[:, 18:]),
    }
    print(f"sample {options.sample}: largest difference from spindrift until")
    print("   time, s  " + "".join(f"{key:>11}" for key in apart))
    for part in np.array_split(np.arange(1, len(found)), 8):
        last = table["time_s"][part[-1]]
        print(f"   {last:7.0f}  " + "".join(f"{one[part].max():11.1e}" for one in apart.values()))
    worst = max(one.max() for one in apart.values())
    if not worst <= options.limit:
        sys.exit(f"NO AGREEMENT: {worst:.1e}")


if __name__ == "__main__":
    main()
