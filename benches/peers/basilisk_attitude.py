"""spindrift against Basilisk on a control loop: a slew by three reaction wheels under MRP feedback, one core.

The spacecraft and the loop are those of Basilisk's examples/scenarioAttitudeFeedbackRW.py (AVS Lab, University of Colorado; PyPI
package bsk): 750 kg, diag(900, 800, 600) kg m^2 with the wheels at rest, three balanced wheels Honeywell HR16 of 50 N m s along the
axes, no friction, modules simpleNav (without errors), inertial3D, attTrackingError, mrpFeedback, rwMotorTorque, all in one task of
0.1 s, 600 s. Left out is what does not touch the attitude: orbit and gravity. CASES are the scenario with and without its limit of
torque, and with its voltage interface, as scenarioMonteCarloAttRW.py has it. No wheel comes near its limit of speed.

Steps, all by default:
  history    Basilisk with RKF78 at 1e-13 against basilisk_attitude.json, and against `discrete_loop`, an integration of ours with each
             delay: which one Basilisk has, is measured. --write writes the file.
  speed      CPU time of a run of Basilisk with the settings of the scenario: RK4 at 0.1 s, 100 recorded points.
  spindrift  `spindrift simulate` of basilisk_attitude.toml against the file, and runs per second of its campaign.

What is in the file, by measurement and by Basilisk's source:
  - The task runs wheels, spacecraft, navigation, law in this order (priorities 2, 1, -1 in the order of entry). A command computed at
    tick k from the state at t_k is read by the wheels at tick k + 1, before the spacecraft integrates from t_k to t_(k+1): it acts from
    t_k. The delay is zero, and the first period has the command of the initial state.
  - The voltage interface runs before the law, which makes the delay one period: in the first period no torque acts.
  - mrpFeedback is given the inertia of the hub, which contains the wheels, and adds Js (Omega + a . omega) a of each wheel. Here it does
    not matter: with Ki < 0, controlLawType = 0 and a reference at rest, the law is u = -K sigma_BR - P omega.

Differences, each the maximum over points and components divided by the largest value of the run: mrp, omega, wheels (rates).
"""

import argparse
import json
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
from Basilisk.fswAlgorithms import attTrackingError, inertial3D, mrpFeedback, rwMotorTorque, rwMotorVoltage
from Basilisk.simulation import motorVoltageInterface, reactionWheelStateEffector, simpleNav, spacecraft, svIntegrators
from Basilisk.utilities import SimulationBaseClass, macros, orbitalMotion, simIncludeGravBody, simIncludeRW

HERE = pathlib.Path(__file__).resolve().parent
HISTORY, CAMPAIGN = HERE / "basilisk_attitude.json", HERE / "basilisk_attitude.toml"
PERIOD, DURATION, INTERVAL = 0.1, 600.0, 10.0
STIFFNESS, DAMPING = 3.5, 30.0
INERTIA, MASS = (900.0, 800.0, 600.0), 750.0
SIGMA, OMEGA = (0.1, 0.2, -0.3), (0.001, -0.01, 0.03)
WHEEL_RPM = (100.0, 200.0, 300.0)
WHEEL_INERTIA = 50.0 / (6000.0 * 2.0 * math.pi / 60.0)  # 50 N m s at 6000 rpm
TORQUE_LIMIT = 0.2
# name: whether the torque is limited, whether it goes through the voltage interface, the delay in periods
CASES = {"unlimited": (False, False, 0), "limited": (True, False, 0), "voltage": (True, True, 1)}
MEASURES = ("mrp", "omega", "wheels")
# Basilisk and `discrete_loop` differ by 4e-14 at most, Basilisk and the 14 digits of the file by 2e-14
SAME = 4e-13


# ---- Basilisk

