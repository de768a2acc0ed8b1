# cyclictest alone: cyclictest.sh PERIOD_us SECONDS. Leaves /out/wakeups, one line "NANOSECONDS COUNT" for each latency.
set -e
period_us=$1 seconds=$2
cycles=$((seconds * 1000000 / period_us))
cyclictest --quiet --mlockall --priority=80 --interval="$period_us" --loops="$cycles" --nsecs --histogram=100000 >/tmp/found
sed -n 's/^0*\([0-9][0-9]*\) 0*\([1-9][0-9]*\)$/\1 \2/p' /tmp/found >/out/wakeups
grep '^#' /tmp/found | grep -i latencies
