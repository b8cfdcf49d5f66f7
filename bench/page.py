"""Makes the tables of a page of docs/measurements.

    python3 -m bench page benchmarks                  # measures all that the page shows, and writes its tables
    python3 -m bench page benchmarks --only hull      # measures what this table shows
    python3 -m bench page --from-results              # writes the tables of all pages from bench/results
    python3 -m bench page --check                     # fails where a page does not say what bench/results does

Without a name all pages are meant. bench/pages/PAGE.json has the page's tables by their names: the file of bench/results
that each is made from, and its layout (bench/layouts.py). bench/pages/measured.json has the command that measures each
file of results, and of those that were measured before programs were written down with them, the day when git last
changed their figures. In the page a table stands between `<!-- table: NAME -->` and `<!-- end of table -->`; below it a
line says which program measured it. Results are kept as soon as a command has ended, and what the same program has
measured below --out is not measured again, so that the same call goes on where it was interrupted."""
import argparse
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

from bench import kept
from bench.layouts import LAYOUTS
from bench.runner import ROOT, Photohull, add_program, listed

FOLDER = Path(__file__).parent / "pages"
TABLE = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end of table -->)", re.S)
MEASURED = "measured"  # the file beside those of the pages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("page", nargs="?", choices=pages(), metavar="PAGE", help=f"one of {', '.join(pages())}")
    parser.add_argument("--only", type=listed, metavar="TABLES", help="names of tables, with commas between them")
    parser.add_argument("--out", type=Path, default=ROOT / "out/page", help="folder of the runs (default: out/page)")
    parser.add_argument("--commit", help="that the program was built from, where it is no build in this checkout")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--from-results", action="store_true", help="measure nothing")
    what.add_argument("--check", action="store_true", help="compare the pages with the results, and write nothing")
    what.add_argument("--list", action="store_true", help="say which tables there are, and what measured them")


def pages() -> list[str]:
    return sorted(path.stem for path in FOLDER.glob("*.json") if path.stem != MEASURED)


def data(name: str) -> dict:
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def path_of(page: str) -> Path:
    return ROOT / f"docs/measurements/{page}.md"


def origin(page: str, table: str, entry: dict) -> str:
    """Which program measured a table, and when."""
    results, command = kept.read(entry["results"]), f"`python3 -m bench page {page} --only {table}`"
    if not results.program:
        day = entry.get("earlier") or data(MEASURED)[entry["results"]]["earlier"]
        return f"Measured by an earlier program (results of {day}); {command} measures it anew."
    commit = f" ({results.program['commit']})" if "commit" in results.program else ""
    return f"Measured {results.date} with photohull {results.program['version']}{commit} by {command}."


def table_of(entry: dict, figures: object = None) -> str:
    """A table of what its file of results has, or of figures that have just been measured."""
    figures = figures or kept.read(entry["results"]).figures
    if entry["layout"] in ("rows", "pivot") and isinstance(figures, dict):
        figures = figures[entry.get("part", "runs")]
    return LAYOUTS[entry["layout"]](figures, entry)


def written(page: str, tables: dict[str, dict], text: str) -> str:
    """The page's text with these tables as the results have them."""
    def put(match: re.Match) -> str:
        name = match[2]
        if name not in tables:
            return match[0]
        return f"{match[1]}{table_of(tables[name])}\n\n{origin(page, name, tables[name])}\n{match[3]}"
    return TABLE.sub(put, text)


def faults(page: str) -> list[str]:
    """The page's tables that are not what the results give."""
    text, tables = path_of(page).read_text(encoding="utf-8"), data(page)
    places = [match[2] for match in TABLE.finditer(text)]
    found = [f"{page}: the table {name} has no entry in bench/pages/{page}.json"
             for name in places if name not in tables]
    for name, entry in tables.items():
        if places.count(name) != 1:
            found.append(f"{page}: the table {name} has {places.count(name)} places in the page, and needs one")
        elif written(page, {name: entry}, text) != text:
            found.append(f"{page}: the table {name} differs from bench/results/{entry['results']}.json; "
                         f"python3 -m bench page {page} --from-results writes it")
    return found


def measure(name: str, program: Path, identity: dict, out: Path) -> None:
    """Runs the command of a file of results and keeps what it measured."""
    entry, folder = data(MEASURED)[name], out / name
    done = out / f"{name}.measured.json"
    wanted = {"program": identity, "command": entry["command"]}
    if done.is_file() and json.loads(done.read_text(encoding="utf-8")) == wanted:
        return
    out.mkdir(parents=True, exist_ok=True)
    words = shlex.split(entry["command"].format(out=folder))
    print(shlex.join(words), file=sys.stderr, flush=True)
    if words[0] == "photohull":
        Photohull(program).call(*words[1:])
    else:
        subprocess.run([sys.executable, *words[1:], "--program", program], cwd=ROOT, check=True)
    kept.write(name, kept.KEEPERS[entry.get("keep", "json")](folder), identity)
    kept.copy_pictures(folder, entry.get("pictures", {}))
    done.write_text(json.dumps(wanted), encoding="utf-8")


def run(options: argparse.Namespace) -> int:
    names = [options.page] if options.page else pages()
    if options.check:
        found = [fault for page in names for fault in faults(page)]
        print("\n".join(found) or f"the tables of {', '.join(names)} are what bench/results gives")
        return 1 if found else 0
    chosen = {page: {name: entry for name, entry in data(page).items() if not options.only or name in options.only}
              for page in names}
    unknown = set(options.only or ()) - {name for tables in chosen.values() for name in tables}
    if unknown:
        sys.exit(f"no page of {', '.join(names)} has a table {', '.join(sorted(unknown))}; --list lists them")
    if options.list:
        for page, tables in chosen.items():
            print("\n".join(f"{page} {name}: {origin(page, name, entry)}" for name, entry in tables.items()))
        return 0
    if not options.from_results:
        program = Photohull(options.program)
        identity = kept.identity(program, options.commit)
        for name in dict.fromkeys(entry["results"] for tables in chosen.values() for entry in tables.values()):
            measure(name, program.program, identity, options.out / identity["sha256"])
    for page, tables in chosen.items():
        text = path_of(page).read_text(encoding="utf-8")
        path_of(page).write_text(written(page, tables, text), encoding="utf-8")
    return 0
