"""Every output in JSON is what its schema says, no key more and none less; and every key of a schema occurs."""
import json
import math
import os
import shutil
import socket
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

try:
    import jsonschema
except ImportError:
    raise unittest.SkipTest("python3-jsonschema is not installed") from None

TOOL = os.environ["HYSTERON_TOOL"]
SCHEMAS = Path(__file__).parents[2] / "docs/reference/schemas"

PLANT = """FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V @min -10 @max 10 *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit um *)
  END_VAR
  VAR
    AMP : HY_GAIN := (K := 2.0);
    LAG : HY_LAG := (T1 := 0.01);
  END_VAR

  AMP(XIN := U);
  LAG(XIN := AMP.XOUT);
  Y := LAG.XOUT;
END_FUNCTION_BLOCK
"""
LOOP = """FUNCTION_BLOCK LOOP  (* @ts 10ms *)
  VAR_INPUT SP : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR P : HY_GAIN; PLANT : HY_INTEGRAL_FORWARD; END_VAR
  P(XIN := SP - PLANT.XOUT);
  Y := PLANT.XOUT;
  PLANT(XIN := P.XOUT);
END_FUNCTION_BLOCK
"""
AXIS = """FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT I : LREAL; (* @unit A *) END_VAR
  VAR_OUTPUT OMEGA : LREAL; (* @unit rad/s *) END_VAR
  VAR
    KT : HY_GAIN := (K := 0.05);
    TORQUE : LREAL;  (* @unit N*m *)
    DRY : HY_COULOMB_FRICTION := (LEVEL := 0.002, PRESLIDE := 0.00002);
    INERTIA : HY_GAIN := (K := 5000.0);
    SPEED : HY_INTEGRAL_FORWARD;
  END_VAR
  KT(XIN := I);
  TORQUE := KT.XOUT;
  DRY(XIN := TORQUE, V := SPEED.XOUT);
  INERTIA(XIN := DRY.XOUT);
  OMEGA := SPEED.XOUT;
  SPEED(XIN := INERTIA.XOUT);
END_FUNCTION_BLOCK
"""
SETTINGS = """[fit.AMP]
K = {}

[tune]
test = [1.0, 2.0]
initial_states = ["LAG.RATE1"]
"""
FAULTY = "FUNCTION_BLOCK A\n  VAR_OUTPUT Y : LREAL; END_VAR\n  VAR G : HY_GAIN; H : HY_GAIN; END_VAR\n  G(XIN := H.XOUT);\n" \
         "  H(XIN := G.XOUT);\n  Y := H.XOUT;\n  Y := 2.0;\nEND_FUNCTION_BLOCK\n"
# A wall clock that was set, what the replay of a runtime's trace, a measured inner signal and an FMU say; tests of their own have them.
RARE = {"history": {"before", "seconds"},
        "fit": {"instance", "file", "derivatives", "relative_step", "instances", "steps"},
        "verdict": {"agrees", "controller", "same_bits", "different", "first_different", "dropped", "outputs", "difference_rms",
                    "limited_rms"}}


