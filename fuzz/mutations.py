"""Shipped campaign files with mistakes in them, through `check` and `campaign`: no panic, no hang, an exit code of the documents, and an error that says something.

python3 fuzz/mutations.py target/release/spindrift 3000 1      (program, mutations, seed; the same seed makes the same files)
"""

import random
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

# s; what takes longer is printed with its file, to be looked at
TIME_LIMIT = 120
NUMBERS = ["0", "-1", "1", "3", "1e308", "-1e308", "5e-324", "1e18", "-0.0", "nan", "inf", "1e-3", "1e3", "360", "0.5"]
OTHERS = ['"30 deg"', '"x"', '"1e999 m"', "true", "[]", "{}", "[1, 2]", '""', '"\\u0000"', "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"]
NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")


def mutated(lines, others, draw):
    """The lines with one mistake."""
    lines, at = list(lines), draw.randrange(len(lines))
    line = lines[at]
    kind = draw.randrange(9)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, line)
    elif kind == 2:
        other = draw.randrange(len(lines))
        lines[at], lines[other] = lines[other], line
    elif kind in (3, 4):
        numbers = list(NUMBER.finditer(line))
        if numbers:
            found = draw.choice(numbers)
            scaled = repr(float(found[0]) * draw.choice([-1.0, 0.01, 57.3, 1000.0]))
            lines[at] = line[: found.start()] + draw.choice([*NUMBERS, scaled]) + line[found.end() :]
    elif kind == 5 and "=" in line:
        lines[at] = line.split("=")[0] + "= " + draw.choice(NUMBERS + OTHERS)
    elif kind == 6:
        lines.insert(at, draw.choice(others))
    elif kind == 7 and line:
        place = draw.randrange(len(line))
        lines[at] = line[:place] + draw.choice(["", "é", "\t", '"', "=", "[", "]", "x", "\x1b", "9"]) + line[place + 1 :]
    elif kind == 8:
        first, last = sorted(draw.randrange(len(lines)) for _ in range(2))
        lines[at:at] = lines[first : min(last, first + 8)]
    return lines or [""]


def main():
    program, count, seed = Path(sys.argv[1]).resolve(), int(sys.argv[2]), int(sys.argv[3])
    first = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    folder = Path(__file__).parents[1] / "campaigns"
    files = {file.name: file.read_text().splitlines() for file in sorted(folder.glob("*.toml"))}
    others = [line for lines in files.values() for line in lines]
    codes, slowest, failures = Counter(), (0.0, ""), 0
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        for data in folder.glob("*.csv"):
            (scratch / data.name).write_bytes(data.read_bytes())
        for number in range(first, first + count):
            draw = random.Random(f"{seed} {number}")
            name = draw.choice(list(files))
            lines = files[name]
            for _ in range(draw.choice([1, 1, 2, 3])):
                lines = mutated(lines, others, draw)
            (scratch / "m.toml").write_text("\n".join(lines) + "\n")
            few = ["--threads", "1", "--samples", "4", "--set", "integrator.max_steps=20000", "--overwrite", "--no-report"]
            for command in (["check", "m.toml"], ["campaign", "m.toml", "--out", "r", *few]):
                begun = time.monotonic()
                try:
                    ended = subprocess.run([program, *command], cwd=scratch, capture_output=True, timeout=TIME_LIMIT)
                    code, said = ended.returncode, (ended.stdout + ended.stderr).decode(errors="replace")
                except subprocess.TimeoutExpired:
                    code, said = "hang", ""
                slowest = max(slowest, (time.monotonic() - begun, f"{name} {number} {command[0]}"))
                codes[command[0], code] += 1
                is_wrong = code not in (0, 1, 2, 3, 4, 5) or "panicked" in said or "\x1b" in said or not said.strip()
                if is_wrong or code == 2 and "must be" not in said and "; " not in said:
                    failures += 1
                    (Path(tempfile.gettempdir()) / f"mutation-{seed}-{number}.toml").write_text("\n".join(lines) + "\n")
                    print(f"{name} {number} {command[0]}: {code}: {said[-600:]}", flush=True)
    print(f"seed {seed}, {count} mutations from {first}: {dict(codes)}; slowest {slowest}; {failures} to be looked at")
    return failures > 0


sys.exit(main())
