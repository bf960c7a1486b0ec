#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Saw training in real time beside cyclictest, while one core is loaded: how late both are woken, and why each tick that
# was late was so.
# usage: tests/bench/live_load.sh [SECONDS [LOAD_PERCENT]]     TACTUS=path/to/tactus to test another build
set -eu

seconds=${1:-600}
load=${2:-80}
tactus=${TACTUS:-build/release/tactus}
out=$(mktemp -d)
workers=()
trap '[ ${#workers[@]} -eq 0 ] || kill "${workers[@]}" 2>/dev/null || true; rm -rf "$out"' EXIT

command -v cyclictest >/dev/null || { echo "live_load: cyclictest is missing (package rt-tests)" >&2; exit 2; }
[ -x "$tactus" ] || { echo "live_load: no command at $tactus; build it, or set TACTUS" >&2; exit 2; }

# Busy for LOAD of every 10 ms, on core 0.
cat >"$out/burn.py" <<'PY'
import os, sys, time
share = float(sys.argv[1]) / 100.0
os.sched_setaffinity(0, {0})
while True:
    begin = time.perf_counter()
    while time.perf_counter() - begin < 0.01 * share:
        pass
    time.sleep(0.01 * (1.0 - share))
PY
python3 "$out/burn.py" "$load" &
workers+=($!)

# The same period, priority and clock as the force path's group.
cyclictest --quiet --mlockall --threads=1 --priority=60 --policy=fifo --interval=1000 --duration="$seconds" \
    --histogram=100000 >"$out/cyclictest.txt" 2>&1 &
cyclictest_id=$!
workers+=("$cyclictest_id")

"$tactus" run saw-training --seconds "$seconds" --out "$out/run" --json >"$out/summary.json"
wait "$cyclictest_id" || true

python3 - "$out/summary.json" "$out/cyclictest.txt" "$seconds" "$load" <<'PY'
import json, re, sys
summary = json.load(open(sys.argv[1]))
counts, worst = [], 0
for line in open(sys.argv[2]):
    row = re.match(r"^(\d+)\s+(\d+)\s*$", line)
    if row:
        counts.append((int(row[1]), int(row[2])))
    last = re.match(r"# Max Latencies:\s*(\d+)", line)
    if last:
        worst = int(last[1])
total = sum(n for _, n in counts)

def quantile(share):
    seen = 0
    for micros, n in counts:
        seen += n
        if seen >= share * total:
            return micros
    return 0

print(f"{sys.argv[3]} s of saw-training, one core loaded to {sys.argv[4]} %")
print(f"{'late by, us':>14} {'p50':>9} {'p99':>9} {'max':>9}")
print(f"{'cyclictest':>14} {quantile(0.5):>9} {quantile(0.99):>9} {worst:>9}")
for group in summary["groups"]:
    late = group["lateness_us"]
    print(f"{group['name']:>14} {late['p50']:>9.0f} {late['p99']:>9.0f} {late['max']:>9.0f}")
print()
for group in summary["groups"]:
    causes = ", ".join(f"{n} {cause.replace('_', ' ')}" for cause, n in group["skipped_because"].items() if n)
    print(f"{group['name']:>14}: {group['ticks']} ticks, {group['skipped']} skipped ({causes or 'none'}), "
          f"{group['misses']} reads of an older value; a call took {group['execution_us']['p50']:.0f} us, "
          f"p99 {group['execution_us']['p99']:.0f}, max {group['execution_us']['max']:.0f}")
for fault in summary["faults"]:
    print(f"fault of {fault['device']} at {fault['time_s']:.3f} s: {fault['reason']}")
attributed = all(sum(g["skipped_because"].values()) == g["skipped"] for g in summary["groups"])
long = sum(g["skipped_because"]["ran_long"] for g in summary["groups"])
print(f"every skipped tick has a cause: {'yes' if attributed else 'NO'}; because a node ran long: {long}")
sys.exit(0 if attributed else 1)
PY
