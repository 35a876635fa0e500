"""Free asymmetric bodies in closed form, 25 digits: writes free_bodies.json beside this file (needs mpmath; python3 free_bodies.py).

Angular velocity by Jacobi's elliptic functions and attitude by the elliptic integral of the third kind (C. G. J. Jacobi, Journal
fuer die reine und angewandte Mathematik 39, 1850; formulas as in L. D. Landau & E. M. Lifshitz, Mechanics, 3rd ed. 1976, section 37).
Every number that a scene is made of is an f64, exactly. The closed form is checked against a Taylor solution before it is written.
"""
import json
import pathlib
import mpmath as mp

mp.mp.dps = 50


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Body:
    """A free body; axis 3 of the working frame is the one about which omega rotates, axis 2 the intermediate."""

    def __init__(self, moments, omega):
        i, w = [mp.mpf(x) for x in moments], [mp.mpf(x) for x in omega]
        energy2 = sum(a * b * b for a, b in zip(i, w))
        square = sum((a * b) ** 2 for a, b in zip(i, w))
        low, middle, high = sorted(range(3), key=lambda k: i[k])
        if i[middle] == i[high]:
            first, middle, last = high, middle, low
        elif i[low] == i[middle] or square > energy2 * i[middle]:
            first, last = low, high
        else:
            first, last = high, low
        self.axes = [first, middle, last]
        even = self.axes in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
        self.sign = [1, 1 if even else -1, 1]
        i1, i2, i3 = self.i = [i[k] for k in self.axes]
        w1, w2, w3 = [s * w[k] for s, k in zip(self.sign, self.axes)]
        self.m, self.e2 = mp.sqrt(square), energy2
        a1 = mp.sqrt((energy2 * i3 - square) / (i1 * (i3 - i1)))
        a3 = mp.sqrt((square - energy2 * i1) / (i3 * (i3 - i1))) * mp.sign(w3)
        a2 = mp.sqrt((energy2 * i3 - square) / (i2 * (i3 - i2))) * mp.sign((i3 - i2) * a3)
        self.a = [a1, a2, a3]
        self.nu = mp.sqrt((i3 - i2) * (square - energy2 * i1) / (i1 * i2 * i3))
        self.k2 = (i2 - i1) * (energy2 * i3 - square) / ((i3 - i2) * (square - energy2 * i1))
        self.quarter = mp.ellipk(self.k2)
        self.d = square - (i3 * a3) ** 2
        self.n = -((i3 * a3) ** 2) * self.k2 / self.d
        self.whole_pi = mp.ellippi(self.n, self.k2)
        self.tau0 = mp.ellipf(mp.atan2(w2 / a2, w1 / a1), self.k2)
        self.period = 4 * self.quarter / self.nu
        self.start = self.euler(mp.mpf(0))

    def phase(self, t):
        """tau as a whole number of half periods 2K and a rest in [-K, K]."""
        tau = self.tau0 + self.nu * t
        half = mp.nint(tau / (2 * self.quarter))
        return tau, half, tau - 2 * half * self.quarter

    def omega_own(self, t):
        _, half, rest = self.phase(t)
        flip = -1 if int(half) % 2 else 1
        sn, cn, dn = (mp.ellipfun(f, rest, m=self.k2) for f in ("sn", "cn", "dn"))
        return [self.a[0] * cn * flip, self.a[1] * sn * flip, self.a[2] * dn]

    def third_kind(self, t):
        _, half, rest = self.phase(t)
        return 2 * half * self.whole_pi + mp.ellippi(self.n, mp.asin(mp.ellipfun("sn", rest, m=self.k2)), self.k2)

    def euler(self, t):
        """Matrix from the working frame to one with axis 3 along L, which turns with the precession angle."""
        h = [i * w for i, w in zip(self.i, self.omega_own(t))]
        cos_theta = h[2] / self.m
        sin_theta = mp.sqrt(h[0] ** 2 + h[1] ** 2) / self.m
        psi = mp.atan2(h[0], h[1])
        grown = self.third_kind(t) - (self.third_kind(mp.mpf(0)) if t else self.third_kind(t))
        i3 = self.i[2]
        phi = self.m * t / i3 + self.m * (self.e2 - self.m**2 / i3) / (self.d * self.nu) * grown
        about3 = lambda x: mp.matrix([[mp.cos(x), -mp.sin(x), 0], [mp.sin(x), mp.cos(x), 0], [0, 0, 1]])
        about1 = mp.matrix([[1, 0, 0], [0, cos_theta, -sin_theta], [0, sin_theta, cos_theta]])
        return about3(phi) * about1 * about3(psi)

    def state(self, t):
        """omega in the body's frame, and C_eb with C_eb(0) = 1."""
        own = self.omega_own(t)
        omega = [None] * 3
        turn = self.start.T * self.euler(t)
        c = mp.matrix(3, 3)
        for r in range(3):
            omega[self.axes[r]] = self.sign[r] * own[r]
            for s in range(3):
                c[self.axes[r], self.axes[s]] = self.sign[r] * self.sign[s] * turn[r, s]
        return omega, c


