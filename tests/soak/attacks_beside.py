"""A whole task under attack: its live page, its MQTT client and its OPC UA gateway, each beside a victim on Modbus.

    HYSTERON_TOOL=build/hysteron python3 -m tests.soak.attacks_beside [SECONDS]

Prints Markdown. Each attack goes on for so many seconds, 5 without the number. A victim on Modbus asks 200 times a second
meanwhile; of the page and the gateway, another one asks 20 times a second. Beside the page, Python's http.server has the same
attacks. An answer that does not come within 2 s is an error. Exit code 1 where a victim on Modbus, or one of ours, had an error
or a wrong value, or where the task lost more than its victims, 0 else."""
import json
import os
import random
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

from tests.gateways import gateway
from tests.gateways.gateway import hello
from tests.web.served import Served

PATIENCE = 2.0
PATTERN = [0x1000 + 257 * i for i in range(16)]  # nobody may change these
ANSWERED = 20  # registers from here on belong to the victim
DIAGRAM = ("FUNCTION_BLOCK ATTACKED  (* @ts 10ms *)\n  VAR_INPUT\n"
           + "".join(f"    R{i} : WORD := WORD#16#{PATTERN[i] if i < 16 else 0:04X};\n" for i in range(32))
           + "    X : LREAL := 1.0;\n  END_VAR\n  VAR_OUTPUT\n    Y : LREAL;\n  END_VAR\n"
           "  VAR\n    LAG : HY_LAG := (T1 := 0.05);\n  END_VAR\n\n  LAG(XIN := X);\n  Y := LAG.XOUT;\nEND_FUNCTION_BLOCK\n")


def run_file(broker):
    registers = "".join(f'R{i} = "holding {i}"\n' for i in range(32))
    return f"""[task]
scheduling = "other"
lock_memory = false

[outputs.Y]
safe = 0.0

[modbus]
port = 0

[addresses]
{registers}
[mqtt]
broker = "127.0.0.1"
port = {broker}
every = "50ms"
"""


# Victims

def ask_modbus(port, seconds):
    """Reads and writes, and holds each answer against what it may be."""
    result = {"requests": 0, "errors": 0, "wrong": 0, "latencies": []}
    link, number, written, is_seen = None, 0, [], False  # an input is read back from the next cycle on
    end = time.monotonic() + seconds
    following = time.monotonic()
    while time.monotonic() < end:
        number = number % 65535 + 1
        writes = number % 4 == 0
        pdu = struct.pack(">BHH", 6, ANSWERED, number) if writes else struct.pack(">BHH", 3, 0, 21)
        request = struct.pack(">HHHB", number, 0, len(pdu) + 1, 1) + pdu
        wanted = 12 if writes else 9 + 42
        result["requests"] += 1
        begin = time.monotonic()
        try:
            link = link or socket.create_connection(("127.0.0.1", port), PATIENCE)
            link.settimeout(PATIENCE)
            link.sendall(request)
            answer = b""
            while len(answer) < wanted:
                part = link.recv(wanted - len(answer))
                if not part:
                    raise OSError("closed")
                answer += part
            result["latencies"].append(time.monotonic() - begin)
            if writes:
                written = written[-20:] + [number]
                result["wrong"] += answer != request
            else:
                values = struct.unpack(">21H", answer[9:])
                is_own = values[20] in written
                is_seen = is_seen or is_own
                result["wrong"] += answer[:2] != request[:2] or list(values[:16]) != PATTERN or (is_seen and not is_own)
        except OSError:
            result["errors"] += 1
            if link is not None:
                link.close()
            link = None
        following = max(following + 0.005, time.monotonic())
        time.sleep(max(0.0, following - time.monotonic()))
    return result


def ask_again(exchange, seconds):
    """A victim that connects anew each time, 20 times a second."""
    result = {"requests": 0, "errors": 0, "wrong": 0, "latencies": []}
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        begin = time.monotonic()
        result["requests"] += 1
        try:
            with socket.create_connection(("127.0.0.1", exchange["port"]), PATIENCE) as link:
                link.settimeout(PATIENCE)
                link.sendall(bytes.fromhex(exchange["sends"]))
                answer = b""
                while len(answer) < len(exchange["expects"]):
                    part = link.recv(4096)
                    if not part:
                        break
                    answer += part
            if answer.startswith(exchange["expects"].encode()):
                result["latencies"].append(time.monotonic() - begin)
            else:
                result["errors"] += 1
        except OSError:
            result["errors"] += 1
        time.sleep(max(0.0, 0.05 - (time.monotonic() - begin)))
    return result


