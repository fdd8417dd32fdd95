"""The Modbus server as jsmodbus and modbus-serial see it: every function that they have, in every word order.

As a program it prints the table of docs/runtime-results.md:

  HYSTERON_TOOL=build/hysteron /usr/bin/python3 -m tests.clients.test_js_clients
"""
import json
import os
import shutil
import subprocess
import sys
import unittest

from tests.web.served import Served

CACHE = os.environ.get("XDG_CACHE_HOME", os.path.expanduser("~/.cache"))
FOLDER = os.environ.get("HYSTERON_JS_CLIENTS", os.path.join(CACHE, "hysteron", "js-clients"))
HERE = os.path.dirname(os.path.abspath(__file__))
CLIENTS = ("jsmodbus", "modbus-serial")
ORDERS = ("ABCD", "CDAB", "BADC", "DCBA")

# Every output says what its input was: what is written over Modbus comes back through a step of the task.
DIAGRAM = """FUNCTION_BLOCK ECHO  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL;
    N : DINT;  (* @min -1000000000 @max 1000000000 *)
    W : WORD;
    B : BOOL;
    C : BOOL;
  END_VAR
  VAR_OUTPUT
    X_BACK : LREAL;
    N_BACK : DINT;
    C_BACK : BOOL;
  END_VAR

  X_BACK := X;
  N_BACK := N;
  C_BACK := C;
END_FUNCTION_BLOCK
"""
RUN_FILE = """[task]
scheduling = "other"
lock_memory = false
[outputs.X_BACK]
safe = 0.0
[outputs.N_BACK]
safe = 0
[outputs.C_BACK]
safe = 0
[modbus]
port = 0
word_order = "{}"
"""


def missing():
    """Why these clients cannot be tried here; empty where they can."""
    if shutil.which("node") is None:
        return "there is no node"
    absent = [client for client in CLIENTS if not os.path.isdir(os.path.join(FOLDER, "node_modules", client))]
    return f"{', '.join(absent)}: not in {FOLDER}; scripts/install-js-clients fetches them" if absent else ""


def versions():
    read = {}
    for client in CLIENTS:
        with open(os.path.join(FOLDER, "node_modules", client, "package.json"), encoding="utf-8") as file:
            read[client] = json.load(file)["version"]
    return read


def tried(client, order):
    """What each function came to, by its number."""
    with Served(DIAGRAM, RUN_FILE.format(order.lower())) as served:
        run = subprocess.run(["node", os.path.join(HERE, "interop.js"), "functions", client, str(served.modbus_port),
                              served.map()], env={**os.environ, "NODE_PATH": os.path.join(FOLDER, "node_modules")},
                             capture_output=True, text=True, timeout=250)
    results = dict(line.split(": ", 1) for line in run.stdout.splitlines())
    if run.returncode != 0:
        raise AssertionError(f"{client}, {order}, after {results}: {run.stderr}")
    return results


@unittest.skipIf(missing(), missing())
class JavaScriptClients(unittest.TestCase):
    def test_every_function_in_every_word_order(self):
        for client in CLIENTS:
            for order in ORDERS:
                with self.subTest(client=client, order=order):
                    results = tried(client, order)
                    self.assertGreater(len(results), 8)
                    for name, result in results.items():
                        offered = client == "modbus-serial" or name not in ("function 22", "function 23")
                        self.assertEqual(result, "ok" if offered else "not offered", name)


def print_table():
    results = {f"{client} {version}": [tried(client, order) for order in ORDERS] for client, version in versions().items()}
    print("| asked for | " + " | ".join(results) + " |")
    print("| --- |" + " --- |" * len(results))
    for name in next(iter(results.values()))[0]:
        said = []
        for runs in results.values():
            good = [run[name] for run in runs].count("ok")
            said.append(f"right in {good} of {len(ORDERS)}" if good else runs[0][name])
        print(f"| {name} | " + " | ".join(said) + " |")


if __name__ == "__main__":
    if missing():
        sys.exit(missing())
    print_table()
