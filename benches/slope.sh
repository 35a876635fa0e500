#!/usr/bin/env bash
# CPU time of whole campaigns of `no_debris.toml` on one thread, without the page, against the number of rows: two programs in turn, medians, and the slope
# between neighbouring numbers of rows. For instance a release build of an earlier commit against that of now:
#
#     benches/slope.sh ../earlier/target/release/spindrift target/release/spindrift
#
# ROUNDS (5) and ROWS ("100000 200000 400000 1000000") can be set. Results go to a temporary folder, which needs 1 GB.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../campaigns"
programs=("$(cd "$OLDPWD" && realpath "$1")" "$(cd "$OLDPWD" && realpath "$2")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
TIMEFORMAT='%U %S'
for ((round = 0; round < ${ROUNDS:-5}; round++)); do
    for rows in ${ROWS:-100000 200000 400000 1000000}; do
        for which in 0 1; do
            rm -rf "$folder/out"
            seconds=$({ time "${programs[$which]}" campaign no_debris.toml --samples "$rows" --threads 1 --no-report --out "$folder/out" >/dev/null 2>&1; } 2>&1)
            echo "$which $rows $seconds"
        done
    done
done | awk '
    { times[$1, $2] = times[$1, $2] " " $3 + $4; if (!($2 in seen)) { seen[$2] = 1; order[++count] = $2 } }
    function median(list,    values, n, i, j, x) {
        n = split(list, values, " ")
        for (i = 2; i <= n; i++) { x = values[i]; for (j = i - 1; j > 0 && values[j] + 0 > x + 0; j--) values[j + 1] = values[j]; values[j + 1] = x }
        return n % 2 ? values[(n + 1) / 2] : (values[n / 2] + values[n / 2 + 1]) / 2
    }
    END {
        printf "%9s %10s %10s %7s %16s %16s\n", "rows", "before, s", "now, s", "ratio", "before, us/row", "now, us/row"
        for (i = 1; i <= count; i++) {
            rows = order[i]; before = median(times[0, rows]); now = median(times[1, rows])
            printf "%9d %10.2f %10.2f %7.3f", rows, before, now, now / before
            if (i > 1) { step = rows - order[i - 1]; printf " %16.2f %16.2f", 1e6 * (before - b) / step, 1e6 * (now - n) / step }
            print ""; b = before; n = now
        }
    }'
