"""python3 -m bench NAME ..., from the project's root: runs a study, each of which is a module of this package."""
import argparse
import importlib
import sys
from pathlib import Path



def studies() -> dict[str, str]:
    """Name and first line of the modules that take arguments, read rather than imported: that may need packages."""
    found = {}
    for path in sorted(Path(__file__).parent.glob("*.py")):
        text = path.read_text(encoding="utf-8")
        if "\ndef add_arguments(" in text:
            found[path.stem] = text.split('"""')[1].splitlines()[0]
    return found


def main() -> int:
    names = studies()
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        width = max(map(len, names))
        print("python3 -m bench NAME ... (NAME --help tells what it takes)\n")
        print("\n".join(f"  {name:{width}}  {summary}" for name, summary in names.items()))
        return 0
    name = sys.argv[1]
    if name not in names:
        sys.exit(f"bench has no study '{name}'; python3 -m bench --help lists them")
    try:
        study = importlib.import_module(f"bench.{name}")
    except ModuleNotFoundError as error:
        sys.exit(f"The study {name} needs the Python package {error.name} (Debian's python3-{error.name}), "
                 f"which {sys.executable} does not have")
    parser = argparse.ArgumentParser(prog=f"python3 -m bench {name}", description=study.__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    study.add_arguments(parser)
    return study.run(parser.parse_args(sys.argv[2:])) or 0


if __name__ == "__main__":
    sys.exit(main())
