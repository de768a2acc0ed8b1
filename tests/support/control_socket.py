"""The control socket of a running contourd, as a test asks it. Between its end and its new beginning nobody answers."""
import json
import socket
import time

import yaml

ANSWER_s = 120  # a safety net on a busy host


class ControlSocket:
    def __init__(self, path):
        self.path = str(path)

    def ask(self, **request):
        with socket.socket(socket.AF_UNIX) as s:
            s.settimeout(ANSWER_s)
            s.connect(self.path)
            with s.makefile("rw", encoding="utf-8") as lines:
                lines.write(json.dumps(request) + "\n")
                lines.flush()
                return json.loads(lines.readline())

    def axis(self, name="x"):
        """As the machine file states it, overrides in it."""
        return yaml.safe_load(self.ask(request="machine_file")["yaml"])["axes"][name]

    def wait_for(self, state):
        self._until(lambda: self.ask(request="status")["status"]["state"] == state, f"never {state}")

    def await_axis(self, is_so):
        """Until axis x is so and the machine Idle."""
        self._until(lambda: is_so(self.axis()), "the axis never became so")
        self.wait_for("Idle")

    @staticmethod
    def _until(reached, why):
        for _ in range(1200):
            try:
                if reached():
                    return
            except (OSError, ValueError):
                pass
            time.sleep(0.05)
        raise RuntimeError(why)
