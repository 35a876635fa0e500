"""spindrift against SciPy on whole closed loops in orbit: the CubeSat of campaigns/cubesat_*.toml over one revolution.

    python benches/peers/orbit_loop.py --spindrift target/release/spindrift

It runs `spindrift simulate` of sample 0 (no noise) and flies the same loop again: orbit with J2, IGRF, gravity gradient, drag and light on plates,
residual dipole, wheels with friction, torque rods, quaternion feedback, unloading, B-dot. The equations are written from docs/control-formulas.md,
docs/environment.md, docs/model.md and docs/campaign-files.md alone, the coefficients of the field are those of the package ppigrf (with numpy, scipy,
pyarrow, ppigrf). Orbit: DOP853 of SciPy, steps of at most 20 s. Attitude: steps of its tableau, of at most --step, within the arcs of the loop.

The filter is not flown again: without noise and bias its attitude is the truth, and its rate is the gyro's rotation over the period.

It prints the largest differences in each part of the run, and the change with half the step (its own error). The exit code is 1 if attitude (rad), or
rates, wheel rates or position, relative to their largest, differ by more than --limit.
"""

import argparse
import math
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import numpy as np
import plates
import ppigrf
import pyarrow.parquet as pq
from scipy.integrate import DOP853, solve_ivp
from scipy.optimize import brentq

CAMPAIGNS = pathlib.Path(__file__).resolve().parents[2] / "campaigns"
TURN = 2.0 * math.pi
UNITS = {"km": 1e3, "deg": math.pi / 180, "min": 60.0, "h": 3600.0, "deg/s": math.pi / 180, "deg/h": math.pi / 648000, "rpm": math.pi / 30,
         "s": 1.0, "nT": 1e-9}
COMMON = {"campaign.duration_s": 5680.0, "observe.points": 285, "integrator.tolerance": 1e-13}
OFF_NADIR = COMMON | {
    "initial.attitude_orbital": [0.999817163, 0.01, -0.008, 0.0142], "initial.angular_velocity_orbital_rad_s": [0.0008, -0.0005, 0.0006],
    "wheels.w1.rate_rad_s": 60.0, "wheels.w2.rate_rad_s": -40.0, "wheels.w3.rate_rad_s": 35.0, "orbit.true_anomaly_rad": 0.7,
    "orbit.argument_of_periapsis_rad": -0.4}
CASES = {
    "nadir, perfect knowledge": ("cubesat_nadir.toml", OFF_NADIR | {"control.estimator": "perfect"}),
    "nadir, gyro and filter": ("cubesat_nadir.toml", OFF_NADIR),
    "day at 1 Hz, gyro and filter": ("cubesat_day.toml", OFF_NADIR | {"control.stability_from_s": 0.0}),
    "detumbling by rods": ("cubesat_detumble.toml", COMMON | {"orbit.true_anomaly_rad": 0.7}),
}


# ---- the campaign file

def merged(base, own):
    """A file over the one that it extends; tables in lists by their names."""
    out = dict(base)
    for key, value in own.items():
        if isinstance(value, dict) and key in out:
            out[key] = merged(out[key], value)
        elif isinstance(value, list) and value and isinstance(value[0], dict) and key in out:
            name = "phase" if key == "guidance" else "name"
            table = {one.get(name, i): one for i, one in enumerate(out[key])}
            for i, one in enumerate(value):
                table[one.get(name, f"own {i}")] = merged(table.get(one.get(name), {}), one)
            out[key] = list(table.values())
        else:
            out[key] = value
    return out


def load(path, settings=None):
    own = tomllib.loads(path.read_text())
    own = merged(load(path.parent / own["extends"]), own) if "extends" in own else own
    for key, value in (settings or {}).items():
        *tables, last = key.split(".")
        place = own
        for name in tables:
            place = place.setdefault(name, {}) if isinstance(place, dict) else next(one for one in place if one["name"] == name)
        place[last] = value
    return own


def number(value):
    """A number or a list of them, with units."""
    if isinstance(value, list):
        return np.array([number(one) for one in value], dtype=float)
    if isinstance(value, str):
        amount, unit = value.split(" ")
        return float(amount) * UNITS[unit]
    return value


# ---- the magnetic field

