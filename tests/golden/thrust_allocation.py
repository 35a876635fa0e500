"""Least total thrust of 1,000 random sets of thrusters by SciPy's linprog: writes thrust_allocation.json beside this file
(needs scipy; python3 thrust_allocation.py).

The sets are not stored: a linear congruential generator makes them, here and in the test (src/control/allocation/thrust.rs).
Of each set the file has three numbers. Without limits: the least sum of what is missing of the torque, N m, then of the force, N, in
magnitudes of the components that are controlled, then the least total thrust, N. With limits: the shares of the torque and of the force that
are not given, in that order of priority, then the total.
"""
import json
import pathlib
import numpy as np
from scipy.optimize import linprog

AXES = ["000111", "111111", "001111", "111111"]


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
    return found.fun


def by_priority(levels, equal, wanted, upper):
    """The least of each cost of `levels` where those before it are at their least."""
    least = []
    for cost in levels:
        value = solved(cost, equal, wanted, upper)
        least.append(max(value, 0.0))
        equal, wanted = np.vstack([equal, cost]), np.append(wanted, value)
    return least


def optimum(index):
    numbers = Numbers(index)
    count, kind = 4 + index % 9, index % 4
    columns = []
    for _ in range(count):
        position, direction = numbers.three(), numbers.three()
        columns.append(np.concatenate([direction, np.cross(position, direction)]))
    columns = np.array(columns).T
    # within the cone by construction, or anywhere
    if kind == 3 or index // 4 % 2 == 0:
        wanted = columns @ np.array([abs(numbers.one()) for _ in range(count)])
    else:
        wanted = np.concatenate([numbers.three(), numbers.three()])
    rows = [row for row in range(6) if AXES[kind][row] == "1"]
    is_torque = np.array([row >= 3 for row in rows], dtype=float)
    columns, wanted = columns[rows], wanted[rows]
    zeros, total = np.zeros(count), np.ones(count)
    if kind == 3:
        most = [0.1 + abs(numbers.one()) for _ in range(count)]
        equal = np.column_stack([columns, wanted * is_torque, wanted * (1 - is_torque)])
        levels = [np.append(zeros, [1, 0]), np.append(zeros, [0, 1]), np.append(total, [0, 0])]
        return by_priority(levels, equal, wanted, most + [1, 1])
    unit = np.eye(len(rows))
    equal = np.column_stack([columns, unit, -unit])
    levels = [np.concatenate([zeros, w, w]) for w in (is_torque, 1 - is_torque)] + [np.append(total, np.zeros(2 * len(rows)))]
    return by_priority(levels, equal, wanted, [None] * equal.shape[1])


if __name__ == "__main__":
    found = [[float(f"{value:.12g}") if value > 1e-12 else 0 for value in optimum(index)] for index in range(1000)]
    text = "[\n" + ",\n".join(json.dumps(one) for one in found) + "\n]\n"
    pathlib.Path(__file__).with_suffix(".json").write_text(text)
