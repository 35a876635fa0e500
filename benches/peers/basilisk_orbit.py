"""spindrift against Basilisk on a control loop in orbit: a CubeSat at nadir, four wheels that torque rods unload.

The scene is basilisk_orbit.toml: J2, gravity gradient, drag and light on two plates, shadow, dipole field, a residual
dipole; 22,720 ticks of 0.25 s. Basilisk's environment is that of basilisk_environment.py, its loop its own modules:
simpleNav without errors, hillPoint, attTrackingError, mrpFeedback, magnetometer, mtbMomentumManagementSimple,
torque2Dipole, dipoleMapping, mtbFeedforward, rwMotorTorque, BalancedWheels with a limit of torque, MtbEffector. They
run in a task of the loop's period, after the task of the spacecraft, whose steps are halved and extrapolated, since
Basilisk holds field, density and light over a step.

Two things are made equal: hillPoint's angular acceleration of the frame, which spindrift's law takes as zero, is set
to zero (Reference); mrpFeedback gets the inertia without what turns with the wheels, whose momentum it adds. In the
timed runs no Python runs, and Sun and Earth are at rest.

The exit code is 1 if a difference is above --limit: attitude (rad), rates, wheel rates, position (of their largest).
"""

import argparse
import pathlib
import sys

import Basilisk
import cpu_time
import numpy as np
import pyarrow.parquet as pq
from basilisk import difference
from basilisk_environment import Case, basilisk_run, extrapolated, spindrift_states
from Basilisk.architecture import bskLogging, messaging, sysModel
from Basilisk.fswAlgorithms import (
    attTrackingError,
    dipoleMapping,
    hillPoint,
    mrpFeedback,
    mtbFeedforward,
    mtbMomentumManagementSimple,
    rwMotorTorque,
    tamComm,
    torque2Dipole,
)
from Basilisk.simulation import MtbEffector, magnetometer, reactionWheelStateEffector, simpleNav
from Basilisk.utilities import RigidBodyKinematics, macros, simIncludeRW

CAMPAIGN = pathlib.Path(__file__).with_name("basilisk_orbit.toml")
STEPS = (0.25, 0.125, 0.0625, 0.03125)


class Reference(sysModel.SysModel):
    """The message of hillPoint with no angular acceleration."""

    def __init__(self, hill):
        super().__init__()
        self.hill, self.out = hill, messaging.AttRefMsg()

    def UpdateState(self, now):
        payload = self.hill.attRefOutMsg.read()
        payload.domega_RN_N = [0.0, 0.0, 0.0]
        self.out.write(payload, now, self.moduleID)