class Field:
    """IGRF-14 of a date, in F_e (O. Montenbruck & E. Gill, Satellite Orbits, 2000, section 3.2)."""

    RADIUS = 6371200.0

    def __init__(self, epoch):
        year = int(epoch[:4])
        begin, end, self.days = (plates.days(date) for date in (f"{year}-01-01T00:00:00Z", f"{year + 1}-01-01T00:00:00Z", epoch))
        date = year + (self.days - begin) / (end - begin)
        lines = (pathlib.Path(ppigrf.__file__).parent / "IGRF14.shc").read_text().splitlines()
        rows = [line.split() for line in lines if line.strip() and not line.startswith("#")][1:]
        years = np.array(rows[0], dtype=float)  # the last one, 2030, is what the secular variation makes of 2025
        self.terms = {}
        for n, m, *values in rows[1:]:
            n, m = int(n), int(m)
            value = 1e-9 * np.interp(date, years, np.array(values, dtype=float))
            # Schmidt's seminorm to plain associated Legendre functions
            value *= math.sqrt((1 if m == 0 else 2) * math.factorial(n - abs(m)) / math.factorial(n + abs(m)))
            g, h = self.terms.get((n, abs(m)), (0.0, 0.0))
            self.terms[n, abs(m)] = (value, h) if m >= 0 else (g, value)

    def meridian(self, time):
        """Greenwich mean sidereal time, rad (IAU 2006): Earth rotation angle and precession, which goes on at the rate of J2000."""
        t = self.days / 36525
        angle = 0.7790572732640 + self.days % 1.0 + 0.00273781191135448 * self.days
        arcsec = 0.014506 + 4612.156534 * t + 1.3915817 * t**2 - 0.00000044 * t**3
        return TURN * (angle + arcsec / 1296000 + (1.00273781191135448 + 4612.156534 / (1296000 * 36525)) * time / 86400)

    def __call__(self, time, r):
        """The field at places r (points, 3), T."""
        angle = self.meridian(time)
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = c * r[:, 0] + s * r[:, 1], c * r[:, 1] - s * r[:, 0], r[:, 2]
        square = x * x + y * y + z * z
        a, ratio = self.RADIUS, self.RADIUS**2 / square
        x, y, z = (a * one / square for one in (x, y, z))
        v, w = {(0, 0): a / np.sqrt(square)}, {(0, 0): np.zeros(len(r))}
        for m in range(15):
            if m:
                before = v[m - 1, m - 1], w[m - 1, m - 1]
                v[m, m] = (2 * m - 1) * (x * before[0] - y * before[1])
                w[m, m] = (2 * m - 1) * (x * before[1] + y * before[0])
            for n in range(m + 1, 15):
                for of in v, w:
                    last = of[n - 2, m] if n > m + 1 else 0.0
                    of[n, m] = ((2 * n - 1) * z * of[n - 1, m] - (n + m - 1) * ratio * last) / (n - m)
        push = np.zeros((3, len(r)))  # the gradient of a sum (g V + h W)/a, times a^2
        for (n, m), (g, h) in self.terms.items():
            if m == 0:
                push += [-g * v[n + 1, 1], -g * w[n + 1, 1], -(n + 1) * g * v[n + 1, 0]]
                continue
            f = (n - m + 2) * (n - m + 1)
            push += [0.5 * (-g * v[n + 1, m + 1] - h * w[n + 1, m + 1] + f * (g * v[n + 1, m - 1] + h * w[n + 1, m - 1])),
                     0.5 * (-g * w[n + 1, m + 1] + h * v[n + 1, m + 1] + f * (-g * w[n + 1, m - 1] + h * v[n + 1, m - 1])),
                     -(n - m + 1) * (g * v[n + 1, m] + h * w[n + 1, m])]
        bx, by, bz = -push
        return np.column_stack([c * bx - s * by, s * bx + c * by, bz])


# ---- the scene

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def product(p, q):
    """Hamilton's product."""
    return np.array([p[0] * q[0] - p[1:] @ q[1:], *(p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:]))])


def quaternion(c):
    """Of a matrix; for w not near zero."""
    w = 0.5 * math.sqrt(1 + np.trace(c))
    return np.array([w, *(np.array([c[2, 1] - c[1, 2], c[0, 2] - c[2, 0], c[1, 0] - c[0, 1]]) / (4 * w))])


def orbital(r, v):
    """The axes of F_o as columns."""
    o3, normal = -r / np.linalg.norm(r), np.cross(r, v)
    o2 = -normal / np.linalg.norm(normal)
    return np.column_stack([np.cross(o2, o3), o2, o3])


