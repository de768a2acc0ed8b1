#!/usr/bin/env bash
# The guest has a real SocketCAN: what cansend sends, candump sees, in order and unchanged; a link that is down says so.
set -euo pipefail

frames=(080#01 201#0F00E803 181#2706CCFFFFFF1234 000#8200)

candump -L -n ${#frames[@]} vcan0 >/tmp/seen &
reader=$!
# Without a listener the list says "(vcan0: no entry)".
until grep -q '^ *vcan0 ' /proc/net/can/rcvlist_all; do sleep 0.01; done
for frame in "${frames[@]}"; do cansend vcan0 "$frame"; done
wait $reader

awk '{print $3}' /tmp/seen >/tmp/seen_frames
diff <(printf '%s\n' "${frames[@]}") /tmp/seen_frames || { echo "candump saw other frames than were sent"; exit 1; }

ip link set vcan0 down
if cansend vcan0 080#01 2>/tmp/error; then echo "sending on a link that is down succeeded"; exit 1; fi
grep -qi "network is down" /tmp/error || { echo "unexpected error: $(cat /tmp/error)"; exit 1; }
ip link set vcan0 up
cansend vcan0 080#02
echo "SocketCAN on vcan0: ${#frames[@]} frames there and back"
