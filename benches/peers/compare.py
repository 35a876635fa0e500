"""spindrift against heyoka (batch mode) and SciPy on the same scenes, one core, in one process.

Scenes: campaigns/no_debris.toml (torque-free, 10 s) and variants of it made here: final state only, three states only, and
motor torque and thrust during the whole run. The dispersed parameters are read from the rows of a spindrift campaign, the
mass properties are computed here again. Errors of the peers are measured against heyoka in 80-bit floating point, those of
spindrift against its own double-double reference; that both solve the same problem is checked by comparing final states.

The compared error is the larger of |omega - reference| / max |omega| and 2 |q - reference|, maximum over samples and points; for three
states the first alone.
"""

import argparse
import itertools
import math
import pathlib
import subprocess
import time
import tomllib

import heyoka as hy
import numpy as np
import pyarrow.parquet as pq
from scipy.integrate import solve_ivp

TOLERANCES = [1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16]
# half decades: the compared setting is the fastest whose error is at most that of heyoka
OUR_TOLERANCES = ",".join(f"{digit}e-{decade}" for decade in range(3, 17) for digit in (3, 1))
ROOT = pathlib.Path(__file__).resolve().parents[2]
ACTUATION = """
[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]

[[thrusters]]
name = "p2"
position_m = [0, -0.5, 3.0]
direction = [0, 0, -1]

[[thrusters]]
name = "p3"
position_m = [0, 0.5, 3.0]
direction = [0, 0, -1]

[[actuation]]
start_s = 0.0
end_s = 10.0
thrust_n = { p1 = 100, p2 = 40, p3 = 15 }
torque_n_m = { w1 = 0.5, w2 = -0.25 }
"""
# name: (changes of the campaign file, appended text, system, points, further options of `spindrift precision`)
CASES = {
    "free, 11 states, 101 points": ([], "", "free", 101, []),
    "free, 11 states, final state only": ([("points = 101", "points = 2")], "", "free", 2, []),
    "free, 3 states, 101 points": (
        [("points = 101", 'points = 101\ngroups = ["energies_com"]')], "", "rates", 101, ["--observed"]),
    "forced, 17 states, 101 points": ([], ACTUATION, "forced", 101, []),
}

# how many parameters each system has
PARAMETERS = {"rates": 8, "free": 8, "forced": 16}