class Loop:
    def __init__(self, file):
        self.file, self.environment = file, file["environment"]
        self.duration = number(file["campaign"]["duration_s"])
        self.wheels = [{key: number(value) if key != "name" else value for key, value in wheel.items()} for wheel in file.get("wheels", [])]
        self.mass_properties()
        self.coast()
        self.phase = {key: number(value) if key not in ("phase", "law", "target", "rods") else value for key, value in file["guidance"][0].items()}
        self.period, self.delay = file["control"]["period_s"], file["control"].get("delay_s", 0.0)
        self.rods = np.array([rod["axis"] for rod in file["torque_rods"]], dtype=float).T
        self.residual = np.array(self.environment["magnetic_dipole_a_m2"])
        self.most = np.array([rod["max_dipole_a_m2"] for rod in file["torque_rods"]])

    def mass_properties(self):
        bodies = []  # mass, place, inertia about its centre
        for part in self.file["body"]["parts"]:
            m, sides = part["mass_kg"], np.array(part["size_m"]) ** 2
            bodies.append((m, np.array(part.get("position_m", [0, 0, 0]), dtype=float), m / 12 * np.diag(sides.sum() - sides)))
        axes = [wheel["axis"] / np.linalg.norm(wheel["axis"]) for wheel in self.wheels]
        self.axes = np.array(axes).reshape(-1, 3).T
        self.axial = np.array([wheel["axial_inertia_kg_m2"] for wheel in self.wheels])
        for wheel, axis in zip(self.wheels, axes):
            across = wheel["transverse_inertia_kg_m2"]
            spin = (wheel["axial_inertia_kg_m2"] - across) * np.outer(axis, axis)
            bodies.append((wheel["mass_kg"], wheel["position_m"], across * np.eye(3) + spin))
        self.center = sum(m * place for m, place, _ in bodies) / sum(m for m, *_ in bodies)
        arms = [(m, place - self.center, own) for m, place, own in bodies]
        self.j = sum(own + m * (arm @ arm * np.eye(3) - np.outer(arm, arm)) for m, arm, own in arms)
        self.k = self.j - (self.axes * self.axial) @ self.axes.T
        self.inverse = np.linalg.inv(self.k)
        # of the body's resistance and the wheel's, one after the other
        self.reduced = self.axial / (1 + self.axial * np.einsum("ji,jk,ki->i", self.axes, self.inverse, self.axes))
        table = [(plate["area_m2"], plate["normal"], plate["center_m"], plate.get("drag_coefficient", 2.2), plate.get("specular", 0.0),
                  plate.get("diffuse", 0.0)) for plate in self.file["plates"]]
        area, normal, place, drag, specular, diffuse = (np.array(one, dtype=float) for one in zip(*table))
        self.normals = normal / np.linalg.norm(normal, axis=1)[:, None]
        arm = place - self.center
        self.drag_arms = (drag * area)[:, None] * arm
        self.light_arms = (area * (1 - specular))[:, None] * arm
        self.mirror, self.matte = (2 * (area * share)[:, None] * np.cross(arm, self.normals) for share in (specular, diffuse / 3))

    def coast(self):
        """The orbit as a function of time, and the state at its start."""
        orbit = {"ascending_node_rad": 0.0, "argument_of_periapsis_rad": 0.0, "true_anomaly_rad": 0.0}
        orbit |= {key: number(value) if key != "epoch" else value for key, value in self.file["orbit"].items()}
        start = np.concatenate(plates.start_of_orbit(orbit))
        flat = 1.5 * orbit["j2"] * plates.RADIUS**2

        def pull(time, y):
            r, square = y[:3], y[:3] @ y[:3]
            # the gradient of mu/r + mu k (1/3 - z^2/r^2)/r^3
            factor = 1 + flat / square * (1 - 5 * r[2] ** 2 / square)
            return np.concatenate([y[3:], -plates.MU / square**1.5 * (factor * r + [0, 0, 2 * flat / square * r[2]])])

        self.orbit = solve_ivp(pull, (0, self.duration), start, "DOP853", rtol=1e-13, atol=1e-9, max_step=20, dense_output=True).sol
        self.field = Field(orbit["epoch"])
        initial, (r, v) = self.file["initial"], np.split(start, 2)
        self.q = np.array(initial.get("attitude", [1, 0, 0, 0]), dtype=float)
        self.omega = number(initial.get("angular_velocity_rad_s", [0, 0, 0]))
        if "attitude_orbital" in initial:
            own = np.array(initial["attitude_orbital"], dtype=float)
            self.q = product(quaternion(orbital(r, v)), own / np.linalg.norm(own))
            self.omega = number(initial["angular_velocity_orbital_rad_s"]) + plates.dcm(self.q).T @ np.cross(r, v) / (r @ r)

    def nodes(self, times):
        """What depends on the orbit alone: columns up, wind, Sun, field of F_e, and (3 mu/r^3, rho/2, pressure and share of light)."""
        state = self.orbit(times)
        r, v = state[:3].T, state[3:].T
        distance = np.linalg.norm(r, axis=1)
        wind = v - np.cross([0, 0, plates.EARTH_RATE], r)
        suns = np.array([plates.sun(self.field.days + time / 86400) for time in times])
        far = np.linalg.norm(suns, axis=1)
        share = np.array([plates.visible(*one) for one in zip(r, suns)])
        light = 4.56e-6 * share * (plates.AU / far) ** 2
        air = np.exp(np.interp((distance - plates.RADIUS) / 1e3, plates.TABLE[:, 0], np.log(plates.TABLE[:, 1])))
        columns = np.stack([r / distance[:, None], wind, suns / far[:, None], self.field(times, r)], axis=2)
        return columns, np.column_stack([3 * plates.MU / distance**3, 0.5 * air, light, share])

    def slope(self, y, momentum, motor, dipole, columns, numbers):
        q0, q1, q2, q3, x, yy, z = y.tolist()
        up, wind, sun, field = (plates.dcm(y[:4]).T @ columns).T
        gradient, air, light, _ = numbers
        cosine = np.maximum(self.normals @ wind, 0)
        torque = gradient * np.array(cross(up, self.j @ up)) + cross(dipole, field) - air * np.array(cross(cosine @ self.drag_arms, wind))
        if light:
            cosine = np.maximum(self.normals @ sun, 0)
            torque -= light * (np.array(cross(cosine @ self.light_arms, sun)) + cosine**2 @ self.mirror + cosine @ self.matte)
        omega = y[4:]
        spin = self.inverse @ (cross(self.k @ omega + momentum, omega) + torque - motor)
        return np.array([-0.5 * (q1 * x + q2 * yy + q3 * z), 0.5 * (q0 * x + q2 * z - q3 * yy), 0.5 * (q0 * yy + q3 * x - q1 * z),
                         0.5 * (q0 * z + q1 * yy - q2 * x), *spin])

    def cosines(self, y, columns):
        _, wind, sun, _ = (plates.dcm(y[:4]).T @ columns).T
        return np.concatenate([self.normals @ wind, self.normals @ sun])

    def arc(self, y, h, motor, dipole, environment, begin, length):
        """Steps of DOP853 with the motors' torques held, which end where plates turn on and off. The edges of the shadow have shorter steps."""
        a, b, c = DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]
        k = np.empty((12, 7))

        def moved(y, since, dt, columns, numbers):
            for i in range(12):
                momentum = self.axes @ (h + (since + c[i] * dt) * motor)
                k[i] = self.slope(y + dt * (a[i, :i] @ k[:i]), momentum, self.axes @ motor, dipole, columns[i], numbers[i])
            return y + dt * (b @ k)

        columns, numbers = environment
        low, high = numbers[:, 3].min(), numbers[:, 3].max()
        if low < high and (low == 0.0 or high == 1.0):
            times = np.arange(64)[:, None] + c
            columns, numbers = self.nodes(begin + length / 64 * times.ravel())
        steps = len(numbers) // 12
        dt = length / steps
        for step in range(steps):
            own, size, since = columns[12 * step:12 * step + 12], numbers[12 * step:12 * step + 12], step * dt
            new, left, done = moved(y, since, dt, own, size), 0.0, np.zeros(2 * len(self.normals), dtype=bool)
            last = self.cosines(y, own[0]) if step == 0 else last
            while True:
                ends = self.cosines(new, own[11])
                crossed = (last * ends < 0) & ~done
                if not crossed.any():
                    break
                some = np.flatnonzero(crossed)
                one = some[np.argmin(last[some] / (last[some] - ends[some]))]

                def part(to):
                    """The step from `left` to a share of the whole one, by cubics through four of its nodes."""
                    at, of = left + (to - left) * c, (0, 5, 8, 11)
                    cubic = np.array([np.prod([(at - c[n]) / (c[m] - c[n]) for n in of if n != m], axis=0) for m in of])
                    mixed = np.tensordot(cubic.T, own[list(of)], 1), cubic.T @ size[list(of)]
                    return moved(y, since + left * dt, (to - left) * dt, *mixed), mixed[0][11]

                share = brentq(lambda to: self.cosines(*part(to))[one] if to > left else last[one], left, 1.0, xtol=1e-7)
                y, place = part(share)
                left, last = share, self.cosines(y, place)
                done[one] = True
                new, _ = part(1.0)
            y, last = new, ends
        y[:4] /= np.linalg.norm(y[:4])
        return y, h + length * motor

    def friction(self, rates, command, length):
        """The torque on each wheel over an arc."""
        out = []
        for wheel, i, rate, tau in zip(self.wheels, self.reduced, rates, command):
            most, dry, wet = wheel["speed_limit_rad_s"], wheel["coulomb_friction_n_m"], wheel["viscous_friction_n_m_s"]
            room = lambda x: max(i * (most - x) / length + (dry + wet * x if x > 0 else 0), 0)
            motor = min(max(tau, -wheel["torque_limit_n_m"]), wheel["torque_limit_n_m"])
            motor = min(max(motor, -room(-rate)), room(rate))
            stop = rate * i / length + motor
            slow = -math.copysign(min(abs(wet * rate), abs(stop)), rate) if stop * rate > 0 else 0.0
            out.append(motor + slow - min(max(stop + slow, -dry), dry))
        return np.array(out)

    def command(self, tick, y, rates):
        """Torques of the wheels and dipoles of the rods, from what flight software knows."""
        phase, period = self.phase, self.period
        q, omega = y[:4], y[4:]
        state = self.orbit(tick * period)
        r, v = state[:3], state[3:]
        field = plates.dcm(q).T @ self.field(np.array([tick * period]), r[None])[0]
        if self.file["control"].get("estimator") == "mekf" and self.before is not None:
            turned = product(self.before * [1, -1, -1, -1], q)
            turned = turned if turned[0] > 0 else -turned
            size = np.linalg.norm(turned[1:])
            omega = 2 * math.atan2(size, turned[0]) / size / period * turned[1:] if size else np.zeros(3)
        self.before = q
        stored = self.axes @ (self.axial * rates)
        wanted = np.zeros(3)
        if phase["rods"] == "b_dot":
            dipole = np.zeros(3) if self.measured is None else -phase["b_dot_gain_a_m2_s_t"] / period * (field - self.measured)
            self.measured = field
        else:
            dipole = np.cross(stored, field) / (phase["rod_unloading_time_s"] * field @ field)
        rods = np.linalg.pinv(self.rods) @ dipole
        rods /= max(1.0, (np.abs(rods) / self.most).max())
        if not self.wheels:
            return np.zeros(0), rods
        wanted = -np.cross(self.rods @ rods, field)
        # quaternion feedback to F_o
        target = plates.dcm(q).T @ np.cross(r, v) / (r @ r)
        error = quaternion(orbital(r, v).T @ plates.dcm(q))[1:]
        self.z = self.z + phase["integral_1_s"] * period * error if tick else np.zeros(3)
        w, zeta = phase["bandwidth_rad_s"], phase["damping"]
        momentum = self.k @ omega + self.axes @ (self.axial * (self.axes.T @ omega + rates))
        wanted += self.k @ (-2 * w * w * (error + self.z) - 2 * zeta * w * (omega - target) - np.cross(omega, target)) + np.cross(omega, momentum)
        return -np.linalg.pinv(self.axes) @ wanted, rods

    def fly(self, step, times):
        """Attitude, rate, wheel rates and position of c at the times, which are ticks; and the commands there."""
        y = np.array([*self.q, *self.omega])
        h = self.axial * (self.axes.T @ self.omega + [wheel.get("rate_rad_s", 0.0) for wheel in self.wheels])
        held = (np.zeros(len(self.wheels)), np.zeros(len(self.most)))
        self.before = self.measured = None
        ticks = round(self.duration / self.period)
        lengths = [self.delay, self.period - self.delay] if self.delay else [self.period]
        shares = [(np.arange(n)[:, None] + DOP853.C[:12]).ravel() / n * length + begin for length, begin, n in
                  ((length, sum(lengths[:i]), math.ceil(length / step - 1e-9)) for i, length in enumerate(lengths))]
        found, block = [], 500
        wanted = {round(time / self.period) for time in times}
        for tick in range(ticks + 1):
            if tick % block == 0:
                begins = self.period * np.arange(tick, min(tick + block, ticks + 1))
                tables = []
                for share in shares:
                    columns, numbers = self.nodes((begins[:, None] + share).ravel())
                    tables.append((columns.reshape(len(begins), len(share), 3, 4), numbers.reshape(len(begins), len(share), 4)))
            rates = h / self.axial - self.axes.T @ y[4:]
            new = self.command(tick, y, rates)
            if tick in wanted:
                found.append([*y, *rates, *self.orbit(tick * self.period)[:3], *new[0], *new[1]])
            for i, (length, table) in enumerate(zip(lengths, tables)):
                if i == len(lengths) - 1:
                    held = new
                rates = h / self.axial - self.axes.T @ y[4:]
                motor = self.friction(rates, held[0], length)
                environment = [one[tick % block] for one in table]
                begin = tick * self.period + sum(lengths[:i])
                y, h = self.arc(y, h, motor, self.residual + self.rods @ held[1], environment, begin, length)
        return np.array(found)


