"""spindrift against SciPy on whole closed loops in orbit: the CubeSat of campaigns/cubesat_*.toml over one revolution.

    python benches/peers/orbit_loop.py --spindrift target/release/spindrift

It runs sample 0 (no noise) of CASES with `spindrift simulate` and flies them again: orbit with J2, IGRF, gravity
gradient, drag, light and shadow on plates, residual dipole, wheels with friction, quaternion feedback, rods. The
numbers are those of `spindrift check --plan`, the equations are written from docs/control-formulas.md,
docs/environment.md, docs/model.md and docs/campaign-files.md alone, the coefficients of the field are those of the
package ppigrf (with numpy, scipy, pyarrow). Orbit: SciPy's DOP853. Attitude: steps of its tableau of at most --step
within the arcs of the loop, which end where a plate turns on or off.

The filter is not flown again: without noise its attitude is the truth, and its rate the gyro's rotation by the period.

It prints the largest differences in each part of the run. The exit code is 1 if attitude (rad), or rate, wheel rates
or position, relative to their largest, differ by more than --limit. Torques and dipoles are the commands.
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
A, B, C = DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]
FOUR = [0, 5, 8, 11]  # nodes of a step for cubics
COMMON = ["campaign.duration_s=5680", "observe.points=285", "integrator.tolerance=1e-13", "orbit.true_anomaly_rad=0.7"]
NADIR = [
    *COMMON,
    "orbit.argument_of_periapsis_rad=-0.4",
    "initial.attitude_orbital=[0.999817163, 0.01, -0.008, 0.0142]",
    "initial.angular_velocity_orbital_rad_s=[0.0008, -0.0005, 0.0006]",
    "wheels.w1.rate_rad_s=60",
    "wheels.w2.rate_rad_s=-40",
    "wheels.w3.rate_rad_s=35",
]
CASES = {
    "nadir, perfect knowledge": ("cubesat_nadir.toml", [*NADIR, "control.estimator=perfect"]),
    "nadir, gyro and filter": ("cubesat_nadir.toml", NADIR),
    "a day's loop at 1 Hz, gyro and filter": ("cubesat_day.toml", [*NADIR, "control.stability_from_s=0"]),
    "detumbling by rods": ("cubesat_detumble.toml", COMMON),
}


class Field:
    """IGRF-14 of a date, in F_e (O. Montenbruck & E. Gill, Satellite Orbits, 2000, section 3.2)."""

    RADIUS = 6371200.0

    def __init__(self, epoch):
        year = int(epoch[:4])
        begin, end, self.days = map(plates.days, (f"{year}-01-01T00:00:00Z", f"{year + 1}-01-01T00:00:00Z", epoch))
        date = year + (self.days - begin) / (end - begin)
        lines = (pathlib.Path(ppigrf.__file__).parent / "IGRF14.shc").read_text().splitlines()
        rows = [line.split() for line in lines if line.strip() and not line.startswith("#")][1:]
        years = np.array(rows[0], dtype=float)  # the last one, 2030, is what the secular variation makes of 2025
        self.terms = {}
        for n, m, *values in rows[1:]:
            n, m = int(n), int(m)
            # Schmidt's normalisation to none
            scale = math.sqrt((2 if m else 1) * math.factorial(n - abs(m)) / math.factorial(n + abs(m)))
            value = 1e-9 * scale * np.interp(date, years, np.array(values, dtype=float))
            g, h = self.terms.get((n, abs(m)), (0.0, 0.0))
            self.terms[n, abs(m)] = (value, h) if m >= 0 else (g, value)

    def __call__(self, time, r):
        """The field at places r (points, 3), T. The Earth: rotation angle and precession of the IAU of 2006."""
        t = self.days / 36525
        turns = 0.7790572732640 + self.days % 1.0 + 0.00273781191135448 * self.days
        arcsec = 0.014506 + 4612.156534 * t + 1.3915817 * t**2 - 0.00000044 * t**3
        rate = (1.00273781191135448 + 4612.156534 / (1296000 * 36525)) / 86400
        angle = 2 * math.pi * (turns + arcsec / 1296000 + rate * time)
        c, s = np.cos(angle), np.sin(angle)
        square = (r * r).sum(axis=1)
        a, ratio = self.RADIUS, self.RADIUS**2 / square
        x, y, z = (a / square * one for one in (c * r[:, 0] + s * r[:, 1], c * r[:, 1] - s * r[:, 0], r[:, 2]))
        v, w = {(0, 0): a / np.sqrt(square)}, {(0, 0): np.zeros(len(r))}
        for m in range(15):
            if m:
                p, q = v[m - 1, m - 1], w[m - 1, m - 1]
                v[m, m], w[m, m] = (2 * m - 1) * (x * p - y * q), (2 * m - 1) * (x * q + y * p)
            for n in range(m + 1, 15):
                for u in v, w:
                    last = u[n - 2, m] if n > m + 1 else 0.0
                    u[n, m] = ((2 * n - 1) * z * u[n - 1, m] - (n + m - 1) * ratio * last) / (n - m)
        b = np.zeros((3, len(r)))
        for (n, m), (g, h) in self.terms.items():
            up, down = (n + 1, m + 1), (n + 1, m - 1)
            b[2] += (n - m + 1) * (g * v[n + 1, m] + h * w[n + 1, m])
            b[0] += (0.5 if m else 1) * (g * v[up] + h * w[up])
            b[1] += (0.5 if m else 1) * (g * w[up] - h * v[up])
            if m:
                f = 0.5 * (n - m + 2) * (n - m + 1)
                b[0] -= f * (g * v[down] + h * w[down])
                b[1] += f * (g * w[down] - h * v[down])
        return np.column_stack([c * b[0] - s * b[1], s * b[0] + c * b[1], b[2]])


def cross(a, b):
    return np.array((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def product(p, q):
    """Hamilton's product."""
    return np.array([p[0] * q[0] - p[1:] @ q[1:], *(p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:]))])