def system(kind):
    """The gyrostat in heyoka's expressions; the wheel axes are s2 and s3, the inertia is diagonal.

    Parameters: 0-2 (J2 - J3)/J1 and cyclic, 3-5 1/J_i, 6-7 wheel momenta h1, h2, 8-9 1/J_wheel, 10-12 torque on the body less
    that of the motors, 13-14 motor torques, 15 force over mass.
    """
    x, y, z, q0, q1, q2, q3, a, b = hy.make_vars("x", "y", "z", "q0", "q1", "q2", "q3", "a", "b")
    p = hy.par
    if kind == "forced":
        h1, h2 = hy.make_vars("h1", "h2")
        torque = [p[10], p[11], p[12]]
    else:
        h1, h2 = p[6], p[7]
        torque = [0.0, 0.0, 0.0]
    dx = p[0] * (y * z) + p[3] * (h1 * z - h2 * y + torque[0])
    dy = p[1] * (z * x) + p[4] * (h2 * x + torque[1])
    dz = p[2] * (x * y) + p[5] * (torque[2] - h1 * x)
    rates = [(x, dx), (y, dy), (z, dz)]
    if kind == "rates":
        return rates
    attitude = [
        (q0, -0.5 * (q1 * x + q2 * y + q3 * z)),
        (q1, 0.5 * (q0 * x + q2 * z - q3 * y)),
        (q2, 0.5 * (q0 * y + q3 * x - q1 * z)),
        (q3, 0.5 * (q0 * z + q1 * y - q2 * x)),
    ]
    if kind == "free":
        u, v = hy.make_vars("u", "v")
        return rates + attitude + [(a, u), (b, v), (u, -dy), (v, -dz)]
    r = hy.make_vars("r1", "r2", "r3")
    v = hy.make_vars("v1", "v2", "v3")
    axis = [2.0 * (q1 * q3 + q0 * q2), 2.0 * (q2 * q3 - q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3]
    wheels = [(a, p[8] * h1 - y), (b, p[9] * h2 - z), (h1, p[13]), (h2, p[14])]
    return rates + attitude + wheels + list(zip(r, v)) + [(v[i], p[15] * axis[i]) for i in range(3)]


def drawn(spindrift, file, samples, folder):
    """The parameters of each sample as applied, and its final rate and attitude, from a campaign's rows."""
    out = folder / "rows"
    command = [spindrift, "campaign", file, "--samples", str(samples), "--out", out, "--overwrite"]
    subprocess.run(command, check=True, capture_output=True)
    rows = pq.read_table(sorted((out / "runs").glob("*.parquet"))).sort_by("sample_id").to_pylist()
    nominal = tomllib.loads(file.read_text())
    return [scene(nominal, row) for row in rows], rows


def scene(nominal, row):
    """Initial state and parameters of one sample for `system`."""

    def value(table, prefix, key, component=None):
        column = parameter_column(prefix, key, component)
        if column in row:
            return row[column]
        written = table[key]
        return float(written if component is None else written[component])

    [part] = nominal["body"]["parts"]
    sizes = ("wall_thickness_m", "outer_radius_m", "length_m", "density_kg_m3")
    body = {key: value(part, f"body_parts_{part['name']}", key) for key in sizes}
    numbers = ("radius_m", "length_m", "density_kg_m3", "rate_rad_s")
    wheels = [
        {key: value({"rate_rad_s": 0.0} | wheel, f"wheels_{wheel['name']}", key) for key in numbers}
        | {"station_m": value(wheel, f"wheels_{wheel['name']}", "position_m", 2)}
        for wheel in nominal["wheels"]
    ]
    omega = [value(nominal["initial"], "initial", "angular_velocity_rad_s", i) for i in range(3)]
    spin = [wheel["rate_rad_s"] for wheel in wheels]

    t, radius, length, density = (body[key] for key in sizes)
    bore, height = radius - t, length - 2 * t
    shell = density * math.pi * t * (radius + bore) * height
    plates = 2 * density * math.pi * radius**2 * t
    arm = 0.5 * (length - t)
    mass = [shell + plates]
    station = [value(part, f"body_parts_{part['name']}", "position_m", 2)]
    axial = 0.5 * (shell * (radius**2 + bore**2) + plates * radius**2)
    across = shell * ((radius**2 + bore**2) / 4 + height**2 / 12) + plates * (radius**2 / 4 + t * t / 12 + arm**2)
    j = [across, across, axial]
    wheel_axial = []
    for i, wheel in enumerate(wheels):
        m = wheel["density_kg_m3"] * math.pi * wheel["radius_m"] ** 2 * wheel["length_m"]
        transverse = m * (wheel["radius_m"] ** 2 / 4 + wheel["length_m"] ** 2 / 12)
        wheel_axial.append(0.5 * m * wheel["radius_m"] ** 2)
        mass.append(m)
        station.append(wheel["station_m"])
        # J*: without the axial moment
        j = [j[k] + (0.0 if k == i + 1 else transverse) for k in range(3)]
    total = sum(mass)
    center = sum(m * s for m, s in zip(mass, station)) / total
    pairs = sum(mass[k] * mass[n] / total * (station[k] - station[n]) ** 2 for k, n in ((0, 1), (0, 2), (1, 2)))
    j = [j[0] + pairs, j[1] + pairs, j[2]]

    act = nominal.get("actuation", [{"thrust_n": {}, "torque_n_m": {}}])[0]
    thrust = [act["thrust_n"].get(name, 0.0) for name in ("p1", "p2", "p3")]
    motor = [act["torque_n_m"].get(name, 0.0) for name in ("w1", "w2")]
    force = thrust[0] - thrust[1] - thrust[2]
    offsets = {thruster["name"]: thruster["position_m"][1] for thruster in nominal.get("thrusters", [])}
    torque = [offsets.get("p3", 0.0) * (thrust[1] - thrust[2]), -motor[0], -motor[1]]
    h = [wheel_axial[i] * (omega[i + 1] + spin[i]) for i in range(2)]
    par = [(j[(i + 1) % 3] - j[(i + 2) % 3]) / j[i] for i in range(3)] + [1 / x for x in j] + h
    par += [1 / x for x in wheel_axial] + torque + list(motor) + [force / total]
    velocity = nominal["initial"]["velocity_m_s"]
    shift = np.cross(omega, [0.0, 0.0, center])  # the attitude at time zero is the identity
    state = {
        "rates": omega,
        "free": omega + [1.0, 0.0, 0.0, 0.0] + [0.0, 0.0] + spin,
        "forced": omega + [1.0, 0.0, 0.0, 0.0] + [0.0, 0.0] + h + [0.0, 0.0, center]
        + [float(velocity[i] + shift[i]) for i in range(3)],
    }
    return state, par


def parameter_column(table, key, component):
    """The name of a dispersed parameter's column: the component before the unit."""
    name = f"{table}_{key}"
    if component is None:
        return name
    unit = "rad_s" if name.endswith("_rad_s") else "m"
    return f"{name.removesuffix('_' + unit)}_{'xyz'[component]}_{unit}"


def errors(states, truth, kind):
    """Worst relative error of omega, and of the state that is compared."""
    rate = np.linalg.norm(states[..., :3] - truth[..., :3], axis=-1)
    rate = (rate / np.linalg.norm(truth[..., :3], axis=-1).max(axis=1, keepdims=True)).max()
    if kind == "rates":
        return float(rate)
    q, p = states[..., 3:7], truth[..., 3:7]
    attitude = 2 * np.minimum(np.linalg.norm(q - p, axis=-1), np.linalg.norm(q + p, axis=-1)).max()
    return float(max(rate, attitude))


def truth_of(kind, scenes, grid):
    """States at the grid in 80-bit floating point."""
    real = np.longdouble
    make = dict(fp_type=real, tol=real(1e-19), compact_mode=True)
    ta = hy.taylor_adaptive(system(kind), np.zeros(len(scenes[0][0][kind]), dtype=real),
                            pars=np.zeros(PARAMETERS[kind], dtype=real), **make)
    truth = []
    for state, par in scenes:
        ta.time = real(0)
        ta.state[:] = np.array(state[kind], dtype=real)
        ta.pars[:] = np.array(par[:PARAMETERS[kind]], dtype=real)
        truth.append(ta.propagate_grid(grid.astype(real))[-1])
    return np.array(truth)


def heyoka_runs(kind, scenes, grid, tolerance, batch, fast, repeats):
    """Median CPU time of a run and the states, in batch mode."""
    states = np.array([state[kind] for state, _ in scenes])
    pars = np.array([par[:PARAMETERS[kind]] for _, par in scenes])
    ta = hy.taylor_adaptive_batch(
        system(kind), np.ascontiguousarray(states[:batch].T), tol=tolerance,
        pars=np.ascontiguousarray(pars[:batch].T), fast_math=fast)
    grids = np.ascontiguousarray(np.repeat(grid[:, None], batch, axis=1))
    inputs = [(np.ascontiguousarray(states[k:k + batch].T), np.ascontiguousarray(pars[k:k + batch].T))
              for k in range(0, len(scenes), batch)]
    zeros = np.zeros(batch)
    results, times = None, []
    rounds = 1
    for repeat in range(repeats + 1):
        results = []
        start = time.process_time()
        for _ in range(rounds):
            results.clear()
            for state, par in inputs:
                ta.set_time(zeros)
                ta.state[:] = state
                ta.pars[:] = par
                if len(grid) == 2:
                    ta.propagate_until(float(grid[-1]))
                    results.append(np.stack([state, ta.state]))
                else:
                    results.append(ta.propagate_grid(grids)[-1])
        took = (time.process_time() - start) / rounds / len(scenes)
        if repeat == 0:  # warm-up
            rounds = max(1, math.ceil(0.02 / (took * len(scenes))))
        else:
            times.append(took)
    return float(np.median(times)), np.concatenate([np.moveaxis(r, 2, 0) for r in results])


def scipy_runs(kind, scenes, grid, count):
    """Median CPU time of a run of SciPy's RK45 at 1e-8 with the right-hand side in plain Python, and the states."""
    states, times = [], []
    for state, p in scenes[:count]:

        def f(_, s):
            x, y, z, q0, q1, q2, q3 = s[:7]
            h1, h2 = p[6], p[7]
            dx = p[0] * y * z + p[3] * (h1 * z - h2 * y)
            dy = p[1] * z * x + p[4] * h2 * x
            dz = p[2] * x * y - p[5] * h1 * x
            return [dx, dy, dz, -0.5 * (q1 * x + q2 * y + q3 * z), 0.5 * (q0 * x + q2 * z - q3 * y),
                    0.5 * (q0 * y + q3 * x - q1 * z), 0.5 * (q0 * z + q1 * y - q2 * x), s[9], s[10], -dy, -dz]

        start = time.process_time()
        solution = solve_ivp(f, (0.0, grid[-1]), state[kind], method="RK45", t_eval=grid, rtol=1e-8, atol=1e-8)
        times.append(time.process_time() - start)
        states.append(solution.y.T)
    return float(np.median(times)), np.array(states)


def spindrift_runs(options, file, extra, folder):
    """Measurements of spindrift: method, setting, runs/s, error that is compared."""
    command = [options.spindrift, "precision", file, "--samples", str(options.samples), "--repeats", str(options.repeats),
               "--methods", "auto,taylor,dop853", "--tolerances", OUR_TOLERANCES, "--out", folder, *extra]
    subprocess.run(command, check=True, capture_output=True)
    found = []
    for row in pq.read_table(folder / "precision.parquet").to_pylist():
        error = max(row["rate_error_max"], row["attitude_error_max_rad"] or 0.0)
        found.append((row["method"], row["tolerance"], row["runs_per_s"], error))
    return found


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--spindrift", required=True)
    arguments.add_argument("--scratch", type=pathlib.Path, required=True)
    arguments.add_argument("--samples", type=int, default=64)
    arguments.add_argument("--repeats", type=int, default=5)
    arguments.add_argument("--quick", action="store_true", help="one tuning of heyoka instead of all")
    arguments.add_argument("--cases", default="", help="only the cases whose name contains this")
    options = arguments.parse_args()
    width = hy.recommended_simd_size()
    tunings = [(width, True)] if options.quick else list(itertools.product((width, 2 * width), (False, True)))
    options.samples -= options.samples % (2 * width)
    print(f"heyoka {hy.__version__}, batches of {sorted({b for b, _ in tunings})}; {options.samples} samples, "
          f"{options.repeats} repeats, medians, CPU time on one core")
    nominal = (ROOT / "campaigns" / "no_debris.toml").read_text()
    for name, (changes, appended, kind, points, extra) in CASES.items():
        if options.cases not in name:
            continue
        folder = options.scratch / name.replace(", ", "_").replace(" ", "_")
        folder.mkdir(parents=True, exist_ok=True)
        text = nominal
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        file = folder / "campaign.toml"
        file.write_text(text + appended)
        checked = folder / "checked.toml"
        checked.write_text(nominal.replace("tolerance = 1e-10", "tolerance = 1e-15") + appended)
        scenes, rows = drawn(options.spindrift, checked, options.samples, folder)
        grid = np.linspace(0.0, 10.0, points)
        truth = truth_of(kind, scenes, grid)
        final = np.array([[row[f"omega_se_s_{axis}_final_rad_s"] for axis in "xyz"] for row in rows])
        apart = float(np.abs(final - truth[:, -1, :3]).max() / np.abs(final).max())
        print(f"\n== {name}\n   same problem: final omega of spindrift and of heyoka in 80 bits differ by {apart:.1e}")
        assert apart < 1e-11, "the scenes differ"
        ours = spindrift_runs(options, file, extra, folder)
        print(f"{'heyoka tol':>10} {'runs/s':>9} {'error':>8} | {'spindrift, fastest at equal or less error':<42}"
              f"{'runs/s':>9} {'error':>8} {'ratio':>7}")
        for tolerance in TOLERANCES:
            best = None
            for batch, fast in tunings:
                seconds, states = heyoka_runs(kind, scenes, grid, tolerance, batch, fast, options.repeats)
                error = errors(states, truth, kind)
                if best is None or seconds < best[0]:
                    best = (seconds, error, batch, fast)
            seconds, error, batch, fast = best
            line = f"{tolerance:10.0e} {1 / seconds:9.0f} {error:8.1e} | "
            fit = [m for m in ours if m[3] <= error]
            chosen = [max(of, key=lambda m: m[2]) for of in (fit, [m for m in fit if m[0] == "taylor"]) if of]
            for method, setting, rate, own in dict.fromkeys(chosen):
                print(f"{line}{method + f' at {setting:.0e}':<42}{rate:9.0f} {own:8.1e} {rate * seconds:6.1f}x")
                line = " " * 30 + "| "
            if not chosen:
                print(f"{line}none is as accurate")
        if kind == "free" and points == 101:
            seconds, states = scipy_runs(kind, scenes, grid, min(4, options.samples))
            error = errors(states, truth[:len(states)], kind)
            method, setting, rate, own = max((m for m in ours if m[0] == "auto" and m[3] <= 1e-12), key=lambda m: m[2])
            print(f"SciPy RK45 at 1e-8: {1 / seconds:.1f} runs/s, error {error:.1e}; {method} at {setting:.0e}: "
                  f"{rate:.0f} runs/s, error {own:.1e}: {rate * seconds:.0f} times as fast")


if __name__ == "__main__":
    main()
