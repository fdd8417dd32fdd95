"""What a Prometheus server gets of a running `hysteron serve`. promtool, where it is installed, reads it too."""
import re
import shutil
import subprocess
import time
import unittest
import urllib.error
import urllib.request

from tests.web.served import Served

TOKEN = "a-token-of-this-test-0123456789"
DIAGRAM = """FUNCTION_BLOCK TANK  (* @ts 10ms *)
  VAR_INPUT
    INFLOW : LREAL := 1.0;  (* @unit l/s *)
  END_VAR
  VAR_OUTPUT
    FLOW_TOTAL : LREAL;  (* @unit l/s *)
  END_VAR
  VAR
    LAG : HY_LAG := (T1 := 0.05);
  END_VAR

  LAG(XIN := INFLOW);
  FLOW_TOTAL := LAG.XOUT;
END_FUNCTION_BLOCK
"""
RUN_FILE = """[task]
scheduling = "other"
lock_memory = false
[outputs.FLOW_TOTAL]
safe = 0.0
"""


def served(address, *arguments):
    task = Served(DIAGRAM, RUN_FILE, "--web", address, *arguments)
    task.write("token", TOKEN + "\n")
    return task


def scrape(port, **headers):
    request = urllib.request.Request(f"http://127.0.0.1:{port}/metrics", headers=headers)
    with urllib.request.urlopen(request, timeout=60) as answer:
        return answer.headers["Content-Type"], answer.read().decode("utf-8")


def cycles(text):
    return int(re.search(r'^hysteron_task_cycles_total\{point="task\.cycles"\} (\d+)$', text, re.MULTILINE).group(1))


class Metrics(unittest.TestCase):
    def test_a_scrape_of_a_running_task(self):
        with served("127.0.0.1:0") as task:
            kind, first = scrape(task.web_port)
            self.assertEqual(kind, "text/plain; version=0.0.4; charset=utf-8")
            end = time.monotonic() + 60
            second = first
            while cycles(second) <= cycles(first) and time.monotonic() < end:
                time.sleep(0.05)
                second = scrape(task.web_port)[1]
            self.assertGreater(cycles(second), cycles(first))
            self.assertIn('\n# TYPE hysteron_task_cycles_total counter\n', second)
            self.assertIn('hysteron_input_inflow{point="INFLOW",unit="l/s"} 1\n', second)
            self.assertIn('\n# TYPE hysteron_output_flow_total_value gauge\n', second)

    def test_beyond_the_loopback_a_scrape_needs_the_token(self):
        with served("0.0.0.0:0", "--web-token-file", "token") as task:
            with self.assertRaises(urllib.error.HTTPError) as refused:
                scrape(task.web_port)
            self.assertEqual(refused.exception.code, 401)
            self.assertNotIn("hysteron_", refused.exception.read().decode("utf-8"))
            refused.exception.close()
            self.assertIn("hysteron_task_cycles_total", scrape(task.web_port, Authorization=f"Bearer {TOKEN}")[1])

    @unittest.skipUnless(shutil.which("promtool"), "promtool is not installed; it comes with Debian's prometheus")
    def test_promtool_finds_nothing_to_mend(self):
        with served("127.0.0.1:0") as task:
            text = scrape(task.web_port)[1]
        check = subprocess.run(["promtool", "check", "metrics"], input=text, capture_output=True, text=True, check=False)
        self.assertEqual((check.returncode, check.stdout + check.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
