"""spindrift against Basilisk in the environment of an orbit: gravity gradient, plates in air and sunlight, torque rods, eclipses, one core.

Basilisk: AVS Lab, University of Colorado (PyPI package bsk). The scenes are plates.toml with other tables (CASES). Start, plates and Sun come from
plates.py; spindrift reads the same text. Basilisk's modules: a point mass, GravityGradientEffector, facetDragDynamicEffector with exponentialAtmosphere
and zeroWindModel (air that turns with the Earth), facetSRPDynamicEffector with eclipse, MtbEffector with magneticFieldCenteredDipole; RK4. Its point B is
the centre of mass, whose velocity meets the air in spindrift.

Basilisk reads air, wind, light, shadow and field from messages and holds them over a step of the task: its error is of first order in the step, while
spindrift has them at each instant. Each case runs with steps that are halved, and the limit of no step is extrapolated (L. F. Richardson, 1911).
"Own error at most" is how far the extrapolation is from the one without the smallest step. Where plates turn on and off
or the Sun sets within steps the error is not a series in powers of the step, and falls more slowly.

Three things differ in the equations. For the comparison they are made equal; what they amount to is measured with Basilisk's own (OWN):
  mass    the forces of air and light act on Basilisk's orbit, not on spindrift's. Here its spacecraft has the mass of a mountain, and the same inertia.
  sun     spindrift's light comes from the direction that the Sun has from the Earth's centre, Basilisk's from that seen from the spacecraft. Here the Sun
          of its plates moves with the spacecraft.
  radius  Basilisk's Sun has a radius of 695,000 km, which is compiled in, spindrift's 695,700 km. Here its eclipse module has the Sun nearer to the
          spacecraft on the line of sight, so that it looks as large, and the Earth with spindrift's 6378137 m as a custom planet instead of 6378136.6 m.
Basilisk's pressure of sunlight is (1368 W/m^2)/c at 1 au, which spindrift's file has too. The Sun, the turning Earth and the changes above are messages
of a module in Python (Sky). In the timed runs they are constant, and no Python runs.

The exit code is 1 if a difference is above --limit: attitude (rad), rate (of the largest), position (of the largest), visible share of the Sun.
"""

import argparse
import math
import pathlib
import sys
import time
import tomllib

import Basilisk
import numpy as np
import plates
import pyarrow.parquet as pq
from basilisk import campaign, difference, matrix, run
from Basilisk.architecture import bskLogging, messaging, sysModel
from Basilisk.simulation import (GravityGradientEffector, MtbEffector, eclipse, exponentialAtmosphere, facetDragDynamicEffector,
                                 facetSRPDynamicEffector, magneticFieldCenteredDipole, spacecraft, sphericalHarmonicsGravityModel, svIntegrators, zeroWindModel)
from Basilisk.utilities import SimulationBaseClass, macros, simIncludeGravBody

FLUX, LIGHT = 1368.0, 299792458.0  # facetSRPDynamicEffector.cpp
BASILISK_SUN_RADIUS = 6.95e8  # REQ_SUN of astroConstants.h
MOUNTAIN = 1e12
# IGRF-14, degree 1 at 2025 and its change in a year, nT: g10, g11, h11
IGRF, SECULAR, IGRF_RADIUS = np.array([-29350.0, -1410.3, 4545.5]), np.array([12.6, 10.0, -21.5]), 6371200.0
AIR = "drag = true\nbase_density_kg_m3 = 1e-11\nbase_height_m = 200e3\nscale_height_m = 55e3\n"
SUNLIGHT = f"solar_pressure = true\nsolar_pressure_n_m2 = {FLUX / LIGHT!r}\n"
ROD = 'magnetic_field = "dipole"\nmagnetic_dipole_a_m2 = [0.3, -0.2, 0.5]\n'
# the start of plates.toml; cases with FACING have others: s1 along the flow and turning with the orbit, or slow and s1 to the Sun (cosines above 0.8)
TUMBLING = "attitude = [0.5, 0.5, -0.5, 0.5]\nangular_velocity_rad_s = [0.004, -0.0025, 0.001]\n"
FACING = """
[[plates]]
name = "one"
area_m2 = 0.8
normal = [1.0, 0.3, -0.2]
center_m = [-0.4, 0.06, 0.05]
specular = 0.3
diffuse = 0.2

[[plates]]
name = "two"
area_m2 = 1.1
normal = [1.0, -0.4, 0.3]
center_m = [-0.3, -0.05, 0.08]
diffuse = 0.4
"""
ELLIPTIC = {'"6900 km"': '"9600 km"', "eccentricity = 0.004": "eccentricity = 0.28"}