def basilisk_run(case, tolerance=None, orbit=False, interval=INTERVAL):
    """One run: what was recorded, CPU seconds of the execution alone, and of everything from an empty simulation to arrays.

    Without a tolerance the integrator is the scenario's, RK4 with a step of the task's period.
    """
    is_limited, has_voltage, _ = CASES[case]
    start = time.process_time()
    simulation = SimulationBaseClass.SimBaseClass()
    simulation.CreateNewProcess("process").addTask(simulation.CreateNewTask("task", macros.sec2nano(PERIOD)))
    add = lambda module, *priority: simulation.AddModelToTask("task", module, *priority)
    column = lambda vector: np.reshape(vector, (3, 1)).tolist()

    craft = spacecraft.Spacecraft()
    craft.ModelTag = "craft"
    craft.hub.mHub = MASS
    craft.hub.r_BcB_B = column([0.0, 0.0, 0.0])
    craft.hub.IHubPntBc_B = np.diag(INERTIA).tolist()
    craft.hub.sigma_BNInit, craft.hub.omega_BN_BInit = column(SIGMA), column(OMEGA)
    if tolerance is not None:
        method = svIntegrators.svIntegratorRKF78(craft)
        method.relTol, method.absTol = tolerance, 0.01 * tolerance
        craft.setIntegrator(method)
    add(craft, 1)
    if orbit:
        gravity = simIncludeGravBody.gravBodyFactory()
        earth = gravity.createEarth()
        earth.isCentralBody = True
        gravity.addBodiesTo(craft)
        elements = orbitalMotion.ClassicElements()
        elements.a, elements.e, elements.f = 1e7, 0.01, 85.3 * macros.D2R
        elements.i, elements.Omega, elements.omega = 33.3 * macros.D2R, 48.2 * macros.D2R, 347.8 * macros.D2R
        craft.hub.r_CN_NInit, craft.hub.v_CN_NInit = orbitalMotion.elem2rv(earth.mu, elements)

    factory = simIncludeRW.rwFactory()
    for axis, rpm in zip(np.eye(3), WHEEL_RPM):
        factory.create("Honeywell_HR16", axis.tolist(), maxMomentum=50.0, Omega=rpm, RWModel=messaging.BalancedWheels,
                       useMaxTorque=is_limited)
    effector = reactionWheelStateEffector.ReactionWheelStateEffector()
    factory.addToSpacecraft("wheels", effector, craft)
    add(effector, 2)
    if has_voltage:
        motors = motorVoltageInterface.MotorVoltageInterface()
        motors.setGains(np.array([TORQUE_LIMIT / 10.0] * 3))
        add(motors)
    navigation = simpleNav.SimpleNav()
    guidance = inertial3D.inertial3D()
    guidance.sigma_R0N = [0.0, 0.0, 0.0]
    error = attTrackingError.attTrackingError()
    law = mrpFeedback.mrpFeedback()
    law.K, law.P, law.Ki = STIFFNESS, DAMPING, -1.0
    law.integralLimit = 2.0 / law.Ki * 0.1
    allocation = rwMotorTorque.rwMotorTorque()
    allocation.controlAxes_B = np.eye(3).flatten().tolist()
    for module in (navigation, guidance, error, law, allocation):
        add(module)

    configuration = messaging.VehicleConfigMsg().write(messaging.VehicleConfigMsgPayload(ISCPntB_B=np.diag(INERTIA).flatten()))
    wheels = factory.getConfigMessage()
    navigation.scStateInMsg.subscribeTo(craft.scStateOutMsg)
    error.attNavInMsg.subscribeTo(navigation.attOutMsg)
    error.attRefInMsg.subscribeTo(guidance.attRefOutMsg)
    law.guidInMsg.subscribeTo(error.attGuidOutMsg)
    law.vehConfigInMsg.subscribeTo(configuration)
    law.rwParamsInMsg.subscribeTo(wheels)
    law.rwSpeedsInMsg.subscribeTo(effector.rwSpeedOutMsg)
    allocation.rwParamsInMsg.subscribeTo(wheels)
    allocation.vehControlInMsg.subscribeTo(law.cmdTorqueOutMsg)
    if has_voltage:
        voltage = rwMotorVoltage.rwMotorVoltage()
        voltage.VMin, voltage.VMax = 0.0, 10.0
        add(voltage)
        voltage.torqueInMsg.subscribeTo(allocation.rwMotorTorqueOutMsg)
        voltage.rwParamsInMsg.subscribeTo(wheels)
        motors.motorVoltageInMsg.subscribeTo(voltage.voltageOutMsg)
        effector.rwMotorCmdInMsg.subscribeTo(motors.motorTorqueOutMsg)
    else:
        effector.rwMotorCmdInMsg.subscribeTo(allocation.rwMotorTorqueOutMsg)

    every = macros.sec2nano(interval)
    states, speeds = craft.scStateOutMsg.recorder(every), effector.rwSpeedOutMsg.recorder(every)
    commands = allocation.rwMotorTorqueOutMsg.recorder(every)
    torques = [message.recorder(every) for message in effector.rwOutMsgs]
    # a recorder more than are read: as many as the scenario has
    for recorder in (states, speeds, commands, error.attGuidOutMsg.recorder(every), *torques):
        add(recorder)
    simulation.InitializeSimulation()
    ready = time.process_time()
    simulation.ConfigureStopTime(macros.sec2nano(DURATION))
    simulation.ExecuteSimulation()
    done = time.process_time()
    found = {"times": states.times() * macros.NANO2SEC, "mrp": np.array(states.sigma_BN), "omega": np.array(states.omega_BN_B),
             "wheels": np.array(speeds.wheelSpeeds)[:, :3], "commanded": np.array(commands.motorTorque)[:, :3],
             "applied": np.transpose([torque.u_current for torque in torques])}
    return found, done - ready, time.process_time() - start


