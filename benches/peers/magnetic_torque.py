"""A whole run under the torque of a residual magnetic dipole, by programs that share nothing with spindrift.

SciPy's DOP853 at 1e-13 integrates a two-body orbit and the attitude of a rigid body; the field is that of pyIGRF14, the Earth's angle that of ERFA.
It prints the state at the end, which tests/accuracy/magnetic_torque.rs has as its truth.

    python -m venv venv && venv/bin/pip install numpy scipy pyIGRF14 pyerfa && venv/bin/python benches/peers/magnetic_torque.py
"""

import math

import erfa
import numpy as np
import pyIGRF14.calculate as igrf
from scipy.integrate import solve_ivp

MU = 3.986004418e14
YEAR, MONTH, DAY, DECIMAL_YEAR = 2026, 11, 24, 2026 + 327 / 365
INERTIA = np.array([0.9, 1.2, 0.7])
DIPOLE = np.array([0.3, -0.2, 0.5])
POSITION = [-3.1e6, 4.7e6, 4.2e6]
VELOCITY = [-6.1e3, -4.2e3, 3.0e2]
ATTITUDE = [0.5, -0.5, 0.1, 0.7]
RATE = [0.01, -0.02, 0.015]
DURATION = 6000.0

DATE, MIDNIGHT = erfa.cal2jd(YEAR, MONTH, DAY)
SIDEREAL = erfa.gmst06(DATE, MIDNIGHT, DATE, MIDNIGHT + 69.0 / 86400.0)
TURN = 2.0 * math.pi * (1.00273781191135448 + 4612.156534 / (1296000.0 * 36525.0)) / 86400.0


def field(time, r):
    """The field at `r` (m) in F_e, T."""
    c, s = math.cos(SIDEREAL + TURN * time), math.sin(SIDEREAL + TURN * time)
    x, y, z = c * r[0] + s * r[1], c * r[1] - s * r[0], r[2]
    distance = math.sqrt(x * x + y * y + z * z)
    theta, phi = math.acos(z / distance), math.atan2(y, x)
    north, east, down, _ = igrf.igrf12syn(
        DECIMAL_YEAR, 2, distance / 1e3, 90.0 - math.degrees(theta), math.degrees(phi) % 360.0
    )
    st, ct, sp, cp = math.sin(theta), math.cos(theta), math.sin(phi), math.cos(phi)
    bx = -down * st * cp - north * ct * cp - east * sp
    by = -down * st * sp - north * ct * sp + east * cp
    bz = -down * ct + north * st
    return 1e-9 * np.array([c * bx - s * by, s * bx + c * by, bz])


def slope(time, y):
    r, v, q, omega = y[:3], y[3:6], y[6:10], y[10:]
    w, (x1, x2, x3) = q[0], q[1:]
    to_f_e = np.array([
        [1 - 2 * (x2 * x2 + x3 * x3), 2 * (x1 * x2 - w * x3), 2 * (x1 * x3 + w * x2)],
        [2 * (x1 * x2 + w * x3), 1 - 2 * (x1 * x1 + x3 * x3), 2 * (x2 * x3 - w * x1)],
        [2 * (x1 * x3 - w * x2), 2 * (x2 * x3 + w * x1), 1 - 2 * (x1 * x1 + x2 * x2)],
    ])
    torque = np.cross(DIPOLE, to_f_e.T @ field(time, r))
    turning = np.concatenate([[-q[1:] @ omega], w * omega + np.cross(q[1:], omega)])
    return np.concatenate([
        v,
        -MU / np.dot(r, r) ** 1.5 * r,
        0.5 * turning,
        (torque - np.cross(omega, INERTIA * omega)) / INERTIA,
    ])


def main():
    attitude = np.array(ATTITUDE)
    start = np.concatenate([POSITION, VELOCITY, attitude / np.linalg.norm(attitude), RATE])
    # lengths in m and angles in rad: each has an absolute tolerance of its own
    tolerances = np.concatenate([np.full(3, 1e-7), np.full(3, 1e-10), np.full(4, 1e-14), np.full(3, 1e-16)])
    end = solve_ivp(slope, (0.0, DURATION), start, method="DOP853", rtol=1e-13, atol=tolerances, max_step=20.0).y[:, -1]
    for name, values in [("position", end[:3]), ("attitude", end[6:10]), ("rate", end[10:])]:
        print(name, ", ".join(f"{value:.16e}" for value in values))


if __name__ == "__main__":
    main()