# What all attackers do

def connected(port, patience=0.5):
    try:
        link = socket.create_connection(("127.0.0.1", port), patience)
        link.settimeout(patience)
        return link
    except OSError:
        return None


def held(port, stop, count, greeting=b""):
    """So many connections, each with the same first words, and nothing more; those that are ended are made again."""
    while not stop.is_set():
        links = []
        while len(links) < count and not stop.is_set():
            link = connected(port)
            if link is None:
                continue
            try:
                link.sendall(greeting)
            except OSError:
                pass
            links.append(link)
        stop.wait(0.2)
        for link in links:
            link.close()


def repeated(port, stop, words):
    while not stop.is_set():
        link = connected(port)
        if link is None:
            continue
        try:
            for _ in range(20):
                if stop.is_set():
                    break
                link.sendall(words())
                stop.wait(0.001)
        except OSError:
            pass
        link.close()


def dripped(port, stop, words):
    while not stop.is_set():
        link = connected(port)
        if link is None:
            continue
        try:
            for byte in words:
                if stop.is_set():
                    break
                link.sendall(bytes([byte]))
                stop.wait(0.4)
        except OSError:
            pass
        link.close()


def unread(port, stop, greeting, words):
    """Eight connections that ask and never read."""
    while not stop.is_set():
        links = []
        for _ in range(8):
            link = connected(port)
            if link is None:
                continue
            link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
            try:
                link.sendall(greeting)
            except OSError:
                pass
            link.setblocking(False)
            links.append(link)
        for _ in range(500):
            if stop.is_set():
                break
            for link in links:
                try:
                    link.send(words)
                except OSError:
                    pass
            stop.wait(0.01)
        for link in links:
            link.close()


DICE = random.Random(11)


def noise():
    return DICE.randbytes(1 + DICE.randrange(300))


# The live page

def get(target, port, lines=""):
    return f"GET {target} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n{lines}\r\n".encode()


def upgrade(port):
    return get("/api/stream", port, "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                                    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n")


ON_WEB = {
    "none": lambda port, stop: stop.wait(),
    "30 idle": lambda port, stop: held(port, stop, 30),
    "slow sender": lambda port, stop: dripped(port, stop, get("/api/values", port, "X-A: " + "a" * 500 + "\r\n")),
    "a header without end": lambda port, stop: repeated(port, stop, lambda: b"GET / HTTP/1.1\r\nX: " + b"a" * 9000),
    "a body of 93 GB": lambda port, stop: repeated(
        port, stop, lambda: f"POST /api/stage HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 99999999999\r\n\r\n".encode()),
    "random bytes": lambda port, stop: repeated(port, stop, noise),
    "commits without a token": lambda port, stop: repeated(
        port, stop, lambda: f"POST /api/commit HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 0\r\n\r\n".encode()),
    "a frame of 2^63 bytes": lambda port, stop: repeated(port, stop, lambda: upgrade(port) + b"\x81\xff\x7f" + b"\xff" * 7 + b"\0" * 4),
    "never reads": lambda port, stop: unread(port, stop, b"", get("/page.js", port) * 20),
    "streams that are not read": lambda port, stop: unread(port, stop, upgrade(port), b""),
    "1,100 connections": lambda port, stop: held(port, stop, 1100),
}


# The broker of MQTT, that means harm

ACCEPTED = b"\x20\x02\x00\x00"


def broker(port, stop, serve):
    """Takes the connections of the task; `serve(link)` is what it does with each."""
    with socket.socket() as listening:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(("127.0.0.1", port))
        listening.listen(64)
        listening.settimeout(0.1)
        while not stop.is_set():
            try:
                link, _ = listening.accept()
            except OSError:
                continue
            with link:
                link.settimeout(0.2)
                try:
                    link.recv(4096)  # CONNECT
                    serve(link)
                except OSError:
                    pass