# ---- the loop again, by other equations

def discrete_loop(delay, limit, steps=4):
    """The same loop with a delay of so many periods, in plain Python: MRP, rates, wheel rates at the recorded times.

    K omega' = H x omega - tau, h_i' = tau_i, q' = q omega/2 with H = K omega + h, K = diag(INERTIA) - Js and h_i = Js (Omega_i +
    omega_i); tau is held over a period. RK4 with `steps` steps a period: with twice as many the results change by 1.4e-13.
    """
    k = [j - WHEEL_INERTIA for j in INERTIA]
    size = 1.0 + sum(s * s for s in SIGMA)
    state = [*OMEGA, (2.0 - size) / size, *(2.0 * s / size for s in SIGMA)]
    held = [WHEEL_INERTIA * (rpm * math.pi / 30.0 + w) for rpm, w in zip(WHEEL_RPM, OMEGA)]

    def slope(s, h, tau):
        x, y, z, q0, q1, q2, q3 = s
        a, b, c = k[0] * x + h[0], k[1] * y + h[1], k[2] * z + h[2]
        return ((b * z - c * y - tau[0]) / k[0], (c * x - a * z - tau[1]) / k[1], (a * y - b * x - tau[2]) / k[2],
                -0.5 * (q1 * x + q2 * y + q3 * z), 0.5 * (q0 * x + q2 * z - q3 * y),
                0.5 * (q0 * y + q3 * x - q1 * z), 0.5 * (q0 * z + q1 * y - q2 * x))

    dt = PERIOD / steps
    queue = [(0.0, 0.0, 0.0)] * delay
    found = {name: [] for name in MEASURES}
    per_point = round(INTERVAL / PERIOD)
    for tick in range(round(DURATION / PERIOD) + 1):
        omega, q = state[:3], state[3:]
        side = 1.0 if q[0] >= 0.0 else -1.0
        mrp = [side * part / (1.0 + side * q[0]) for part in q[1:]]
        if tick % per_point == 0:
            values = (mrp, omega, [h / WHEEL_INERTIA - w for h, w in zip(held, omega)])
            for name, value in zip(MEASURES, values):
                found[name].append(value)
        # on the wheels: the opposite of the torque on the body
        wanted = [STIFFNESS * s + DAMPING * w for s, w in zip(mrp, omega)]
        queue.append([max(-limit, min(limit, u)) for u in wanted])
        tau = queue.pop(0)
        for _ in range(steps):
            at = lambda share: [h + share * dt * u for h, u in zip(held, tau)]
            moved = lambda slope, share: [s + share * dt * d for s, d in zip(state, slope)]
            k1 = slope(state, held, tau)
            k2 = slope(moved(k1, 0.5), at(0.5), tau)
            k3 = slope(moved(k2, 0.5), at(0.5), tau)
            k4 = slope(moved(k3, 1.0), at(1.0), tau)
            state = [s + dt / 6.0 * (a + 2.0 * b + 2.0 * c + d) for s, a, b, c, d in zip(state, k1, k2, k3, k4)]
            held = at(1.0)
    return {name: np.array(values) for name, values in found.items()}


def difference(one, other):
    return {name: float(np.abs(one[name] - other[name]).max() / np.abs(other[name]).max()) for name in MEASURES}


def shown(differences):
    return ", ".join(f"{name} {value:.1e}" for name, value in differences.items())


# ---- the steps

