"""A contourd on the in-process bus in virtual time, for as long as the `with` block lasts."""
import contextlib
import subprocess
from pathlib import Path

from free_port import free_port


@contextlib.contextmanager
def lockstep_daemon(contourd, machine_file, scratch, *options):
    """Yields its process; its control socket is `scratch`/control.sock. What it said is printed where the block fails, and it has to
    end with status 0."""
    port = free_port()
    command = [contourd, "--config", machine_file, "--clock", "lockstep", "--socket", f"{scratch}/control.sock", *options]
    for override in ("telemetry.publish=false", f"io.modbus.port={port}", f"emulator.io.port={port}"):
        command += ["--set", override]
    with open(f"{scratch}/daemon.txt", "w", encoding="utf-8") as messages:
        process = subprocess.Popen(command, stdout=messages, stderr=messages)
    try:
        yield process
    except Exception:
        print(Path(f"{scratch}/daemon.txt").read_text(encoding="utf-8"))
        raise
    finally:
        process.terminate()
        status = process.wait(timeout=60)
    assert status == 0, status