def initial(attitude, omega):
    return {TUMBLING: f"attitude = {attitude}\nangular_velocity_rad_s = {omega}\n"}


SMOOTH, SWITCHING = (1.0, 0.5, 0.25, 0.125), (0.125, 0.0625, 0.03125)
# name: what replaces text of plates.toml, the table [environment], the plates (None: those of plates.toml), Basilisk's steps in s
CASES = {
    "gravity gradient, elliptic orbit": (ELLIPTIC, "gravity_gradient = true\n", "", SMOOTH),
    "drag, plates always on": (initial([0.82819056, -0.21504163, -0.33804201, 0.39189933], [0.0, -0.00111, 0.0]), AIR, FACING, SMOOTH),
    "drag, tumbling": ({}, AIR, None, SWITCHING),
    "sunlight and eclipse, plates always on": (initial([0.28092414, -0.43149426, 0.84517714, -0.14342219], [0.0001, 0.00005, -0.00008]),
                                               SUNLIGHT, FACING, SWITCHING),
    "sunlight and eclipse, tumbling": ({}, SUNLIGHT, None, SWITCHING),
    "torque rods": ({}, ROD, "", SMOOTH),
    "all of them, tumbling": ({}, "gravity_gradient = true\n" + AIR + SUNLIGHT + ROD, None, (0.25, *SWITCHING)),
}
# what Basilisk has of its own, the case in which it is measured
OWN = [("mass", "drag, tumbling"), ("sun", "sunlight and eclipse, tumbling"), ("radius", "sunlight and eclipse, tumbling")]
ECLIPSES = {
    "eclipse fraction": {},
    "eclipse fraction, elliptic orbit": ELLIPTIC,
    "eclipse fraction, edge of the shadow": {'"51.6 deg"': '"60 deg"', '"40 deg"': '"127 deg"', "eccentricity = 0.004": "eccentricity = 0.0"},
}


# ---- a case as text for spindrift, and as numbers for Basilisk

def text_of(replaced, environment, own_plates):
    """The campaign file of a case."""
    text = pathlib.Path(plates.__file__).with_name("plates.toml").read_text()
    for old, new in replaced.items():
        assert old in text, old
        text = text.replace(old, new)
    head, rest = text.split("[environment]\n")
    return head + "[environment]\n" + environment + (rest[rest.index("\n[[plates]]"):] if own_plates is None else own_plates)


class Case:
    """A campaign file as Basilisk needs it."""

    def __init__(self, text):
        self.file = tomllib.loads(text)
        self.scene = plates.Scene(text, coupled=False)
        self.environment = self.file["environment"]
        self.duration, self.points = self.file["campaign"]["duration_s"], self.file["observe"]["points"]
        year = int(self.file["orbit"]["epoch"][:4])
        begin, end = (plates.days(f"{y}-01-01T00:00:00Z") for y in (year, year + 1))
        self.dipole = 1e-9 * (IGRF + (year + (self.scene.epoch - begin) / (end - begin) - 2025.0) * SECULAR)

    def meridian(self, seconds):
        """Angle from e1 to the meridian of Greenwich, rad: Earth rotation angle (N. Capitaine et al., 2000, eq. 14) and precession (Capitaine,
        Wallace & Chapront, 2003, eq. 42), which goes on at the rate of J2000."""
        days, centuries = self.scene.epoch, self.scene.epoch / 36525.0
        turns = 0.7790572732640 + days % 1.0 + 0.00273781191135448 * days
        arcsec = 0.014506 + 4612.156534 * centuries + 1.3915817 * centuries**2 - 0.00000044 * centuries**3
        rate = (1.00273781191135448 + 4612.156534 / (1296000.0 * 36525.0)) / 86400.0
        return 2.0 * math.pi * (turns + arcsec / 1296000.0 + rate * seconds)