def history(options):
    """Measures the delay of each case; compares with the file, or writes it."""
    found, wrong = {}, []
    for case, (is_limited, _, expected) in CASES.items():
        every, *_ = basilisk_run(case, tolerance=1e-13, interval=PERIOD)
        run = {name: every[name][::round(INTERVAL / PERIOD)] for name in ("times", *MEASURES)}
        # what the wheels report at a tick acted until then
        found[case] = run | {"commanded": every["commanded"][:3], "applied": every["applied"][1:4],
                             "largest": np.abs(every["applied"]).max(axis=0)}
        print(f"== {case}: Basilisk with RKF78 at 1e-13 against our discrete loop")
        apart = [difference(discrete_loop(delay, TORQUE_LIMIT if is_limited else math.inf), run) for delay in range(3)]
        for delay, one in enumerate(apart):
            print(f"   delay of {delay} periods: {shown(one)}")
        worst = [max(one.values()) for one in apart]
        if not (worst[expected] < SAME and min(worst[:expected] + worst[expected + 1:]) > 1e-4):
            wrong.append(f"{case}: the delay is not {expected} periods")
        print(f"   motor torques commanded at the first ticks: {found[case]['commanded'].tolist()}")
        print(f"   motor torques that act in the first periods: {found[case]['applied'].tolist()}")
    if options.write:
        write(found)
        print(f"{HISTORY.name}: {HISTORY.stat().st_size} bytes")
    stored, _ = read()
    for case, run in found.items():
        apart = difference(stored[case], run)
        print(f"== {case}: the file against Basilisk {Basilisk.__version__}: {shown(apart)}")
        if max(apart.values()) > SAME:
            wrong.append(f"{case}: the file is not of this Basilisk")
    return wrong


def write(found):
    """The file: what was computed with what, one line per point."""
    about = {
        "source": f"Basilisk {Basilisk.__version__} (PyPI package bsk); examples/scenarioAttitudeFeedbackRW.py of github.com/AVSLab/"
                  "basilisk at commit babdff7 (24 July 2026) without the orbit; written by benches/peers/basilisk_attitude.py --write",
        "integrator": "RKF78, relative tolerance 1e-13, absolute 1e-15, begun again at each tick",
        "order_of_a_tick": "wheels read the command, spacecraft integrates from the last tick to this one, simpleNav, inertial3D, "
                           "attTrackingError, mrpFeedback, rwMotorTorque; with the voltage interface: motorVoltageInterface before "
                           "simpleNav, rwMotorVoltage last",
        "law": "torque on the body u = -K sigma - P omega; motor torque on wheel i is -u_i. The inertia given to mrpFeedback is that of "
               "the hub, which contains the wheels; it has no effect with Ki < 0, controlLawType = 0 and a reference at rest",
        "parameters": {
            "period_s": PERIOD, "duration_s": DURATION, "K_n_m": STIFFNESS, "P_n_m_s": DAMPING, "Ki": -1.0, "mass_kg": MASS,
            "inertia_with_wheels_kg_m2": INERTIA, "sigma_bn": SIGMA, "omega_bn_b_rad_s": OMEGA, "sigma_r0n": [0.0, 0.0, 0.0],
            "wheel_axes": np.eye(3).tolist(), "wheel_axial_inertia_kg_m2": WHEEL_INERTIA, "wheel_rates_rpm": WHEEL_RPM,
            "wheel_model": "Honeywell_HR16, maxMomentum 50, BalancedWheels, no friction",
        },
        "columns": "time_s, mrp sigma_BN (3), omega_BN_B rad/s (3), wheel rates rad/s (3)",
    }
    lines = [f'"{key}": {json.dumps(value)},' for key, value in about.items()]
    numbers = lambda values: "[" + ",".join(f"{value:.14g}" for value in values) + "]"
    cases = []
    for case, (is_limited, has_voltage, delay) in CASES.items():
        run = found[case]
        rows = [numbers([t, *m, *o, *w]) for t, m, o, w in zip(run["times"], run["mrp"], run["omega"], run["wheels"])]
        facts = {"delay_s": delay * PERIOD, "torque_limit_n_m": TORQUE_LIMIT if is_limited else None, "voltage_interface": has_voltage}
        facts |= {f"{name}_in_first_periods_n_m": run[name].tolist() for name in ("commanded", "applied")}
        facts["largest_applied_n_m"] = run["largest"].tolist()
        cases.append(f'"{case}": ' + json.dumps(facts)[:-1] + ', "points": [\n' + ",\n".join(rows) + "\n]}")
    HISTORY.write_text("{\n" + "\n".join(lines) + '\n"cases": {\n' + ",\n".join(cases) + "\n}\n}\n")