def swallow(link, stop, words=b"", each=lambda: b"", pause=0.01):
    link.sendall(words)
    while not stop.is_set():
        try:
            if not link.recv(65536):
                return
        except TimeoutError:
            pass
        link.sendall(each())
        stop.wait(pause)


def drip(link, stop, words):
    for byte in words:
        link.sendall(bytes([byte]))
        stop.wait(0.4)


ON_MQTT = {
    "nobody listens": lambda port, stop: stop.wait(),
    "closes at once": lambda port, stop: broker(port, stop, lambda link: None),
    "says nothing": lambda port, stop: broker(port, stop, lambda link: swallow(link, stop)),
    "drips its greeting": lambda port, stop: broker(port, stop, lambda link: drip(link, stop, ACCEPTED)),
    "random bytes": lambda port, stop: broker(port, stop, lambda link: swallow(link, stop, noise(), noise)),
    "acknowledges nothing": lambda port, stop: broker(port, stop, lambda link: swallow(link, stop, ACCEPTED)),
    "acknowledges what was not sent": lambda port, stop: broker(
        port, stop, lambda link: swallow(link, stop, ACCEPTED, lambda: b"".join(
            b"\x40\x02" + struct.pack(">H", DICE.randrange(1, 65536)) for _ in range(50)))),
    "a packet of 256 MB": lambda port, stop: broker(
        port, stop, lambda link: swallow(link, stop, ACCEPTED + b"\x30\xff\xff\xff\x7f", lambda: b"a" * 65536, 0.0)),
    "never reads": lambda port, stop: broker(port, stop, lambda link: (link.sendall(ACCEPTED), stop.wait())),
}


# The gateway of OPC UA

ON_OPCUA = {
    "none": lambda port, stop: stop.wait(),
    "30 idle": lambda port, stop: held(port, stop, 30),
    "slow sender": lambda port, stop: dripped(port, stop, hello(port)),
    "random bytes": lambda port, stop: repeated(port, stop, noise),
    "a message of 4 GB": lambda port, stop: repeated(port, stop, lambda: hello(port, 0xFFFFFFFF)),
    "a message of 0 bytes": lambda port, stop: repeated(port, stop, lambda: hello(port, 0)),
    "greets and stays": lambda port, stop: held(port, stop, 30, hello(port)),
    "never reads": lambda port, stop: unread(port, stop, hello(port), b"MSGF" + struct.pack("<I", 65535) + b"a" * 4000),
    "1,100 connections": lambda port, stop: held(port, stop, 1100),
}
GROUPS = {"web": ON_WEB, "mqtt": ON_MQTT, "opcua": ON_OPCUA}


# Each in a process of its own

def part(name, **given):
    return subprocess.Popen([sys.executable, "-m", "tests.soak.attacks_beside", name, json.dumps(given)], stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, text=True)


def result_of(process):
    out, _ = process.communicate(timeout=120)
    return json.loads(out)


def run_part(name, given):
    if name == "attack":
        stop = threading.Event()
        threading.Thread(target=lambda: (sys.stdin.read(), stop.set()), daemon=True).start()
        while not stop.is_set():
            GROUPS[given["group"]][given["attack"]](given["port"], stop)
        return
    asked = ask_modbus(given["port"], given["seconds"]) if name == "modbus" else ask_again(given, given["seconds"])
    print(json.dumps(asked))


def beside(group, attack, port, seconds, victims):
    """The victims' results while the attack goes on."""
    attacker = part("attack", group=group, attack=attack, port=port)
    time.sleep(0.3)
    asking = [part(name, seconds=seconds, **given) for name, given in victims]
    results = [result_of(one) for one in asking]
    attacker.stdin.close()
    attacker.wait(timeout=60)
    attacker.stdout.close()
    return results


def columns(result, with_wrong=False):
    latencies = sorted(result["latencies"])
    at = lambda share: f"{1e3 * latencies[int(share * (len(latencies) - 1))]:.1f}" if latencies else "–"  # noqa: E731
    return f"{result['requests']} | {result['errors']} | " + (f"{result['wrong']} | " if with_wrong else "") + f"{at(0.99)} | {at(1.0)}"


def head(*names):
    print(f"| {' | '.join(names)} |\n|{' --- |' * len(names)}", flush=True)


