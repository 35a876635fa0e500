"""spindrift against SciPy: plates in air and sunlight, gravity gradient, the Earth's shadow.

    spindrift simulate benches/peers/plates.toml --sample 0 --out /tmp/plates.parquet
    python benches/peers/plates.py --states /tmp/plates.parquet

With `--set environment.coupled=true` after the first and `--coupled` after the second the forces move the orbit, too. It needs NumPy, SciPy and pyarrow. The scene is read from plates.toml; its equations are written here again, from their sources alone (docs/environment.md):
orbit and rotation together, by DOP853 at 1e-13 with steps of at most --step seconds, for plates that turn on and off. It prints the
largest differences of attitude (rad), rate (rad/s, and relative to the largest) and position (m), and fails where attitude or rate is above --limit, or the position
off by a millimetre.
"""

import argparse
import datetime
import math
import pathlib
import re
import tomllib

import numpy as np
import pyarrow.parquet as pq

MU, RADIUS, SUN_RADIUS, AU, EARTH_RATE = 3.986004418e14, 6378137.0, 6.957e8, 149597870700.0, 7.292115e-5
# D. Vallado, Fundamentals of Astrodynamics and Applications, table 8-4: km, kg/m^3
TABLE = np.array([
    [0, 1.225], [25, 3.899e-2], [30, 1.774e-2], [40, 3.972e-3], [50, 1.057e-3], [60, 3.206e-4], [70, 8.770e-5], [80, 1.905e-5],
    [90, 3.396e-6], [100, 5.297e-7], [110, 9.661e-8], [120, 2.438e-8], [130, 8.484e-9], [140, 3.845e-9], [150, 2.070e-9],
    [180, 5.464e-10], [200, 2.789e-10], [250, 7.248e-11], [300, 2.418e-11], [350, 9.518e-12], [400, 3.725e-12], [450, 1.585e-12],
    [500, 6.967e-13], [600, 1.454e-13], [700, 3.614e-14], [800, 1.170e-14], [900, 5.245e-15], [1000, 3.019e-15]])


def number(value):
    """A number, or a text with a unit."""
    if isinstance(value, str):
        amount, unit = re.fullmatch(r"(\S+) (\S+)", value).groups()
        return float(amount) * {"km": 1e3, "deg": math.pi / 180.0}[unit]
    return value


def days(date):
    """Days from J2000.0 to a date in UTC."""
    moment = datetime.datetime.fromisoformat(date.replace("Z", "+00:00"))
    return (moment - datetime.datetime(2000, 1, 1, 12, tzinfo=datetime.timezone.utc)).total_seconds() / 86400


def turn(angle, axis):
    """The matrix that turns a vector about an axis."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]] if axis == 0 else [[c, -s, 0], [s, c, 0], [0, 0, 1]])


def start_of_orbit(orbit):
    """Position and velocity of elements, by rotations of the plane of the orbit."""
    a, e, f = orbit["semi_major_axis_m"], orbit["eccentricity"], orbit["true_anomaly_rad"]
    p = a * (1 - e * e)
    c = turn(orbit["ascending_node_rad"], 2) @ turn(orbit["inclination_rad"], 0) @ turn(orbit["argument_of_periapsis_rad"], 2)
    r = p / (1 + e * math.cos(f)) * np.array([math.cos(f), math.sin(f), 0])
    v = math.sqrt(MU / p) * np.array([-math.sin(f), e + math.cos(f), 0])
    return c @ r, c @ v


def sun(days):
    """Vector to the Sun, m: the Astronomical Almanac's low-precision series."""
    g, length = math.radians(357.528 + 0.9856003 * days), 280.460 + 0.9856474 * days
    longitude = math.radians(length + 1.915 * math.sin(g) + 0.020 * math.sin(2 * g))
    tilt = math.radians(23.439 - 0.0000004 * days)
    distance = 1.00014 - 0.01671 * math.cos(g) - 0.00014 * math.cos(2 * g)
    return AU * distance * np.array([math.cos(longitude), math.cos(tilt) * math.sin(longitude), math.sin(tilt) * math.sin(longitude)])


def visible(r, s):
    """Share of the Sun's disc that is visible (Montenbruck & Gill, section 3.4.2)."""
    d = s - r
    a, b = math.asin(SUN_RADIUS / np.linalg.norm(d)), math.asin(RADIUS / np.linalg.norm(r))
    c = math.atan2(np.linalg.norm(np.cross(-r, d)), -r @ d)
    if c >= a + b:
        return 1.0
    if c <= b - a:
        return 0.0
    x = (c * c + a * a - b * b) / (2 * c)
    y = math.sqrt(max(0.0, a * a - x * x))
    return 1 - (a * a * math.acos(x / a) + b * b * math.acos((c - x) / b) - c * y) / (math.pi * a * a)


def density(height):
    """Exponential between the heights of the table."""
    return math.exp(np.interp(height / 1e3, TABLE[:, 0], np.log(TABLE[:, 1])))