def read():
    """The cases of the file, and what it says of each."""
    cases = json.loads(HISTORY.read_text())["cases"]
    points = {case: np.array(facts["points"]) for case, facts in cases.items()}
    parts = {"mrp": slice(1, 4), "omega": slice(4, 7), "wheels": slice(7, 10)}
    return {case: {name: table[:, part] for name, part in parts.items()} | {"times": table[:, 0]}
            for case, table in points.items()}, cases


def speed(options):
    """CPU time of a run of Basilisk with the settings of the scenario."""
    stored, _ = read()
    basilisk_run("limited")  # warm-up
    for case in CASES:
        for orbit in (False, True):
            runs = [basilisk_run(case, orbit=orbit, interval=DURATION / 100) for _ in range(options.repeats)]
            alone, whole = (float(np.median([run[part] for run in runs])) for part in (1, 2))
            print(f"   {case:<10}{'with the orbit' if orbit else 'attitude alone':<16}{alone:.4f} s a run without set-up, {whole:.4f} s "
                  f"with it: {1 / alone:.1f} and {1 / whole:.1f} runs/s")
        run, *_ = basilisk_run(case)
        print(f"   {case:<10}its error against RKF78: {shown(difference(run, stored[case]))}")
    return []


def spindrift(options):
    """`spindrift simulate` of each case against the file; runs per second of a campaign."""
    stored, about = read()
    nominal = tomllib.loads(CAMPAIGN.read_text())
    wrong = []
    for case, truth in stored.items():
        limit = about[case]["torque_limit_n_m"]
        settings = [f"control.delay_s={about[case]['delay_s']}"]
        settings += [f"wheels.{wheel['name']}.torque_limit_n_m={limit}" for wheel in nominal["wheels"] if limit]
        settings = [word for setting in settings for word in ("--set", setting)]
        out = options.scratch / "series.parquet"
        run([options.spindrift, "simulate", CAMPAIGN, "--sample", "0", *settings, "--out", out])
        table = pq.read_table(out).to_pydict()
        assert np.allclose(table["time_s"], truth["times"], rtol=0.0, atol=1e-9), "other times"
        q = np.transpose([table[f"q_es_{c}"] for c in "wxyz"])
        q = np.where(q[:, :1] < 0.0, -q, q)
        ours = {"mrp": q[:, 1:] / (1.0 + q[:, :1]), "omega": np.transpose([table[f"omega_se_s_{c}_rad_s"] for c in "xyz"]),
                "wheels": np.transpose([table[f"rate_{wheel['name']}_rad_s"] for wheel in nominal["wheels"]])}
        apart = difference(ours, truth)
        print(f"   {case:<10}spindrift simulate against Basilisk: {shown(apart)}")
        if not max(apart.values()) <= options.limit:
            wrong.append(f"{case}: spindrift and Basilisk differ by {max(apart.values()):.1e}")
        rates = []
        for _ in range(options.repeats):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            run([options.spindrift, "campaign", CAMPAIGN, *settings, "--samples", str(options.campaign), "--threads", "1",
                 "--overwrite", "--out", options.scratch / "rows"])
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            rates.append(options.campaign / (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime))
        print(f"   {case:<10}a campaign of {options.campaign} samples, everything counted: {np.median(rates):.0f} runs/s")
    return wrong


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


STEPS = {"history": history, "speed": speed, "spindrift": spindrift}


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--spindrift")
    arguments.add_argument("--scratch", type=pathlib.Path, required=True)
    arguments.add_argument("--steps", default=",".join(STEPS), help="which of them, with commas between")
    arguments.add_argument("--write", action="store_true", help="write basilisk_attitude.json")
    arguments.add_argument("--repeats", type=int, default=5, help="runs whose median is the CPU time")
    arguments.add_argument("--campaign", type=int, default=1024, help="samples of the timed campaign")
    arguments.add_argument("--limit", type=float, default=1e-12, help="largest difference that counts as agreement: the campaign's tolerance")
    options = arguments.parse_args()
    options.scratch.mkdir(parents=True, exist_ok=True)
    bskLogging.setDefaultLogLevel(bskLogging.BSK_WARNING)
    print(f"Basilisk {Basilisk.__version__}, numpy {np.__version__}")
    wrong = [message for step in options.steps.split(",") for message in STEPS[step](options)]
    if wrong:
        sys.exit("\n".join(["\nNO AGREEMENT", *wrong]))


if __name__ == "__main__":
    main()
