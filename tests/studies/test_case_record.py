"""The record of cases survives what may happen to it."""

import json

import pytest

from morphing_wing.errors import InputError
from morphing_wing.studies.case_record import CaseRecord

pytestmark = pytest.mark.quick

STUDY = {"design": {"points": 3}, "factors": [{"key": "a", "low": 0.0}]}


def written(folder, cases):
    with CaseRecord(folder, STUDY, 3, resume=False) as record:
        for number in range(cases):
            record.add(number, {"a": 0.1 * number}, {"y": number / 3, "refused": ""})
    return folder / "cases.jsonl"


def resumed(folder, study=STUDY):
    with CaseRecord(folder, study, 3, resume=True) as record:
        return record.done


@pytest.mark.parametrize("torn", [b"{", b'{"case": 2, "inputs": {"a": 0.2}, "result": {"y": 0.6',
                                  b'{"case": 2}'])
def test_a_last_line_that_was_cut_off_is_dropped_and_the_next_one_is_whole(tmp_path, torn):
    file = written(tmp_path, 2)
    with file.open("ab") as more:
        more.write(torn)
    assert resumed(tmp_path) == {0: {"y": 0.0, "refused": ""}, 1: {"y": 1 / 3, "refused": ""}}
    with CaseRecord(tmp_path, STUDY, 3, resume=True) as record:
        record.add(2, {"a": 0.2}, {"y": 2 / 3, "refused": ""})
    assert sorted(resumed(tmp_path)) == [0, 1, 2]
    assert all(json.loads(line) for line in file.read_text().splitlines())


def test_a_line_that_is_damaged_in_the_middle_is_refused(tmp_path):
    file = written(tmp_path, 2)
    lines = file.read_text().splitlines(keepends=True)
    file.write_text(lines[0] + "what\n" + lines[2])
    with pytest.raises(InputError, match=r"cases.jsonl, line 2: must be a case"):
        resumed(tmp_path)


def test_cases_of_another_study_are_refused_by_the_first_difference(tmp_path):
    written(tmp_path, 1)
    other = {**STUDY, "factors": [{"key": "a", "low": 0.5}]}
    with pytest.raises(InputError, match=r"whose factors.a.low is 0.0, not 0.5"):
        resumed(tmp_path, other)
    with pytest.raises(InputError, match=r"whose design.points is 3, not 4"):
        resumed(tmp_path, {**STUDY, "design": {"points": 4}})


def test_cases_computed_at_other_points_are_refused(tmp_path):
    written(tmp_path, 2)
    with CaseRecord(tmp_path, STUDY, 3, resume=True) as record:
        record.check_inputs([{"a": 0.0}, {"a": 0.1}, {"a": 0.2}])
        with pytest.raises(InputError, match="case 1 in .* was another one"):
            record.check_inputs([{"a": 0.0}, {"a": 0.11}, {"a": 0.2}])


def test_a_study_that_has_not_ended_is_not_written_over(tmp_path):
    written(tmp_path, 2)
    with pytest.raises(InputError, match=r"holds 2 of 3 cases of a study: must be another folder"):
        written(tmp_path, 1)
    assert len(resumed(tmp_path)) == 2


def test_a_study_that_has_ended_is_begun_anew_without_resume(tmp_path):
    written(tmp_path, 3)
    written(tmp_path, 1)
    assert list(resumed(tmp_path)) == [0]


def test_a_record_in_use_is_refused(tmp_path):
    with (CaseRecord(tmp_path, STUDY, 3, resume=False),
          pytest.raises(InputError, match="is in use, must be left")):
        resumed(tmp_path)


def test_there_must_be_something_to_resume(tmp_path):
    with pytest.raises(InputError, match="--resume: .* must hold a cases.jsonl"):
        resumed(tmp_path / "nowhere")
    assert not (tmp_path / "nowhere").exists()
