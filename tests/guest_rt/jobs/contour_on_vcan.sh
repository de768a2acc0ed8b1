# Daemon, emulated machine and a listener to the telemetry as processes of their own on vcan0, a program running for so many
# seconds: contour_on_vcan.sh MACHINE PROGRAM SECONDS LOAD [KEY=VALUE...]
# LOAD is a command that runs beside them from before the program begins until it ends, or empty.
# Leaves in /out: status.json after the program; wakeups and sends, lines "NANOSECONDS COUNT" over every cycle from the
# first to the last, sends_running while the program ran; late, how many cycles were in each state; worst_cycles; digest, a checksum of the daemon's log.
machine=$1 program=$2 seconds=$3 load=$4
shift 4
set_keys="--set realtime.cpu=0"
for key in "$@"; do set_keys="$set_keys --set $key"; done
socket=/run/contourd.sock

fail() {
  echo "FAILED: $1"
  tail -n 20 /tmp/*.log
  exit 1
}
wait_for() {  # WHAT COMMAND...
  what=$1 tries=0
  shift
  until "$@" >/dev/null 2>&1; do
    tries=$((tries + 1))
    [ "$tries" -lt 300 ] || fail "waited in vain for $what"
    sleep 0.1
  done
}
# The log says what happened without another process: to load and end one as large as contour makes the kernel fetch and
# free pages behind locks that the cycle needs to send, and there is but one processor.
logged() { grep -q -e "$1" /tmp/contourd.log; }

ip link add dev vcan0 type vcan
ip link set vcan0 up
lcm-logger --quiet /tmp/telemetry.lcm >/tmp/lcm-logger.log 2>&1 &
logger=$!
# shellcheck disable=SC2086  # the keys hold no blanks
contour emulate --config "$machine" --bus vcan0 $set_keys >/tmp/emulator.log 2>&1 &
emulator=$!
wait_for "the emulated machine" grep -q ready /tmp/emulator.log
# Real drives answer whatever else the computer does. Its first thread alone: the one on the bus.
chrt -f -p 70 "$emulator" || fail "no real-time priority for the emulated machine"
# shellcheck disable=SC2086
contourd --config "$machine" --bus vcan0 --socket "$socket" --log /tmp/cycles.lcm $set_keys >/tmp/contourd.log 2>&1 &
daemon=$!
wait_for "state Idle" logged "-> Idle"
contour enable --socket "$socket" || fail "enable was refused"
wait_for "state Ready" logged "-> Ready"
if [ -n "$load" ]; then
  # shellcheck disable=SC2086  # words
  $load >/tmp/load.log 2>&1 &
  load_process=$!
  sleep 1
fi
contour run "$program" --socket "$socket" >/tmp/run.log 2>&1 &
wait_for "state Running" logged "-> Running"
sleep "$seconds"
if logged "Running ->"; then fail "the program ended before its time"; fi
if [ -n "$load" ]; then
  kill -0 "$load_process" || fail "the load ended before its time"
  kill -INT "$load_process"
  wait "$load_process"
fi
contour stop --socket "$socket" || fail "stop was refused"
wait_for "state Ready again" logged "Stopping -> Ready"
contour status --json --socket "$socket" >/out/status.json || fail "no status"
kill -TERM "$daemon"
wait "$daemon"
status=$?
[ "$status" -eq 0 ] || fail "contourd ended with $status"
kill -INT "$logger"
wait "$logger"
[ -s /tmp/telemetry.lcm ] || fail "no telemetry came over LCM"
cp /tmp/contourd.log /out/

contour export /tmp/cycles.lcm --out /tmp/cycles.csv \
  --columns cycle,state,wakeup_late_us,received_us,stepped_us,sent_us,solver_iterations,late >/dev/null || fail "the log cannot be read"
awk -F, '
  NR > 1 {printf "%.0f %.0f cycle %d %s woken %.3f received %.3f stepped %.3f sent %.3f us, %d iterations\n",
                 1000 * $3, 1000 * $6, $1, $2, $3, $4, $5, $6, $7}' /tmp/cycles.csv >/tmp/times
awk -F, 'NR > 1 {late[$2] += $8} END {for (state in late) print state, late[state]}' /tmp/cycles.csv | sort >/out/late
histogram() { cut -d' ' -f"$1" /tmp/times | sort -n | uniq -c | awk '{print $2, $1}'; }  # COLUMN
worst() { sort -rn -k"$1,$1" /tmp/times | head -n 20 | cut -d' ' -f3-; }                # COLUMN
histogram 1 >/out/wakeups
histogram 2 >/out/sends
grep " Running " /tmp/times >/tmp/running
cut -d' ' -f2 /tmp/running | sort -n | uniq -c | awk '{print $2, $1}' >/out/sends_running
# The cycles to look at when a bar is missed.
{ echo "woken last:"; worst 1; echo "sent last:"; worst 2; } >/out/worst_cycles
sha256sum </tmp/cycles.lcm | cut -d' ' -f1 >/out/digest
