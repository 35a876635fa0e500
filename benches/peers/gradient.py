"""spindrift against heyoka under the gravity gradient: 8 h on a circular orbit at a tolerance of 1e-12, one core.

    python benches/peers/gradient.py --spindrift target/release/spindrift        (with numpy, heyoka, pyarrow)

The scene is campaigns/libration.toml with no eccentricity, rates of 2e-4 rad/s at one sigma and the final state only.
heyoka integrates 13 states (place, velocity, quaternion, rate) in units of the orbit's radius and rate, in batches of
one and two vectors with and without fast_math; the fastest counts. spindrift: `precision` (states and estimates, as
heyoka without observables and files), and a further run of a campaign, everything counted. All alternate; medians.
The errors are those of the attitude against heyoka in 80 bits, median and largest of the samples.
"""

import argparse
import itertools
import pathlib
import subprocess
import tempfile
import time

import cpu_time
import heyoka as hy
import numpy as np
import pyarrow.parquet as pq

CAMPAIGN = pathlib.Path(__file__).resolve().parents[2] / "campaigns" / "libration.toml"
DURATION, TOLERANCE, RADIUS, MU = 28800.0, 1e-12, 7e6, 3.986004418e14
RATE = np.sqrt(MU / RADIUS**3)
J = np.array([90.0, 100.0, 40.0])


def system():
    r, v, w = (hy.make_vars(*(f"{name}{i}" for i in range(3))) for name in "rvw")
    q0, q1, q2, q3 = q = hy.make_vars("q0", "q1", "q2", "q3")
    square = hy.sum([x * x for x in r])
    pull, gradient = square**-1.5, 3.0 * square**-2.5
    rows = (
        (1 - 2 * (q2 * q2 + q3 * q3), 2 * (q1 * q2 + q0 * q3), 2 * (q1 * q3 - q0 * q2)),
        (2 * (q1 * q2 - q0 * q3), 1 - 2 * (q1 * q1 + q3 * q3), 2 * (q2 * q3 + q0 * q1)),
        (2 * (q1 * q3 + q0 * q2), 2 * (q2 * q3 - q0 * q1), 1 - 2 * (q1 * q1 + q2 * q2)),
    )
    own = [hy.sum([a * x for a, x in zip(row, r)]) for row in rows]
    spin = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        spin.append(float((J[j] - J[k]) / J[i]) * (w[j] * w[k] - gradient * own[j] * own[k]))
    x, y, z = w
    turn = (
        -0.5 * (q1 * x + q2 * y + q3 * z),
        0.5 * (q0 * x + q2 * z - q3 * y),
        0.5 * (q0 * y + q3 * x - q1 * z),
        0.5 * (q0 * z + q1 * y - q2 * x),
    )
    return [*zip(r, v), *((a, -pull * b) for a, b in zip(v, r)), *zip(q, turn), *zip(w, spin)]


def final(ta, starts, batch):
    """Final states, by batches."""
    ends = []
    for begin in range(0, len(starts), batch):
        if batch > 1:
            ta.set_time(np.zeros(batch))
        else:
            ta.time = np.longdouble(0)
        ta.state[:] = starts[begin : begin + batch].T if batch > 1 else starts[begin]
        ta.propagate_until(ta.state.dtype.type(DURATION * RATE))
        ends.append(np.atleast_2d(ta.state.T).copy())
    return np.concatenate(ends)


def angle(one, other):
    q, p = one[:, 6:10], other[:, 6:10]
    return 2 * np.minimum(np.linalg.norm(q - p, axis=1), np.linalg.norm(q + p, axis=1)).astype(float)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spindrift", required=True)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--samples", type=int, default=512)
    options = parser.parse_args()
    text = CAMPAIGN.read_text().split("[[disperse]]")[0].replace("eccentricity = 0.005", "eccentricity = 0.0")
    text = text.replace("172800.0", f"{DURATION}").replace("points = 1441", "points = 2")
    groups = 'groups = ["final_state", "numerics", "momentum_conservation", "energy_conservation"]\n'
    text = "\n".join(groups if line.startswith("groups") else line for line in text.splitlines())
    text = text.replace('method = "auto"', f'method = "auto"\ntolerance = {TOLERANCE}')
    text += '\n[[disperse]]\nparameter = "initial.angular_velocity_rad_s"\ndistribution = "normal"\nstd = 2e-4\n'
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        file = folder / "gradient.toml"
        file.write_text(text)

        def campaign(samples):
            return cpu_time.campaign(options.spindrift, file, folder, samples)

        def precision():
            words = ["--samples", "64", "--repeats", "3", "--methods", "auto", "--tolerances", str(TOLERANCE)]
            subprocess.run(
                [options.spindrift, "precision", file, *words, "--out", folder / "precision"],
                check=True,
                capture_output=True,
            )
            return 1e6 / pq.read_table(folder / "precision" / "precision.parquet")["runs_per_s"][0].as_py()

        campaign(options.samples)
        rows = pq.read_table(sorted((folder / "rows" / "runs").glob("*.parquet"))).sort_by("sample_id").to_pydict()
        columns = lambda pattern, parts: np.transpose([rows[pattern.format(part)] for part in parts])
        omega = columns("initial_angular_velocity_{}_rad_s", "xyz")
        start = [1.0, 0, 0, 0, 1.0, 0, 0.5, -0.5, -0.5, 0.5]
        starts = np.hstack([np.tile(start, (len(omega), 1)), omega / RATE])
        ours = np.hstack([starts[:, :6], columns("q_es_{}_final", "wxyz"), omega])

        real = np.longdouble
        exact = hy.taylor_adaptive(system(), np.zeros(13, dtype=real), fp_type=real, tol=real(1e-19), compact_mode=True)
        truth = final(exact, starts[:64].astype(real), 1)
        width = hy.recommended_simd_size()
        makers = {}
        for batch, fast in itertools.product((width, 2 * width), (False, True)):
            makers[batch, fast] = hy.taylor_adaptive_batch(
                system(), np.zeros((13, batch)), tol=TOLERANCE, fast_math=fast
            )
        times, slopes, alone = {key: [] for key in makers}, [], []
        for _ in range(options.repeats + 1):
            for key, ta in makers.items():
                begin = time.process_time()
                ends = final(ta, starts, key[0])
                times[key].append(1e6 * (time.process_time() - begin) / len(starts))
            slopes.append(1e6 * (campaign(4 * options.samples) - campaign(options.samples)) / (3 * options.samples))
            alone.append(precision())
        best = min(makers, key=lambda key: np.median(times[key][1:]))
        print(
            f"heyoka {hy.__version__}: us a run, batch and fast_math: "
            + ", ".join(f"{key} {np.median(one[1:]):.1f}" for key, one in times.items())
        )
        theirs = np.array(times[best][1:])
        for name, one in (("precision", alone), ("a further run of a campaign", slopes)):
            ratio = np.sort(theirs / one[1:])
            print(
                f"spindrift, {name}: {np.median(one[1:]):.1f} us a run, {np.median(ratio):.2f} times the runs of heyoka"
                f" ({ratio[0]:.2f} to {ratio[-1]:.2f})"
            )
        for name, one in (("heyoka", ends), ("spindrift", ours)):
            off = angle(one[:64], truth)
            print(f"error of {name}: median {np.median(off):.1e} rad, largest {off.max():.1e}")


if __name__ == "__main__":
    main()
