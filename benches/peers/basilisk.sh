#!/bin/sh
# Runs spindrift and Basilisk on the same spacecraft with four wheels, one after the other on one core. Fails if they do not agree.
# With `attitude` as the first word: the same spacecraft with three wheels under a control loop; with `environment`: gravity gradient, plates in air
# and sunlight, torque rods and eclipses; with `orbit`: a control loop among them. See benches/README.md.
#
#   benches/peers/basilisk.sh [options of basilisk.py, for example --samples 32 --repeats 3 --limit 1e-9]
#   benches/peers/basilisk.sh attitude [options of basilisk_attitude.py, for example --steps history,speed]
#   benches/peers/basilisk.sh environment [options of basilisk_environment.py, for example --cases drag]
#   benches/peers/basilisk.sh orbit [options of basilisk_orbit.py, for example --repeats 0]
#
# The scratch environment is PEERS (default: a folder in the system's temporary folder) and is reused. It is apart from that of run.sh,
# so that neither decides the other's versions. SPINDRIFT=program takes this program instead of building one.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
scratch=${PEERS:-${TMPDIR:-/tmp}/spindrift-peers}
python=${PYTHON:-python3}
script=basilisk.py
case "${1:-}" in
attitude | environment | orbit)
    script=basilisk_$1.py
    shift
    ;;
esac

mkdir -p "$scratch/basilisk"
[ -x "$scratch/venv-basilisk/bin/python" ] || "$python" -m venv "$scratch/venv-basilisk"
"$scratch/venv-basilisk/bin/python" -c 'import Basilisk, numpy, pyarrow' 2>/dev/null ||
    "$scratch/venv-basilisk/bin/pip" install --quiet bsk numpy pyarrow
if [ -z "${SPINDRIFT:-}" ]; then
    (cd "$root" && cargo build --release --bin spindrift)
    SPINDRIFT=${CARGO_TARGET_DIR:-$root/target}/release/spindrift
fi

# one core for everybody, the last one: interrupts prefer the first
pin=
if command -v taskset >/dev/null; then pin="taskset -c $(($(nproc) - 1))"; fi
exec $pin "$scratch/venv-basilisk/bin/python" "$here/$script" --spindrift "$SPINDRIFT" --scratch "$scratch/basilisk" "$@"
