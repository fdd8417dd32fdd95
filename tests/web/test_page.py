"""The live page in a browser, against a running `hysteron serve`: what a user sees, types and is told."""
import json
import os
import subprocess
import tomllib
import unittest
import urllib.request

from tests.web.browser import Browser
from tests.web.served import Served

TOKEN = "a-token-of-this-test-0123456789"
DIAGRAM = """FUNCTION_BLOCK STAGE  (* @ts 10ms *)
  VAR_INPUT
    SCALE : LREAL := 1.0;  (* @min 0 @max 2 *)
    RESET : BOOL;
  END_VAR
  VAR_OUTPUT
    U : LREAL;  (* @unit V *)
    Y : LREAL;  (* @unit um *)
    REST : LREAL;  (* @unit um *)
    UP : BOOL;
  END_VAR
  VAR
    WAVE : HY_SINE := (AMPLITUDE := 30.0, FREQUENCY := 0.2);
    BRANCH : HY_BRANCH;
    HYST : HY_HYSTERESIS_RO := (C1 := 0.15, C2 := 0.01, C3 := 0.7);
    SHARE : HY_GAIN := (K := 0.5);
    LAG : HY_LAG := (T1 := 0.05);
  END_VAR

  BRANCH(XIN := SCALE * WAVE.XOUT, R1 := RESET);
  HYST(XIN := SCALE * WAVE.XOUT, R1 := RESET);
  LAG(XIN := HYST.XOUT);
  SHARE(XIN := HYST.XOUT - LAG.XOUT);
  U := SCALE * WAVE.XOUT;
  Y := LAG.XOUT;
  REST := SHARE.XOUT;
  UP := BRANCH.Q;
  WAVE();
END_FUNCTION_BLOCK
"""
RUN_FILE = """[task]
scheduling = "other"
lock_memory = false
[outputs.U]
safe = 0.0
[outputs.Y]
safe = 0.0
[outputs.REST]
safe = 0.0
[outputs.UP]
safe = 0
"""
FORCING = RUN_FILE + '[web]\nrights = ["parameters", "reset", "force"]\n'
LIVE = "Number(document.body?.dataset.frames) > 20"


