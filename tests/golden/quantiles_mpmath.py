"""Quantiles in 30 digits, for tests/sampling/distributions.rs.

python3 tests/golden/quantiles_mpmath.py > tests/golden/quantiles_mpmath.json      (needs mpmath; its version is in the file)

A row has the distribution, its parameters, u, the quantile (of the unit interval, scale 1, centre 0) and, of a beta distribution, 1 - x. The
parameters of a truncated normal distribution are its bounds.
Each is the root of the distribution function's logarithm, by bisection and Newton's method; the smaller tail is the one that is used.
"""

import json

import mpmath
from mpmath import mp, mpf

mp.dps = 40
U = [2.0**-45, 1e-9, 1e-3, 0.2, 0.5, 0.7, 0.99, 1 - 2.0**-30]


def root(tail, low, high):
    """The t with tail(t) = 0, increasing, between low and high."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if tail(middle) < 0 else (low, middle)
    return mpmath.findroot(tail, (low, high), solver="anderson", tol=mpf(10) ** -60, verify=False)


def beta_tail(a, b, x, y):
    """I_x(a, b), y = 1 - x."""
    if x > y:
        return 1 - beta_tail(b, a, y, x)
    series = mpmath.hyp2f1(1, a + b, a + 1, x) if a + b < 100 else continued(a, b, x)
    return mpmath.exp(a * mpmath.log(x) + b * mpmath.log(y) - mpmath.log(a) - mpmath.log(mpmath.beta(a, b))) * series


def continued(a, b, x):
    if x > (a + 1) / (a + b + 2):
        whole = 1 / mpmath.exp(a * mpmath.log(x) + b * mpmath.log(1 - x) - mpmath.log(a) - mpmath.log(mpmath.beta(a, b)))
        other = mpmath.exp(b * mpmath.log(1 - x) + a * mpmath.log(x) - mpmath.log(b) - mpmath.log(mpmath.beta(a, b)))
        return (1 - other * continued(b, a, 1 - x)) * whole
    value = mpf(0)
    for m in range(900, 0, -1):
        odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        value = even / (1 + odd / (1 + value))
    first = -(a + b) * x / (a + 1)
    return 1 / (1 + first / (1 + value))


def beta(a, b, u):
    a, b, u = mpf(a), mpf(b), mpf(u)
    sides = lambda t: (1 / (1 + mpmath.exp(-t)), 1 / (1 + mpmath.exp(t)))

    def tail(t):
        x, y = sides(t)
        if u <= mpf(1) / 2:
            return mpmath.log(beta_tail(a, b, x, y) / u)
        return -mpmath.log(beta_tail(b, a, y, x) / (1 - u))

    return sides(root(tail, mpf(-1500), mpf(1500)))


def gamma(a, u):
    a, u = mpf(a), mpf(u)

    def tail(t):
        x = mpmath.exp(t)
        if u <= mpf(1) / 2:
            return mpmath.log(mpmath.gammainc(a, 0, x, regularized=True) / u)
        return -mpmath.log(mpmath.gammainc(a, x, mpmath.inf, regularized=True) / (1 - u))

    return mpmath.exp(root(tail, mpf(-4000) if a < 1 else mpf(-60), mpmath.log(2 * a + 800)))


def student(nu, u):
    nu, u = mpf(nu), mpf(u)
    if u == mpf(1) / 2:
        return mpf(0)
    p = min(u, 1 - u)
    x, y = beta(nu / 2, mpf(1) / 2, 2 * p)
    return mpmath.sign(u - mpf(1) / 2) * mpmath.sqrt(nu * y / x)


def truncated_normal(a, b, u):
    a, b, u = mpf(a), mpf(b), mpf(u)
    if a > 0:
        return -truncated_normal(-b, -a, 1 - u)
    below, between = mpmath.ncdf(a), mpmath.ncdf(b) - mpmath.ncdf(a)
    return root(lambda x: mpmath.log(mpmath.ncdf(x) / (below + u * between)), a, b)


rows = []


def add(law, parameters, u, *values):
    row = [law, parameters, u] + [float(mpmath.nstr(value, 20)) for value in values]
    rows.append(row)


for a, b in [(1e4, 1e4), (0.01, 1e4), (1e4, 0.01), (0.01, 0.01), (0.5, 3.0), (3.0, 7.0), (900.0, 1.5), (2.0, 5000.0)]:
    for u in U:
        x, y = beta(a, b, u)
        if min(x, y) > mpf(10) ** -290:
            add("beta", [a, b], u, x, y)
for a in [0.01, 0.3, 1.0, 4.5, 100.0, 1e4]:
    for u in U:
        x = gamma(a, u)
        if x > mpf(10) ** -290:
            add("gamma", [a], u, x)
for nu in [0.5, 1.0, 2.0, 5.0, 30.0, 1e4]:
    for u in U:
        add("student_t", [nu], u, student(nu, u))
for shape in [0.05, 1.0, 2.0, 50.0]:
    for u in U:
        add("weibull", [shape], u, (-mpmath.log1p(-mpf(u))) ** (1 / mpf(shape)))
for a, b in [(7, 7.5), (7, 40), (-7.5, -7), (-40, -7), (8, 8.1), (-8.1, -8), (3, 5), (-5, -3), (-1, 9), (-9, 1), (0.25, 0.5)]:
    for u in U:
        add("truncated_normal", [a, b], u, truncated_normal(a, b, u))
for u in U:
    add("exponential", [], u, -mpmath.log1p(-mpf(u)))

lines = ",\n".join(json.dumps(row) for row in rows)
made_by = f"python3 tests/golden/quantiles_mpmath.py, mpmath {mpmath.__version__}"
print(f'{{"made_by": {json.dumps(made_by)},\n"rows": [\n{lines}\n]}}')
