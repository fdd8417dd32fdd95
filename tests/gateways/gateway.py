"""The OPC UA gateway and a client of it as processes beside a test, and a live page that says what a test wants."""
import json
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

HERE = Path(__file__).resolve().parent
FOLDER = HERE.parents[1] / "gateways" / "opcua"
TOKEN = "a-token-of-this-test-0123456789"
PASSWORDS = {"anna": "password-of-anna", "ben": "password-of-ben"}  # anna may write


_KEYS = tempfile.TemporaryDirectory()  # of the client and of a gateway: making them takes longer than most of a test


def missing():
    """Why the gateway cannot be tried here; empty where it can."""
    if shutil.which("node") is None:
        return "there is no node"
    version = subprocess.run(["node", "--version"], capture_output=True, text=True, check=True).stdout
    if tuple(map(int, re.findall(r"\d+", version)[:2])) < (20, 19):
        return f"node is {version.strip()}, and 20.19 is needed"
    if not (FOLDER / "node_modules" / "node-opcua").is_dir():
        return f"node-opcua is not in {FOLDER}: scripts/install-dependencies opcua"
    return ""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def eventually(ask, expected, seconds=180):
    """What is asked, once it is as expected; or the last answer. A busy machine is given time."""
    end = time.monotonic() + seconds
    while True:
        answer = ask()
        if (expected(answer) if callable(expected) else answer == expected) or time.monotonic() > end:
            return answer
        time.sleep(0.1)


def hello(port, size=None):
    """The first message of a client, whose head may state another size."""
    url = f"opc.tcp://127.0.0.1:{port}".encode()
    body = struct.pack("<IIIIII", 0, 65536, 65536, 0, 0, len(url)) + url
    return b"HELF" + struct.pack("<I", size if size is not None else len(body) + 8) + body


class Gateway:
    """Given the port of a live page, and further arguments. Use it in a with statement."""

    def __init__(self, task_port, *arguments):
        self._folder = tempfile.TemporaryDirectory()
        self.path = Path(self._folder.name)
        self.users = self.path / "users.json"
        self.port = free_port()
        self.url = f"opc.tcp://127.0.0.1:{self.port}"
        self.lines = []
        self.command = ["node", FOLDER / "hysteron-opcua.js", "--task", f"http://127.0.0.1:{task_port}", "--listen",
                        f"127.0.0.1:{self.port}", "--state", self.path / "state", "--interval", "50ms", *arguments]

    def secret(self, text):
        """A file with the text, for its owner alone."""
        file = self.path / "token"
        file.touch(mode=0o600)
        file.write_text(text + "\n", encoding="utf-8")
        return file

    def add_users(self):
        for name, password in PASSWORDS.items():
            run(["add-user", name, "--users", self.users, *(["--may-write"] if name == "anna" else [])], password + "\n")
        return self.users

    def __enter__(self):
        kept = Path(_KEYS.name) / "gateway"
        if kept.is_dir():
            shutil.copytree(kept, self.path / "state" / "pki" / "own")
        self.process = subprocess.Popen(list(map(str, self.command)), stderr=subprocess.PIPE, text=True)
        self._reader = threading.Thread(target=lambda: self.lines.extend(iter(self.process.stderr.readline, "")))
        self._reader.start()
        try:
            self.wait_for_line("Listening on ")
        except AssertionError:
            self.__exit__()
            raise
        if not kept.is_dir():
            shutil.copytree(self.path / "state" / "pki" / "own", kept)
        return self

    def wait_for_line(self, text):
        found = eventually(lambda: any(text in line for line in list(self.lines)) or self.process.poll() is not None, True)
        if not found or not any(text in line for line in self.lines):
            raise AssertionError(f"no line with {text!r} in {self.lines}")

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        self.code = self.process.wait(timeout=60)
        self._reader.join()
        self.process.stderr.close()
        self._folder.cleanup()


def run(arguments, given=""):
    """The gateway as a command that ends."""
    return subprocess.run(["node", FOLDER / "hysteron-opcua.js", *map(str, arguments)], input=given, capture_output=True,
                          text=True, timeout=60)


class Client:
    """A client that connects as it is told. Use it in a with statement."""

    def __enter__(self):
        self._process = subprocess.Popen(["node", HERE / "opcua_client.js", FOLDER, Path(_KEYS.name) / "client"], stdin=subprocess.PIPE,
                                         stdout=subprocess.PIPE, text=True)
        return self

    def __getattr__(self, command):
        return lambda **given: self._do(command, given)

    def _do(self, command, given):
        self._process.stdin.write(json.dumps({"command": command, **given}) + "\n")
        self._process.stdin.flush()
        for line in self._process.stdout:
            if line.startswith(('{"result"', '{"error"')):
                answer = json.loads(line)
                if "error" in answer:
                    raise RuntimeError(answer["error"])
                return answer.get("result")
        raise AssertionError(f"the client ended within {command}")

    def __exit__(self, *_):
        self._process.stdin.close()
        self._process.wait(timeout=60)
        self._process.stdout.close()


def point(name, kind, data_type="real64", unit="1", low=None, high=None, meaning=""):
    return {"name": name, "kind": kind, "type": "real", "data_type": data_type, "unit": unit, "low": low, "high": high,
            "meaning": meaning}


class Page:
    """A live page that says what a test wants, and counts what it is asked. Use it in a with statement."""

    def __init__(self, points, values, inner=()):
        self.description = {"name": "PAGE", "period": 0.01, "diagram": "", "points": list(points), "inner": list(inner),
                            "history": [], "writable": False, "token_to_read": False}
        self.values = {"cycle": 1, "values": list(values), "inner": [0.0] * len(inner), "staged": []}
        self.asked = 0
        self.body = None  # what is answered instead
        self.status = 200
        self.goes_on = True
        page = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                page.asked += 1
                page.values["cycle"] += page.goes_on
                answer = page.description if self.path == "/api/description" else page.values
                body = (page.body or json.dumps(answer)).encode()
                self.send_response(page.status)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self._server.handle_error = lambda *_: None  # of a gateway that ends as it is answered
        self.port = self._server.server_address[1]

    def __enter__(self):
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_):
        self._server.shutdown()
        self._server.server_close()
