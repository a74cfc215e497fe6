"""The `casepush` command as its users call it."""

import json
import os
import shutil
import subprocess

import pytest

DATA = os.path.join(os.path.dirname(__file__), "..", "data")
CHAIR_CASES = os.path.join(DATA, "office_chair_cases.yaml")


def casepush(*arguments, timeout=100):
    return subprocess.run(["rosrun", "casepush", "casepush", *map(str, arguments)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          timeout=timeout, check=False)


def result_of(process):
    """The one JSON object on stdout."""
    lines = process.stdout.strip().splitlines()
    assert len(lines) == 1, process.stdout + process.stderr
    return json.loads(lines[0])


def without_timing(process):
    result = result_of(process)
    assert set(result.pop("timing")) >= {"wall_s"}
    return json.dumps(result)


@pytest.fixture(scope="module")
def case_base(tmp_path_factory):
    file = tmp_path_factory.mktemp("cases") / "chair.db"
    process = casepush("cases", "import", "--case-base", file, CHAIR_CASES, "--json")
    assert process.returncode == 0, process.stderr
    assert result_of(process)["imported"] == 14
    return file


def test_help_explains_every_command():
    process = casepush("--help")
    assert process.returncode == 0
    for word in ("learn", "plan", "push", "rearrange", "cases", "world", "bench", "experiment",
                 "Exit code"):
        assert word in process.stdout
    for command in ("learn", "plan", "push", "rearrange", "cases", "world", "bench"):
        assert casepush(command, "--help").returncode == 0


def test_learns_stores_and_resumes(tmp_path):
    file = tmp_path / "cases.db"
    arguments = ("learn", "--object", "office_chair", "--case-base", file, "--practices", 3,
                 "--seed", 5, "--json")
    first = casepush(*arguments, "--cases", 2)
    assert first.returncode == 0, first.stderr
    result = result_of(first)
    assert result["success"] and len(result["cases"]) == 2
    assert all(case["observations"] == 3 for case in result["cases"])
    resumed = casepush(*arguments, "--cases", 3)
    assert resumed.returncode == 0, resumed.stderr
    again = result_of(resumed)
    assert len(again["cases"]) == 3
    assert again["cases"][:2] == result["cases"]
    assert "learning case 3/3" in resumed.stderr


def test_threads_change_nothing_but_time(tmp_path):
    learn = ("learn", "--object", "office_chair", "--cases", 2, "--practices", 4, "--seed", 3,
             "--caster-model", "planar", "--json")
    runs = [casepush(*learn, "--case-base", tmp_path / f"{jobs}.db", "--jobs", jobs)
            for jobs in (1, 2, 3)]
    assert without_timing(runs[0]) == without_timing(runs[1]) == without_timing(runs[2])


def test_threads_change_nothing_for_transferred_cases(tmp_path):
    first = tmp_path / "1.db"
    common = ("--case-base", first, "--json")
    assert casepush("learn", "--object", "utility_cart", "--cases", 1, "--practices", 2,
                    "--caster-model", "planar", *common).returncode == 0
    assert casepush("cases", "transfer", "--to", "service_trolley", *common).returncode == 0
    second = tmp_path / "2.db"
    shutil.copy(first, second)
    learnt = [casepush("learn", "--object", "service_trolley", "--cases", 1, "--practices", 4,
                       "--caster-model", "planar", "--case-base", file, "--jobs", jobs, "--json")
              for jobs, file in ((1, first), (2, second))]
    assert result_of(learnt[0])["cases"][0]["observations"] == 4, learnt[0].stderr
    assert without_timing(learnt[0]) == without_timing(learnt[1])


def test_learns_by_driving(tmp_path):
    process = casepush("learn", "--object", "office_chair", "--cases", 2, "--practices", 4,
                       "--reset", "drive", "--caster-model", "planar", "--case-base",
                       tmp_path / "cases.db", "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    assert [case["observations"] >= 4 for case in result["cases"]] == [True, True]
    assert result["collisions"] == 0


def test_compares_strategies_of_coverage():
    process = casepush("experiment", "coverage", "--seeds", 2, "--problems", 1, "--cases", 3,
                       "--practices", 1, "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    for strategy in ("random", "spread", "spread_minus_random"):
        low, high = result[strategy]["mean_distance_tolerances"]["ci95"]
        assert low <= result[strategy]["mean_distance_tolerances"]["mean"] <= high
        assert len(result[strategy]["planned"]["seeds"]) == 2


def test_transferred_cases_need_fewer_practices():
    process = casepush("experiment", "transfer", "--from", "overbed_table", "--to", "utility_cart",
                       "--seeds", 1, "--cases", 4, "--learning-practices", 6, "--practices", 2,
                       "--tests", 4, "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    assert result["cases"][0] + result["useless_cases"][0] == 4
    transferred = [row["surprise_nat"]["mean"] for row in result["transferred"]]
    scratch = [row["surprise_nat"]["mean"] for row in result["scratch"]]
    assert [len(transferred), len(scratch)] == [3, 2]
    assert transferred[1] < transferred[0]
    assert transferred[1] < scratch[0]


def test_objects_too_different_share_no_cases():
    process = casepush("experiment", "transfer", "--from", "utility_cart", "--to", "stretcher",
                       "--seeds", 1, "--cases", 1, "--learning-practices", 1, "--json")
    assert process.returncode == 2
    assert "too different to transfer" in process.stderr


def test_same_seed_gives_same_bytes(tmp_path, case_base):
    learn = ("learn", "--object", "office_chair", "--cases", 1, "--practices", 3, "--seed", 9)
    runs = [casepush(*learn, "--case-base", tmp_path / name, "--json") for name in ("a.db", "b.db")]
    assert without_timing(runs[0]) == without_timing(runs[1])
    plan = ("plan", "--object", "office_chair", "--case-base", case_base, "--seed", 3, "--json")
    assert without_timing(casepush(*plan)) == without_timing(casepush(*plan))
    other = casepush(*plan[:-2], 4, "--json")
    assert without_timing(other) != without_timing(casepush(*plan))


def test_pushes_a_chair_to_a_goal(case_base):
    process = casepush("push", "--object", "office_chair", "--world", "open_floor", "--case-base",
                       case_base, "--seed", 2, "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    assert result["success"] is True
    assert result["position_error_m"] <= 0.2
    assert result["yaw_error_rad"] <= 0.35
    assert result["pushes"] == len(result["push_reports"]) > 0
    assert result["collisions"] == 0
    assert result["seed"] == 2
    assert {"replans", "plan_length_m", "sim_time_s", "timing"} <= set(result)
    assert "push 1 of" in process.stderr
    assert sum(result["replan_causes"].values()) == result["replans"]


def test_rearranges_two_chairs(case_base):
    world = os.path.join(DATA, "two_chairs.yaml")
    process = casepush("rearrange", "--world", world, "--case-base", case_base, "--goal",
                       "chair_1:1.6,0.6,0", "--goal", "chair_2:1.6,-1.8,0", "--caster-model",
                       "planar", "--seed", 1, "--json")
    result = result_of(process)
    assert process.returncode == 0 and result["success"], process.stderr + process.stdout
    assert result["order"][0] == "chair_2"  # It stands in the way of chair_1.
    assert [each["object"] for each in result["objects"]] == ["chair_1", "chair_2"]
    for each in result["objects"]:
        assert each["at_goal"] and each["turns"] >= 1 and each["pushes"] > 0
        assert each["position_error_m"] < 0.2
    assert {push["object"] for push in result["push_reports"]} == {"chair_1", "chair_2"}


@pytest.mark.parametrize("goal, words", [
    ("chair_1", "id:x,y,yaw"), ("chair_1:1,2", "id:x,y,yaw"), ("chair_1:1,2,x", "id:x,y,yaw"),
    ("chair_1:nan,0,0", "id:x,y,yaw"), ("chair_1:99,0,0", "outside of world"),
    ("piano:1,0,0", "no object 'piano'")])
def test_refuses_bad_goals_of_rearrange(case_base, goal, words):
    process = casepush("rearrange", "--world", os.path.join(DATA, "two_chairs.yaml"),
                       "--case-base", case_base, "--goal", goal)
    assert process.returncode == 2
    assert words in process.stderr
    assert len(process.stderr.strip().splitlines()) == 1


def test_keeps_what_a_loaded_object_taught_beside_what_is_known(tmp_path, case_base):
    file = shutil.copy(case_base, tmp_path / "kept.db")
    arguments = ("push", "--object", "office_chair", "--world", "open_floor", "--case-base", file,
                 "--caster-model", "planar", "--load", 20, "--seed", 2, "--json")
    refused = casepush(*arguments, "--keep", "--no-adapt")
    assert refused.returncode == 2
    assert "--keep" in refused.stderr
    pushed = casepush(*arguments, "--keep")
    assert pushed.returncode == 0, pushed.stderr
    used = {report["case"] for report in result_of(pushed)["push_reports"]}
    before = {each["id"]: each for each in
              result_of(casepush("cases", "list", "--case-base", case_base, "--json"))["cases"]}
    after = {each["id"]: each for each in
             result_of(casepush("cases", "list", "--case-base", file, "--json"))["cases"]}
    assert len(after) == len(before) + len(used)
    assert all(after[each] == before[each] for each in before)


@pytest.mark.parametrize("experiment, rows", [
    (("success", "--objects", "office_chair", "--size", 7), 1),
    (("replans", "--practices", 3, 4, "--distance", 1.5), 2),
    (("adaptation", "--object", "office_chair", "--practices", 4, "--distance", 1.5), 4),
])
def test_measures_tasks(experiment, rows):
    arguments = ("experiment", *experiment, "--caster-models", "planar", "--tasks", 1,
                 "--case-bases", 1, "--cases", 8)
    process = casepush(*arguments, "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    assert len(result["rows"]) == rows
    for row in result["rows"]:
        assert row["tasks"] == row["success"]["of"] == 1
        assert row["success"]["ci95"][0] < row["success"]["ci95"][1] <= 1.0
        assert row["replans"]["mean"] == sum(row["replan_causes"].values())
    assert "left" in process.stderr
    table = casepush(*arguments)
    assert len(table.stdout.splitlines()) == rows + 2


def test_compares_plans_around_and_through_movable_obstacles():
    process = casepush("experiment", "obstacles", "--plans-only", "--plans", 2, "--tasks", 2,
                       "--case-bases", 1, "--cases", 10, "--caster-models", "planar", "--json")
    stationary, movable = (row["plans"] for row in result_of(process)["rows"])
    assert stationary["trials"] == movable["trials"] == 4
    assert 2.0 < movable["length_m"]["mean"] < stationary["length_m"]["mean"]


def test_export_and_import_keep_every_case(tmp_path, case_base):
    exported = tmp_path / "out.yaml"
    assert casepush("cases", "export", "--case-base", case_base, exported).returncode == 0
    copy = tmp_path / "copy.db"
    assert casepush("cases", "import", "--case-base", copy, exported).returncode == 0
    listed = [result_of(casepush("cases", "list", "--case-base", file, "--json"))
              for file in (case_base, copy)]
    assert listed[0] == listed[1]


def test_generates_rooms_to_push_in(tmp_path, case_base):
    generate = ("world", "generate", "--seed", 4, "--size", 8, "--density", 0.1, "--json")
    files = [tmp_path / name for name in ("a.yaml", "b.yaml")]
    for file in files:
        process = casepush(*generate, "--output", file)
        assert process.returncode == 0, process.stderr
    assert files[0].read_bytes() == files[1].read_bytes()
    room = result_of(process)
    start, goal = ([room[key][part] for part in ("x_m", "y_m", "yaw_deg")]
                   for key in ("start", "goal"))
    planned = casepush("plan", "--object", "office_chair", "--world", files[0], "--case-base",
                       case_base, "--start", *start, "--goal", *goal, "--json")
    assert planned.returncode == 0, planned.stderr
    assert result_of(planned)["success"] is True


def write(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def bad_inputs(tmp_path, case_base):
    """(arguments, words of the one-line message)."""
    junk = write(tmp_path / "junk.db", "this is no database " * 300)
    truncated = tmp_path / "truncated.db"
    with open(case_base, "rb") as stream:
        truncated.write_bytes(stream.read(5000))
    empty = tmp_path / "empty.db"
    only_other = write(tmp_path / "none.yaml", "casepush_cases: 1\ncases: []\n")
    casepush("cases", "import", "--case-base", empty, only_other)
    chair = os.path.join(os.environ["CASEPUSH_SHARE"], "config", "objects", "office_chair")
    for suffix in (".urdf", ".yaml"):
        shutil.copy(chair + suffix, tmp_path / ("broken" + suffix))
    urdf = (tmp_path / "broken.urdf").read_text(encoding="utf-8")
    write(tmp_path / "broken.urdf", urdf.replace("<inertia ", "<inertia_lost ", 1))
    bad_world = write(tmp_path / "bad.yaml", "bounds: [not a world\n")
    nan_yaml = tmp_path / "nan.yaml"
    with open(CHAIR_CASES, encoding="utf-8") as stream:
        nan_yaml.write_text(stream.read().replace("period_s: 0.1", "period_s: .nan", 1),
                            encoding="utf-8")
    plan = ["plan", "--object", "office_chair"]
    with_cases = plan + ["--case-base", case_base]
    return [
        (["plan", "--object", "sofa", "--case-base", case_base], ["sofa", "office_chair"]),
        (["plan", "--object", tmp_path / "broken.urdf", "--case-base", case_base],
         ["broken.urdf", "inerti"]),
        (with_cases + ["--world", "moon"], ["moon", "office"]),
        (with_cases + ["--world", bad_world], ["bad.yaml"]),
        (with_cases + ["--map", junk], ["junk.db"]),
        (with_cases + ["--map", tmp_path / "no.bt"], ["no.bt"]),
        (plan + ["--case-base", tmp_path / "absent.db"], ["absent.db"]),
        (plan + ["--case-base", junk], ["junk.db"]),
        (plan + ["--case-base", truncated], ["truncated.db"]),
        (plan + ["--case-base", empty], ["empty.db", "casepush learn"]),
        (with_cases + ["--goal", "nan", "1", "0"], ["--goal", "finite"]),
        (with_cases + ["--goal", "900", "1", "0"], ["--goal", "outside", "(0, 0) to (15, 15)"]),
        (with_cases + ["--start", "3", "3", "0"], ["--goal"]),
        (with_cases + ["--seed", "-1"], ["--seed"]),
        (with_cases + ["--seed", "99999999999999999999"], ["--seed"]),
        (with_cases + ["--deadline", "nan"], ["--deadline", "see casepush plan --help"]),
        (["cases", "remove", "--case-base", case_base], ["--id", "see casepush cases remove --help"]),
        (["learn", "--objct", "office_chair"], ["unknown argument --objct", "see casepush learn --help"]),
        (["bench", "sim", "--pushes", "-1"], ["--pushes", "100000"]),
        (["experiment", "obstacles", "--movable", "sofa"], ["sofa", "office_chair"]),
        (["experiment", "success", "--rooms", "moon"], ["moon", "office"]),
        (plan + ["--case-base", ""], ["--case-base"]),
        (["cases", "import", "--case-base", tmp_path / "new.db", nan_yaml], ["nan.yaml", "period"]),
        (["learn", "--object", "office_chair", "--case-base", tmp_path / "l.db", "--coverage", "all"],
         ["all", "random or spread"]),
        (["learn", "--object", "office_chair", "--case-base", tmp_path / "l.db", "--world", "office"],
         ["--world", "--reset drive"]),
        (["learn", "--object", "office_chair", "--case-base", tmp_path / "l.db", "--cases", "0"],
         ["cases"]),
        (["world", "generate", "--size", "1", "--output", tmp_path / "w.yaml"], ["size", "100"]),
        (["world", "generate", "--density", "nan", "--output", tmp_path / "w.yaml"], ["density"]),
        (["world", "generate", "--output", tmp_path / "absent" / "w.yaml"], ["absent"]),
        (["fly"], ["fly"]),
    ]


def test_bad_input_is_one_clear_line_and_leaves_files_alone(tmp_path, case_base):
    for arguments, words in bad_inputs(tmp_path, case_base):
        before = {file: file.read_bytes() for file in tmp_path.iterdir() if file.is_file()}
        process = casepush(*arguments)
        lines = [line for line in process.stderr.splitlines() if line.strip()]
        assert process.returncode == 2, (arguments, process.stderr)
        assert len(lines) == 1, (arguments, process.stderr)
        for word in words:
            assert word in lines[0], (arguments, word, lines[0])
        known = set(before) | {file for file in tmp_path.iterdir() if file.is_dir()}
        assert set(tmp_path.iterdir()) == known, (arguments, "left something behind")
        for file, content in before.items():
            assert file.read_bytes() == content, (arguments, file)


def test_bad_input_with_json_still_gives_one_object():
    process = casepush("plan", "--object", "sofa", "--case-base", "none.db", "--json")
    assert process.returncode == 2
    result = result_of(process)
    assert result["success"] is False and "sofa" in result["error"]


@pytest.mark.parametrize("arguments, words", [
    (("--seed", "-3"), ["--seed", "2147483647"]), (("--timeout", "nan"), ["--timeout", "above 0"]),
    (("--world", "moon"), ["'moon'", "office"]), (("--object", "sofa"), ["'sofa'", "office_chair"]),
    (("--goal", "1 2"), ["--goal", "x_m y_m yaw_deg"]), (("--world", "moon.yaml"), ["moon.yaml"])])
def test_demo_refuses_bad_arguments_before_it_starts(tmp_path, arguments, words):
    script = os.path.join(os.environ["CASEPUSH_SHARE"], "scripts", "run_demo")
    process = subprocess.run([script, "--results", tmp_path / "demo", *arguments], text=True,
                             capture_output=True, timeout=20, check=False)
    assert process.returncode == 2
    for word in words:
        assert word in process.stderr.splitlines()[-1]
    assert not (tmp_path / "demo").exists()


def test_goal_in_a_wall_is_refused_with_a_reason(case_base):
    process = casepush("plan", "--object", "office_chair", "--case-base", case_base, "--goal",
                       "0.05", "5", "0", "--json")
    assert process.returncode == 2
    assert "goal (0.05, 5.00, 0 deg)" in result_of(process)["error"]


def test_unknown_caster_models_are_refused(case_base):
    process = casepush("push", "--object", "office_chair", "--case-base", case_base,
                       "--caster-model", "flat", "--json")
    assert process.returncode == 2
    assert "featherstone or planar" in result_of(process)["error"]


def test_learns_what_a_load_does_and_refuses_bad_ones(tmp_path):

    def learn(name, *load):
        process = casepush("learn", "--object", "overbed_table", "--case-base", tmp_path / name,
                           "--cases", 1, "--practices", 2, "--caster-model", "planar", "--json",
                           *load)
        return process.returncode, result_of(process)

    code, bare = learn("bare.db")
    assert code == 0
    code, loaded = learn("loaded.db", "--load", 40)
    assert code == 0
    assert loaded["cases"][0]["x_m"] != bare["cases"][0]["x_m"]
    for load, words in (((90,), "[0, 80]"), (("nan",), "[0, 80]"), ((40, 3, 0), "footprint"),
                        ((40, 1), "KG X_M Y_M")):
        code, result = learn("bad.db", "--load", *load)
        assert code == 2
        assert words in result["error"]
    assert not (tmp_path / "bad.db").exists()
