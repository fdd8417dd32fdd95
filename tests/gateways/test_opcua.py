"""A task that `hysteron serve` runs, as a client of OPC UA sees it through the gateway."""
import contextlib
import os
import random
import shutil
import socket
import struct
import subprocess
import time
import unittest

from tests.gateways.gateway import (FOLDER, PASSWORDS, TOKEN, Client, Gateway, Page, eventually, free_port, hello, missing,
                                    point, run)
from tests.web.served import Served

DIAGRAM = """FUNCTION_BLOCK STAGE  (* @ts 10ms *)
  VAR_INPUT
    SCALE : LREAL := 1.0;  (* @min 0 @max 2 *)
    RESET : BOOL;
  END_VAR
  VAR_OUTPUT
    U : LREAL;  (* @unit V *)
    Y : LREAL;  (* @unit um *)
    COUNT : DINT;
  END_VAR
  VAR
    WAVE : HY_SINE := (AMPLITUDE := 30.0, FREQUENCY := 0.2);
    HYST : HY_HYSTERESIS_RO := (C1 := 0.15, C2 := 0.01, C3 := 0.7);
    CLAMP : HY_LIMIT := (MN := -100.0, MX := 100.0);
    LAG : HY_LAG := (T1 := 0.05);
  END_VAR

  HYST(XIN := SCALE * WAVE.XOUT, R1 := RESET);
  CLAMP(XIN := HYST.XOUT);
  LAG(XIN := CLAMP.XOUT);
  U := SCALE * WAVE.XOUT;
  Y := LAG.XOUT;
  COUNT := -3;
  WAVE();
END_FUNCTION_BLOCK
"""
EDITED = DIAGRAM.replace("U : LREAL;  (* @unit V *)", "U : LREAL;  (* @unit mV *)").replace("COUNT", "LEVEL")
RUN_FILE = """[task]
scheduling = "other"
lock_memory = false
[outputs.U]
safe = 0.0
[outputs.Y]
safe = 0.0
[outputs.COUNT]
safe = 0
"""
RANGE = {"low": 0, "high": 2}
VOLT = {"namespaceUri": "http://www.opcfoundation.org/UA/units/un/cefact", "unitId": 5655636,
        "displayName": {"text": "V"}, "description": {"text": "volt"}}
STATE = point("task.state", "status", "uint16", meaning="0 starting, 1 running, 2 faulted, 3 stopped")
FAULT = point("task.fault", "status", "uint16", meaning="0 none, 1 hang, 2 crash, 3 not finite, 4 stale input, 5 lost link")


