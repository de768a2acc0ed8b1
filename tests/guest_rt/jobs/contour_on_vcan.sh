# Daemon, emulated machine and a listener to the telemetry as processes of their own on vcan0, a program running for so many
# seconds: contour_on_vcan.sh MACHINE PROGRAM SECONDS LOAD [KEY=VALUE...]
# LOAD is a command that runs beside them from before the program begins until after it has been stopped, or empty.
# Leaves in /out: status.json after the program; wakeups and sends, lines "NANOSECONDS COUNT" over every cycle from the
# first to the last; window_wakeups, window_sends and window (lines "KEY VALUE") of the program's first so many seconds, in which nothing begins or
# ends; late_causes, lines "STATE CAUSE COUNT"; worst_cycles; digest, a checksum of the daemon's log.
machine=$1 program=$2 seconds=$3 load=$4
shift 4
period_us=$(sed -n 's/^  cycle_us: \([0-9]*\).*/\1/p' "$machine")
for key in "$@"; do
  case $key in machine.cycle_us=*) period_us=${key#*=} ;; esac
done
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
  setsid $load >/tmp/load.log 2>&1 &  # a group of its own
  load_process=$!
  sleep 1
fi
contour run "$program" --socket "$socket" >/tmp/run.log 2>&1 &
wait_for "state Running" logged "-> Running"
sleep "$seconds"
if logged "Running ->"; then fail "the program ended before its time"; fi
contour stop --socket "$socket" || fail "stop was refused"
wait_for "state Ready again" logged "Stopping -> Ready"
if [ -n "$load" ]; then
  kill -0 "$load_process" || fail "the load ended before its time"
  # Asked to end, stress-ng may take minutes: one of its own loads keeps it from hearing of it.
  kill -s KILL -- "-$load_process"
  wait "$load_process"
fi
contour status --json --socket "$socket" >/out/status.json || fail "no status"
kill -TERM "$daemon"
wait "$daemon"
status=$?
[ "$status" -eq 0 ] || fail "contourd ended with $status"
kill -INT "$logger"
wait "$logger"
[ -s /tmp/telemetry.lcm ] || fail "no telemetry came over LCM"
cp /tmp/contourd.log /out/

columns=cycle,state,wakeup_late_us,received_us,stepped_us,sent_us,solver_iterations,late_cause,skipped_grid_points,stale_cycles,page_faults,involuntary_switches
contour export /tmp/cycles.lcm --out /tmp/cycles.csv --columns "$columns" >/dev/null || fail "the log cannot be read"
awk -F, '
  NR > 1 {printf "%.0f %.0f cycle %d %s woken %.3f received %.3f stepped %.3f sent %.3f us, %d iterations\n",
                 1000 * $3, 1000 * $6, $1, $2, $3, $4, $5, $6, $7}' /tmp/cycles.csv >/tmp/times
awk -F, -v wanted=$((seconds * 1000000 / period_us)) '
  $2 == "Running" && cycles < wanted {
    if (cycles++ == 0) stale = $10
    late += $8 != "none"
    skipped += $9
    last_stale = $10
    printf "%.0f %.0f\n", 1000 * $3, 1000 * $6 >"/tmp/window"
  }
  END {printf "cycles %d\nlate_cycles %d\nskipped_grid_points %d\nstale_cycles %d\n", cycles, late, skipped, last_stale - stale}
' /tmp/cycles.csv >/out/window
awk -F, 'NR > 1 && $8 != "none" {late[$2 " " $8]++} END {for (key in late) print key, late[key]}' /tmp/cycles.csv | sort >/out/late_causes
histogram() { cut -d' ' -f"$1" "$2" | sort -n | uniq -c | awk '{print $2, $1}'; }  # COLUMN FILE
worst() { sort -rn -k"$1,$1" /tmp/times | head -n 20 | cut -d' ' -f3-; }           # COLUMN
histogram 1 /tmp/times >/out/wakeups
histogram 2 /tmp/times >/out/sends
histogram 1 /tmp/window >/out/window_wakeups
histogram 2 /tmp/window >/out/window_sends
# The cycles to look at when a bar is missed.
{
  echo "woken last:"; worst 1
  echo "sent last:"; worst 2
  echo "held up:"
  awk -F, 'NR > 1 && $11 + $12 > 0 {print "cycle", $1, $2, "page faults", $11, "involuntary switches", $12, "sent", $6, "us"}' /tmp/cycles.csv
} >/out/worst_cycles
sha256sum </tmp/cycles.lcm | cut -d' ' -f1 >/out/digest
