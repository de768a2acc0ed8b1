# How many cycles lie between an operator's program being started for a stop and the cycle that begins to brake, by the numbers
# that the daemon gives its cycles: stop_in_cycles.sh MACHINE PROGRAM WHAT
# WHAT fails meanwhile: nothing, log (into a pipe that nobody reads), lcm (the same), clients (sixteen that flood the control socket and never read).
machine=$1 program=$2 what=$3
most_cycles=100
socket=/run/contourd.sock
options=""

fail() {
  echo "FAILED: $what: $1"
  tail -n 20 /tmp/*.log
  exit 1
}
wait_for() {  # WHAT COMMAND...
  awaited=$1 tries=0
  shift
  until "$@" >/dev/null 2>&1; do
    tries=$((tries + 1))
    [ "$tries" -lt 300 ] || fail "waited in vain for $awaited"
    sleep 0.1
  done
}
logged() { grep -q -e "$1" /tmp/contourd.log; }
blocked_pipe() {  # is open at its other end, and never read
  mkfifo "$1"
  sleep 100000 <>"$1" &
}
cycle_of() { sed -n "s/.*$1.*(cycle \([0-9]*\)).*/\1/p" /tmp/contourd.log | tail -n 1; }

# Inputs that are stale stop the machine by themselves; here the stop is to come from the operator.
sed -e '/emergency_stop:/d' -e '/enable_chain:/d' "$machine" >/tmp/machine.yaml
ip link add dev vcan0 type vcan
ip link set vcan0 up
contour emulate --config /tmp/machine.yaml --bus vcan0 --set realtime.cpu=0 >/tmp/emulator.log 2>&1 &
emulator=$!
wait_for "the emulated machine" grep -q ready /tmp/emulator.log
chrt -f -p 70 "$emulator" || fail "no real-time priority for the emulated machine"
case $what in
  log) blocked_pipe /tmp/pipe && options="--log /tmp/pipe" ;;
  lcm) blocked_pipe /tmp/pipe && options="--set telemetry.lcm_url=file:///tmp/pipe?mode=w" ;;
esac
# shellcheck disable=SC2086  # words
contourd --config /tmp/machine.yaml --bus vcan0 --socket "$socket" --set realtime.cpu=0 $options >/tmp/contourd.log 2>&1 &
wait_for "state Idle" logged "-> Idle"
contour enable --socket "$socket" || fail "enable was refused"
wait_for "state Ready" logged "-> Ready"
contour run "$program" --socket "$socket" >/tmp/run.log 2>&1 &
wait_for "state Running" logged "-> Running"
sleep 3
if [ "$what" = clients ]; then
  flooding_clients "$socket" >/tmp/flood.log 2>&1 &
  wait_for "the clients" grep -q flooding /tmp/flood.log
  sleep 1
fi
if logged "Running ->"; then fail "the program ended before its time"; fi
asked=$(contour status --json --socket "$socket" | sed -n 's/^ *"cycle": \([0-9]*\),.*/\1/p' | head -n 1)
contour stop --socket "$socket" || fail "stop was refused"
wait_for "the stop" logged "Running -> Stopping"
braking=$(cycle_of "Running -> Stopping")
[ -n "$asked" ] && [ -n "$braking" ] || fail "no cycle: asked in '$asked', braking from '$braking'"
echo "$what: status in cycle $asked, braking from cycle $braking: $((braking - asked)) cycles, two starts of a program among them"
[ $((braking - asked)) -le "$most_cycles" ] || fail "braking began $((braking - asked)) cycles later, more than $most_cycles"
wait_for "state Ready again" logged "Stopping -> Ready"