MODBUS = ("Modbus: requests", "errors", "wrong", "p99, ms", "worst, ms")


class Sum:
    def __init__(self):
        self.well = True

    def add(self, *ours):
        self.well = self.well and all(one["errors"] == 0 and one["wrong"] == 0 for one in ours)


def on_web(task, seconds, total):
    print("\n### The live page\n\nA victim on Modbus, one that reads `/api/values`, and the same beside Python's `http.server`.\n")
    head("attack", *MODBUS, "page: requests", "errors", "p99, ms", "worst, ms", "plain: requests", "errors", "p99, ms", "worst, ms")
    for attack in ON_WEB:
        page = ("again", {"port": task.web_port, "sends": get("/api/values", task.web_port).hex(), "expects": "HTTP/1.1 200"})
        modbus, ours = beside("web", attack, task.web_port, seconds, [("modbus", {"port": task.modbus_port}), page])
        with tempfile.TemporaryDirectory() as folder:
            port = gateway.free_port()
            with open(os.path.join(folder, "values"), "w", encoding="ascii") as file:
                file.write("{}")
            plain = subprocess.Popen([sys.executable, "-m", "http.server", "--bind", "127.0.0.1", str(port)], cwd=folder,
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            gateway.eventually(lambda: connected(port) is not None, True, 20)
            (theirs,) = beside("web", attack, port, seconds,
                               [("again", {"port": port, "sends": get("/values", port).hex(), "expects": "HTTP/1.0 200"})])
            plain.kill()
            plain.wait()
        total.add(modbus, ours)
        print(f"| {attack} | {columns(modbus, True)} | {columns(ours)} | {columns(theirs)} |", flush=True)


def on_mqtt(task, port, seconds, total):
    print("\n### The MQTT client\n\nThe broker that the task is given means harm. The victim is on Modbus.\n")
    head("the broker", *MODBUS)
    for attack in ON_MQTT:
        (modbus,) = beside("mqtt", attack, port, seconds, [("modbus", {"port": task.modbus_port})])
        total.add(modbus)
        print(f"| {attack} | {columns(modbus, True)} |", flush=True)


def on_opcua(task, seconds, total):
    print("\n### The OPC UA gateway\n\nA victim on Modbus, and one that connects to the gateway and greets it.\n")
    reason = gateway.missing()
    if reason:
        print(f"Not tried: {reason}.")
        return
    head("attack", *MODBUS, "gateway: requests", "errors", "p99, ms", "worst, ms")
    sys.stdout.flush()
    own = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # of the gateway's library, which says there whom it refuses
    with gateway.Gateway(task.web_port, "--anonymous") as opcua:
        os.dup2(own, 1)
        for attack in ON_OPCUA:
            greeting = ("again", {"port": opcua.port, "sends": hello(opcua.port).hex(), "expects": "ACKF"})
            modbus, ours = beside("opcua", attack, opcua.port, seconds, [("modbus", {"port": task.modbus_port}), greeting])
            total.add(modbus)
            print(f"| {attack} | {columns(modbus, True)} | {columns(ours)} |", flush=True)


def main():
    if len(sys.argv) > 2:
        run_part(sys.argv[1], json.loads(sys.argv[2]))
        return 0
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 5.0
    total = Sum()
    port = gateway.free_port()
    print("A task of `hysteron serve` with Modbus, a live page, MQTT and an OPC UA gateway. An error is an answer that did not come within\n"
          "2 s, wrong is a value that nobody may have written.")
    with Served(DIAGRAM, run_file(port), "--web", "127.0.0.1:0") as task:
        on_web(task, seconds, total)
        on_mqtt(task, port, seconds, total)
        on_opcua(task, seconds, total)
        said, code = task.stop()
    account = re.search(r"(\d+) cycles, (\d+) skipped; late: (\d+) woken, (\d+) own CPU", said)
    cycles, skipped, woken, own = map(int, account.groups())
    total.well = total.well and code == 0 and own == 0
    print(f"\nThe task meanwhile: {cycles} cycles of 10 ms, {own} of them late by what they computed; {skipped} skipped and {woken} woken late on "
          f"a machine\nthat attackers and victims shared. It ended as asked, with exit code {code}.")
    return 0 if total.well else 1


if __name__ == "__main__":
    sys.exit(main())