def strict(schema):
    """The schema that refuses a key which it does not describe."""
    if isinstance(schema, list):
        return [strict(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    made = {key: strict(value) for key, value in schema.items()}
    if isinstance(schema.get("properties"), dict) and "additionalProperties" not in schema:
        made["additionalProperties"] = False
    return made


def described(schema):
    """Every key that a schema describes."""
    if isinstance(schema, list):
        return set().union(*map(described, schema)) if schema else set()
    if not isinstance(schema, dict):
        return set()
    own = set(schema["properties"]) if isinstance(schema.get("properties"), dict) else set()
    return own.union(*(described(value) for value in schema.values()))


def keys_in(data):
    if isinstance(data, list):
        return set().union(*map(keys_in, data)) if data else set()
    if not isinstance(data, dict):
        return set()
    return set(data).union(*map(keys_in, data.values()))


class Schemas(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        machine = PLANT.replace("HY_LAG := (T1 := 0.01)", "HY_HYSTERESIS_RO := (C1 := 9.0, C2 := 1.5, C3 := 0.8)")
        machine = machine.replace("K := 2.0", "K := 1.0")
        files = {"plant.st": PLANT, "machine.st": machine, "faulty.st": FAULTY, "p.toml": SETTINGS}
        rows = []
        u = 0.0
        noise = 7
        for k in range(2000):
            step = (k // 250) % 4
            u += (0.008, -0.006, 0.005, -0.007)[step]
            noise = 16807 * noise % 2147483647
            rows.append((k * 0.001, u, noise / 2147483647 - 0.5))
        files["drive.csv"] = "t,U\n" + "".join(f"{t:.3f},{u:.6f}\n" for t, u, _ in rows)
        for name, text in files.items():
            (cls.folder / name).write_text(text, encoding="utf-8")
        cls.printed("run", "machine.st", "--in", "drive.csv", "--out", "moved.csv")
        moved = [float(line.split(",")[1]) for line in (cls.folder / "moved.csv").read_text().splitlines()[1:]]
        text = "t,U,Y,STATE\n" + "".join(f"{t:.3f},{u:.6f},{y + 0.05 * n:.5f},RUN\n" for (t, u, n), y in zip(rows, moved))
        (cls.folder / "log.csv").write_text(text, encoding="utf-8")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def printed(cls, *arguments, codes=(0,)):
        done = subprocess.run([TOOL, *arguments], cwd=cls.folder, capture_output=True, text=True)
        assert done.returncode in codes, f"{arguments} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}"
        return done.stdout

    def holds(self, name, *texts):
        schema = json.loads((SCHEMAS / f"{name}.json").read_text(encoding="utf-8"))
        validator = jsonschema.Draft202012Validator(strict(schema))
        validator.check_schema(schema)
        seen = set()
        for text in texts:
            data = json.loads(text)
            faults = [inner for one in validator.iter_errors(data) for inner in one.context or [one]]
            self.assertEqual([f"{list(one.absolute_path)}: {one.message[-200:]}" for one in faults][:5], [])
            seen |= keys_in(data)
        self.assertLessEqual(described(schema) - seen, RARE.get(name, set()), "described and never seen")

    def test_diagnostics(self):
        self.holds("diagnostics", self.printed("check", "--json", "faulty.st", codes=(1,)),
                   self.printed("check", "--json", "plant.st"), self.printed("check", "--json", "none.st", codes=(1, 2)))

    def test_blocks(self):
        self.holds("blocks", self.printed("blocks", "--json"), self.printed("blocks", "HY_LAG", "--json"))

    def test_record(self):
        self.holds("record", self.printed("record", "log.csv", "--json"),
                   self.printed("record", "log.csv", "--for", "plant.st", "--params", "p.toml", "--json"))

    def test_history(self):
        (self.folder / "run.toml").write_text('[outputs.Y]\nsafe = 0.0\n[history]\nfile = "history.sqlite"\nevery = "1ms"\n')
        self.printed("serve", "plant.st", "--config", "run.toml", "--virtual", "--engine", "interpreter", "--cycles", "1500")
        self.holds("history", self.printed("history", "history.sqlite", "--json"))

    def test_retained(self):
        (self.folder / "keeping.toml").write_text('[outputs.Y]\nsafe = 0.0\n[retain]\nfolder = "kept"\n')
        self.printed("serve", "plant.st", "--config", "keeping.toml", "--virtual", "--engine", "interpreter", "--cycles", "100")
        self.holds("retained", self.printed("retained", "kept", "--json"))

    def test_compare(self):
        (self.folder / "other.csv").write_text("t,U,Y,N\n0,0,0,1\n0.001,0.5,0.1,1\n0.0025,0.5,0.1,1\n0.0035,1,nan,1\n")
        (self.folder / "other.toml").write_text("[parameters.AMP]\nK = 3.0\n")
        (self.folder / "others.toml").write_text("[parameters.AMP]\nK = 4.0\n")
        changed = PLANT.replace("@unit um", "@unit mm").replace("K := 2.0", "K := 3.0").replace("Y := LAG.XOUT", "Y := AMP.XOUT")
        (self.folder / "changed.st").write_text(changed.replace("LAG : HY_LAG := (T1 := 0.01);", "LAG : HY_INTEGRAL;"))
        for name, used in (("one", "lag"), ("two", "offset")):
            self.printed("diagnose", "plant.st", "--log", "log.csv", "--params", "p.toml", "--out", name, "--effects", used)
        self.holds("compare", *(self.printed("compare", *files, "--json", codes=(1,)) for files in (
            ("log.csv", "other.csv"), ("other.toml", "others.toml"), ("plant.st", "changed.st"),
            ("one/verdict.json", "two/verdict.json"))))

    def test_online_change(self):
        (self.folder / "online.toml").write_text('[task]\nscheduling = "other"\nlock_memory = false\n[outputs.Y]\nsafe = 0.0\n'
                                                 '[modbus]\nport = 0\n[online_change]\nsocket = "online-change.socket"\n')
        (self.folder / "changed.st").write_text(PLANT)
        command = [TOOL, "serve", "changed.st", "--config", "online.toml", "--engine", "interpreter"]
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as task:
            try:
                self.assertIn("online change on", task.stdout.readline())
                # In front of the others, so that a restart without a lock file moves them.
                (self.folder / "changed.st").write_text(PLANT.replace("    AMP :", "    AHEAD : HY_GAIN := (K := 1.0);\n    AMP :")
                                                        .replace("AMP(XIN := U)", "AHEAD(XIN := U);\n  AMP(XIN := AHEAD.XOUT)"))
                self.holds("online-change", self.printed("online-change", "online.toml", "--check", "--json"),
                           self.printed("online-change", "online.toml", "--json"))
            finally:
                task.terminate()

    def test_fit(self):
        self.holds("fit", self.printed("tune", "plant.st", "--log", "log.csv", "--params", "p.toml", "--out", "tuned.toml",
                                       "--start", "2", "--report", "report", "--json", codes=(0, 1)),
                   (self.folder / "report/report.json").read_text(encoding="utf-8"))

    def test_goal_and_relay(self):
        (self.folder / "loop.st").write_text(LOOP, encoding="utf-8")
        goal = "[fit.P]\nK = {min = 0.0}\n[goal]\nsettling_time = 0.5\n"
        (self.folder / "bare.toml").write_text(goal, encoding="utf-8")
        (self.folder / "goal.toml").write_text(goal + 'loop = "P.XOUT"\n[goal.limits]\neffort = 4.0\n', encoding="utf-8")
        self.holds("goal", self.printed("tune", "loop.st", "--params", "bare.toml", "--out", "bare_tuned.toml", "--json"),
                   self.printed("tune", "loop.st", "--params", "goal.toml", "--out", "goal_tuned.toml", "--start", "2",
                                "--report", "goal_report", "--json"),
                   (self.folder / "goal_report/report.json").read_text(encoding="utf-8"))
        rows, y, u = [], 0.0, 1.2
        for k in range(3000):
            u = 1.2 if y < -0.05 else -0.3 if y > 0.05 else u
            rows.append((0.01 * k, u if k >= 50 else 0.0, y))
            y += 0.01 * (rows[max(0, k - 30)][1] - y)
        (self.folder / "relay.csv").write_text("t,U,Y\n" + "".join(f"{t:.2f},{u},{y:.6f}\n" for t, u, y in rows))
        (self.folder / "late.csv").write_text("t,U,Y\n" + "".join(f"{t:.2f},{u},{y:.6f}\n" for t, u, y in rows[100:]))
        self.holds("relay", self.printed("relay", "relay.csv", "--u", "U", "--y", "Y", "--json"),
                   self.printed("relay", "late.csv", "--u", "U", "--y", "Y", "--json"))

    def test_export(self):
        (self.folder / "axis.st").write_text(AXIS, encoding="utf-8")
        (self.folder / "current.csv").write_text("t,I\n" + "".join(f"{0.001 * k:.3f},{k % 7 - 3}\n" for k in range(500)))
        (self.folder / "arm.xml").write_text('<mujoco><worldbody><body><joint name="j"/><geom size=".1"/></body></worldbody></mujoco>')
        self.holds("export", self.printed("export", "axis.st", "--in", "current.csv", "--out", "bench.xml", "--json"),
                   self.printed("export", "axis.st", "--into", "arm.xml", "--joint", "j", "--out", "new.xml", "--json"))

    def test_map(self):
        self.holds("map", self.printed("map", "plant.st", "--format", "json"))

    def test_doctor(self):
        (self.folder / "machine" / "proc").mkdir(parents=True)  # of a machine that tells nothing
        self.holds("doctor", self.printed("doctor", "--rt", "--seconds", "0.02", "--json", codes=(0, 1)),
                   self.printed("doctor", "--rt", "--root", "machine", "--json", codes=(0, 1)))

    def test_fleet(self):
        (self.folder / "broken.csv").write_text("no record")
        (self.folder / "fleet.csv").write_text("machine,when,diagram,params,log\nA,2026-05-02,plant.st,p.toml,log.csv\n"
                                               "B,,plant.st,p.toml,broken.csv\n")
        self.holds("fleet", self.printed("fleet", "fleet.csv", "--out", "fleet", "--effort", "0.01", "--share", "2/2", "--json",
                                         codes=(1,)),
                   self.printed("fleet", "fleet.csv", "--out", "fleet", "--effort", "0.01", "--json", codes=(1,)))

    def test_fleet_report(self):
        header = "machine,when,command,diagram,params,log\n"
        (self.folder / "broken.csv").write_text("no record")
        months = "".join(f"A,2026-0{k}-01,tune,plant.st,p.toml,log.csv\n" for k in range(1, 5))
        (self.folder / "machines.csv").write_text(header + months + "A,,,plant.st,p.toml,log.csv\nB,,,plant.st,p.toml,broken.csv\n")
        self.printed("fleet", "machines.csv", "--out", "machines", "--effort", "0.01", codes=(1,))
        # Four fits of the same record do not differ: a ramp is written into them.
        units = json.loads(self.printed("fleet", "machines.csv", "--out", "machines", "--effort", "0.01", "--json", codes=(1,)))
        for k, unit in enumerate(units["units"][:4]):
            path = self.folder / "machines" / unit["folder"] / "report.json"
            report = json.loads(path.read_text(encoding="utf-8"))
            report["parameters"][0]["value"] += k
            report["parameters"][0]["standard_error"] = 0.001
            path.write_text(json.dumps(report), encoding="utf-8")
        self.holds("fleet-report", self.printed("fleet-report", "machines", "--json"))

    def test_verdict(self):
        (self.folder / "still.csv").write_text("t,U,Y\n" + "".join(f"{k * 0.001:.3f},0,0\n" for k in range(100)))
        y, integral, loop = 0.0, 0.0, "t,U,Y\n"
        for k in range(400):
            measured = y + 0.01 * math.sin(7.0 * k * k)
            integral -= 0.02 * measured
            u = integral - measured + 0.5
            loop += f"{k * 0.001:.3f},{u:.6f},{measured:.6f}\n"
            y += 0.1 * (2.0 * u - y)
        (self.folder / "loop.csv").write_text(loop, encoding="utf-8")
        self.holds("verdict", self.printed("diagnose", "plant.st", "--log", "loop.csv", "--params", "p.toml", "--out", "looped",
                                           "--effort", "0.01", "--json"),
                   self.printed("diagnose", "plant.st", "--log", "log.csv", "--params", "p.toml", "--out", "found",
                                           "--explain", "--effort", "0.01", "--json"),
                   (self.folder / "found/verdict.json").read_text(encoding="utf-8"),
                   self.printed("diagnose", "plant.st", "--log", "still.csv", "--params", "p.toml", "--out", "still", "--json",
                                codes=(1,)))

    def test_proof(self):
        (self.folder / "values.toml").write_text("[parameters.AMP]\nK = 3.0\n", encoding="utf-8")
        self.printed("generate", "plant.st", "--target", "c", "--params", "values.toml", "--proof", "--out", "proved")
        self.printed("generate", "machine.st", "--target", "st", "--proof", "--out", "proved")
        self.holds("proof", *(file.read_text(encoding="utf-8") for file in (self.folder / "proved").glob("*.proof.json")))

    def test_mqtt(self):
        broker = shutil.which("mosquitto", path=os.environ["PATH"] + ":/usr/sbin")
        listener = shutil.which("mosquitto_sub")
        if broker is None or listener is None:
            self.skipTest("no broker is installed: apt install mosquitto mosquitto-clients")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        (self.folder / "broker.conf").write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
        (self.folder / "mqtt.toml").write_text(
            "[task]\nscheduling = \"other\"\nlock_memory = false\n[outputs.Y]\nsafe = 0.0\n"
            f"[mqtt]\nbroker = \"127.0.0.1\"\nport = {port}\nevery = \"10ms\"\ntopic = \"plant\"\n")
        quiet = {"cwd": self.folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen([broker, "-c", "broker.conf"], **quiet) as serving:
            try:
                for _ in range(1000):
                    with socket.socket() as client:
                        if client.connect_ex(("127.0.0.1", port)) == 0:
                            break
                    time.sleep(0.01)
                heard = subprocess.Popen([listener, "-h", "127.0.0.1", "-p", str(port), "-t", "plant/#", "-F", "%t %p", "-W", "20"],
                                         cwd=self.folder, stdout=subprocess.PIPE, text=True)
                self.printed("serve", "plant.st", "--config", "mqtt.toml", "--cycles", "300")
                messages = {"plant/data": [], "plant/state": ['{"online":false}']}  # the last is the broker's, of a crash
                for line in heard.stdout:
                    topic, text = line.split(" ", 1)
                    messages[topic].append(text)
                    if topic == "plant/state" and not json.loads(text)["online"]:
                        break
                heard.kill()
                heard.communicate()
            finally:
                serving.kill()
        self.assertGreater(len(messages["plant/data"]), 5)
        self.holds("mqtt-data", *messages["plant/data"])
        self.holds("mqtt-state", *messages["plant/state"])

    def test_diagram(self):
        try:
            import hysteron
        except ImportError as reason:
            self.skipTest(f"the Python package cannot be imported: {reason}")
        from hysteron import _library
        table = PLANT.replace("AMP : HY_GAIN := (K := 2.0)", "AMP : HY_TABLE := (X := [0.0, 1.0], Y := [0.0, 2.0])")
        texts = []
        for text in (PLANT, table if "HY_TABLE" in self.printed("blocks") else PLANT):
            diagram = hysteron.compile(text)
            texts.append(_library.library.hysteron_diagram_json(diagram._pointer).decode())
        self.holds("diagram", *texts)


if __name__ == "__main__":
    unittest.main()
