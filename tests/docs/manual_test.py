#!/usr/bin/env python3
"""Tests scripts/make_manual.py: manual_test.py PROGRAM SOURCE. Every command has a page with all of its options, groff finds
no fault with the pages, and bash completes commands, options, their values and files; zsh and fish read their files where
they are installed."""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
COMPLETE = """source "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
_photohull
printf '%s\\n' "${COMPREPLY[@]}"
"""


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.share = Path(cls.folder.name)
        subprocess.run([SOURCE / "scripts/make_manual.py", PROGRAM, cls.share], check=True, capture_output=True)
        cls.pages = {path.stem: path.read_text(encoding="utf-8") for path in (cls.share / "man/man1").glob("*.1")}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def completed(self, *words: str) -> set[str]:
        script = self.share / "bash-completion/completions/photohull"
        done = subprocess.run(["bash", "-c", COMPLETE, "bash", script, "photohull", *words], cwd=self.share, check=True,
                              capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.split())

    def help_of(self, *words: str) -> str:
        return subprocess.run([PROGRAM, *words, "--help"], check=True, capture_output=True, text=True).stdout

    def test_every_command_has_a_page_with_its_options(self):
        commands = re.findall(r"^  (\w[\w-]*)  ", self.help_of().partition("Subcommands:")[2].partition("\n\n")[0], re.M)
        self.assertGreater(len(commands), 15)
        self.assertIn("measure", commands)
        for command in commands:
            page = self.pages[f"photohull-{command}"].replace("\\-", "-")
            options = re.findall(r"^  (?:-h,)?(--[a-z-]+)", self.help_of(command), re.M)
            self.assertTrue(options)
            for option in options:
                self.assertRegex(page, rf"\n\.B (-h, )?{option}\b")

    def test_no_description_is_empty(self):
        for name, page in self.pages.items():
            self.assertNotIn("\n\\&\n", page, name)

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_groff_finds_no_fault(self):
        for path in (self.share / "man/man1").glob("*.1"):
            done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", path], check=True, capture_output=True, text=True)
            faults = [line for line in done.stderr.splitlines() if "adjust line" not in line and "break line" not in line]
            self.assertEqual(faults, [])

    def test_bash_completes_commands_and_options(self):
        self.assertEqual(self.completed("rec"), {"reconstruct"})
        self.assertIn("sampling", self.completed("bench", ""))
        self.assertEqual(self.completed("reconstruct", "scene", "--qual"), {"--quality"})
        self.assertNotIn("--quality", self.completed("measure", "--"))

    def test_bash_completes_values(self):
        self.assertEqual(self.completed("reconstruct", "--quality", ""), {"draft", "normal", "high"})
        self.assertEqual(self.completed("measure", "--axis", "u"), {"up"})
        self.assertEqual(self.completed("reconstruct", "--resolution", ""), {"man", "bash-completion", "zsh", "fish"})

    def test_bash_completes_files(self):
        self.assertEqual(self.completed("measure", "ba"), {"bash-completion"})
        self.assertIn("man", self.completed("reconstruct", ""))

    def test_other_shells_read_their_files(self):
        for shell, name in (("zsh", "zsh/vendor-completions/_photohull"), ("fish", "fish/vendor_completions.d/photohull.fish")):
            text = (self.share / name).read_text(encoding="utf-8")
            self.assertIn("draft normal high", text)
            if shutil.which(shell):
                subprocess.run([shell, "-n", self.share / name], check=True)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
