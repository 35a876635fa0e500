"""spindrift against Basilisk on a spacecraft with four balanced reaction wheels in a pyramid, one core.

Basilisk: AVS Lab, University of Colorado (PyPI package bsk). Here it is a Spacecraft with a ReactionWheelStateEffector whose
wheels are BalancedWheels without friction and limits, no gravity. In this model the properties of the hub contain the wheels at
rest, which is includes_wheels = true in a campaign file; Basilisk takes from a wheel only its axis, Js and rate (source:
src/simulation/dynamics/reactionWheels/reactionWheelStateEffector.cpp, and Alcorn, Allard and Schaub, "Fully Coupled Reaction
Wheel Static and Dynamic Imbalance for Spacecraft Jitter Modeling", Journal of Guidance, Control, and Dynamics 41(6), 2018).

Scenes: campaigns/pyramid.toml over 100 s at 101 points, with free wheels, and with motor torques during the first 20 s. Each sample's
initial attitude, angular velocity and tilt of w1 are read from `spindrift sample`. The true axis of w1 is computed here again.
A motor command of Basilisk holds from one execution of the wheels' task to the next. The wheels run before the spacecraft and the
run is halted at 20 s to change the command, so that the arc is exact.

spindrift's states are those of `spindrift simulate`. There is a third solution of the scenes as Basilisk gets them: Taylor series
here, in numpy.longdouble (64 bits of mantissa on x86), of the momentum balance with the wheels' axial momenta as parameters. It says
who is off if the two do not agree.

Errors, each the maximum over samples and points:
  omega     |difference| over the run's largest |omega|
  attitude  angle of the rotation between the two attitudes, rad
  wheels    |difference of the rate of a wheel| over the wheel's largest |rate| in the run
  position  of the reference point p, |difference| over the largest |position|; only between Basilisk and spindrift

spindrift's runs per second are those of `spindrift precision`, whose error is the larger of omega's and attitude's.

The exit code is 1 if Basilisk at its best setting and spindrift differ by more than --limit.
"""

import argparse
import math
import pathlib
import resource
import subprocess
import sys
import time
import tomllib

import Basilisk
import numpy as np
import pyarrow.parquet as pq
from Basilisk.architecture import bskLogging, messaging
from Basilisk.simulation import reactionWheelStateEffector, spacecraft, svIntegrators
from Basilisk.utilities import SimulationBaseClass, macros

ROOT = pathlib.Path(__file__).resolve().parents[2]
DURATION, POINTS, ARC_END = 100.0, 101, 20.0
TORQUES = {"w1": 0.05, "w2": -0.03, "w3": 0.02, "w4": 0.04}
ARC = f"""
[[actuation]]
start_s = 0.0
end_s = {ARC_END}
torque_n_m = {{ {", ".join(f"{name} = {torque}" for name, torque in TORQUES.items())} }}
"""
CASES = {"free wheels": "", "motor torques during 20 s": ARC}
# Basilisk's integrator, step of the task in s, tolerance of an adaptive integrator. Those adapt within a step of the task only.
SETTINGS = [
    ("RK4", 1.0, None), ("RK4", 0.1, None), ("RK4", 0.02, None),
    ("RKF45", 1.0, 1e-8), ("RKF45", 1.0, 1e-11), ("RKF45", 1.0, 1e-14),
    ("RKF78", 1.0, 1e-8), ("RKF78", 1.0, 1e-14), ("RKF78", 0.5, 1e-14), ("RKF78", 0.2, 1e-14),
]
MEASURES = ("omega", "attitude", "wheels")


# ---- the scenes