@unittest.skipIf(missing(), missing())
class OfATask(unittest.TestCase):
    def start(self, *arguments, users=True):
        """A task, its gateway, and a client that is not connected."""
        self.port = free_port()
        self.task = Served(DIAGRAM, RUN_FILE, "--web", f"127.0.0.1:{self.port}", "--web-token-file", "token")
        self.task.write("token", TOKEN + "\n")
        self.enterContext(self.task)
        self.gateway = Gateway(self.port, *arguments)
        self.gateway.command += ["--token-file", self.gateway.secret(TOKEN), "--writable"] if users else []
        self.gateway.command += ["--users", self.gateway.add_users()] if users else ["--anonymous"]
        self.enterContext(self.gateway)
        self.gateway.wait_for_line("Linked to STAGE")
        return self.enterContext(Client())

    def connect(self, client, user="anna", **how):
        client.connect(url=self.gateway.url, user=user, password=PASSWORDS[user], **how)

    def kill_task(self):
        self.task.process.kill()
        self.task.process.wait(timeout=60)
        self.task.process.stdout.close()

    def test_points_stand_in_folders_with_units_ranges_and_types(self):
        client = self.start()
        self.connect(client)
        self.assertEqual([name for name in client.browse(node="Task") if name != "NodeVersion"],
                         ["Inputs", "Outputs", "Parameters", "Status", "Signals", "Connected", "Program", "Period", "Layout"])
        self.assertEqual(client.browse(node="Inputs")[1:], ["SCALE", "RESET"])
        self.assertEqual(client.browse(node="Outputs")[1:], ["U", "Y", "COUNT"])
        self.assertLess({"LAG.T1", "HYST.C1", "Commit", "Discard", "Waiting", "LastRefusal"}, set(client.browse(node="Parameters")))
        self.assertIn("task.cycles", client.browse(node="Status"))
        self.assertIn("HYST.XOUT", client.browse(node="Signals"))
        types = {"Inputs/SCALE": "Double", "Inputs/RESET": "Boolean", "Outputs/COUNT": "Int32", "Status/task.cycles": "UInt64",
                 "Status/task.state": "UInt16", "Status/task.lateness_worst": "Int64", "Task.Program": "String"}
        for node, kind in types.items():
            self.assertEqual(client.read(node=node)["type"], kind, node)
        self.assertEqual(client.read(node="Outputs/COUNT")["value"], -3)
        scale = client.read(node="Inputs/SCALE.EURange")["value"]
        self.assertEqual({key: scale[key] for key in RANGE}, RANGE)
        unit = client.read(node="Outputs/U.EngineeringUnits")["value"]
        self.assertEqual((unit["namespaceUri"], unit["unitId"]), (VOLT["namespaceUri"], VOLT["unitId"]))
        self.assertEqual(unit["displayName"]["text"], "V")
        self.assertEqual([text["text"] for text in client.read(node="Status/task.state.EnumStrings")["value"]],
                         ["starting", "running", "faulted", "stopped"])
        kinds = {"Inputs/SCALE": "AnalogItemType", "Outputs/U": "AnalogUnitType", "Inputs/RESET": "TwoStateDiscreteType",
                 "Status/task.state": "MultiStateDiscreteType", "Outputs/COUNT": "BaseDataVariableType"}
        for node, kind in kinds.items():
            self.assertEqual(client.attributes(node=node)["is"], kind, node)
        self.assertIn("at least 0 s", client.attributes(node="Parameters/LAG.T1")["description"])

    def test_a_subscription_sees_values_change_with_the_time_of_the_snapshot(self):
        client = self.start()
        self.connect(client)
        self.assertEqual(client.watch(nodes=["Outputs/U", "Inputs/SCALE"], interval=10), [50, 50], "no faster than --interval")
        seen = eventually(lambda: client.seen(node="Outputs/U"), lambda all_of_it: len(all_of_it) > 10)
        self.assertGreater(len({one["value"] for one in seen}), 10)
        self.assertEqual({one["status"] for one in seen}, {"Good"})
        times = [one["source"] for one in seen]
        self.assertEqual(times, sorted(times))
        self.assertLessEqual(times[-1], time.time() * 1000 + 1)
        self.assertEqual(len(client.seen(node="Inputs/SCALE")), 1, "what does not change is sent once")

    def test_a_write_is_staged_refused_in_the_tasks_words_and_committed(self):
        client = self.start()
        self.connect(client)
        before = client.read(node="Parameters/LAG.T1")["value"]
        self.assertEqual(client.write(node="Parameters/LAG.T1", value=-3), "BadOutOfRange")
        self.assertEqual(client.read(node="Parameters.LastRefusal")["value"], "LAG.T1 must be at least 0 s; -3 was given.")
        self.assertEqual(client.write(node="Parameters/LAG.T1", value="a lot", type="String"), "BadTypeMismatch")
        self.assertEqual(client.write(node="Inputs/SCALE", value=1.5), "BadNotWritable")

        self.assertEqual(client.write(node="Parameters/LAG.T1", value=0.2), "Good")
        self.assertEqual(client.read(node="Parameters/LAG.T1")["value"], before, "a staged value does not count yet")
        self.assertEqual(client.read(node="Parameters.Waiting")["value"], ["LAG.T1 = 0.2"])
        self.assertEqual(client.call(method="Discard"), {"status": "Good", "refusal": ""})
        self.assertEqual(client.read(node="Parameters.Waiting")["value"], [])

        client.write(node="Parameters/LAG.T1", value=0.3)
        self.assertEqual(client.call(method="Commit"), {"status": "Good", "refusal": ""})
        self.assertEqual(eventually(lambda: client.read(node="Parameters/LAG.T1")["value"], 0.3), 0.3)
        self.gateway.wait_for_line("Commit by anna: taken")

        client.write(node="Parameters/CLAMP.MN", value=200.0)
        refused = client.call(method="Commit")
        self.assertEqual(refused["status"], "BadInvalidState")
        self.assertIn("CLAMP", client.read(node="Parameters.LastRefusal")["value"])
        self.assertEqual(client.read(node="Parameters/CLAMP.MN")["value"], -100.0)

    def test_who_may_read_may_not_write_and_a_wrong_password_is_refused(self):
        client = self.start()
        for user, password in (("anna", "password-of-ben"), ("nobody", "password-of-anna"), (None, None)):
            with self.assertRaises(RuntimeError):
                client.connect(url=self.gateway.url, user=user, password=password)
        self.gateway.wait_for_line('A wrong name or password was given for "anna"')
        self.connect(client, "ben")
        self.assertEqual(client.read(node="Inputs/SCALE")["status"], "Good")
        self.assertEqual(client.write(node="Parameters/LAG.T1", value=0.2), "BadUserAccessDenied")
        self.assertEqual(client.call(method="Commit")["status"], "BadUserAccessDenied")
        self.assertEqual({key: client.attributes(node="Parameters/LAG.T1")[key] for key in ("access", "mine")},
                         {"access": 3, "mine": 1})
        # a user who is taken out while the gateway runs is out
        users = self.gateway.users.read_text(encoding="utf-8")
        self.gateway.users.write_text("{" + users[users.index('"ben"'):], encoding="utf-8")
        self.gateway.wait_for_line("Users: ") if eventually(lambda: self.refused("anna"), True) else self.fail("anna is still let in")
        self.connect(client, "ben")

    def test_of_the_whole_server_parameters_alone_are_open_to_writes(self):
        client = self.start()
        standard = {"ns=0;i=11492", "ns=0;i=12749", "ns=0;i=12873"}  # GetMonitoredItems, SetSubscriptionDurable, ResendData
        self.connect(client, "ben")
        self.assertEqual(client.allowed()["variables"], [])
        self.assertEqual(set(client.allowed()["methods"]), standard)
        self.connect(client)
        may = client.allowed()
        parameters = {f"Parameters/{name}" for name in client.browse(node="Parameters") if "." in name}
        self.assertEqual(set(may["variables"]), parameters)
        self.assertGreater(len(parameters), 8)
        self.assertEqual(set(may["methods"]), standard | {"Parameters.Commit", "Parameters.Discard"})

    def refused(self, user):
        with Client() as other:
            try:
                self.connect(other, user)
            except RuntimeError:
                return True
        return False

    def test_read_only_is_the_default(self):
        client = self.start(users=False)
        client.connect(url=self.gateway.url)
        self.assertNotIn("Commit", client.browse(node="Parameters"))
        self.assertEqual(client.attributes(node="Parameters/LAG.T1")["access"], 1)
        self.assertEqual(client.write(node="Parameters/LAG.T1", value=0.2), "BadUserAccessDenied")

    def test_a_client_is_encrypted_once_its_certificate_is_trusted(self):
        client = self.start()
        policies = client.endpoints(url=self.gateway.url)
        self.assertIn(["Basic256Sha256", "SignAndEncrypt"], policies)
        self.assertEqual({mode for policy, mode in policies if policy != "None"}, {"SignAndEncrypt"})
        with self.assertRaises(RuntimeError):
            self.connect(client, policy="Basic256Sha256")
        pki = self.gateway.path / "state" / "pki"
        rejected = eventually(lambda: list((pki / "rejected").glob("*.pem")), lambda found: found)
        self.assertEqual(len(rejected), 1)
        time.sleep(3)  # an operator looks at it first; the library learns of its own file by an event, and of the move by another
        shutil.move(rejected[0], pki / "trusted" / "certs")
        self.assertEqual(eventually(lambda: self.refusal_of(client), ""), "", self.gateway.lines)
        self.assertEqual(client.read(node="Inputs/SCALE")["value"], 1.0)
        self.assertEqual((pki / "own" / "private" / "private_key.pem").stat().st_mode & 0o077, 0)

    def refusal_of(self, client):
        try:
            self.connect(client, policy="Basic256Sha256")
        except RuntimeError as refusal:
            return str(refusal)
        return ""

    def test_a_task_that_is_killed_is_missed_and_found_again(self):
        client = self.start()
        self.connect(client)
        client.watch(nodes=["Outputs/U"], interval=50)
        self.kill_task()
        self.assertEqual(eventually(lambda: client.read(node="Outputs/U")["status"], "BadNoCommunication"), "BadNoCommunication")
        self.assertEqual(client.read(node="Task.Connected")["value"], False)
        self.assertEqual(client.write(node="Parameters/LAG.T1", value=0.2), "BadNoCommunication")
        self.assertEqual(client.call(method="Commit")["status"], "BadNoCommunication")
        self.task.__enter__()
        self.assertEqual(eventually(lambda: client.read(node="Outputs/U")["status"], "Good"), "Good")
        seen = eventually(lambda: client.seen(node="Outputs/U"), lambda all_of_it: all_of_it[-1]["status"] == "Good")
        order = [one["status"] for one in seen]
        self.assertLess(order.index("BadNoCommunication"), len(order) - 1, "the watch went on over the restart")
        self.assertEqual(len([line for line in self.gateway.lines if "No link" in line]), 1, "a line for a change, none for a try")

    def test_another_diagram_changes_the_nodes_that_are_others(self):
        client = self.start()
        self.connect(client)
        layout = client.read(node="Task.Layout")["value"]
        client.watch(nodes=["Outputs/Y", "Outputs/U", "Outputs/COUNT"], interval=50)
        self.assertEqual(client.events(type="GeneralModelChangeEventType"), "Good")
        versions = {name: client.property(node=name, name="NodeVersion")["value"] for name in ("Inputs", "Outputs")}
        self.assertEqual(client.namespace_version()["value"], layout[:16])
        self.task.stop()
        self.task.process.stdout.close()
        self.task.write("diagram.st", EDITED)
        self.task.write("RUN.toml", RUN_FILE.replace("COUNT", "LEVEL"))
        self.task.__enter__()
        self.assertNotEqual(eventually(lambda: client.read(node="Task.Layout")["value"], lambda now: now != layout), layout)
        self.assertEqual(set(client.browse(node="Outputs")[1:]), {"U", "Y", "LEVEL"})
        self.assertEqual(client.read(node="Outputs/COUNT")["status"], "BadNodeIdUnknown")
        unit = client.read(node="Outputs/U.EngineeringUnits")["value"]
        self.assertEqual(unit["displayName"]["text"], "mV")
        known = len(client.seen(node="Outputs/Y"))
        self.assertGreater(len(eventually(lambda: client.seen(node="Outputs/Y"), lambda all_of_it: len(all_of_it) > known + 3)),
                           known + 3, "who watched a node that stayed goes on")
        gone = eventually(lambda: client.seen(node="Outputs/COUNT")[-1]["status"], lambda status: status.startswith("BadNodeId"))
        self.assertEqual(gone, "BadNodeIdInvalid", "who watched a node that went is told")
        events = eventually(lambda: client.seen(node="events"), lambda seen: seen)
        self.assertEqual(len(events), 1, "one event for all that changed")
        self.assertIn("Outputs", " ".join(events[0]))
        self.assertEqual(client.namespace_version()["value"], client.read(node="Task.Layout")["value"][:16])
        self.assertEqual(client.property(node="Inputs", name="NodeVersion")["value"], versions["Inputs"])
        self.assertGreater(int(client.property(node="Outputs", name="NodeVersion")["value"]), int(versions["Outputs"]))

    def test_the_task_may_come_after_the_gateway(self):
        port = free_port()
        with Gateway(port, "--anonymous") as gateway, Client() as client:
            client.connect(url=gateway.url)
            self.assertEqual(client.read(node="Task.Connected")["value"], False)
            gateway.wait_for_line("No link to the task")
            task = Served(DIAGRAM, RUN_FILE, "--web", f"127.0.0.1:{port}")
            with task:
                gateway.wait_for_line("Linked to STAGE")
                self.assertEqual(eventually(lambda: client.read(node="Outputs/COUNT")["value"], -3), -3)
        self.assertEqual(gateway.code, 0)

    def test_a_crowd_of_sessions_is_bounded_and_the_task_goes_on(self):
        client = self.start("--sessions", "5")
        self.connect(client)
        nodes = [f"Status/{name}" for name in client.browse(node="Status")[1:]]
        crowd = client.crowd(url=self.gateway.url, count=12, nodes=nodes, how={"user": "ben", "password": PASSWORDS["ben"]})
        self.assertEqual(crowd["made"], 4, crowd["refusal"])
        cycles = client.read(node="Status/task.cycles")["value"]
        self.assertGreater(eventually(lambda: client.read(node="Status/task.cycles")["value"], lambda now: now > cycles + 100),
                           cycles + 100)

    def test_a_chunk_that_is_too_long_ends_its_own_connection_alone(self):
        client = self.start()
        self.connect(client)
        for kind in (b"MSGF", b"OPNF", b"CLOF", b"MSGC"):
            with socket.create_connection(("127.0.0.1", self.gateway.port), timeout=10) as one:
                one.sendall(hello(self.gateway.port) + kind + struct.pack("<I", 65535) + 4000 * b"a")  # one packet: nobody listens yet
                one.settimeout(30)
                with contextlib.suppress(ConnectionError):
                    while one.recv(4096):  # to its end
                        pass
        self.assertEqual(client.read(node="Status/task.state")["value"], 1)
        self.assertIsNone(self.gateway.process.poll())

    def test_no_message_ends_the_gateway(self):
        client = self.start()
        self.connect(client)
        chance = random.Random(5)
        policy = b"http://opcfoundation.org/UA/SecurityPolicy#None"
        for _ in range(150):
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self.gateway.port), timeout=10) as one:
                if chance.random() < 0.9:
                    one.sendall(hello(self.gateway.port))
                if chance.random() < 0.5:
                    one.settimeout(1)
                    one.recv(64)
                for _ in range(chance.randint(1, 4)):
                    body = chance.randbytes(chance.choice((0, 1, 4, 8, 24, 60, 132, 500, 3000)))
                    if chance.random() < 0.4:  # a channel is asked for, as it should be, and then as it should not
                        body = struct.pack("<Ii", 0, len(policy)) + policy + struct.pack("<iiII", -1, -1, 1, 1) + body
                    size = chance.choice((len(body) + 8, len(body) + 8, 0, 7, 8, 4096, 65535, 2**31, 2**32 - 1))
                    kind = chance.choice((b"OPN", b"MSG", b"CLO", b"HEL", b"ERR", b"RHE", b"XYZ")) + chance.choice((b"F", b"C", b"A", b"?"))
                    one.sendall(kind + struct.pack("<I", size) + body)
        self.assertIsNone(self.gateway.process.poll(), self.gateway.lines[-20:])
        self.assertEqual(client.read(node="Status/task.state")["value"], 1)

    def test_who_says_nothing_or_only_greets_keeps_no_client_out(self):
        client = self.start("--sessions", "2")
        for greeting in (b"", hello(self.gateway.port)):
            crowd = []
            self.addCleanup(lambda all=crowd: [one.close() for one in all])
            for _ in range(400):
                crowd.append(socket.create_connection(("127.0.0.1", self.gateway.port), timeout=10))
                crowd[-1].sendall(greeting)
            self.connect(client)
            self.assertEqual(client.read(node="Status/task.state")["value"], 1)
            client.close()