def quaternion(c):
    """Of a matrix that turns by less than half a turn."""
    w = 0.5 * math.sqrt(1 + np.trace(c))
    return np.array([w, *((c[[2, 0, 1], [1, 2, 0]] - c[[1, 2, 0], [2, 0, 1]]) / (4 * w))])


def orbital(r, v):
    """The axes of F_o as columns, and its rate."""
    normal = np.cross(r, v)
    o2, o3 = -normal / np.linalg.norm(normal), -r / np.linalg.norm(r)
    return np.column_stack([np.cross(o2, o3), o2, o3]), normal / (r @ r)


def joined(bodies):
    """Mass, centre and inertia about it of bodies that are given by the same."""
    mass = sum(m for m, *_ in bodies)
    center = sum(m * np.array(place) for m, place, _ in bodies) / mass
    arms = [(m, place - center, own) for m, place, own in bodies]
    return mass, center, sum(own + m * (arm @ arm * np.eye(3) - np.outer(arm, arm)) for m, arm, own in arms)


class Loop:
    """A plan, or a drawn scene of it."""

    def __init__(self, file):
        self.file, self.wheels, self.phase = file, file.get("wheels", []), file["guidance"][0]
        self.duration, self.period = file["campaign"]["duration_s"], file["control"]["period_s"]
        self.is_filtered = file["control"]["estimator"] == "mekf"
        self.rods = np.array([rod["axis"] for rod in file["torque_rods"]], dtype=float).T
        self.most = np.array([rod["max_dipole_a_m2"] for rod in file["torque_rods"]])
        self.residual = np.array(file["environment"]["magnetic_dipole_a_m2"])
        self.body()
        self.coast()

    def body(self):
        parts = []
        for part in self.file["body"]["parts"]:
            m, sides = part["mass_kg"], np.array(part["size_m"]) ** 2
            parts.append((m, part["position_m"], m / 12 * np.diag(sides.sum() - sides)))
        mass, center, own = joined(parts)
        bodies = [(mass, center, self.file["body"]["inertia_scale"] * own)]
        axes = [wheel["axis"] / np.linalg.norm(wheel["axis"]) for wheel in self.wheels]
        for wheel, axis in zip(self.wheels, axes):
            axial, across = wheel["axial_inertia_kg_m2"], wheel["transverse_inertia_kg_m2"]
            own = across * np.eye(3) + (axial - across) * np.outer(axis, axis)
            bodies.append((wheel["mass_kg"], wheel["position_m"], own))
        self.axes = np.array(axes).reshape(-1, 3).T
        self.axial = np.array([wheel["axial_inertia_kg_m2"] for wheel in self.wheels])
        _, self.center, self.j = joined(bodies)
        self.k = self.j - (self.axes * self.axial) @ self.axes.T
        self.inverse = np.linalg.inv(self.k)
        self.reduced = self.axial / (1 + self.axial * (self.axes * (self.inverse @ self.axes)).sum(axis=0))
        keys = ("area_m2", "normal", "center_m", "drag_coefficient", "specular", "diffuse")
        area, normal, place, drag, specular, diffuse = (np.array([p[key] for p in self.file["plates"]]) for key in keys)
        self.normals = normal / np.linalg.norm(normal, axis=1)[:, None]
        arm = place - self.center
        self.drag, self.light = (drag * area)[:, None] * arm, (area * (1 - specular))[:, None] * arm
        turns = 2 * area[:, None] * np.cross(arm, self.normals)
        self.mirror, self.matte = specular[:, None] * turns, diffuse[:, None] / 3 * turns

    def coast(self):
        orbit = {"argument_of_periapsis_rad": 0.0} | self.file["orbit"]
        start = np.concatenate(plates.start_of_orbit(orbit))
        flat = 1.5 * orbit["j2"] * plates.RADIUS**2

        def slope(_, y):
            r, square = y[:3], y[:3] @ y[:3]
            pull = (1 + flat / square * (1 - 5 * r[2] ** 2 / square)) * r + [0, 0, 2 * flat / square * r[2]]
            return np.concatenate([y[3:], -plates.MU / square**1.5 * pull])

        accuracy = {"rtol": 1e-13, "atol": 1e-9, "max_step": 20.0}
        self.orbit = solve_ivp(slope, (0, self.duration), start, "DOP853", dense_output=True, **accuracy).sol
        self.field = Field(orbit["epoch"])
        initial = self.file["initial"]
        self.q, self.omega = (np.array(initial[key], dtype=float) for key in ("attitude", "angular_velocity_rad_s"))
        if "attitude_orbital" in initial:
            frame, turning = orbital(*np.split(start, 2))
            own = np.array(initial["attitude_orbital"])
            self.q = product(quaternion(frame), own / np.linalg.norm(own))
            self.omega = initial["angular_velocity_orbital_rad_s"] + plates.dcm(self.q).T @ turning

    def nodes(self, times):
        """Of the orbit alone: up, wind, Sun, field as columns in F_e; 3 mu/r^3, rho/2, light, its share."""
        r, v = np.split(self.orbit(times).T, 2, axis=1)
        distance = np.linalg.norm(r, axis=1)
        suns = np.array([plates.sun(self.field.days + time / 86400) for time in times])
        far = np.linalg.norm(suns, axis=1)
        share = np.array([plates.visible(*one) for one in zip(r, suns)])
        air = self.file["environment"].get("density_scale", 1.0)
        air *= np.exp(np.interp((distance - plates.RADIUS) / 1e3, plates.TABLE[:, 0], np.log(plates.TABLE[:, 1])))
        wind = v - np.cross([0, 0, plates.EARTH_RATE], r)
        columns = np.stack([r / distance[:, None], wind, suns / far[:, None], self.field(times, r)], axis=2)
        light = 4.56e-6 * share * (plates.AU / far) ** 2
        return columns, np.column_stack([3 * plates.MU / distance**3, 0.5 * air, light, share])

    def slope(self, y, momentum, motor, dipole, columns, numbers):
        up, wind, sun, field = (plates.dcm(y[:4]).T @ columns).T
        gradient, air, light, _ = numbers
        cosine = np.maximum(self.normals @ wind, 0)
        torque = gradient * cross(up, self.j @ up) + cross(dipole, field) - motor
        torque -= air * cross(cosine @ self.drag, wind)
        if light:
            cosine = np.maximum(self.normals @ sun, 0)
            torque -= light * (cross(cosine @ self.light, sun) + cosine**2 @ self.mirror + cosine @ self.matte)
        omega = y[4:]
        spin = self.inverse @ (cross(self.k @ omega + momentum, omega) + torque)
        return np.concatenate([0.5 * product(y[:4], np.array([0.0, *omega])), spin])

    def arc(self, y, h, motor, dipole, environment, begin, length):
        """State and wheels' momenta at the end of an arc of constant commands. Edges of the shadow have short steps."""
        k = np.empty((12, 7))

        def moved(y, since, dt, columns, numbers):
            for i in range(12):
                momentum, at = self.axes @ (h + (since + C[i] * dt) * motor), y + dt * (A[i, :i] @ k[:i])
                k[i] = self.slope(at, momentum, self.axes @ motor, dipole, columns[i], numbers[i])
            return y + dt * (B @ k)

        def cosines(y, columns):
            _, wind, sun, _ = (plates.dcm(y[:4]).T @ columns).T
            return np.concatenate([self.normals @ wind, self.normals @ sun])

        columns, numbers = environment
        low, high = numbers[:, 3].min(), numbers[:, 3].max()
        if low < high and (low == 0 or high == 1):
            columns, numbers = self.nodes(begin + length / 64 * (np.arange(64)[:, None] + C).ravel())
        dt = length * 12 / len(numbers)
        for step in range(len(numbers) // 12):
            own, size = columns[12 * step : 12 * step + 12], numbers[12 * step : 12 * step + 12]
            left, done, last = 0.0, np.zeros(2 * len(self.normals), dtype=bool), cosines(y, own[0])
            new = moved(y, step * dt, dt, own, size)
            while True:
                ends = cosines(new, own[11])
                some = np.flatnonzero((last * ends < 0) & ~done)
                if not len(some):
                    break
                one = some[np.argmin(last[some] / (last[some] - ends[some]))]

                def part(to):
                    """From `left` to another share of the step; its environment by cubics."""
                    at = left + (to - left) * C
                    share = lambda m: np.prod([(at - C[n]) / (C[m] - C[n]) for n in FOUR if n != m], axis=0)
                    cubic = np.column_stack([share(m) for m in FOUR])
                    place = np.tensordot(cubic, own[FOUR], 1)
                    return moved(y, (step + left) * dt, (to - left) * dt, place, cubic @ size[FOUR]), place[11]

                cosine = lambda to: cosines(*part(to))[one] if to > left else last[one]
                share = brentq(cosine, left, 1.0, xtol=1e-7)
                y, place = part(share)
                left, last, done[one] = share, cosines(y, place), True
                new, _ = part(1.0)
            y = new
        y[:4] /= np.linalg.norm(y[:4])
        return y, h + length * motor

    def friction(self, rates, command, length):
        """The torque on each wheel over an arc."""
        out = []
        for wheel, i, rate, tau in zip(self.wheels, self.reduced, rates, command):
            dry, wet = wheel["coulomb_friction_n_m"], wheel["viscous_friction_n_m_s"]
            limit, top = wheel["torque_limit_n_m"], wheel["speed_limit_rad_s"]
            room = lambda x: max(i * (top - x) / length + (dry + wet * x if x > 0 else 0), 0)
            motor = min(max(min(max(tau, -limit), limit), -room(-rate)), room(rate))
            stop = rate * i / length + motor
            slow = -math.copysign(min(abs(wet * rate), abs(stop)), rate) if stop * rate > 0 else 0.0
            out.append(motor + slow - min(max(stop + slow, -dry), dry))
        return np.array(out)

    def command(self, tick, y, rates):
        """Torques of the wheels and dipoles of the rods, from measurements without noise."""
        q, omega, period = y[:4], y[4:], self.period
        field = plates.dcm(q).T @ self.field(tick * period, self.orbit(tick * period)[None, :3])[0]
        if tick and self.is_filtered:
            turned = product(self.before * [1, -1, -1, -1], q)
            size = np.linalg.norm(turned[1:])
            omega = 2 * math.atan2(size, abs(turned[0])) / size / period * math.copysign(1, turned[0]) * turned[1:]
        self.before = q
        return self.law(tick, q, omega, rates, field)

    def law(self, tick, q, omega, rates, field):
        phase, period, c = self.phase, self.period, plates.dcm(q)
        if phase["rods"] == "b_dot":
            dipole = phase["b_dot_gain_a_m2_s_t"] / period * (self.measured - field) if tick else np.zeros(3)
            self.measured = field
        else:
            dipole = np.cross(self.axes @ (self.axial * rates), field) / (phase["rod_unloading_time_s"] * field @ field)
        rods = np.linalg.pinv(self.rods) @ dipole
        rods /= max(1.0, (np.abs(rods) / self.most).max())
        if not self.wheels:
            return np.zeros(0), rods
        frame, turning = orbital(*np.split(self.orbit(tick * period), 2))
        error, target = quaternion(frame.T @ c)[1:], c.T @ turning
        self.z = self.z + phase["integral_1_s"] * period * error if tick else np.zeros(3)
        w, zeta = phase["bandwidth_rad_s"], phase["damping"]
        momentum = self.k @ omega + self.axes @ (self.axial * (self.axes.T @ omega + rates))
        rate = -2 * w * w * (error + self.z) - 2 * zeta * w * (omega - target) - np.cross(omega, target)
        wanted = self.k @ rate + np.cross(omega, momentum) - np.cross(self.rods @ rods, field)
        return -np.linalg.pinv(self.axes) @ wanted, rods

    def fly(self, step, times):
        """Attitude, rate, wheel rates, place of c and commands at the times, which are ticks."""
        y = np.concatenate([self.q, self.omega])
        h = self.axial * (self.axes.T @ self.omega + [wheel["rate_rad_s"] for wheel in self.wheels])
        held = np.zeros(len(self.wheels)), np.zeros(len(self.most))
        delay, ticks = self.file["control"]["delay_s"], round(self.duration / self.period)
        arcs = [(0.0, delay), (delay, self.period - delay)] if delay else [(0.0, self.period)]
        counts = [math.ceil(length / step - 1e-9) for _, length in arcs]
        shares = [begin + length / n * (np.arange(n)[:, None] + C).ravel() for (begin, length), n in zip(arcs, counts)]
        found, wanted = [], {round(time / self.period) for time in times}
        for tick in range(ticks + 1):
            if tick % 500 == 0:
                begins = self.period * np.arange(tick, min(tick + 500, ticks + 1))
                tables = [self.nodes((begins[:, None] + share).ravel()) for share in shares]
                tables = [[one.reshape(len(begins), -1, *one.shape[1:]) for one in table] for table in tables]
            rates = h / self.axial - self.axes.T @ y[4:]
            new = self.command(tick, y, rates)
            if tick in wanted:
                found.append([*y, *rates, *self.orbit(tick * self.period)[:3], *new[0], *new[1]])
            for (begin, length), table in zip(arcs, tables):
                held = new if begin == delay else held
                motor = self.friction(h / self.axial - self.axes.T @ y[4:], held[0], length)
                environment = [one[tick % 500] for one in table]
                dipole = self.residual + self.rods @ held[1]
                y, h = self.arc(y, h, motor, dipole, environment, tick * self.period + begin, length)
        return np.array(found)


def spindrift(program, *words):
    done = subprocess.run([program, *words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spindrift", required=True)
    parser.add_argument("--cases", default="", help="only those whose name has this text")
    parser.add_argument("--step", default=0.25, type=float, help="longest step, s")
    parser.add_argument("--limit", default=1e-9, type=float)
    options = parser.parse_args()
    wrong = []
    for case, (name, settings) in CASES.items():
        if options.cases not in case:
            continue
        words = [CAMPAIGNS / name, *(word for one in settings for word in ("--set", one))]
        plan = spindrift(options.spindrift, "check", "--plan", *words).split("\n== Plan (")[1]
        loop = Loop(tomllib.loads(plan.split("\n", 1)[1]))
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "states.parquet"
            spindrift(options.spindrift, "simulate", *words, "--sample", "0", "--out", out)
            table = {key: np.array(value) for key, value in pq.read_table(out).to_pydict().items()}
        times, apart, first = table["time_s"], {}, 0
        wheels, rods = ([one["name"] for one in loop.file.get(key, [])] for key in ("wheels", "torque_rods"))
        columns = lambda name, parts: np.array([table[name.format(one)] for one in parts]).reshape(-1, len(times)).T
        q = columns("q_es_{}", "wxyz")
        ours = {
            "attitude": q,
            "rate": columns("omega_se_s_{}_rad_s", "xyz"),
            "wheels": columns("rate_{}_rad_s", wheels),
            "position": columns("r_po_e_{}_m", "xyz") + [plates.dcm(one) @ loop.center for one in q],
            "torques": columns("commanded_torque_{}_n_m", wheels),
            "dipoles": columns("commanded_dipole_{}_a_m2", rods),
        }
        found = loop.fly(options.step, times)
        for key, own in ours.items():
            other, first = found[:, first : first + own.shape[1]], first + own.shape[1]
            length = lambda v: np.linalg.norm(v, axis=1)
            if key == "attitude":
                apart[key] = 2 * np.minimum(length(own - other), length(own + other))
            elif own.size:
                apart[key] = length(own - other) / length(other).max()
        print(f"== {case}: largest difference from spindrift until")
        print("   time, s  " + "".join(f"{key:>11}" for key in apart))
        for part in np.array_split(np.arange(1, len(times)), 8):
            print(f"   {times[part[-1]]:7.0f}  " + "".join(f"{one[part].max():11.1e}" for one in apart.values()))
        worst = max(one.max() for key, one in apart.items() if key not in ("torques", "dipoles"))
        if not worst <= options.limit:
            wrong.append(f"{case}: {worst:.1e}")
    if wrong:
        sys.exit("NO AGREEMENT: " + "; ".join(wrong))


if __name__ == "__main__":
    main()
