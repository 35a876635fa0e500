"""Estimates of attitude and gyro bias from recorded measurements: writes attitude_filter.json beside this file (needs mpmath; python3 attitude_filter.py).

An implementation of the filter of E. J. Lefferts, F. L. Markley & M. D. Shuster (J. Guidance 5(5), 1982) that shares nothing with the program's: direction
cosine matrices instead of quaternions, exponentials and Jacobians by their series, the covariance after a measurement by the sum of informations, 40 digits;
and no history of states: the estimate at a tick is made from the start of the run, with all measurements that have arrived by then, each at its time.
Measurements are doubles; estimates are rounded to doubles at the end.
"""
import json
import pathlib
import random
import mpmath as mp

mp.mp.dps = 40
# every second attitude arrives five ticks late, after one that was taken later
TICK, TICKS, EVERY, LATENCIES = 0.25, 36, 2, [5, 1]
WHITE, WALK, TRACKER = 2e-4, 3e-5, [3e-4, 4e-4, 2e-3]
START_SIGMAS = [0.02, 1e-3]


def vector(v):
    return mp.matrix([mp.mpf(x) for x in v])


def skew(v):
    return mp.matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def series(m, shift):
    """sum of m^k / (k + shift)!: for shift 0 the exponential, for shift 1 its integral over [0, 1]."""
    total, power = mp.zeros(3), mp.eye(3)
    for k in range(60):
        total += power / mp.factorial(k + shift)
        power = power * m
    return total


def dcm(q):
    """C of F_s -> F_e by Rodrigues's formula from the quaternion."""
    q = vector(q)
    q = q / mp.sqrt(sum(x * x for x in q))
    cross = skew(q[1:4])
    return mp.eye(3) + 2 * q[0] * cross + 2 * cross * cross


def logarithm(c):
    cosine = (c[0, 0] + c[1, 1] + c[2, 2] - 1) / 2
    axis = mp.matrix([c[2, 1] - c[1, 2], c[0, 2] - c[2, 0], c[1, 0] - c[0, 1]]) / 2
    sine = mp.sqrt(sum(x * x for x in axis))
    return axis if sine == 0 else axis * (mp.atan2(sine, cosine) / sine)


def block(p, i, j):
    return mp.matrix([[p[3 * i + a, 3 * j + b] for b in range(3)] for a in range(3)])


def joined(a, b, c, d):
    return mp.matrix([[(a, b, c, d)[2 * (i // 3) + j // 3][i % 3, j % 3] for j in range(6)] for i in range(6)])


class Filter:
    def __init__(self, q):
        self.c, self.bias = dcm(q), mp.zeros(3, 1)
        a, b = (mp.mpf(s) ** 2 for s in START_SIGMAS)
        self.p = mp.diag([a, a, a, b, b, b])

    def propagate(self, rotation):
        t, white, walk = mp.mpf(TICK), mp.mpf(WHITE) ** 2, mp.mpf(WALK) ** 2
        turn = vector(rotation) - t * self.bias
        self.c = self.c * series(skew(turn), 0)
        backwards, integral = series(-skew(turn), 0), series(-skew(turn), 1)
        ptt, ptb, pbb = block(self.p, 0, 0), block(self.p, 0, 1), block(self.p, 1, 1)
        # error after = backwards * error - integral * (t bias error + noise)
        m = integral * t
        ptt_after = backwards * ptt * backwards.T - backwards * ptb * m.T - m * ptb.T * backwards.T + m * pbb * m.T
        ptt_after += integral * integral.T * (white * t + walk * t ** 3 / 3)
        ptb_after = backwards * ptb - m * pbb - integral * (walk * t ** 2 / 2)
        self.p = joined(ptt_after, ptb_after, ptb_after.T, pbb + walk * t * mp.eye(3))

    def update(self, q):
        information = mp.inverse(self.p)
        weight = mp.diag([1 / mp.mpf(s) ** 2 for s in TRACKER])
        for i in range(3):
            information[i, i] += weight[i, i]
        self.p = mp.inverse(information)
        innovation = logarithm(self.c.T * dcm(q))
        seen = weight * innovation
        correction = self.p * mp.matrix([seen[0], seen[1], seen[2], 0, 0, 0])
        self.c = self.c * series(skew(correction[0:3]), 0)
        self.bias += correction[3:6]


def quaternion(v):
    angle = mp.sqrt(sum(x * x for x in v))
    factor = mp.sinc(angle / 2) / 2
    return [float(mp.cos(angle / 2))] + [float(factor * x) for x in v]


def main():
    draw = random.Random(31)
    noise = lambda sigma: draw.gauss(0.0, 1.0) * sigma
    start = quaternion(vector([0.4, -0.7, 1.1]))
    c = dcm(start) * series(skew(vector([noise(0.02) for _ in range(3)])), 0)
    bias = [noise(1e-3) for _ in range(3)]
    rotations, attitudes = [], []
    for tick in range(TICKS + 1):
        if tick > 0:
            t = TICK * tick
            omega = [0.3 * float(mp.sin(0.2 * t)), 0.25, -0.4 * float(mp.cos(0.1 * t))]
            turn = vector([TICK * x for x in omega])
            c = c * series(skew(turn), 0)
            bias = [b + noise(WALK * TICK ** 0.5) for b in bias]
            rotations.append([float(turn[i]) + TICK * bias[i] + noise(WHITE * TICK ** 0.5) for i in range(3)])
        latency = LATENCIES[len(attitudes) % 2]
        if tick % EVERY == 0 and tick + latency <= TICKS:
            seen = c * series(skew(vector([noise(s) for s in TRACKER])), 0)
            attitudes.append({"taken": tick, "age": latency, "q_es": quaternion(logarithm(seen))})
    estimates = []
    for now in range(TICKS + 1):
        state = Filter(start)
        for tick in range(now + 1):
            if tick > 0:
                state.propagate(rotations[tick - 1])
            for seen in attitudes:
                if seen["taken"] == tick and tick + seen["age"] <= now:
                    state.update(seen["q_es"])
        estimates.append({
            "c_es": [float(state.c[i, j]) for i in range(3) for j in range(3)],
            "bias_s": [float(x) for x in state.bias],
            "covariance": [float(state.p[i, j]) for i in range(6) for j in range(i, 6)],
        })
    numbers = {
        "tick_s": TICK, "angular_random_walk": WHITE, "bias_random_walk": WALK, "tracker_sigmas": TRACKER,
        "start_sigmas": START_SIGMAS, "start_q_es": start, "rotations": rotations, "attitudes": attitudes,
    }
    lines = [f' "{key}": {json.dumps(value)}' for key, value in numbers.items()]
    lines.append(' "estimates": [\n  ' + ",\n  ".join(json.dumps(e) for e in estimates) + "\n ]")
    pathlib.Path(__file__).with_suffix(".json").write_text("{\n" + ",\n".join(lines) + "\n}\n")


main()
