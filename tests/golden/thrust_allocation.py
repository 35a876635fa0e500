"""Thrusts of 1,000 random sets of thrusters by SciPy's linprog: writes thrust_allocation.json beside this file
(needs scipy; python3 thrust_allocation.py).

The sets are not stored: a linear congruential generator makes them, here and in the test (crates/control/src/control/allocation/tests.rs).
The program of each set: thrusts f within 0 <= f <= max give the torque A f and the force B f. In this order of priority the least

1. |A f - torque| across the axes of the wheels,
2. |B f - force|, where a force is wanted,
3. |A f - torque| along the axes of the wheels,
4. sum(f)

where |x| is the sum of the magnitudes of the components. Wheels reach nothing, s3, s1 and s2, or everything. Where the thrusts of that program without
limits are beyond them, the torque of priority 1 is (1 - share) times the one that they give, with the least share, and 2 to 4 follow within the limits.

The file has five numbers of each set: what is missing of 1 to 3 and the total, as they come out, and the share.
"""
import json
import pathlib
import numpy as np
from scipy.optimize import linprog

WHEELS = [[], [2], [0, 1], [0, 1, 2]]


class Numbers:
    """From -1 to 1 in thousandths."""

    def __init__(self, seed):
        self.state = seed

    def one(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return ((self.state >> 33) % 2001 - 1000) / 1000

    def three(self):
        return np.array([self.one() for _ in range(3)])


def solved(cost, equal, wanted, upper):
    options = dict(primal_feasibility_tolerance=1e-10, dual_feasibility_tolerance=1e-10, presolve=False)
    found = linprog(cost, A_eq=equal, b_eq=wanted, bounds=[(0, most) for most in upper], method="highs-ds", options=options)
    assert found.status == 0, found.message
    return found


def by_priority(levels, equal, wanted, upper):
    """The least of each cost of `levels` where those before it are at their least, and the variables."""
    least = []
    for cost in levels:
        found = solved(cost, equal, wanted, upper)
        least.append(max(found.fun, 0.0))
        equal, wanted = np.vstack([equal, cost]), np.append(wanted, found.fun)
    return least, found.x


def optimum(index):
    numbers = Numbers(index)
    count = 4 + index % 9
    has_force, has_limits, wheels = index % 2 == 1, index // 2 % 2 == 1, WHEELS[index // 4 % 4]
    columns = []
    for _ in range(count):
        position, direction = numbers.three(), numbers.three()
        columns.append(np.concatenate([direction, np.cross(position, direction)]))
    columns = np.array(columns).T
    # within the cone by construction, or anywhere
    if index // 16 % 2 == 0:
        wanted = columns @ np.array([abs(numbers.one()) for _ in range(count)])
    else:
        wanted = np.concatenate([numbers.three(), numbers.three()])
    most = [0.1 + abs(numbers.one()) for _ in range(count)] if has_limits else [None] * count
    # components: torque, then force
    order = [3, 4, 5] + ([0, 1, 2] if has_force else [])
    columns, wanted = columns[order], wanted[order]
    rows = len(order)
    is_force = np.arange(rows) >= 3
    is_within = np.array([row in wheels for row in range(rows)]) & ~is_force
    is_across = ~is_force & ~is_within
    groups = [group.astype(float) for group in (is_across, is_force, is_within)]
    unit = np.eye(rows)
    zeros, total = np.zeros(count), np.append(np.ones(count), np.zeros(2 * rows))
    equal = np.column_stack([columns, unit, -unit])
    levels = [np.concatenate([zeros, group, group]) for group in groups] + [total]
    least, found = by_priority(levels, equal, wanted, [None] * equal.shape[1])
    thrust = found[:count]
    if not has_limits or all(one <= limit for one, limit in zip(thrust, most)):
        return least + [0.0]
    given = np.where(is_across, columns @ thrust, wanted)
    equal = np.column_stack([columns, given * is_across, unit * ~is_across, -unit * ~is_across])
    levels = [np.append(zeros, np.append(1, np.zeros(2 * rows)))]
    levels += [np.concatenate([zeros, [0], group, group]) for group in groups[1:]]
    levels += [np.append(np.ones(count), np.zeros(2 * rows + 1))]
    (share, force, within, _), found = by_priority(levels, equal, given, most + [1] + [None] * 2 * rows)
    thrust = found[:count]
    missing = np.abs(columns @ thrust - wanted)
    return [missing @ groups[0], force, within, sum(thrust), share]


if __name__ == "__main__":
    found = [[float(f"{value:.12g}") if value > 1e-12 else 0 for value in optimum(index)] for index in range(1000)]
    text = "[\n" + ",\n".join(json.dumps(one) for one in found) + "\n]\n"
    pathlib.Path(__file__).with_suffix(".json").write_text(text)
