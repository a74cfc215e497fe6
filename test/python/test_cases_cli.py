"""Looking after a case base from the shell, and its pictures."""

import json
import os
import shutil
import sqlite3
import subprocess

import pytest

DATA = os.path.join(os.path.dirname(__file__), "..", "data")
CHAIR_CASES = os.path.join(DATA, "office_chair_cases.yaml")


def run(*arguments):
    return subprocess.run(["rosrun", "casepush", *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=150, check=False)


def cases(command, file, *arguments):
    return run("casepush", "cases", command, "--case-base", file, *arguments, "--json")


def result(command, file, *arguments, code=0):
    process = cases(command, file, *arguments)
    assert process.returncode == code, process.stdout + process.stderr
    lines = process.stdout.strip().splitlines()
    assert len(lines) == 1, process.stdout
    return json.loads(lines[0])


def refusal(command, file, *arguments):
    process = cases(command, file, *arguments)
    assert process.returncode == 2, process.stdout + process.stderr
    lines = process.stderr.strip().splitlines()
    assert len(lines) == 1, process.stderr
    return lines[0]


@pytest.fixture(scope="module")
def learnt(tmp_path_factory):
    file = tmp_path_factory.mktemp("cases") / "chair.db"
    assert result("import", file, CHAIR_CASES)["imported"] == 14
    return file


@pytest.fixture
def base(learnt, tmp_path):
    return shutil.copy(learnt, tmp_path / "chair.db")


def test_calibration_tells_the_tests_apart(base):
    answer = result("calibrate", base, "--alpha", 0.05)
    assert answer["cases"] == 14 and answer["observations"] == 280
    assert 0.0 < answer["rejected_by_hotelling"] < 0.12
    assert answer["rejected_by_plug_in"] > answer["rejected_by_hotelling"]


def test_dump_holds_everything(base):
    case = result("dump", base)["cases"][0]
    assert len(case["tube"]) == len(case["object_path"]) == len(case["robot_path"])
    assert case["tube"][-1] == case["outcome"]
    assert len(case["history"]) == 20 and 0.0 <= case["history"][3]["left_out"]["p_value"] <= 1.0
    assert result("dump", base, "--object", "nothing")["cases"] == []


def test_copies_have_a_context_and_nothing_can_be_taken_back_that_came_from_elsewhere(base):
    copy = result("copy", base, "--id", 3, "--load", 12.5, "--floor", "vinyl")["id"]
    listed = [c for c in result("list", base)["cases"] if c["id"] == copy][0]
    assert (listed["source_id"], listed["load_kg"], listed["floor"]) == (3, 12.5, "vinyl")
    assert "has no observation that can be taken back" in refusal("undo", base, "--id", copy)
    assert "case 99: does not exist" in refusal("copy", base, "--id", 99)
    result("remove", base, "--id", copy)
    assert len(result("list", base)["cases"]) == 14


def test_prune_says_why(base):
    for dry in (["--dry-run"], []):
        answer = result("prune", base, "--least-motion", 0.2, "--least-turn", 0.5, *dry)
        assert answer["pruned"] and all("hardly moves" in p["reason"] for p in answer["pruned"])
    left = result("list", base)["cases"]
    assert len(left) == 14 - len(answer["pruned"])


def test_merge_adds_what_is_missing_once(base, learnt, tmp_path):
    result("remove", base, "--id", 5)
    answer = result("merge", base, learnt)
    assert (answer["added"], answer["unchanged"]) == (1, 13)
    assert result("merge", base, learnt)["unchanged"] == 14
    assert "does not exist" in refusal("merge", base, tmp_path / "none.db")


def test_transfer_proposes_cases_of_similar_objects_only(base):
    proposed = result("transfer", base, "--to", "overbed_table", "--dry-run")
    assert proposed["from"] == "office_chair" and len(proposed["cases"]) == 14
    assert all(c["effective_count"] < 1.0 and c["source_id"] > 0 for c in proposed["cases"])
    assert len(result("list", base)["cases"]) == 14
    result("transfer", base, "--to", "overbed_table", "--from", "office_chair")
    stored = result("list", base, "--object", "overbed_table")["cases"]
    assert len(stored) == 14 and all(c["origin"] == "transferred" for c in stored)
    failed = result("transfer", base, "--to", "stretcher", "--from", "office_chair",
                    "--largest-dissimilarity", 0.1, code=1)
    assert "too different" in failed["explanation"]
    assert "no_such_thing" in refusal("transfer", base, "--to", "no_such_thing")


def test_an_export_cut_short_is_refused(base, tmp_path):
    whole = tmp_path / "cases.yaml"
    result("export", base, whole)
    lines = whole.read_text().splitlines(keepends=True)
    cut = tmp_path / "cut.yaml"
    for missing in (1, 2, 40):
        cut.write_text("".join(lines[:-missing]))
        assert str(cut) in refusal("import", tmp_path / "new.db", cut)
        assert not (tmp_path / "new.db").exists()


def test_damaged_bases_are_named_and_left_alone(base):
    with sqlite3.connect(base) as database:
        database.execute("UPDATE steps SET steps = zeroblob(144) WHERE case_id = 2")
    database.close()
    with open(base, "rb") as stream:
        before = stream.read()
    for command in ("list", "dump", "calibrate"):
        assert "case 2: steps: is damaged" in refusal(command, base)
    with open(base, "rb") as stream:
        assert stream.read() == before


def test_plot_cases_draws_every_object(base, tmp_path):
    result("transfer", base, "--to", "overbed_table")
    folder = tmp_path / "pictures"
    process = run("plot_cases", base, "--out", folder)
    assert process.returncode == 0, process.stderr
    names = sorted(f.name for f in folder.iterdir())
    assert names == [f"office_chair_{k}.png" for k in ("calibration", "cases", "outcomes", "tubes")
                     ] + [f"overbed_table_{k}.png" for k in ("cases", "outcomes", "tubes")]
    assert all(f.stat().st_size > 10000 for f in folder.iterdir())
    assert "too few observations" in process.stderr


def test_plot_cases_refuses_bad_input(base, tmp_path):
    for arguments, reason in (((tmp_path / "none.db",), "does not exist"),
                              ((CHAIR_CASES,), "is no case base"),
                              ((base, "--object", "sofa"), "holds no case of sofa")):
        process = run("plot_cases", *arguments, "--out", tmp_path / "out")
        assert process.returncode == 2 and reason in process.stderr
        assert len(process.stderr.strip().splitlines()) == 1
        assert not (tmp_path / "out").exists()
