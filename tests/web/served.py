"""`hysteron serve` as a process beside a test: a folder with its files, its ports from its status line, its end by SIGTERM."""
import os
import re
import signal
import subprocess
import tempfile
import time

TOOL = os.environ["HYSTERON_TOOL"]


class Served:
    """Given the text of a diagram, of a run file, and further arguments. Use it in a with statement."""

    def __init__(self, diagram, run_file, *arguments):
        self._folder = tempfile.TemporaryDirectory()
        self.path = self._folder.name
        self.write("diagram.st", diagram)
        self.write("RUN.toml", run_file)
        self.command = [TOOL, "serve", "diagram.st", "--config", "RUN.toml", "--engine", "interpreter", *arguments]

    def write(self, name, text, mode=0o600):
        with open(os.path.join(self.path, name), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(file.name, mode)
        return file.name

    def __enter__(self):
        with open(os.path.join(self.path, "notices.txt"), "w", encoding="utf-8") as notices:
            self.process = subprocess.Popen(self.command, cwd=self.path, stdout=subprocess.PIPE, stderr=notices, text=True)
        self.status = self.process.stdout.readline()
        if not self.status:
            self.process.wait()
            raise AssertionError(self.notices())
        self.modbus_port = self._port(r"Modbus on \S+:(\d+)")
        self.web_port = self._port(r"live page on http://\S+:(\d+)/")
        return self

    def notices(self):
        """What it has said on standard error so far."""
        with open(os.path.join(self.path, "notices.txt"), encoding="utf-8") as file:
            return file.read()

    def wait_for_notice(self, text, seconds=20.0):
        """What lasts shorter than the pace of notices may never be told of."""
        end = time.monotonic() + seconds
        while text not in self.notices():
            if time.monotonic() > end:
                raise AssertionError(f"{text!r} was not said: {self.notices()!r}")
            time.sleep(0.05)

    def _port(self, pattern):
        found = re.search(pattern, self.status)
        return int(found.group(1)) if found else None

    def map(self):
        """The file of the register map."""
        text = subprocess.run([TOOL, "map", "diagram.st", "--config", "RUN.toml", "--format", "json"], cwd=self.path,
                              check=True, capture_output=True, text=True).stdout
        return self.write("map.json", text)

    def stop(self):
        """Ends it; what it printed, and its exit code."""
        self.process.send_signal(signal.SIGTERM)
        out, _ = self.process.communicate(timeout=60)
        return self.status + out + self.notices(), self.process.returncode

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.stop()
        self.process.stdout.close()
        self._folder.cleanup()
