"""Chromium without a window, driven over its debugging pipe; no library but Python's own."""
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

PATIENCE = 60  # seconds


class Browser:
    """One page. Use it in a with statement."""

    def __init__(self, url, width=1280, height=1400):
        self._url = url
        self._size = (width, height)
        self._number = 0
        self._buffer = b""
        self._session = None
        self.requests = []  # addresses that the page asked for
        self.faults = []    # what its console and its scripts complained of

    @staticmethod
    def is_there():
        return shutil.which("chromium") is not None

    @staticmethod
    def _beyond(end):
        moved = fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10)
        os.close(end)
        return moved

    def __enter__(self):
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_read, self._to = os.pipe()
        self._from, to_write = os.pipe()
        # Beyond those that Chromium takes them by, whatever else this process has open.
        to_read, to_write = (self._beyond(end) for end in (to_read, to_write))
        width, height = self._size
        self._process = subprocess.Popen(
            ["/bin/bash", "-c", f'exec "$@" 3<&{to_read} 4>&{to_write}', "bash", "chromium", "--headless", "--no-sandbox",
             "--disable-gpu", "--remote-debugging-pipe", "--force-color-profile=srgb", f"--window-size={width},{height}",
             f"--user-data-dir={self._profile.name}"], pass_fds=(to_read, to_write), stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        target = self._ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._ask(domain + ".enable")
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self._ask("Page.navigate", url=self._url)
        return self

    def __exit__(self, *_):
        os.close(self._to)  # it ends when its pipe does
        try:
            self._process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._from)
        self._profile.cleanup()

    def evaluate(self, expression):
        """What an expression is in the page."""
        result = self._ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise AssertionError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, expression):
        """Until an expression is true in the page; the patience is for a machine under load."""
        end = time.monotonic() + PATIENCE
        while not (value := self.evaluate(expression)):
            if time.monotonic() > end:
                raise AssertionError(f"never true: {expression}; the page says {self.text('body')}; faults: {self.faults[:5]}")
            time.sleep(0.05)
        return value

    def text(self, selector):
        return self.evaluate(f"document.querySelector({json.dumps(selector)}).innerText")

    def type(self, selector, text):
        """Puts a text into a field as a hand would: focus, then keys."""
        self.evaluate(f"(e => {{ e.focus(); e.select(); }})(document.querySelector({json.dumps(selector)}))")
        self._ask("Input.insertText", text=text)

    def click(self, selector):
        press = "new MouseEvent('click', { bubbles: true, cancelable: true })"
        self.evaluate(f"document.querySelector({json.dumps(selector)}).dispatchEvent({press})")

    def screenshot(self, file):
        data = self._ask("Page.captureScreenshot", format="png")["data"]
        with open(file, "wb") as picture:
            picture.write(base64.b64decode(data))

    def _ask(self, method, **parameters):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise AssertionError(f"{method}: {answer['error']}")
                return answer["result"]
            self._note(answer)

    def _note(self, event):
        method, parameters = event.get("method"), event.get("params", {})
        if method == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])
        elif method == "Network.webSocketCreated":
            self.requests.append(parameters["url"])
        elif method == "Runtime.exceptionThrown":
            self.faults.append({"source": "script", "text": parameters["exceptionDetails"].get("text")})
        elif method == "Log.entryAdded":
            self.faults.append({name: parameters["entry"].get(name) for name in ("source", "text", "url")})

    def _receive(self):
        while b"\0" not in self._buffer:
            ready, _, _ = select.select([self._from], [], [], PATIENCE)
            chunk = os.read(self._from, 1 << 20) if ready else b""
            if not chunk:
                raise AssertionError("the browser does not answer")
            self._buffer += chunk
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)