@unittest.skipIf(missing(), missing())
class OfAPage(unittest.TestCase):
    """What a running task does seldom, or not at a test's word."""

    def start(self, page, *arguments):
        self.enterContext(page)
        self.gateway = self.enterContext(Gateway(page.port, "--anonymous", *arguments))
        self.gateway.wait_for_line("Linked to PAGE")
        client = self.enterContext(Client())
        client.connect(url=self.gateway.url)
        return client

    def test_the_status_says_how_far_a_value_is_to_be_trusted(self):
        page = Page([point("X", "input", low=0.0, high=1.0), point("Y", "output"), point("G.K", "parameter"), STATE, FAULT],
                    [0.5, 2.0, 3.0, 1, 0])
        client = self.start(page)

        def expect(values, x, y, k="Good"):
            page.values["values"] = values
            wanted = {"Inputs/X": x, "Outputs/Y": y, "Parameters/G.K": k}
            self.assertEqual(eventually(lambda: {node: client.read(node=node)["status"] for node in wanted}, wanted), wanted)

        expect([0.5, 2.0, 3.0, 1, 0], "Good", "Good")
        expect([0.5, 2.0, 3.0, 0, 0], "UncertainInitialValue", "UncertainInitialValue")
        expect([0.5, 2.0, 3.0, 2, 4], "UncertainLastUsableValue", "UncertainSubstituteValue")
        expect([0.5, 2.0, 3.0, 2, 1], "UncertainSubNormal", "UncertainSubstituteValue")
        expect([0.5, 2.0, 3.0, 3, 0], "BadOutOfService", "BadOutOfService")
        expect([1.5, None, 3.0, 1, 0], "UncertainEngineeringUnitsExceeded", "BadOutOfRange")
        page.goes_on = False
        expect([0.5, 2.0, 3.0, 1, 0], *3 * ["UncertainLastUsableValue"])
        page.goes_on = True
        expect([0.5, 2.0, 3.0, 1, 0], "Good", "Good")

    def test_what_is_no_live_page_is_said_to_be_none(self):
        page = Page([point("X", "input"), STATE], [0.5, 1])
        client = self.start(page)
        for status, body, words in ((200, "<html>", "no JSON"), (401, '{"refusal": "The token is missing or wrong."}', "401: The token"),
                                    (503, "busy", "503")):
            page.status, page.body = status, body
            self.gateway.wait_for_line(words)
            self.assertEqual(client.read(node="Inputs/X")["status"], "BadNoCommunication")
        page.status, page.body = 200, None
        self.assertEqual(eventually(lambda: client.read(node="Inputs/X")["status"], "Good"), "Good")

    def test_a_task_of_an_unknown_version_is_refused_and_asked_for_again(self):
        page = Page([point("X", "input", "real128"), STATE], [0.5, 1])
        self.enterContext(page)
        gateway = self.enterContext(Gateway(page.port, "--anonymous"))
        gateway.wait_for_line("another version of Hysteron")
        page.description["points"][0]["data_type"] = "real64"
        gateway.wait_for_line("Linked to PAGE")

    def test_the_task_is_asked_as_often_for_many_clients_as_for_none(self):
        page = Page([*(point(f"X{i}", "input") for i in range(50)), STATE], [*50 * [0.5], 1])
        client = self.start(page, "--interval", "500ms", "--sessions", "8")

        def asked_in_a_while():
            begun, asked = time.monotonic(), page.asked
            time.sleep(3)
            return (page.asked - asked) / (time.monotonic() - begun)

        crowd = client.crowd(url=self.gateway.url, count=7, nodes=[f"Inputs/X{i}" for i in range(50)], how={})
        self.assertEqual(crowd["made"], 7, crowd["refusal"])
        self.assertLessEqual(asked_in_a_while(), 2.4, "two a second, whoever watches what")