class Sky(sysModel.SysModel):
    """Messages of the Earth and of the Sun at each tick, from the state at this tick."""

    def __init__(self, case, craft, own):
        super().__init__()
        self.case, self.own = case, own
        self.state = craft.scStateOutMsg.addSubscriber()
        self.planet, self.light, self.shadow = (messaging.SpicePlanetStateMsg() for _ in range(3))
        self.UpdateState(0)

    def UpdateState(self, now):
        seconds = now * macros.NANO2SEC
        angle = self.case.meridian(seconds)
        c, s = math.cos(angle), math.sin(angle)
        self.planet.write(messaging.SpicePlanetStateMsgPayload(PlanetName="earth" if "radius" in self.own else "custom",
                                                              J20002Pfix=[[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]), now)
        place = np.array(self.state().r_BN_N) if self.state.isWritten() else self.case.scene.state[:3]
        sun = plates.sun(self.case.scene.epoch + seconds / 86400.0)
        near = place + BASILISK_SUN_RADIUS / plates.SUN_RADIUS * (sun - place)
        for message, vector in ((self.light, sun if "sun" in self.own else sun + place), (self.shadow, sun if "radius" in self.own else near)):
            message.write(messaging.SpicePlanetStateMsgPayload(PlanetName="sun", PositionVector=vector.tolist()), now)


def basilisk_run(case, step, own=(), moving=True, loop=None):
    """One run of Basilisk: states at the points, visible share of the Sun at every tick (with sunlight), CPU seconds of the execution alone.

    Within a tick the spacecraft comes first; then the modules of the environment write for its state what it has during the next step.
    `loop` adds a control loop: called with the simulation, its process, the spacecraft and the module of the field, it has the rates of its wheels.
    """
    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("process")
    process.addTask(simulation.CreateNewTask("task", macros.sec2nano(step)), 2)
    column = lambda vector: np.reshape(vector, (3, 1)).tolist()
    scene, environment = case.scene, case.environment
    position, velocity, q, omega = np.split(scene.state, [3, 6, 10])

    craft = spacecraft.Spacecraft()
    craft.ModelTag = "craft"
    craft.hub.mHub = case.file["body"]["mass_kg"] if "mass" in own else MOUNTAIN
    craft.hub.r_BcB_B, craft.hub.IHubPntBc_B = column([0.0, 0.0, 0.0]), scene.inertia.tolist()
    craft.hub.r_CN_NInit, craft.hub.v_CN_NInit = column(position), column(velocity)
    q = q / np.linalg.norm(q)
    craft.hub.sigma_BNInit, craft.hub.omega_BN_BInit = column(q[1:] / (1.0 + q[0])), column(omega)
    method = svIntegrators.svIntegratorRK4(craft)
    craft.setIntegrator(method)
    bodies = simIncludeGravBody.gravBodyFactory()
    earth = bodies.createCustomGravObject("earth", plates.MU, radEquator=plates.RADIUS)
    earth.isCentralBody = True
    if "j2" in case.file["orbit"]:
        harmonics = earth.gravityModel = sphericalHarmonicsGravityModel.SphericalHarmonicsGravityModel()
        harmonics.maxDeg, harmonics.muBody, harmonics.radEquator = 2, plates.MU, plates.RADIUS
        harmonics.cBar = [[1.0], [0.0, 0.0], [-case.file["orbit"]["j2"] / math.sqrt(5.0), 0.0, 0.0]]
        harmonics.sBar = [[0.0], [0.0, 0.0], [0.0, 0.0, 0.0]]
    bodies.addBodiesTo(craft)
    simulation.AddModelToTask("task", craft, 9)

    sky = Sky(case, craft, own)
    sky.ModelTag = "sky"
    kept = [method, bodies, sky]
    if moving and ("solar_pressure" in environment or "magnetic_field" in environment):
        simulation.AddModelToTask("task", sky, 8)

    def add(module, tag, priority, is_effector):
        module.ModelTag = tag
        simulation.AddModelToTask("task", module, priority)
        if is_effector:
            craft.addDynamicEffector(module)
        else:
            module.addSpacecraftToModel(craft.scStateOutMsg)
        kept.append(module)
        return module

    if environment.get("gravity_gradient"):
        add(GravityGradientEffector.GravityGradientEffector(), "gradient", 1, True).addPlanetName(earth.planetName)
    if environment.get("drag"):
        air = add(exponentialAtmosphere.ExponentialAtmosphere(), "air", 7, False)
        air.planetRadius, air.scaleHeight = plates.RADIUS, environment["scale_height_m"]
        air.baseDensity = environment["base_density_kg_m3"] * math.exp(environment["base_height_m"] / environment["scale_height_m"])
        wind = add(zeroWindModel.ZeroWindModel(), "wind", 6, False)
        wind.setPlanetOmega_N([0.0, 0.0, plates.EARTH_RATE])
        wind.planetPosInMsg.subscribeTo(sky.planet)
        drag = add(facetDragDynamicEffector.FacetDragDynamicEffector(), "drag", 1, True)
        for area, normal, arm, coefficient, *_ in scene.plates:
            drag.addFacet(area, coefficient, normal, arm)
        drag.atmoDensInMsg.subscribeTo(air.envOutMsgs[0])
        drag.windVelInMsg.subscribeTo(wind.envOutMsgs[0])
    shares = None
    if environment.get("solar_pressure"):
        shadow = add(eclipse.Eclipse(), "shadow", 5, False)
        shadow.sunInMsg.subscribeTo(sky.shadow)
        shadow.addPlanetToModel(sky.planet)
        shadow.rEqCustom = plates.RADIUS
        light = add(facetSRPDynamicEffector.FacetSRPDynamicEffector(), "light", 1, True)
        light.setNumFacets(len(scene.plates))
        light.setNumArticulatedFacets(0)
        for area, normal, arm, _, specular, diffuse in scene.plates:
            light.addFacet(area, np.eye(3), normal, np.array([1.0, 0.0, 0.0]), arm, diffuse, specular)
        light.sunInMsg.subscribeTo(sky.light)
        light.sunEclipseInMsg.subscribeTo(shadow.eclipseOutMsgs[0])
        shares = shadow.eclipseOutMsgs[0].recorder() if moving else None
    if "magnetic_field" in environment:
        field = add(magneticFieldCenteredDipole.MagneticFieldCenteredDipole(), "field", 4, False)
        field.planetRadius = IGRF_RADIUS
        field.g10, field.g11, field.h11 = case.dipole
        field.planetPosInMsg.subscribeTo(sky.planet)
        rods = add(MtbEffector.MtbEffector(), "rods", 1, True)
        moments = environment["magnetic_dipole_a_m2"]
        setup = messaging.MTBArrayConfigMsg().write(messaging.MTBArrayConfigMsgPayload(
            numMTB=3, GtMatrix_B=np.eye(3).flatten().tolist(), maxMtbDipoles=[10.0] * 3))
        command = messaging.MTBCmdMsg().write(messaging.MTBCmdMsgPayload(mtbDipoleCmds=moments))
        kept += [setup, command]
        rods.mtbParamsInMsg.subscribeTo(setup)
        rods.mtbCmdInMsg.subscribeTo(command)
        rods.magInMsg.subscribeTo(field.envOutMsgs[0])
    flight = loop(simulation, process, craft, field) if loop else None

    every = macros.sec2nano(case.duration / (case.points - 1))
    states = craft.scStateOutMsg.recorder(every)
    for recorder in filter(None, (states, shares)):
        simulation.AddModelToTask("task", recorder)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(case.duration))
    begin = time.process_time()
    simulation.ExecuteSimulation()
    spent = time.process_time() - begin

    assert np.array_equal(states.times(), every * np.arange(case.points)), states.times()
    sigma = np.array(states.sigma_BN)
    square = (sigma * sigma).sum(axis=1, keepdims=True)
    found = {"omega": np.array(states.omega_BN_B), "attitude": np.hstack([1 - square, 2 * sigma]) / (1 + square),
             "position": np.array(states.r_BN_N)}
    if loop:
        found["wheels"] = flight.rates()
    return {key: value[None] for key, value in found.items()}, None if shares is None else np.array(shares.illuminationFactor), spent


