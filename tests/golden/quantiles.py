"""Quantiles of a published implementation, for tests/sampling/distributions.rs.

python3 tests/golden/quantiles.py > tests/golden/quantiles.json      (needs numpy and scipy; their versions are in the file)
"""

import json

import numpy
import scipy
from scipy import stats

U = [2.0**-40, 1e-9, 1e-4, 0.01, 0.074, 0.076, 0.3, 0.5, 0.62, 0.924, 0.926, 0.99, 0.9999, 1 - 2.0**-30]

laws = [
    ("normal", [3.0, 2.0], stats.norm(3.0, 2.0)),
    ("normal", [0.0, 1.0], stats.norm()),
    ("uniform", [-1.0, 4.0], stats.uniform(-1.0, 5.0)),
    ("log_normal", [2.5, 0.4], stats.lognorm(0.4, scale=2.5)),
    ("log_uniform", [0.01, 50.0], stats.loguniform(0.01, 50.0)),
    ("triangular", [2.0, 2.5, 4.0], stats.triang(0.25, 2.0, 2.0)),
    ("triangular", [2.0, 2.0, 4.0], stats.triang(0.0, 2.0, 2.0)),
]
for mean, std, low, high in [
    (10.0, 0.1, 9.7, 10.3),
    (0.0, 1.0, -0.5, 3.0),
    (0.0, 1.0, 1.0, 2.0),
    (0.0, 1.0, -5.0, -4.0),
    (1.0, 2.0, 2.0, numpy.inf),
]:
    law = stats.truncnorm((low - mean) / std, (high - mean) / std, mean, std)
    laws.append(("truncated_normal", [mean, std, low, high], law))
for a, b in [(0.5, 0.5), (2.0, 5.0), (1.0, 1.0), (5.0, 1.0), (0.3, 7.0), (30.0, 20.0), (900.0, 1100.0), (1.5, 0.2)]:
    laws.append(("beta", [a, b, 0.0, 1.0], stats.beta(a, b)))
# PERT from 1 to 7, mode 3: shapes 1 + 4/3, 1 + 8/3
laws.append(("pert", [1.0, 3.0, 7.0], stats.beta(1 + 4 * (3 - 1) / (7 - 1), 1 + 4 * (7 - 3) / (7 - 1), 1.0, 6.0)))

rows = [
    {"law": name, "parameters": [p if numpy.isfinite(p) else None for p in parameters], "u": u, "value": float(law.ppf(u))}
    for name, parameters, law in laws
    for u in U
]
lines = ",\n".join(json.dumps(row) for row in rows)
made_by = f"python3 tests/golden/quantiles.py, scipy {scipy.__version__}, numpy {numpy.__version__}"
print(f'{{"made_by": {json.dumps(made_by)},\n"rows": [\n{lines}\n]}}')
