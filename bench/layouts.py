"""How tables of the pages come from results: a layout each, which takes the results and the table's entry of
bench/pages/PAGE.json and gives Markdown. Cells are written by Python's format strings over a run's fields, those of
fields after points; {f:.1p} is a share in percent, {f:.1P} the same with the sign, and a dash for nothing."""
import string
from collections.abc import Callable

from bench import tables, visibility_tables


class Cells(string.Formatter):
    def get_field(self, field_name: str, args: tuple, kwargs: dict) -> tuple[object, str]:
        value: object = kwargs
        for key in field_name.split("."):
            value = value[key]
        return value, field_name

    def format_field(self, value: object, format_spec: str) -> str:
        if format_spec.endswith("p"):
            return super().format_field(100 * value, format_spec[:-1] + "f")
        if format_spec.endswith("P"):
            return self.format_field(value, format_spec[:-1] + "p") + " %" if value else "-"
        return super().format_field(value, format_spec)


def cell(template: str, run: dict) -> str:
    """The fields of a run in words; of a failed run, its status."""
    try:
        return Cells().vformat(template, (), run)
    except (KeyError, TypeError, IndexError):
        return run.get("status", "")


def chosen(runs: list[dict], entry: dict) -> list[dict]:
    """The runs whose fields have one of the values that `where` names. A tool's name has its setting after a comma."""
    found = []
    for run in runs:
        base, _, setting = run.get("tool", "").partition(", ")
        run = {"base": base, "setting": setting} | run
        if all(run.get(key) in values for key, values in entry.get("where", {}).items()):
            found.append(run)
    return found


def rows(runs: list[dict], entry: dict) -> str:
    """A row a run, a column a template; columns of which no run knows anything are left out."""
    runs = chosen(runs, entry)
    columns = {title: t for title, t in entry["columns"].items() if any(cell(t, run) for run in runs)}
    return tables.markdown(list(columns), ([cell(t, run) for t in columns.values()] for run in runs))


def pivot(runs: list[dict], entry: dict) -> str:
    """Cells by two fields; where it is wanted with the mean of a field over the columns, and the sum of another.
    A run that failed counts as zero in the mean."""
    runs, titles, found = chosen(runs, entry), entry.get("titles", {}), {}
    ends = {name: entry[name] for name in ("mean", "sum") if any(entry.get(name) in run for run in runs)}
    heads: dict[str, None] = {}
    for run in runs:
        row, column = cell(entry["rows"], run), cell(entry["columns"], run)
        heads[column] = None
        found.setdefault(row, {})[column] = run
    lines = []
    for row, by_column in found.items():
        line = [titles.get(row, row), *(cell(entry["cell"], by_column[c]) if c in by_column else "" for c in heads)]
        for name, field in ends.items():
            total = sum(run.get(field, 0) for run in by_column.values())
            line.append(f"{total / len(by_column):.2f}" if name == "mean" else f"{total:.1f}")
        lines.append(line)
    last = ["mean" if name == "mean" else "CPU s, all" for name in ends]
    return tables.markdown([entry["head"], *(titles.get(c, c) for c in heads), *last], lines)


def kept(results: dict, entry: dict) -> str:
    """A table that the results hold as it is."""
    table = results["tables"][entry["table"]]
    return tables.markdown(table["columns"], table["rows"])


def errors_of_samplers(study: dict, entry: dict) -> str:
    """RMS errors at square footprints, the worst and the p99 of all footprints, and the time."""
    found: dict[str, list[dict]] = {}
    for run in study["cells"]:
        n = run["supersample"]
        found.setdefault(run["sampler"] + (f" {n}x{n}" if n > 1 else ""), []).append(run)
    sizes = sorted({run["footprint_pixels"] for run in study["cells"]})
    lines = []
    for name in entry["samplers"]:
        runs = found[name]
        square = {run["footprint_pixels"]: run for run in runs if run["anisotropy"] == 1}
        lines.append([name, *(f"{square[s]['rms_percent']:.2f}" for s in sizes),
                      *(f"{max(run[key] for run in runs):.2f}" for key in ("rms_percent", "p99_percent")),
                      f"{square[1]['nanoseconds']:.1f}"])
    return tables.markdown(["sampler", *(f"{s:g}" for s in sizes), "worst", "p99", "ns"], lines)


def visibility(data: dict, entry: dict) -> str:
    return getattr(visibility_tables.Results(data), entry["table"])()


LAYOUTS: dict[str, Callable[[object, dict], str]] = {
    "rows": rows, "pivot": pivot, "kept": kept, "errors of samplers": errors_of_samplers, "visibility": visibility}