# ---- the comparison

def spindrift_states(options, case, file, folder):
    """The states of `spindrift simulate`, the position that of the centre of mass."""
    run([options.spindrift, "simulate", file, "--sample", "0", "--out", folder / "states.parquet"])
    table = pq.read_table(folder / "states.parquet").to_pydict()
    columns = lambda pattern, parts: np.transpose([table[pattern.format(part)] for part in parts])
    attitude = columns("q_es_{}", "wxyz")
    center = np.array([matrix(q) @ case.file["body"]["center_of_mass_m"] for q in attitude])
    found = {"omega": columns("omega_se_s_{}_rad_s", "xyz"), "attitude": attitude, "position": columns("r_po_e_{}_m", "xyz") + center}
    return {key: value[None] for key, value in found.items()}


def extrapolated(runs):
    """The limit of no step, from runs whose steps are halved: an error of powers 1, 2, 3 ... of the step."""
    sides = [np.sign((r["attitude"] * runs[-1]["attitude"]).sum(axis=-1, keepdims=True)) for r in runs]
    runs = [r | {"attitude": side * r["attitude"]} for r, side in zip(runs, sides)]
    for order in range(1, len(runs)):
        runs = [{key: fine[key] + (fine[key] - coarse[key]) / (2**order - 1) for key in fine} for coarse, fine in zip(runs, runs[1:])]
    return runs[0]