def values_of(port):
    """The values as the server gives them to anybody else."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/api/values", timeout=60) as answer:
        return json.load(answer)


def served(*arguments, run_file=RUN_FILE):
    return Served(DIAGRAM, run_file, *arguments)


@unittest.skipUnless(Browser.is_there(), "chromium is not installed: scripts/install-dependencies test")
class LivePage(unittest.TestCase):
    def open(self, port):
        return self.enterContext(Browser(f"http://127.0.0.1:{port}/"))

    def start(self, *arguments, **options):
        task = served(*arguments, **options)
        if "--web-token-file" in arguments:
            task.write("token", TOKEN + "\n")
        return self.enterContext(task)

    def expect_no_fault(self, browser, port):
        self.assertEqual(browser.faults[:5], [])
        own = (f"http://127.0.0.1:{port}/", f"ws://127.0.0.1:{port}/")
        self.assertGreater(len(browser.requests), 6)
        for address in browser.requests:
            self.assertTrue(address.startswith(own), address)

    def test_values_reach_the_page_and_no_other_host_is_asked(self):
        port = self.start("--web", "127.0.0.1:0").web_port
        browser = self.open(port)
        browser.wait_for(LIVE)
        self.assertEqual(browser.text("#title"), "STAGE")
        self.assertEqual(browser.text("#state"), "Running")
        cycles = "Number(document.querySelector('[data-value=\"task.cycles\"]').textContent)"
        seen = browser.evaluate(cycles)
        browser.wait_for(f"{cycles} > {seen} + 100")
        self.assertGreater(values_of(port)["cycle"], seen)
        # the diagram: the value of an input, and one within that moves
        scale = "document.querySelector('#diagram [data-point=SCALE]').textContent"
        self.assertEqual(browser.evaluate(scale), "1.0000")
        wave = "[...document.querySelectorAll('#diagram [data-inner]')].find(e => !/TRUE|FALSE/.test(e.textContent)).textContent"
        before = browser.evaluate(wave)
        browser.wait_for(f"{wave} !== {json.dumps(before)}")
        places = browser.evaluate("[...document.querySelectorAll('#diagram .value')].map(e => e.textContent)")
        self.assertGreater(len(places), 10)
        self.assertNotIn("–", places, "every place has its value")
        # the trends: axes with names and units, and curves
        self.assertGreater(browser.evaluate("document.querySelectorAll('.plot canvas').length"), 2)
        trends = browser.text("#trends")
        for label in ("U [V]", "time since the task's start [s]", "UP = "):
            self.assertIn(label, trends)
        keys = "document.querySelectorAll('#trends .keys span').length"
        before = browser.evaluate(keys)
        browser.click("#diagram [data-inner]")
        self.assertEqual(browser.evaluate(keys), before + 1, "a click adds a signal to the trends")
        browser.click("#diagram [data-inner]")
        self.assertEqual(browser.evaluate(keys), before, "and takes it away")
        self.expect_no_fault(browser, port)

    def test_without_a_token_file_the_page_is_read_only(self):
        port = self.start("--web", "127.0.0.1:0").web_port
        browser = self.open(port)
        browser.wait_for(LIVE)
        self.assertIn("Read-only", browser.text("#access"))
        self.assertTrue(browser.evaluate("[...document.querySelectorAll('#parameters input, .tools button:not(#save)')].every(e => e.disabled)"))
        self.expect_no_fault(browser, port)

    def test_parameters_are_staged_refused_and_committed(self):
        task = self.start("--web", "127.0.0.1:0", "--web-token-file", "token")
        browser = self.open(task.web_port)
        browser.wait_for(LIVE)
        field = 'input[data-name="LAG.T1"]'
        now = "document.querySelector('[data-value=\"LAG.T1\"]').textContent"
        staged = "document.querySelector('[data-staged=\"LAG.T1\"]').textContent"
        notice = "document.getElementById('notice').textContent"

        browser.type(field, "0.2")
        browser.click("#stage")
        browser.wait_for(f"{notice}.includes('Type the token first')")
        browser.type("#token", "a-wrong-token-0123456789")
        browser.click("#stage")
        browser.wait_for(f"{notice}.includes('token is missing or wrong')")
        self.assertEqual(browser.evaluate(staged), "")

        browser.type("#token", TOKEN)
        browser.type(field, "-3")
        browser.click("#stage")
        browser.wait_for(f"{notice}.startsWith('Refused: LAG.T1 must be at least 0 s; -3 was given.')")
        self.assertTrue(browser.evaluate(f"document.querySelector('{field}').classList.contains('refused')"))
        browser.type(field, "a lot")
        browser.click("#stage")
        browser.wait_for(f"{notice}.includes('is no number')")
        browser.type(field, "1,000")
        browser.click("#stage")
        browser.wait_for(f"{notice}.includes('can be read in two ways. Write 1.000 or 1000. Nothing was staged.')")
        self.assertEqual(browser.evaluate(staged), "")
        browser.type(field, "0,125")
        browser.click("#stage")
        browser.wait_for(f"{staged} === '0.125'")

        browser.type(field, "0.2")
        browser.click("#stage")
        browser.wait_for(f"{staged} === '0.2'")
        self.assertEqual(browser.evaluate(now), "0.05", "what is staged does not count yet")
        self.assertIn("waits for a commit", browser.evaluate(notice))
        browser.click("#commit")
        browser.wait_for(f"{now} === '0.2' && {staged} === ''")
        self.assertIn("Committed", browser.evaluate(notice))
        browser.type(field, "0.3")
        browser.click("#stage")
        browser.wait_for(f"{staged} === '0.3'")
        browser.click("#discard")
        browser.wait_for(f"{staged} === ''")
        self.assertEqual(browser.evaluate(now), "0.2")
        # 401 and 422 are logged by the browser itself; there is nothing else
        self.assertTrue(all(fault.get("source") == "network" for fault in browser.faults), browser.faults[:5])
        printed, _ = task.stop()
        self.assertNotIn(TOKEN, printed)

    def test_what_counts_is_saved_as_a_parameter_file(self):
        task = self.start("--web", "127.0.0.1:0", "--web-token-file", "token")
        browser = self.open(task.web_port)
        browser.wait_for(LIVE)
        # what the browser is given to save, since a headless one has no folder for it
        browser.evaluate("void (URL.createObjectURL = blob => { blob.text().then(text => window.saved = text); return 'blob:x'; },"
                         " HTMLAnchorElement.prototype.click = function () { window.savedAs = this.download; })")
        browser.click("#save")
        browser.wait_for("window.saved !== undefined")
        self.assertEqual(browser.evaluate("window.savedAs"), "stage.toml")
        saved = tomllib.loads(browser.evaluate("window.saved"))["parameters"]
        self.assertEqual(saved["LAG"]["T1"], 0.05)
        self.assertEqual(saved["WAVE"]["AMPLITUDE"], 30.0)
        # and the tool takes it
        file = task.write("saved.toml", browser.evaluate("window.saved"))
        task.write("in.csv", "t,SCALE,RESET\n0.00,1,0\n0.01,1,0\n0.02,1,0\n")
        checked = subprocess.run([os.environ["HYSTERON_TOOL"], "run", "diagram.st", "--in", "in.csv", "--out", "out.csv",
                                  "--params", file], cwd=task.path, capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_a_reset_is_asked_twice_and_begins_every_state_anew(self):
        task = self.start("--web", "127.0.0.1:0", "--web-token-file", "token")
        browser = self.open(task.web_port)
        browser.wait_for(LIVE)
        browser.type("#token", TOKEN)
        browser.wait_for("Math.abs(parseFloat(document.querySelector('#diagram [data-point=U]').textContent)) > 5")
        browser.click("#reset")
        self.assertIn("begins anew?", browser.text("#reset"))
        browser.click("#reset")
        browser.wait_for("document.getElementById('notice').textContent.startsWith('Reset: every state')")
        self.assertEqual(browser.text("#reset"), "Reset the task")

    def test_an_input_is_forced_and_marked_and_free_when_its_page_is_gone(self):
        task = self.start("--web", "127.0.0.1:0", "--web-token-file", "token", run_file=FORCING)
        watcher = self.open(task.web_port)
        watcher.wait_for(LIVE)
        notice = "document.getElementById('notice').textContent"
        scale = "document.querySelector('#diagram [data-point=SCALE]')"
        with Browser(f"http://127.0.0.1:{task.web_port}/") as browser:
            browser.wait_for(LIVE)
            self.assertTrue(browser.evaluate("document.getElementById('forced').hidden"))
            browser.type("#token", TOKEN)
            field = '#inputs input[data-name="SCALE"]'
            browser.type(field, "3")
            browser.click("#force")
            browser.wait_for(f"{notice}.startsWith('Refused: SCALE must be at most 2')")
            self.assertTrue(browser.evaluate(f"document.querySelector('{field}').classList.contains('refused')"))
            browser.type(field, "0,5")
            browser.click("#force")
            for page in (browser, watcher):
                page.wait_for("document.getElementById('forced').textContent === 'Forced: SCALE = 0.5'")
                page.wait_for(f"{scale}.textContent === '0.5000' && {scale}.classList.contains('forced')")
                self.assertIn("(forced)", page.text("#trends"))
            self.assertEqual(values_of(task.web_port)["values"][0], 0.5)
            task.wait_for_notice("Forced: SCALE = 0.5 from the live page")
            browser.type(field, "")
            browser.click("tr.is-forced button")
            browser.wait_for("document.getElementById('forced').hidden")
            self.assertEqual(values_of(task.web_port)["values"][0], 1.0)
            browser.type(field, "2")
            browser.click("#force")
            watcher.wait_for("document.getElementById('forced').textContent === 'Forced: SCALE = 2'")
        watcher.wait_for("document.getElementById('forced').hidden")
        self.assertEqual(values_of(task.web_port)["values"][0], 1.0)
        printed, _ = task.stop()
        self.assertIn("Forced: SCALE = 0.5 from the live page", printed)
        self.assertIn("Forced: no input is forced any more.", printed)

    def test_without_the_right_no_input_is_offered_to_be_forced(self):
        task = self.start("--web", "127.0.0.1:0", "--web-token-file", "token")
        browser = self.open(task.web_port)
        browser.wait_for(LIVE)
        self.assertTrue(browser.evaluate("document.getElementById('inputs-section').hidden"))
        self.assertIn("With the token, parameters are changed, the task is reset.", browser.text("#access"))

    def test_the_page_follows_an_online_change(self):
        task = self.start("--web", "127.0.0.1:0", "--web-token-file", "token",
                          run_file=RUN_FILE + '[online_change]\nsocket = "change.socket"\n')
        browser = self.open(task.web_port)
        browser.wait_for(LIVE)
        browser.type("#token", TOKEN)
        rows = browser.evaluate("trends.rows.length")
        self.assertNotIn("EXTRA", browser.text("#diagram"))
        task.write("diagram.st", DIAGRAM.replace("LAG : HY_LAG", "EXTRA : HY_GAIN := (K := 1.0);\n    LAG : HY_LAG")
                   .replace("Y := LAG.XOUT;", "EXTRA(XIN := LAG.XOUT);\n  Y := EXTRA.XOUT;"))
        # without the unit of EXTRA, which nothing tells, some states begin anew
        changed = subprocess.run([os.environ["HYSTERON_TOOL"], "online-change", "RUN.toml", "--bump", "Y=1000", "--bump",
                                  "REST=1000"], cwd=task.path, capture_output=True, text=True)
        self.assertEqual(changed.returncode, 0, changed.stdout + changed.stderr)
        browser.wait_for("document.getElementById('diagram').textContent.includes('EXTRA')")
        self.assertIn("version 2", browser.evaluate("document.getElementById('notice').textContent"))
        self.assertGreaterEqual(browser.evaluate("trends.rows.length"), rows, "the curves go on")
        places = "[...document.querySelectorAll('#diagram .value')].map(e => e.textContent)"
        browser.wait_for(f"!{places}.includes('–')")
        browser.type('input[data-name="EXTRA.K"]', "2")
        browser.click("#stage")
        browser.wait_for("document.querySelector('[data-staged=\"EXTRA.K\"]').textContent === '2'")
        browser.click("#commit")
        browser.wait_for("document.querySelector('[data-value=\"EXTRA.K\"]').textContent === '2'")
        self.assertEqual(browser.faults[:5], [])

    def test_one_signal_is_drawn_over_another(self):
        port = self.start("--web", "127.0.0.1:0").web_port
        browser = self.open(port)
        browser.wait_for(LIVE)
        self.assertFalse(browser.evaluate("document.getElementById('xy-section').hidden"))
        chosen = "document.getElementById('{}').selectedOptions[0].textContent"
        self.assertEqual(browser.evaluate(chosen.format("xy-across")), "U [V]")
        for choice in ("xy-across", "xy-up"):
            texts = browser.evaluate(f"[...document.getElementById('{choice}').options].map(option => option.textContent)")
            self.assertEqual(sorted(set(texts)), sorted(texts), "each signal once")
            self.assertIn("REST [um]", texts)
        self.assertEqual(browser.evaluate(chosen.format("xy-up")), "Y [um]")
        browser.wait_for("Number(document.getElementById('xy').dataset.points) > 20")
        ink = ("(() => { const c = document.getElementById('xy'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
               " let n = 0; for (let i = 0; i < d.length; i += 4) n += d[i] === 0 && d[i + 1] === 114 && d[i + 2] === 178; return n; })()")
        self.assertGreater(browser.evaluate(ink), 100, "a curve of the first colour")
        self.expect_no_fault(browser, port)

    def test_the_keyboard_reaches_what_the_mouse_does(self):
        port = self.start("--web", "127.0.0.1:0").web_port
        browser = self.open(port)
        browser.wait_for(LIVE)
        value = "document.querySelector('#diagram [data-inner]')"
        keys = "document.querySelectorAll('#trends .keys span').length"
        before = browser.evaluate(keys)
        browser.evaluate(f"void {value}.focus()")
        self.assertTrue(browser.evaluate(f"document.activeElement === {value}"))
        browser.evaluate(f"void {value}.dispatchEvent(new KeyboardEvent('keydown', {{ key: 'Enter', cancelable: true }}))")
        self.assertEqual(browser.evaluate(keys), before + 1)
        self.assertEqual(browser.evaluate(f"{value}.getAttribute('aria-pressed')"), "true")

    def test_a_narrow_screen_shows_all_without_sliding_sideways(self):
        port = self.start("--web", "127.0.0.1:0", "--web-token-file", "token", run_file=FORCING).web_port
        browser = self.enterContext(Browser(f"http://127.0.0.1:{port}/", width=420, height=900))
        browser.wait_for(LIVE)
        self.assertLessEqual(browser.evaluate("document.documentElement.scrollWidth"), 420)
        cut = "[...document.querySelectorAll('.scroll')].filter(one => one.scrollWidth > one.clientWidth + 2)"
        self.assertGreater(browser.evaluate(cut + ".length"), 0)
        self.assertTrue(browser.evaluate(cut + ".every(one => getComputedStyle(one).backgroundImage !== 'none')"))

    def test_the_last_hours_of_a_point_are_drawn(self):
        history = RUN_FILE + '[history]\nfile = "history.sqlite"\nevery = "10ms"\npoints = ["Y", "LAG.T1"]\n'
        port = self.start("--web", "127.0.0.1:0", run_file=history).web_port
        browser = self.open(port)
        browser.wait_for(LIVE)
        self.assertFalse(browser.evaluate("document.getElementById('history-section').hidden"))
        self.assertEqual(browser.evaluate("[...document.getElementById('history-point').options].map(o => o.value).join()"), "Y,LAG.T1")
        browser.wait_for("Number(document.getElementById('history').dataset.places) > 20 || "
                         "(document.querySelector('#history-form button').click(), false)")
        self.assertGreater(browser.evaluate("document.querySelectorAll('#history canvas').length"), 0)
        self.assertIn("Y [um]", browser.text("#history"))
        self.assertRegex(browser.text("#history-note"), r"^\d+ rows\.")
        self.assertTrue(all(fault.get("source") == "network" for fault in browser.faults), browser.faults[:5])

    def test_without_a_history_its_section_is_hidden(self):
        browser = self.open(self.start("--web", "127.0.0.1:0").web_port)
        browser.wait_for(LIVE)
        self.assertTrue(browser.evaluate("document.getElementById('history-section').hidden"))

    def test_a_lost_connection_is_said(self):
        task = self.start("--web", "127.0.0.1:0")
        browser = self.open(task.web_port)
        browser.wait_for(LIVE)
        _, code = task.stop()
        self.assertEqual(code, 0)
        browser.wait_for("document.body.classList.contains('stale')")
        self.assertIn("No connection", browser.text("#state"))

    def test_beyond_the_loopback_the_token_comes_first(self):
        task = self.start("--web", "0.0.0.0:0", "--web-token-file", "token")
        browser = self.open(task.web_port)
        browser.wait_for("document.getElementById('login')?.hidden === false")
        self.assertNotIn("STAGE", browser.text("body"))
        browser.type("#login-token", TOKEN)
        browser.click("#login button")
        browser.wait_for(LIVE)
        self.assertEqual(browser.text("#title"), "STAGE")


if __name__ == "__main__":
    # The picture of docs/how-to/live-page.md: HYSTERON_TOOL=build/hysteron /usr/bin/python3 -m tests.web.test_page FILE.png
    import sys
    import time

    with_token = served("--web", "127.0.0.1:0", "--web-token-file", "token")
    with_token.write("token", TOKEN + "\n")
    with with_token as task:
        with Browser(f"http://127.0.0.1:{task.web_port}/", 1280, 1560) as page:
            page.wait_for(LIVE)
            time.sleep(25)
            page.type("#token", TOKEN)
            page.type('input[data-name="LAG.T1"]', "0.1")
            page.click("#stage")
            page.wait_for("document.getElementById('notice').hidden === false")
            time.sleep(1)
            page.evaluate("scrollTo(0, 0)")
            page.screenshot(sys.argv[1])