def scenes_of(options, file, folder):
    """What Basilisk needs to know of each sample."""
    drawn = folder / "drawn.parquet"
    run([options.spindrift, "sample", file, "--samples", str(options.samples), "--out", drawn])
    nominal = tomllib.loads(file.read_text())
    body = nominal["body"]
    assert body["includes_wheels"], "the hub of Basilisk contains the wheels"
    wheels = []
    for wheel in nominal["wheels"]:
        axis = np.array(wheel["axis"], dtype=float)
        rate = wheel["rate_rad_s"]
        if isinstance(rate, str):
            number, unit = rate.split()
            assert unit == "rpm", rate
            rate = float(number) * 2 * math.pi / 60
        wheels.append((wheel["name"], axis / np.linalg.norm(axis), wheel["axial_inertia_kg_m2"], rate, wheel["mass_kg"],
                       wheel["transverse_inertia_kg_m2"], wheel["position_m"]))
    scenes = []
    for row in pq.read_table(drawn).sort_by("sample_id").to_pylist():
        tilt = [row["wheels_w1_tilt_1_rad"], row["wheels_w1_tilt_2_rad"]]
        q = np.array([row[f"initial_attitude_{c}"] for c in "wxyz"])
        scenes.append({
            "mass": body["mass_kg"], "center": np.array(body["center_of_mass_m"]), "inertia": np.array(body["inertia_kg_m2"]),
            "axes": [tilted(axis, tilt) if name == "w1" else axis for name, axis, *_ in wheels],
            "js": [w[2] for w in wheels], "rates": [w[3] for w in wheels], "wheels": wheels,
            "q": q / np.linalg.norm(q),
            "omega": np.array([row[f"initial_angular_velocity_{c}_rad_s"] for c in "xyz"]),
        })
    return scenes


def tilted(axis, tilt):
    """The true axis by docs/campaign-files.md: rotated by u e1 + v e2, e1 from the axis of F_s that is farthest."""
    e1 = np.eye(3)[int(np.argmin(np.abs(axis)))]
    e1 = e1 - (e1 @ axis) * axis
    e1 /= np.linalg.norm(e1)
    theta = tilt[0] * e1 + tilt[1] * np.cross(axis, e1)
    angle = np.linalg.norm(theta)
    if angle == 0.0:
        return axis
    turned = math.cos(angle) * axis + math.sin(angle) / angle * np.cross(theta, axis)  # theta is across the axis
    return turned / np.linalg.norm(turned)


def matrix(q):
    """The rotation matrix of q_es: components in F_s to components in F_e."""
    w, v = q[0], q[1:]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


# ---- three solutions: arrays [sample, point, ...] of omega (3), attitude q_es (4), rates of the wheels (4), position of p (3)

def basilisk_run(scene, torques, integrator, step, tolerance):
    """One run of Basilisk: states, CPU seconds of the execution alone, and of everything from an empty simulation to arrays."""
    start = time.process_time()
    simulation = SimulationBaseClass.SimBaseClass()
    simulation.CreateNewProcess("process").addTask(simulation.CreateNewTask("task", macros.sec2nano(step)))

    craft = spacecraft.Spacecraft()
    craft.ModelTag = "craft"
    craft.hub.mHub = scene["mass"]
    craft.hub.r_BcB_B = scene["center"].reshape(3, 1).tolist()
    craft.hub.IHubPntBc_B = scene["inertia"].tolist()
    q = scene["q"] if scene["q"][0] >= 0 else -scene["q"]
    craft.hub.sigma_BNInit = (q[1:] / (1 + q[0])).reshape(3, 1).tolist()
    craft.hub.omega_BN_BInit = scene["omega"].reshape(3, 1).tolist()
    # p is at rest at the origin; Basilisk takes position and velocity of the centre of mass
    turn = matrix(scene["q"])
    craft.hub.r_CN_NInit = (turn @ scene["center"]).reshape(3, 1).tolist()
    craft.hub.v_CN_NInit = (turn @ np.cross(scene["omega"], scene["center"])).reshape(3, 1).tolist()
    method = getattr(svIntegrators, "svIntegrator" + integrator)(craft)
    if tolerance is not None:
        method.relTol = tolerance
        method.absTol = 0.01 * tolerance  # rates are about 0.1 rad/s
    craft.setIntegrator(method)

    effector = reactionWheelStateEffector.ReactionWheelStateEffector()
    effector.ModelTag = "wheels"
    for (_, _, js, rate, mass, transverse, place), axis in zip(scene["wheels"], scene["axes"]):
        wheel = reactionWheelStateEffector.RWConfigPayload()
        wheel.RWModel = messaging.BalancedWheels
        wheel.gsHat_B = axis.reshape(3, 1).tolist()
        wheel.rWB_B = np.reshape(place, (3, 1)).tolist()
        wheel.mass, wheel.Js, wheel.Jt, wheel.Jg = mass, js, transverse, transverse
        wheel.Omega = rate
        wheel.u_max = wheel.P_max = wheel.Omega_max = -1.0  # no limits
        wheel.u_min = 0.0
        effector.addReactionWheel(wheel)
    craft.addStateEffector(effector)
    if any(torques):
        command = messaging.ArrayMotorTorqueMsgPayload()
        command.motorTorque = torques
        message = messaging.ArrayMotorTorqueMsg().write(command)
        effector.rwMotorCmdInMsg.subscribeTo(message)
    simulation.AddModelToTask("task", effector, 2)  # before the spacecraft, which integrates to the time of the call
    simulation.AddModelToTask("task", craft, 1)
    every = macros.sec2nano(DURATION / (POINTS - 1))
    states = craft.scStateOutMsg.recorder(every)
    speeds = effector.rwSpeedOutMsg.recorder(every)
    simulation.AddModelToTask("task", states)
    simulation.AddModelToTask("task", speeds)
    simulation.InitializeSimulation()

    ready = time.process_time()
    if any(torques):
        simulation.ConfigureStopTime(macros.sec2nano(ARC_END))
        simulation.ExecuteSimulation()
        message.write(messaging.ArrayMotorTorqueMsgPayload())
    simulation.ConfigureStopTime(macros.sec2nano(DURATION))
    simulation.ExecuteSimulation()
    done = time.process_time()

    assert np.array_equal(states.times(), every * np.arange(POINTS)), states.times()
    sigma = np.array(states.sigma_BN)
    square = (sigma * sigma).sum(axis=1, keepdims=True)
    found = {"omega": np.array(states.omega_BN_B), "attitude": np.hstack([1 - square, 2 * sigma]) / (1 + square),
             "wheels": np.array(speeds.wheelSpeeds)[:, :len(scene["axes"])], "position": np.array(states.r_BN_N)}
    return found, done - ready, time.process_time() - start