def compare(options, name):
    """One case. Returns what is wrong."""
    folder, (*texts, steps) = options.scratch, CASES[name]
    text = text_of(*texts)
    file = folder / "environment.toml"
    file.write_text(text)
    case = Case(text)
    ours = spindrift_states(options, case, file, folder)
    largest = float(np.linalg.norm(ours["omega"], axis=-1).max())
    print(f"\n== {name}")
    runs = [basilisk_run(case, step)[0] for step in steps]
    limit, coarse = extrapolated(runs), runs[0] if steps[0] == 1.0 else basilisk_run(case, 1.0)[0]
    apart = difference(limit, ours)
    free = basilisk_run(Case(text_of(texts[0], "", "")), 1.0)[0]
    lines = [("without these torques", difference(free, ours)), ("Basilisk at 1 s", difference(coarse, ours)),
             (f"at {steps[-1]} s", difference(runs[-1], ours)), ("extrapolated", apart),
             ("own error at most", difference(limit, extrapolated(runs[:-1])))]
    lines += [(f"with Basilisk's {own}", difference(basilisk_run(case, 1.0, own={own})[0], coarse)) for own, where in OWN if where == name]
    for what, errors in lines:
        print(f"   {what:<23} attitude {errors['attitude']:.1e} rad, rate {errors['omega'] * largest:.1e} rad/s ({errors['omega']:.1e}), "
              f"position {errors['position']:.1e}")
    if options.repeats:
        theirs = 1.0 / float(np.median([basilisk_run(case, 1.0, moving=False)[2] for _ in range(options.repeats)]))
        rate = float(np.median(campaign(options, file, folder)))
        print(f"   runs/s of one core: Basilisk at 1 s {theirs:.1f} (its execution alone), spindrift {rate:.0f} (everything counted), "
              f"ratio {rate / theirs:.0f}")
    return [f"{name}: {key} differs by {value:.1e}" for key, value in apart.items() if not value <= options.limit]


