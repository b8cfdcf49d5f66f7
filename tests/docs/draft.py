"""A command of the pages as a quick run on the stand-ins."""
import re
import shlex

from stand_ins import BOX, WORDS, WORDS_OF

# Studies take long: written to the same places they are the same commands, and run once.
BENCH_FILES = {"--out": "out/bench", "--json": "bench.json"}
# Options that every run of a command gets, in the place of their values if they are there; None: a flag.
DRAFT = {
    "reconstruct": {"--resolution": "24"},
    "batch": {"--resolution": "24"},
    "demo": {"--resolution": "24", "--out": "out/demo"},
    "scan": {"--resolution": "24", "--texture": "256"},
    "synthesize": {"--size": "96x72", "--views": "12"},
    "refine-cameras": {"--views": "0-5"},
    "evaluate --truth": {"--samples": "2000"},
    "render --turntable": {"--frames": "4", "--size": "160x120"},
    "chart": {"--dry-run": None},
    "stress": {"--dry-run": None},
    "bench sampling": {"--squares": "16", "--repeats": "1"} | BENCH_FILES,
    "bench visibility": {"--quick": None, "--repeats": "1"} | BENCH_FILES,
}
# Tags want more pixels.
SHEET = {"--size": "640x480", "--views": "8"}
# Values that fit the stand-in, for options that are there.
FITTING = {"--voxel-size": "0.08", "--box": BOX, "--samples": "2000", "--frames": "4", "--parts": "2", "--views": "0,3,6,9",
           "--hold-out": "0,3,6,9"}
SIZED = {"--voxel-size", "--part"}  # say how large voxels are
WRITES = ("reconstruct", "synthesize", "masks", "chart", "stress")  # want --out, also where sentences leave it out
READS = ("reconstruct", "masks", "info")  # want a scene


def shell_commands(text: str) -> list[str]:
    """The commands of the program in a line: those between semicolons, without what their output is piped to."""
    return [part.split(" | ")[0] for part in re.split(r";\s*", without_brackets(text)) if "photohull " in part]


def optional_options(text: str) -> set[str]:
    """The options in the brackets of a synopsis."""
    return {option for part in re.findall(r"\s\[[^\]]*\]", text) for option in re.findall(r"--[a-z-]+", part)}


def without_brackets(text: str) -> str:
    """A synopsis without its optional parts."""
    return re.sub(r"\s\[[^\]]*\]", "", text)


def set_option(words: list[str], option: str, value: str | None) -> None:
    """Puts the option at the end, and takes it away where it stands."""
    added = [option] if value is None else [option, value]
    if option in words:
        at = words.index(option)
        del words[at:at + len(added)]
    words += added


def drafted(text: str) -> tuple[dict[str, str], list[str]]:
    """Environment and arguments of a quick run of one command."""
    words = shlex.split(text)
    at = next(i for i, word in enumerate(words) if word.rpartition("/")[2] == "photohull")
    environment = dict(word.split("=", 1) for word in words[:at])
    command = words[at + 1]
    stand_ins = WORDS | WORDS_OF.get(command, {})
    words = [stand_ins.get(first, first) for first in (word.split("|")[0] for word in words[at + 1:])]
    name = " ".join(words[:2]) if command == "bench" else command
    if words == name.split() and not command.startswith("-"):
        return environment, [*words, "--help"]
    if command in READS and words[1].startswith("-"):
        words.insert(1, "scene")
    if command in WRITES and "--out" not in words:
        words += ["--out", "out/unnamed"]
    for option, value in FITTING.items():
        if option in words:
            set_option(words, option, value)
    for option in ("render --turntable", "evaluate --truth"):
        if option.split()[0] == command and option.split()[1] in words:
            name = option
    sheet = command == "synthesize" and ("on_sheet" in text or "on_turntable" in text)
    for option, value in (SHEET if sheet else DRAFT.get(name, {})).items():
        if option != "--resolution" or SIZED.isdisjoint(words):
            set_option(words, option, value)
    return environment, words