def basilisk(scenes, torques, repeats):
    """For each setting the states, and CPU seconds of a run without and with set-up: the least of the repetitions.

    The settings take turns, so that a busy minute of the machine does not meet one of them alone.
    """
    found = {}
    basilisk_run(scenes[0], torques, *SETTINGS[0])  # warm-up
    for _ in range(repeats):
        for setting in SETTINGS:
            runs = [basilisk_run(scene, torques, *setting) for scene in scenes]
            alone, whole = (float(np.mean([r[k] for r in runs])) for k in (1, 2))
            _, least, least_whole = found.get(setting, (None, math.inf, math.inf))
            found[setting] = stacked([r[0] for r in runs]), min(alone, least), min(whole, least_whole)
    return found


def spindrift(options, file, scenes, folder):
    """States of `spindrift simulate`, which runs a sample as its campaign does."""
    found = []
    for sample in range(len(scenes)):
        out = folder / "series.parquet"
        run([options.spindrift, "simulate", file, "--sample", str(sample), "--out", out])
        table = pq.read_table(out).to_pydict()
        assert np.allclose(table["time_s"], np.linspace(0.0, DURATION, POINTS), rtol=0.0, atol=1e-13)
        found.append({
            "omega": np.transpose([table[f"omega_se_s_{c}_rad_s"] for c in "xyz"]),
            "attitude": np.transpose([table[f"q_es_{c}"] for c in "wxyz"]),
            "wheels": np.transpose([table[f"rate_{name}_rad_s"] for name, *_ in scenes[0]["wheels"]]),
            "position": np.transpose([table[f"r_po_e_{c}_m"] for c in "xyz"]),
        })
    return stacked(found)


def third(scenes, torques, step=0.25, order=24):
    """Taylor series of the momentum balance, all samples at once.

    With J the inertia with the wheels at rest, a_i the axes, J_i their axial moments and H_i = J_i (Omega_i + a_i . omega):
    (J - sum J_i a_i a_i^T) omega' = -omega x ((J - sum J_i a_i a_i^T) omega + sum a_i H_i) - sum a_i u_i,  H_i' = u_i.
    """
    real = np.longdouble
    as_real = lambda key: np.array([scene[key] for scene in scenes], dtype=real)
    axes, js, spin = as_real("axes"), as_real("js"), as_real("rates")
    omega, q = as_real("omega"), as_real("q")
    axes = axes / np.sqrt((axes * axes).sum(axis=2, keepdims=True))
    q = q / np.sqrt((q * q).sum(axis=1, keepdims=True))
    locked = as_real("inertia") - np.einsum("ni,nij,nik->njk", js, axes, axes)
    inverse = inverted(locked)
    held = js * (spin + np.einsum("nij,nj->ni", axes, omega))
    motor = np.array(torques, dtype=real)
    apply = lambda m, v: np.einsum("njk,nk->nj", m, v)
    found = {"omega": [omega], "attitude": [q], "wheels": [spin]}
    per_point = round(DURATION / (POINTS - 1) / step)
    for k in range((POINTS - 1) * per_point):
        u = motor if k * step < ARC_END else 0 * motor
        torque = -np.einsum("nij,i->nj", axes, u)
        x, p = [omega], [q]
        g = [apply(locked, omega) + np.einsum("nij,ni->nj", axes, held)]
        for n in range(order):
            rate = -sum(np.cross(x[i], g[n - i]) for i in range(n + 1))
            if n == 0:
                rate = rate + torque
            x.append(apply(inverse, rate) / real(n + 1))
            g.append(apply(locked, x[-1]) + (-torque if n == 0 else 0))
            p.append(sum(times_vector(p[i], x[n - i]) for i in range(n + 1)) / real(2 * (n + 1)))
        h = real(step)
        omega, q = (sum(c * h**n for n, c in reversed(list(enumerate(series)))) for series in (x, p))
        held = held + h * u
        if (k + 1) % per_point == 0:
            found["omega"].append(omega)
            found["attitude"].append(q)
            found["wheels"].append(held / js - np.einsum("nij,nj->ni", axes, omega))
    return {key: np.moveaxis(np.array(value), 0, 1) for key, value in found.items()}


