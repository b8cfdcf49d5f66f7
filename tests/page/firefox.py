"""What Firefox shows of a report page, as a picture.

    xvfb-run python3 tests/page/firefox.py REPORT.html PICTURE.png [LAYER]

Needs firefox-esr and, on machines without a screen, xvfb: its headless mode has no WebGL. Says after how many seconds the
model was there. LAYER (clay, confidence, ...) is chosen first."""
import base64
import json
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

PATIENCE = 60  # seconds
READY = "return document.getElementById('viewport').getAttribute('aria-busy') === 'false'"
MESSAGE = "return document.getElementById('message').textContent"


class Firefox:
    """Driven by its Marionette protocol: texts of JSON, each behind its length and a colon."""

    def __init__(self, profile: Path) -> None:
        (profile / "user.js").write_text('user_pref("marionette.port", 0);\n')
        self.rest, self.last = b"", 0
        self.process = subprocess.Popen(["firefox-esr", "--no-remote", "--marionette", "--profile", str(profile)],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self.connect(profile / "MarionetteActivePort")
        except Exception:
            self.end()
            raise

    def connect(self, port: Path) -> None:
        deadline = time.monotonic() + PATIENCE
        while not (port.exists() and port.read_text().strip()):
            if self.process.poll() is not None or time.monotonic() > deadline:
                raise RuntimeError("firefox-esr did not start; without a screen it needs xvfb-run")
            time.sleep(0.1)
        self.socket = socket.create_connection(("127.0.0.1", int(port.read_text())), PATIENCE)
        self.receive()
        self.call("WebDriver:NewSession")

    def end(self) -> None:
        self.process.kill()
        self.process.wait()

    def more(self) -> bytes:
        part = self.socket.recv(1 << 16)
        if not part:
            raise RuntimeError("firefox-esr ended")
        return part

    def receive(self) -> Any:
        while b":" not in self.rest:
            self.rest += self.more()
        length, self.rest = self.rest.split(b":", 1)
        while len(self.rest) < int(length):
            self.rest += self.more()
        message, self.rest = self.rest[:int(length)], self.rest[int(length):]
        return json.loads(message)

    def call(self, command: str, **parameters: Any) -> Any:
        self.last += 1
        message = json.dumps([0, self.last, command, parameters]).encode()
        self.socket.sendall(f"{len(message)}:".encode() + message)
        _, _, error, result = self.receive()
        if error:
            raise RuntimeError(f"{command}: {error['message']}")
        return result

    def run(self, script: str) -> Any:
        return self.call("WebDriver:ExecuteScript", script=script, args=[])["value"]


def main() -> None:
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        firefox = Firefox(Path(profile))
        try:
            firefox.call("WebDriver:SetWindowRect", width=1280, height=1000)
            start = time.monotonic()
            firefox.call("WebDriver:Navigate", url=Path(sys.argv[1]).absolute().as_uri())
            while not firefox.run(READY):
                if time.monotonic() - start > PATIENCE:
                    sys.exit(f"the page is not ready after {PATIENCE} s")
                time.sleep(0.05)
            seconds, message = time.monotonic() - start, firefox.run(MESSAGE)
            if message:
                sys.exit(message)
            print(f"ready after {seconds:.2f} s")
            if len(sys.argv) == 4:
                firefox.run(f"document.getElementById('layer-{sys.argv[3]}').click()")
            time.sleep(1)
            Path(sys.argv[2]).write_bytes(base64.b64decode(firefox.call("WebDriver:TakeScreenshot", full=False)["value"]))
        finally:
            firefox.end()


if __name__ == "__main__":
    main()