def dcm(q):
    w, x, y, z = q
    return np.array([
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]]) / (q @ q)


class Scene:
    def __init__(self, text, coupled):
        file = tomllib.loads(text)
        self.inertia = np.array(file["body"]["inertia_kg_m2"])
        self.inverse = np.linalg.inv(self.inertia)
        self.mass, self.coupled = file["body"]["mass_kg"], coupled
        center = self.center = np.array(file["body"]["center_of_mass_m"])
        orbit = {key: number(value) if key != "epoch" else value for key, value in file["orbit"].items()}
        self.epoch = days(orbit["epoch"])
        self.scale = file["environment"].get("density_scale", 1.0)
        self.plates = []
        for plate in file.get("plates", []):
            normal = np.array(plate["normal"], dtype=float)
            self.plates.append((plate["area_m2"], normal / np.linalg.norm(normal), np.array(plate["center_m"]) - center,
                                plate.get("drag_coefficient", 2.2), plate.get("specular", 0.0), plate.get("diffuse", 0.0)))
        self.state = np.concatenate([*start_of_orbit(orbit), file["initial"]["attitude"], file["initial"]["angular_velocity_rad_s"]])

    def slope(self, time, y):
        r, v, q, omega = y[:3], y[3:6], y[6:10], y[10:]
        distance = np.linalg.norm(r)
        c = dcm(q).T
        up = c @ r / distance
        torque = 3 * MU / distance**3 * np.cross(up, self.inertia @ up)
        wind = c @ (v - np.cross([0, 0, EARTH_RATE], r))
        pressure = 0.5 * self.scale * density(distance - RADIUS)
        to_sun = sun(self.epoch + time / 86400)
        share = visible(r, to_sun)
        s = c @ to_sun / np.linalg.norm(to_sun)
        light = 4.56e-6 * share * (AU / np.linalg.norm(to_sun)) ** 2
        push = np.zeros(3)
        for area, normal, arm, drag, specular, diffuse in self.plates:
            force = -pressure * drag * area * max(0.0, normal @ wind) * wind
            cosine = max(0.0, normal @ s)
            force = force - light * area * cosine * ((1 - specular) * s + 2 * (specular * cosine + diffuse / 3) * normal)
            torque = torque + np.cross(arm, force)
            push = push + force
        spin = self.inverse @ (torque - np.cross(omega, self.inertia @ omega))
        w, x, yy, z = q
        a, b, d = 0.5 * omega
        turning = [-x * a - yy * b - z * d, w * a + yy * d - z * b, w * b + z * a - x * d, w * d + x * b - yy * a]
        own = c.T @ push / self.mass if self.coupled else 0.0
        return np.concatenate([v, -MU / distance**3 * r + own, turning, spin])


def main():
    from scipy.integrate import solve_ivp  # basilisk_environment.py imports the equations alone

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", default=pathlib.Path(__file__).with_name("plates.toml"), type=pathlib.Path)
    parser.add_argument("--states", required=True, type=pathlib.Path, help="Parquet file of `spindrift simulate`")
    parser.add_argument("--step", default=2.0, type=float)
    parser.add_argument("--coupled", action="store_true", help="the forces move the centre of mass")
    parser.add_argument("--limit", default=1e-8, type=float)
    options = parser.parse_args()
    table = pq.read_table(options.states).to_pydict()
    times = np.array(table["time_s"])
    scene = Scene(options.file.read_text(), options.coupled)
    # the orbit in megametres would be as good: the tolerance is relative, and the rest is of order one
    found = solve_ivp(scene.slope, (0.0, times[-1]), scene.state, "DOP853", times, rtol=1e-13, atol=1e-15, max_step=options.step).y.T
    q = np.transpose([table[f"q_es_{c}"] for c in "wxyz"])
    other = found[:, 6:10] / np.linalg.norm(found[:, 6:10], axis=1)[:, None]
    attitude = 2 * np.minimum(np.linalg.norm(q - other, axis=1), np.linalg.norm(q + other, axis=1)).max()
    omega = np.transpose([table[f"omega_se_s_{c}_rad_s"] for c in "xyz"])
    rate = np.linalg.norm(omega - found[:, 10:], axis=1).max()
    size = np.linalg.norm(omega, axis=1).max()
    # from the point p of the file to the centre of mass
    place = np.transpose([table[f"r_po_e_{c}_m"] for c in "xyz"]) + np.array([dcm(own) @ scene.center for own in q])
    off = np.linalg.norm(place - found[:, :3], axis=1).max()
    print(f"attitude {attitude:.1e} rad, rate {rate:.1e} rad/s ({rate / size:.1e} of the largest), position {off:.1e} m")
    if attitude > options.limit or rate / size > options.limit or off > 1e-3:
        raise SystemExit("the two differ")


if __name__ == "__main__":
    main()
