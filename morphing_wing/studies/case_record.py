"""The record of a study: one line a case, written as soon as the case is done."""

from __future__ import annotations

import contextlib
import fcntl
import json
import pathlib
from collections.abc import Mapping
from types import TracebackType
from typing import Any

from morphing_wing.errors import InputError
from morphing_wing.summary import plain

__all__ = ["CaseRecord"]

FILE = "cases.jsonl"


class CaseRecord:
    """Cases that are done, in a folder's ``cases.jsonl``; a context manager that holds the file.

    The first line says which study it is. A last line that was cut off by a kill is dropped.

    Parameters
    ----------
    folder
        Where it is; made if it is not there.
    study
        Description of the study, of plain values.
    size
        Number of its cases.
    resume
        Whether to go on with what is there, or to begin anew.

    Attributes
    ----------
    done
        Result of each case that was done, by its number.

    Raises
    ------
    InputError
        If there is nothing to resume, or the cases there are another study's, or are still being
        computed by another program, or the record cannot be read; without ``resume``, if it holds
        cases of a study that has not ended.
    """

    def __init__(
        self, folder: pathlib.Path, study: Mapping[str, Any], size: int, resume: bool
    ) -> None:
        self._path = folder / FILE
        self._study, self._size = plain(dict(study)), size
        self.done: dict[int, dict[str, Any]] = {}
        if resume and not self._path.is_file():
            raise InputError(f"--resume: {folder} must hold a {FILE} of a study to go on with")
        folder.mkdir(parents=True, exist_ok=True)
        self._file = open(self._path, "a+b")  # noqa: SIM115
        try:
            self._begin(folder, resume)
        except BaseException:
            self._file.close()
            raise

    def __enter__(self) -> CaseRecord:
        """Return the record."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Let go of the file."""
        self._file.close()

    def add(self, number: int, inputs: Mapping[str, Any], result: Mapping[str, Any]) -> None:
        """Write down a case."""
        self.done[number] = dict(result)
        self._write({"case": number, "inputs": inputs, "result": result})

    def check_inputs(self, inputs: list[Mapping[str, Any]]) -> None:
        """Refuse a record whose cases were computed at other points than these."""
        for number, there in self._inputs.items():
            if number >= len(inputs) or there != plain(dict(inputs[number])):
                raise InputError(f"--resume: case {number} in {self._path} was another one, as by "
                                 "another version of a library: must be begun anew elsewhere")

    def _begin(self, folder: pathlib.Path, resume: bool) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(f"{self._path}: is in use, must be left to the program that computes "
                             "it") from None
        except OSError:  # not every file system has locks
            pass
        lines, whole = self._lines()
        self._inputs = {}
        if resume and lines:
            self._check_study(lines[0])
            for line in lines[1:]:
                self.done[line["case"]] = line["result"]
                self._inputs[line["case"]] = line["inputs"]
            self._file.truncate(whole)
            return
        if lines and not resume and 1 < len(lines) <= lines[0].get("cases", 0):
            raise InputError(
                f"{folder}: holds {len(lines) - 1} of {lines[0]['cases']} cases of a study: must "
                f"be another folder, go on with --resume, or have its {FILE} removed")
        self._file.truncate(0)
        self._write({"study": self._study, "cases": self._size})

    def _lines(self) -> tuple[list[dict[str, Any]], int]:
        """Return all whole lines, and how many bytes they take."""
        self._file.seek(0)
        lines, whole = [], 0
        pieces = self._file.read().splitlines(keepends=True)
        for number, piece in enumerate(pieces):
            line = None
            with contextlib.suppress(ValueError):
                line = json.loads(piece)
            key = "study" if number == 0 else "case"
            if not (piece.endswith(b"\n") and isinstance(line, dict) and key in line):
                if number < len(pieces) - 1:
                    raise InputError(f"{self._path}, line {number + 1}: must be a case as a study "
                                     "writes it, or the file be removed")
                break
            lines.append(line)
            whole += len(piece)
        return lines, whole

    def _check_study(self, head: Mapping[str, Any]) -> None:
        other = difference(head["study"], self._study)
        if other is not None:
            key, there, here = other
            raise InputError(f"--resume: {self._path} is of another study, whose {key} is {there}, "
                             f"not {here}: must be the same")

    def _write(self, line: Mapping[str, Any]) -> None:
        self._file.write(json.dumps(plain(line), allow_nan=False).encode() + b"\n")
        self._file.flush()


def difference(there: Any, here: Any, key: str = "") -> tuple[str, str, str] | None:
    """Return the first key in which two descriptions differ, with both values; None: in none."""
    if isinstance(there, dict) and isinstance(here, dict):
        for name in [*there, *(n for n in here if n not in there)]:
            other = difference(there.get(name), here.get(name), f"{key}.{name}".lstrip("."))
            if other is not None:
                return other
        return None
    if isinstance(there, list) and isinstance(here, list) and len(there) == len(here):
        for a, b in zip(there, here, strict=True):
            name = a.get("key", "") if isinstance(a, dict) else ""
            other = difference(a, b, f"{key}.{name}".rstrip("."))
            if other is not None:
                return other
        return None
    return None if there == here else (key, json.dumps(there), json.dumps(here))