def loop_of(case, moving, kept):
    """What `basilisk_run` calls to add the loop; the modules stay in `kept`."""

    def build(simulation, process, craft, field):
        file = case.file
        control, law_keys = file["control"], file["guidance"][0]
        process.addTask(simulation.CreateNewTask("flight", macros.sec2nano(control["period_s"])), 1)
        factory = simIncludeRW.rwFactory()
        axes = np.array([np.array(wheel["axis"]) / np.linalg.norm(wheel["axis"]) for wheel in file["wheels"]])
        axial = [wheel["axial_inertia_kg_m2"] for wheel in file["wheels"]]
        for wheel, axis in zip(file["wheels"], axes):
            factory.create(
                "custom",
                axis.tolist(),
                Js=wheel["axial_inertia_kg_m2"],
                Omega=float(wheel["rate_rad_s"].split()[0]),
                Omega_max=1e5,
                u_max=wheel["torque_limit_n_m"],
                useMaxTorque=True,
                RWModel=messaging.BalancedWheels,
            )
        effector = reactionWheelStateEffector.ReactionWheelStateEffector()
        factory.addToSpacecraft("wheels", effector, craft)
        simulation.AddModelToTask("task", effector, 10)
        rods = MtbEffector.MtbEffector()
        rods.ModelTag = "driven"
        craft.addDynamicEffector(rods)
        simulation.AddModelToTask("task", rods, 1)

        navigation, hill, error = simpleNav.SimpleNav(), hillPoint.hillPoint(), attTrackingError.attTrackingError()
        law, compass, unload = (
            mrpFeedback.mrpFeedback(),
            magnetometer.Magnetometer(),
            mtbMomentumManagementSimple.mtbMomentumManagementSimple(),
        )
        tam, dipole, mapping = tamComm.tamComm(), torque2Dipole.torque2Dipole(), dipoleMapping.dipoleMapping()
        forward, allocation = mtbFeedforward.mtbFeedforward(), rwMotorTorque.rwMotorTorque()
        reference = Reference(hill)
        modules = [
            navigation,
            hill,
            *([reference] if moving else []),
            error,
            law,
            compass,
            tam,
            unload,
            dipole,
            mapping,
            forward,
            allocation,
        ]
        tam.dcm_BS = np.eye(3).flatten().tolist()
        for i, module in enumerate(modules):
            module.ModelTag = f"flight {i}"
            simulation.AddModelToTask("flight", module, 100 - i)

        # from the frame of Hill, up, ahead and across, to F_o
        error.sigma_R0R = (
            -RigidBodyKinematics.C2MRP(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]]))
        ).tolist()
        law.K, law.P, law.Ki = law_keys["stiffness_n_m"], law_keys["damping_n_m_s"], -1.0
        unload.Kp = 1.0 / law_keys["rod_unloading_time_s"]
        mapping.steeringMatrix = np.eye(3).flatten().tolist()
        allocation.controlAxes_B = np.eye(3).flatten().tolist()
        inertia = np.array(file["body"]["inertia_kg_m2"]) - (axes.T * axial) @ axes
        setup = messaging.VehicleConfigMsg().write(
            messaging.VehicleConfigMsgPayload(ISCPntB_B=inertia.flatten().tolist())
        )
        wheels = factory.getConfigMessage()
        magnets = messaging.MTBArrayConfigMsg().write(
            messaging.MTBArrayConfigMsgPayload(
                numMTB=3,
                GtMatrix_B=np.eye(3).flatten().tolist(),
                maxMtbDipoles=[rod["max_dipole_a_m2"] for rod in file["torque_rods"]],
            )
        )

        navigation.scStateInMsg.subscribeTo(craft.scStateOutMsg)
        hill.transNavInMsg.subscribeTo(navigation.transOutMsg)
        error.attNavInMsg.subscribeTo(navigation.attOutMsg)
        error.attRefInMsg.subscribeTo(reference.out if moving else hill.attRefOutMsg)
        law.guidInMsg.subscribeTo(error.attGuidOutMsg)
        law.vehConfigInMsg.subscribeTo(setup)
        law.rwParamsInMsg.subscribeTo(wheels)
        law.rwSpeedsInMsg.subscribeTo(effector.rwSpeedOutMsg)
        compass.stateInMsg.subscribeTo(craft.scStateOutMsg)
        compass.magInMsg.subscribeTo(field.envOutMsgs[0])
        tam.tamInMsg.subscribeTo(compass.tamDataOutMsg)
        unload.rwParamsInMsg.subscribeTo(wheels)
        unload.rwSpeedsInMsg.subscribeTo(effector.rwSpeedOutMsg)
        dipole.tamSensorBodyInMsg.subscribeTo(tam.tamOutMsg)
        dipole.tauRequestInMsg.subscribeTo(unload.tauMtbRequestOutMsg)
        mapping.dipoleRequestBodyInMsg.subscribeTo(dipole.dipoleRequestOutMsg)
        mapping.mtbArrayConfigParamsInMsg.subscribeTo(magnets)
        forward.dipoleRequestMtbInMsg.subscribeTo(mapping.dipoleRequestMtbOutMsg)
        forward.tamSensorBodyInMsg.subscribeTo(tam.tamOutMsg)
        forward.mtbArrayConfigParamsInMsg.subscribeTo(magnets)
        forward.vehControlInMsg.subscribeTo(law.cmdTorqueOutMsg)
        allocation.rwParamsInMsg.subscribeTo(wheels)
        allocation.vehControlInMsg.subscribeTo(forward.vehControlOutMsg)
        effector.rwMotorCmdInMsg.subscribeTo(allocation.rwMotorTorqueOutMsg)
        rods.mtbParamsInMsg.subscribeTo(magnets)
        rods.mtbCmdInMsg.subscribeTo(mapping.dipoleRequestMtbOutMsg)
        rods.magInMsg.subscribeTo(field.envOutMsgs[0])
        speeds = effector.rwSpeedOutMsg.recorder(macros.sec2nano(case.duration / (case.points - 1)))
        simulation.AddModelToTask("task", speeds)
        kept.extend([modules, factory, effector, rods, setup, wheels, magnets, speeds])
        build.rates = lambda: np.array(speeds.wheelSpeeds)[:, : len(axes)]
        return build

    return build


