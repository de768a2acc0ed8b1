# The short form: cyclictest while nothing else runs, then the daemon, in one boot: timing_in_one_boot.sh PERIOD_us MACHINE PROGRAM
# SECONDS LOAD [KEY=VALUE...]. Leaves in /out what contour_on_vcan.sh does, and cyclictest's wake-ups as "alone".
period_us=$1
shift
sh /job/cyclictest.sh "$period_us" "$3" || exit 1
mv /out/wakeups /out/alone
exec sh /job/contour_on_vcan.sh "$@"