@unittest.skipIf(missing(), missing())
class CommandLine(unittest.TestCase):
    def test_a_mistake_is_told_with_its_mend(self):
        gateway = Gateway(1)
        open_to_all = gateway.path / "open"
        open_to_all.write_text("{}", encoding="utf-8")
        open_to_all.chmod(0o644)
        task = ["--task", "http://127.0.0.1:1"]
        cases = [([], "--task is missing"), (["--task", "https://a", "--anonymous"], "take a tunnel"), (task, "Nobody could connect"),
                 ([*task, "--anonymous", "--listen", "4840"], "127.0.0.1:4840"), ([*task, "--anonymous", "--interval", "1"], "50ms"),
                 ([*task, "--anonymous", "--sessions", "0"], "1 to 200"), ([*task, "--users", open_to_all], "chmod 600"),
                 ([*task, "--anonymous", "--writable"], "--token-file"), ([*task, "--users", "/nowhere"], "ENOENT"),
                 ([*task, "--anonymous", "--writable", "--token-file", gateway.secret(TOKEN)], "--users"),
                 ([*task, "--anonymous", "--token-file", gateway.secret("short")], "no token"), (["--unknown"], "usage:"),
                 (["add-user", "anna"], "--users FILE")]
        for arguments, words in cases:
            done = run(arguments)
            self.assertEqual((done.returncode, words in done.stderr), (2, True), f"{arguments}: {done.stderr}")
            self.assertNotIn("    at ", done.stderr, "no stack for a user's mistake")
        for name, password, words in (("anonymous", "long-enough-one", "no name"), ("a b", "long-enough-one", "no name"),
                                      ("anna", "short", "8 at least")):
            done = run(["add-user", name, "--users", gateway.users], password)
            self.assertEqual((done.returncode, words in done.stderr), (2, True), done.stderr)
        self.assertFalse(gateway.users.exists(), "nothing is left of a refusal")
        gateway._folder.cleanup()

    def test_passwords_are_hashed_in_a_file_of_the_owner_alone(self):
        gateway = Gateway(1)
        text = gateway.add_users().read_text(encoding="utf-8")
        self.assertEqual(gateway.users.stat().st_mode & 0o777, 0o600)
        for password in PASSWORDS.values():
            self.assertNotIn(password, text)
        self.assertEqual(os.listdir(gateway.path), ["users.json"])
        gateway._folder.cleanup()


class Parts(unittest.TestCase):
    @unittest.skipIf(shutil.which("node") is None, "there is no node")
    def test_the_parts_that_need_no_library(self):
        done = subprocess.run(["node", "--test", FOLDER.parents[1] / "tests" / "gateways" / "parts.test.js"], capture_output=True,
                              text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