def quaternion(c):
    """The quaternion of c, by its largest component."""
    t = [1 + c[0, 0] + c[1, 1] + c[2, 2], 1 + c[0, 0] - c[1, 1] - c[2, 2],
         1 - c[0, 0] + c[1, 1] - c[2, 2], 1 - c[0, 0] - c[1, 1] + c[2, 2]]
    k = max(range(4), key=lambda j: t[j])
    rows = [[t[0], c[2, 1] - c[1, 2], c[0, 2] - c[2, 0], c[1, 0] - c[0, 1]],
            [c[2, 1] - c[1, 2], t[1], c[0, 1] + c[1, 0], c[0, 2] + c[2, 0]],
            [c[0, 2] - c[2, 0], c[0, 1] + c[1, 0], t[2], c[1, 2] + c[2, 1]],
            [c[1, 0] - c[0, 1], c[0, 2] + c[2, 0], c[1, 2] + c[2, 1], t[3]]]
    return [x / (2 * mp.sqrt(t[k])) for x in rows[k]]


def taylor(moments, omega, t):
    """omega and q after t by a Taylor method of order 40, which shares nothing with the closed form."""
    i, w = [mp.mpf(x) for x in moments], [mp.mpf(x) for x in omega]
    q = [mp.mpf(1), mp.mpf(0), mp.mpf(0), mp.mpf(0)]
    steps = int(mp.ceil(t * max(abs(x) for x in w) * 8)) + 1
    h = t / steps
    for _ in range(steps):
        ws, qs = [w], [q]
        for n in range(44):
            nxt = []
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                nxt.append((i[b] - i[c]) / i[a] * sum(ws[k][b] * ws[n - k][c] for k in range(n + 1)) / (n + 1))
            r = [mp.mpf(0)] * 4
            for k in range(n + 1):
                p, v = qs[k], ws[n - k]
                r[0] -= p[1] * v[0] + p[2] * v[1] + p[3] * v[2]
                r[1] += p[0] * v[0] + p[2] * v[2] - p[3] * v[1]
                r[2] += p[0] * v[1] + p[3] * v[0] - p[1] * v[2]
                r[3] += p[0] * v[2] + p[1] * v[1] - p[2] * v[0]
            ws.append(nxt)
            qs.append([x / (2 * (n + 1)) for x in r])
        w = [mp.polyval([c[a] for c in reversed(ws)], h) for a in range(3)]
        q = [mp.polyval([c[a] for c in reversed(qs)], h) for a in range(4)]
    return w, q


