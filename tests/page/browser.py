"""A headless Chromium, driven over its debugging pipe: the standard library is enough."""
import base64
import json
import os
import select
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

FLAGS = ("--headless", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--disable-background-networking",
         "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars")


class Page:
    """One page, loaded from a file without any network; `errors` has what it said in its console or threw."""

    def __init__(self, program: str, seconds: float = 400) -> None:
        self.profile = tempfile.TemporaryDirectory(prefix="photohull_browser_", ignore_cleanup_errors=True)
        self.deadline = time.monotonic() + seconds
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.loaded = False
        self.last = 0
        self.rest = b""
        from_browser, browser_out = os.pipe()
        browser_in, to_browser = os.pipe()
        self.read_end, self.write_end = from_browser, to_browser

        def connect() -> None:
            # The pipe is at descriptors 3 and 4; what is moved there may lie there already.
            take, give = os.dup(browser_in), os.dup(browser_out)
            os.dup2(take, 3)
            os.dup2(give, 4)

        self.process = subprocess.Popen(
            [program, *FLAGS, "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}", "about:blank"],
            preexec_fn=connect, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(browser_in)
        os.close(browser_out)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session: str | None = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Page", "Network"):
            self.call(f"{domain}.enable")

    session = None
    flights = 0.9  # seconds until they have ended

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self.read_end)
        os.close(self.write_end)
        self.profile.cleanup()

    def __enter__(self) -> "Page":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def receive(self) -> dict[str, Any]:
        while b"\0" not in self.rest:
            ready = select.select([self.read_end], [], [], max(0.0, self.deadline - time.monotonic()))[0]
            part = os.read(self.read_end, 1 << 20) if ready else b""
            if not part:
                raise TimeoutError("the browser does not answer" if not ready else "the browser ended")
            self.rest += part
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def note(self, message: dict[str, Any]) -> None:
        method, params = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.errors.append(" ".join(str(a.get("value", a.get("description"))) for a in params["args"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        elif method == "Page.loadEventFired":
            self.loaded = True
        elif method == "Page.javascriptDialogOpening":
            self.errors.append("a dialog: " + params["message"])

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        self.last += 1
        message = {"id": self.last, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.last:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.note(answer)

    def size(self, width: int, height: int, scale: float = 1, touch: bool = False) -> None:
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=touch)
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch)

    def prefers(self, dark: bool = False, still: bool = False) -> None:
        features = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
                    {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"}]
        self.call("Emulation.setEmulatedMedia", features=features)
        self.flights = 0.0 if still else 0.9

    def load(self, path: Path, ready: str = "document.getElementById('viewport')?.getAttribute('aria-busy') === 'false'") -> float:
        """Seconds until the page says that it is ready."""
        start = time.monotonic()
        self.loaded = False
        self.call("Page.navigate", url=path.absolute().as_uri())
        while not self.loaded:
            self.note(self.receive())
        self.wait(ready)
        return time.monotonic() - start

    def evaluate(self, expression: str) -> Any:
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']['text']}")
        return result["result"].get("value")

    def wait(self, expression: str) -> None:
        while not self.evaluate(expression):
            if time.monotonic() > self.deadline:
                raise TimeoutError(expression)
            time.sleep(0.05)

    def settle(self) -> None:
        """Until flights have ended and pictures are drawn."""
        self.evaluate("new Promise(done => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), "
                      f"{1000 * self.flights + 50}))")

    def press(self, key: str) -> None:
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key)

    def screenshot(self, selector: str | None = None) -> bytes:
        """PNG of the window, or of an element in it."""
        params: dict[str, Any] = {"format": "png"}
        if selector:
            box = self.evaluate(f"(() => {{ const r = document.querySelector('{selector}').getBoundingClientRect();"
                                " return {x: r.x + scrollX, y: r.y + scrollY, width: r.width, height: r.height}; })()")
            params["clip"] = box | {"scale": 1}
        return base64.b64decode(self.call("Page.captureScreenshot", **params)["data"])