def eclipses(options, name):
    """The share of the Sun that the Earth hides, in one revolution: at 257 points, and its mean of every second. Returns what is wrong."""
    folder, file = options.scratch / "eclipse", options.scratch / "eclipse.toml"
    text = text_of(ECLIPSES[name], SUNLIGHT, FACING)
    semi_major_axis = plates.number(tomllib.loads(text)["orbit"]["semi_major_axis_m"])
    period = round(2.0 * math.pi * math.sqrt(semi_major_axis**3 / plates.MU))
    text = text.replace("duration_s = 6000.0", f"duration_s = {period}.0").replace("points = 61", f"points = {period + 1}")
    text += "\n[bands]\npoints = 257\n"
    file.write_text(text)
    run([options.spindrift, "campaign", file, "--samples", "1", "--threads", "1", "--overwrite", "--out", folder])
    bands = pq.read_table(folder / "bands.parquet", filters=[("series", "=", "sun_hidden_fraction")]).to_pydict()
    ticks, hidden = np.rint(bands["time_s"]).astype(int), np.array(bands["nominal"])
    (fraction,) = pq.read_table(folder / "runs")["eclipse_fraction"].to_pylist()
    theirs, own = (1.0 - basilisk_run(Case(text), 1.0, own=which)[1] for which in ((), {"radius"}))
    apart = {"share": float(np.abs(hidden - theirs[ticks]).max()), "fraction": abs(fraction - float(theirs.mean()))}
    partial = [int(((0.0 < h) & (h < 1.0)).sum()) for h in (hidden, theirs)]
    print(f"\n== {name}: {fraction:.6f} of {period} s; in part shadow {partial[1]} s, {partial[0]} of {len(ticks)} points")
    print(f"   hidden share of the Sun {apart['share']:.1e}, eclipse fraction {apart['fraction']:.1e}")
    print(f"   with Basilisk's own radius {np.abs(hidden - own[ticks]).max():.1e}, {abs(fraction - own.mean()):.1e}")
    return [f"{name}: the {what} differs by {value:.1e}" for what, value in apart.items() if not value <= options.limit]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--spindrift", required=True)
    arguments.add_argument("--scratch", type=pathlib.Path, required=True)
    arguments.add_argument("--cases", default="", help="only the cases whose name contains this")
    arguments.add_argument("--repeats", type=int, default=5, help="timed runs of each, whose median counts; 0 for none")
    arguments.add_argument("--campaign", type=int, default=1024, help="samples of the timed campaign")
    arguments.add_argument("--limit", type=float, default=1e-8, help="largest difference that counts as agreement")
    options = arguments.parse_args()
    options.scratch.mkdir(parents=True, exist_ok=True)
    bskLogging.setDefaultLogLevel(bskLogging.BSK_WARNING)
    print(f"Basilisk {Basilisk.__version__}, numpy {np.__version__}; differences are those from spindrift, the largest of the points")
    steps = [(step, name) for step, names in ((compare, CASES), (eclipses, ECLIPSES)) for name in names if options.cases in name]
    if not steps:
        sys.exit(f"no case has {options.cases} in its name")
    wrong = [message for step, name in steps for message in step(options, name)]
    if wrong:
        sys.exit("\n".join([f"\nNO AGREEMENT to {options.limit:.0e}", *wrong]))
    print(f"\nagreement to {options.limit:.0e} in every case")


if __name__ == "__main__":
    main()