def inverted(m):
    """Inverses of symmetric matrices in the precision of their elements."""
    rows = [np.cross(m[:, 1], m[:, 2]), np.cross(m[:, 2], m[:, 0]), np.cross(m[:, 0], m[:, 1])]
    return np.stack(rows, axis=2) / (m[:, 0] * rows[0]).sum(axis=1)[:, None, None]


def times_vector(q, v):
    """The quaternion product q (0, v)."""
    w, u = q[:, :1], q[:, 1:]
    return np.hstack([-(u * v).sum(axis=1, keepdims=True), w * v + np.cross(u, v)])


def stacked(runs):
    return {key: np.array([r[key] for r in runs]) for key in runs[0]}


# ---- errors and times

def difference(a, b):
    """The measures of the docstring between two solutions, with b as the reference."""
    length = lambda v: np.sqrt((v * v).sum(axis=-1))
    found = {"omega": length(a["omega"] - b["omega"]) / length(b["omega"]).max(axis=1, keepdims=True)}
    q, p = (s["attitude"] / length(s["attitude"])[..., None] for s in (a, b))
    found["attitude"] = 4 * np.arcsin(np.minimum(length(q - p), length(q + p)) / 2)
    if "wheels" in a and "wheels" in b:
        found["wheels"] = np.abs(a["wheels"] - b["wheels"]) / np.abs(b["wheels"]).max(axis=1, keepdims=True)
    if "position" in a and "position" in b:
        found["position"] = length(a["position"] - b["position"]) / length(b["position"]).max(axis=1, keepdims=True)
    return {key: float(value.max()) for key, value in found.items()}


def shown(errors):
    return "".join(f"{errors[key]:11.1e}" for key in MEASURES)


def tolerance_of(text):
    return tomllib.loads(text)["integrator"]["tolerance"]


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def precision(options, file, folder):
    """Measurements of spindrift: method, tolerance, runs/s, the larger of the errors of omega and attitude."""
    run([options.spindrift, "precision", file, "--samples", str(options.samples), "--repeats", str(options.repeats),
         "--methods", "auto,taylor,dop853", "--out", folder / "precision"])
    return [(row["method"], row["tolerance"], 1 / row["cpu_least_s"], max(row["rate_error_max"], row["attitude_error_max_rad"]))
            for row in pq.read_table(folder / "precision" / "precision.parquet").to_pylist()]


def campaign(options, file, folder):
    """Runs per second of CPU time of whole campaigns: start of the process, sampling, runs, observables, files."""
    found = []
    for _ in range(options.repeats):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run([options.spindrift, "campaign", file, "--samples", str(options.campaign), "--threads", "1", "--overwrite",
             "--out", folder / "rows"])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        found.append(options.campaign / (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime))
    return found


