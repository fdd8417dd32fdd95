"""For scripts that try a generated host in a system of its own: how commands are run, what a client of Modbus is answered there,
and the table of what holds."""
import subprocess
import sys

UNIT = "hysteron-stage"  # of a diagram STAGE
PORT = 15802
# The first two registers of the discovery chain.
ASK = f"""import socket
s = socket.create_connection(("127.0.0.1", {PORT}), 2)
s.settimeout(2)
s.sendall(bytes([0, 1, 0, 0, 0, 6, 1, 3, 0x9c, 0x40, 0, 2]))
print(s.recv(13)[9:].decode("ascii"))"""


def run(*command, **options):
    """What a command prints. Ends the script where it fails."""
    words = list(map(str, command))
    done = subprocess.run(words, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)} failed:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def asked(leader):
    """What the host answers in the network of that process, where no Python is."""
    return subprocess.run(["nsenter", "--target", str(leader), "--net", sys.executable, "-c", ASK], capture_output=True, text=True)


def status_of(text):
    """The words of each line of /proc/PID/status."""
    return {line.split(":")[0]: line.split(":")[1].split() for line in text.splitlines()}


class Table:
    def __init__(self):
        self.good = True
        print("| what | result | holds |\n| --- | --- | --- |", flush=True)

    def row(self, what, result, holds):
        self.good = self.good and holds
        print(f"| {what} | {result} | {'yes' if holds else 'no'} |", flush=True)