# ---- the comparison

def spindrift(program, file, settings, folder):
    text = lambda value: "[" + ", ".join(map(repr, value)) + "]" if isinstance(value, list) else value if isinstance(value, str) else repr(value)
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={text(value)}")]
    out = folder / "states.parquet"
    done = subprocess.run([program, "simulate", CAMPAIGNS / file, "--sample", "0", *words, "--out", out], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return pq.read_table(out).to_pydict()


def differences(one, other, wheels):
    """Of rows of `fly`, at each time: attitude (rad), and rate, wheel rates, position, torques, dipoles relative to their largest."""
    q, p = one[:, :4], other[:, :4]
    out = {"attitude": 2 * np.minimum(np.linalg.norm(q - p, axis=1), np.linalg.norm(q + p, axis=1))}
    first = 4
    for name, width in (("rate", 3), ("wheels", wheels), ("position", 3), ("torques", wheels), ("dipoles", 3)):
        part = slice(first, first + width)
        first += width
        if width:
            out[name] = np.linalg.norm(one[:, part] - other[:, part], axis=1) / np.linalg.norm(other[:, part], axis=1).max()
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spindrift", required=True)
    parser.add_argument("--scratch", type=pathlib.Path, help="ignored: basilisk.sh gives it")
    parser.add_argument("--cases", default="", help="only those whose name has this text")
    parser.add_argument("--step", default=0.25, type=float, help="longest step, s")
    parser.add_argument("--halve", action="store_true", help="fly again with half the step")
    parser.add_argument("--limit", default=1e-9, type=float)
    options = parser.parse_args()
    wrong = []
    for case, (file, settings) in CASES.items():
        if options.cases not in case:
            continue
        with tempfile.TemporaryDirectory() as folder:
            table = spindrift(options.spindrift, file, settings, pathlib.Path(folder))
        loop = Loop(load(CAMPAIGNS / file, settings))
        times = np.array(table["time_s"])
        columns = lambda names: np.transpose([table[name] for name in names]).reshape(len(times), -1)
        wheels, rods = ([one["name"] for one in loop.file.get(key, [])] for key in ("wheels", "torque_rods"))
        q = columns([f"q_es_{c}" for c in "wxyz"])
        place = columns([f"r_po_e_{c}_m" for c in "xyz"]) + [plates.dcm(one) @ loop.center for one in q]
        ours = np.hstack([q, columns([f"omega_se_s_{c}_rad_s" for c in "xyz"]), columns([f"rate_{w}_rad_s" for w in wheels]), place,
                          columns([f"commanded_torque_{w}_n_m" for w in wheels]), columns([f"commanded_dipole_{m}_a_m2" for m in rods])])
        found = loop.fly(options.step, times)
        apart = differences(ours, found, len(wheels))
        print(f"== {case}: largest difference from spindrift until")
        print("   time, s  " + "".join(f"{name:>11}" for name in apart))
        for part in np.array_split(np.arange(1, len(times)), 8):
            print(f"   {times[part[-1]]:7.0f}  " + "".join(f"{values[part].max():11.1e}" for values in apart.values()))
        if options.halve:
            own = differences(loop.fly(options.step / 2, times), found, len(wheels))
            print("   half step" + "".join(f"{values.max():11.1e}" for values in own.values()))
        worst = max(values.max() for name, values in apart.items() if name not in ("torques", "dipoles"))
        if not worst <= options.limit:
            wrong.append(f"{case}: {worst:.1e}")
    if wrong:
        sys.exit("NO AGREEMENT: " + "; ".join(wrong))


if __name__ == "__main__":
    main()
