"""The files of a study: its summary and its tables, each written whole or not at all."""

from __future__ import annotations

import json
import pathlib
from collections.abc import Mapping
from typing import Any

import pandas as pd

from .root import write_whole
from .summary import plain, versions

__all__ = ["write_study"]


def write_study(
    directory: pathlib.Path, summary: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]
) -> None:
    """Write ``summary.json``, with the versions of what decides the numbers, and NAME.csv.

    Call on rank 0.
    """
    text = json.dumps(plain({**summary, "versions": versions()}), indent=2, allow_nan=False)
    write_whole(directory / "summary.json", lambda file: file.write_text(text + "\n"))
    for name, table in tables.items():
        write_whole(directory / f"{name}.csv", lambda file, t=table: t.to_csv(file, index=False))