def compare(options, name, appended):
    """One case. Returns what is wrong, if Basilisk at its best and spindrift do not agree."""
    folder = options.scratch / name.replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    text = (ROOT / "campaigns" / "pyramid.toml").read_text()
    for old, new in (('duration_s = "2 min"', f"duration_s = {DURATION}"), ("points = 121", f"points = {POINTS}")):
        assert old in text, old
        text = text.replace(old, new)
    file = folder / "campaign.toml"
    file.write_text(text + appended)
    scenes = scenes_of(options, file, folder)
    torques = [TORQUES[wheel[0]] if appended else 0.0 for wheel in scenes[0]["wheels"]]
    reference = third(scenes, torques)
    ours = spindrift(options, file, scenes, folder)
    print(f"\n== {name}")
    print(f"   {'':<27}{'errors against the third solution':>33} | {'runs/s, set-up':<18} "
          "| spindrift, fastest at equal or less error")
    print(f"   {'Basilisk':<10}{'step':>6}{'tolerance':>11}" + "".join(f"{key:>11}" for key in MEASURES)
          + f" | {'excluded':>9}{'included':>9} | {'method':<18}{'runs/s':>9}{'ratio':>8}")
    found = precision(options, file, folder)
    best = quick = None
    for setting, (states, alone, whole) in basilisk(scenes, torques, options.repeats).items():
        errors = difference(states, reference)
        error = max(errors["omega"], errors["attitude"])
        fit = [m for m in found if m[3] <= error]
        adapted = f"{setting[2]:.0e}" if setting[2] else "-"
        line = f"   {setting[0]:<10}{setting[1]:>4} s{adapted:>11}{shown(errors)} | {1 / alone:9.0f}{1 / whole:9.0f} | "
        if fit:
            method, tolerance, rate, _ = max(fit, key=lambda m: m[2])
            line += f"{f'{method} at {tolerance:.0e}':<18}{rate:9.0f}{rate * alone:7.0f}x"
        else:
            line += "none is as accurate"
        print(line)
        measured = (np.max([errors[key] for key in MEASURES]), " ".join(map(str, setting)), states, alone, whole, errors)
        if best is None or measured[0] < best[0]:
            best = measured
        if measured[0] <= options.limit and (quick is None or alone < quick[3]):
            quick = measured
    _, setting, states, _, _, errors = best
    own = difference(ours, reference)
    print(f"   {f'spindrift simulate at {tolerance_of(text):.0e}':<27}{shown(own)} |")
    agreement = difference(states, ours)
    print(f"   Basilisk at its best ({setting}) and spindrift differ by "
          + ", ".join(f"{key} {value:.1e}" for key, value in agreement.items()))
    rate = max(campaign(options, file, folder))
    print(f"   spindrift, a campaign of {options.campaign} samples at {tolerance_of(text):.0e} with start of the process, "
          f"sampling, observables and files: {rate:.0f} runs/s")
    for which, measured in (("most accurate", best), (f"fastest with errors below {options.limit:.0e}", quick)):
        if measured is not None:
            _, setting, _, alone, whole, _ = measured
            print(f"      Basilisk, {which} ({setting}): {1 / whole:.0f} runs/s with set-up, ratio {rate * whole:.0f}; "
                  f"{1 / alone:.0f} without, ratio {rate * alone:.0f}")
    worst = float(np.max(list(agreement.values())))
    if not worst <= options.limit:
        return (f"{name}: they differ by {worst:.1e}; from the third solution, Basilisk by {np.max(list(errors.values())):.1e}, "
                f"spindrift by {np.max(list(own.values())):.1e}")
    return None


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--spindrift", required=True)
    arguments.add_argument("--scratch", type=pathlib.Path, required=True)
    arguments.add_argument("--samples", type=int, default=32, help="samples that both run")
    arguments.add_argument("--campaign", type=int, default=65536, help="samples of the timed campaign")
    arguments.add_argument("--repeats", type=int, default=3)
    arguments.add_argument("--limit", type=float, default=1e-9, help="largest difference that counts as agreement")
    arguments.add_argument("--cases", default="", help="only the cases whose name contains this")
    options = arguments.parse_args()
    bskLogging.setDefaultLogLevel(bskLogging.BSK_WARNING)
    print(f"Basilisk {Basilisk.__version__}; {options.samples} samples, {DURATION:.0f} s, {POINTS} points, "
          f"CPU time on one core, the least of {options.repeats} repeats; third solution with {np.finfo(np.longdouble).nmant + 1} bits")
    cases = {name: appended for name, appended in CASES.items() if options.cases in name}
    if not cases:
        sys.exit(f"no case has {options.cases} in its name")
    wrong = [message for name, appended in cases.items() if (message := compare(options, name, appended))]
    if wrong:
        sys.exit("\n".join([f"\nNO AGREEMENT to {options.limit:.0e}", *wrong]))
    print(f"\nagreement to {options.limit:.0e} in every case")


if __name__ == "__main__":
    main()
