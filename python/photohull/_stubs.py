"""Writes _options.pyi, the types of options, from the library's descriptions: python3 -m photohull._stubs."""
from __future__ import annotations

import textwrap

from . import _LISTS, options

_NAMES = {"load": "LoadOptions", "reconstruct": "ReconstructOptions", "masks": "MaskOptions", "evaluate": "EvaluateOptions",
          "measure": "MeasureOptions", "pose": "PoseOptions"}


def _field(option) -> list[str]:
    default = f" Default: {option['default']}." if option["default"] else ""
    unit = f" ({option['unit']})" if option["unit"] else ""
    help_ = textwrap.wrap(f"{option['help']}{unit}.{default}", 96)
    return [*(f"    # {line}" for line in help_), f"    {option['name']}: {option['type']} | None"]


def option_stubs() -> str:
    """The text of _options.pyi."""
    lines = ["# The options as keyword arguments. Written by python3 -m photohull._stubs.", "import os",
             "from collections.abc import Mapping, Sequence", "from typing import Literal, TypedDict", "",
             "import numpy as np"]
    for function in _LISTS:
        lines += ["", f"class {_NAMES[function]}(TypedDict, total=False):"]
        for option in options(function):
            lines += _field(option)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(option_stubs(), end="")