def theirs(case, step, moving=True):
    kept = []
    states, _, spent = basilisk_run(case, step, moving=moving, loop=loop_of(case, moving, kept))
    return states, spent


def marginal(options, file, folder):
    """CPU seconds of a further run of a campaign: between one and two times --campaign samples."""
    spent = [cpu_time.campaign(options.spindrift, file, folder, factor * options.campaign) for factor in (1, 2)]
    return (spent[1] - spent[0]) / options.campaign


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--spindrift", required=True)
    arguments.add_argument("--scratch", type=pathlib.Path, required=True)
    arguments.add_argument(
        "--repeats", type=int, default=5, help="timed runs of each, alternating, whose medians count; 0 for none"
    )
    arguments.add_argument("--campaign", type=int, default=256, help="samples of the timed campaign")
    arguments.add_argument("--limit", type=float, default=1e-9, help="largest difference that counts as agreement")
    options = arguments.parse_args()
    options.scratch.mkdir(parents=True, exist_ok=True)
    bskLogging.setDefaultLogLevel(bskLogging.BSK_WARNING)
    case = Case(CAMPAIGN.read_text())
    ticks = round(case.duration / case.file["control"]["period_s"])
    print(
        f"Basilisk {Basilisk.__version__}, numpy {np.__version__}; differences are those from spindrift, "
        f"the largest of {case.points} points"
    )
    ours = spindrift_states(options, case, CAMPAIGN, options.scratch)
    table = pq.read_table(options.scratch / "states.parquet").to_pydict()
    ours["wheels"] = np.transpose([table[f"rate_{wheel['name']}_rad_s"] for wheel in case.file["wheels"]])[None]
    runs = [theirs(case, step)[0] for step in STEPS]
    limit = extrapolated(runs)
    apart = difference(limit, ours)
    for what, errors in [
        *((f"at {step} s", difference(one, ours)) for step, one in zip(STEPS, runs)),
        ("extrapolated", apart),
        ("own error at most", difference(limit, extrapolated(runs[:-1]))),
    ]:
        print(f"   {what:<18}" + ", ".join(f"{name} {value:.1e}" for name, value in errors.items()))
    if options.repeats:
        spent = [
            (theirs(case, STEPS[0], moving=False)[1], marginal(options, CAMPAIGN, options.scratch))
            for _ in range(options.repeats)
        ]
        other, own = (1e6 / ticks * float(np.median(one)) for one in zip(*spent))
        ratios = sorted(a / b for a, b in spent)
        print(
            f"   CPU time a tick: Basilisk (RK4 at {STEPS[0]} s) {other:.1f} us, "
            f"a further run of spindrift's campaign {own:.2f} us; "
            f"ratio {np.median(ratios):.1f} ({ratios[0]:.1f} to {ratios[-1]:.1f})"
        )
    if not max(apart.values()) <= options.limit:
        sys.exit(f"NO AGREEMENT to {options.limit:.0e}")


if __name__ == "__main__":
    main()