NEAR = 1e-3
CASES = {
    "near the axis of largest moment": ([1000.0, 1500.0, 2000.0], [0.125, -0.0625, 3.0]),
    "near the axis of smallest moment": ([1000.0, 1500.0, 2000.0], [3.0, 0.125, -0.0625]),
    "about the axis of largest moment, wide": ([1000.0, 1500.0, 2000.0], [1.0, -0.75, 1.5]),
    "about the axis of smallest moment, wide": ([1000.0, 1500.0, 2000.0], [-2.0, 1.25, 0.5]),
    "near the separatrix, largest side": ([1000.0, 1500.0, 2000.0], [0.0, 2.0, NEAR]),
    "near the separatrix, smallest side": ([1000.0, 1500.0, 2000.0], [NEAR, -2.0, 0.0]),
    "symmetric, flat": ([1200.0, 1200.0, 2000.0], [1.0, -0.5, 2.0]),
    "symmetric, long": ([2000.0, 2000.0, 600.0], [0.5, 0.25, 3.0]),
}
# Published cases. Rigid body of E. Hairer, C. Lubich & G. Wanner, Geometric Numerical Integration, 2nd ed. 2006, VII.5: moments
# (2, 1, 2/3), momenta y(0) = (cos 1.1, 0, sin 1.1). No real body has these moments (2 > 1 + 2/3), but y(t) stays the same when 1 is
# added to each 1/I: moments (2/3, 1/2, 2/5), angular velocity y/I.
CASES["Hairer, Lubich & Wanner"] = (
    [2.0 / 3.0, 0.5, 0.4],
    [float(mp.cos(mp.mpf("1.1"))) / (2.0 / 3.0), 0.0, float(mp.sin(mp.mpf("1.1"))) / 0.4],
)
# NASA/TM-2015-218675 (D. G. Murri, E. B. Jackson & R. O. Shelton, Check-Cases for Verification of 6-Degree-of-Freedom Flight Vehicle
# Simulations), volume II, check case 2, tumbling brick without damping and drag: tables 4 and 26, in slug ft^2 and deg/s.
SLUG_FT2 = 0.45359237 * 9.80665 / 0.3048 * 0.3048**2
CASES["NESC check case 2"] = (
    [x * SLUG_FT2 for x in (0.001894220, 0.006211019, 0.007194665)],
    [float(x * mp.pi / 180) for x in (10, 20, 30)],
)


def digits(values):
    return [mp.nstr(v, 25, min_fixed=0, max_fixed=0) for v in values]


def main():
    cases = []
    for name, (moments, omega) in CASES.items():
        body = Body(moments, omega)
        check = mp.mpf(5)
        w, q = taylor(moments, omega, check)
        w2, c2 = body.state(check)
        q2 = quaternion(c2)
        off = max(abs(a - b) for a, b in zip(w, w2))
        turned = min(max(abs(a - s * b) for a, b in zip(q, q2)) for s in (1, -1))
        assert off < mp.mpf(10) ** -30 and turned < mp.mpf(10) ** -30, (name, off, turned)
        hundred = float(100 * body.period)
        times = [0.0] + [hundred * k / 8 for k in range(1, 9)]
        times += [t for t in (1e4, 1e5, 1e6) if t > hundred]
        times = sorted(times + ([30.0] if name == "NESC check case 2" else []))
        truth = []
        for t in times:
            w, c = body.state(mp.mpf(t))
            truth.append({"t": repr(t), "omega": digits(w), "q": digits(quaternion(c))})
        print(f"{name}: period {float(body.period):.6g} s, against Taylor {mp.nstr(off, 3)} {mp.nstr(turned, 3)}")
        cases.append({"name": name, "moments": [repr(x) for x in moments], "omega": [repr(x) for x in omega],
                      "periods_100_s": repr(hundred), "truth": truth})
    path = pathlib.Path(__file__).with_suffix(".json")
    path.write_text(json.dumps({"source": __doc__.split("\n")[0], "cases": cases}, indent=1) + "\n")


main()
