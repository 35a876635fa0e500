#!/bin/sh
# Runs spindrift, heyoka and SciPy on the same scenes, one after the other on one core, and prints ratios. See benches/README.md.
#
#   benches/peers/run.sh [options of compare.py, for example --samples 64 --repeats 5 --quick]
#
# The scratch environment is PEERS (default: a folder in the system's temporary folder) and is reused.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
scratch=${PEERS:-${TMPDIR:-/tmp}/spindrift-peers}
python=${PYTHON:-python3}

mkdir -p "$scratch"
[ -x "$scratch/venv/bin/python" ] || "$python" -m venv "$scratch/venv"
"$scratch/venv/bin/python" -c 'import heyoka, scipy, pyarrow' 2>/dev/null ||
    "$scratch/venv/bin/pip" install --quiet heyoka scipy numpy pyarrow
(cd "$root" && cargo build --release --bin spindrift)
spindrift=${CARGO_TARGET_DIR:-$root/target}/release/spindrift

# one core for everybody, the last one: interrupts prefer the first
pin=
if command -v taskset >/dev/null; then pin="taskset -c $(($(nproc) - 1))"; fi
exec $pin "$scratch/venv/bin/python" "$here/compare.py" --spindrift "$spindrift" --scratch "$scratch" "$@"
