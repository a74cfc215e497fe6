"""Maps from the shell, and plans on maps that are bad or odd."""

import json
import os
import subprocess
import time

import pytest

DATA = os.path.join(os.path.dirname(__file__), "..", "data")
CHAIR_CASES = os.path.join(DATA, "office_chair_cases.yaml")
HEAD = "# Octomap OcTree binary file\nid OcTree\n"


def casepush(*arguments, timeout=60):
    return subprocess.run(["rosrun", "casepush", "casepush", *map(str, arguments)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          timeout=timeout, check=False)


def result(*arguments, code=0, timeout=60):
    process = casepush(*arguments, "--json", timeout=timeout)
    assert process.returncode == code, (arguments, process.stdout, process.stderr)
    lines = process.stdout.strip().splitlines()
    assert len(lines) == 1, process.stdout
    return json.loads(lines[0])


def refusal(*arguments):
    process = casepush(*arguments)
    assert process.returncode == 2, (arguments, process.stdout, process.stderr)
    lines = process.stderr.strip().splitlines()
    assert len(lines) == 1, process.stderr
    return lines[0]


@pytest.fixture(scope="module")
def case_base(tmp_path_factory):
    file = tmp_path_factory.mktemp("cases") / "chair.db"
    assert result("cases", "import", "--case-base", file, CHAIR_CASES)["imported"] == 14
    return file


@pytest.fixture(scope="module")
def floor_plan(tmp_path_factory):
    """open_floor's walls as map_server would write them: 10 m x 10 m in cells of 10 cm."""
    folder = tmp_path_factory.mktemp("plan")
    rows = [bytes(0 if x in (0, 99) or y in (0, 99) else 254 for x in range(100))
            for y in range(100)]
    (folder / "plan.pgm").write_bytes(b"P5 100 100 255\n" + b"".join(rows))
    yaml = folder / "plan.yaml"
    yaml.write_text("image: plan.pgm\nresolution: 0.1\norigin: [-5.0, -5.0, 0.0]\nnegate: 0\n"
                    "occupied_thresh: 0.65\nfree_thresh: 0.196\n", encoding="utf-8")
    return yaml


def plan(case_base, *arguments, goal=(2.5, 1.5, 45)):
    return ["plan", "--object", "office_chair", "--world", "open_floor", "--case-base", case_base,
            "--start", 0, 0, 0, "--goal", *goal, *arguments]


def test_converts_floor_plans_and_tells_what_is_in_them(tmp_path, floor_plan):
    file = tmp_path / "plan.bt"
    made = result("map", "convert", floor_plan, file, "--height", 1.0)
    info = result("map", "info", file)
    assert info["resolution_m"] == made["resolution_m"] == 0.05
    assert info["min_m"] == pytest.approx([-5, -5, -0.05]) and info["max_m"][2] == 1.0
    # Four walls of 10 cm, and one layer of cells below the rim of the floor.
    assert info["occupied_m3"] == pytest.approx(3.96 + 796 * 0.05 ** 3)
    assert info["memory_bytes"] > 1000 and info["occupied_leaves"] > 100
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plan.bt"]


@pytest.mark.parametrize("resolution", [0.02, 0.05, 0.1, 0.2])
def test_plans_at_every_resolution(tmp_path, floor_plan, case_base, resolution):
    file = tmp_path / "plan.bt"
    result("map", "convert", floor_plan, file, "--resolution", resolution)
    planned = result(*plan(case_base, "--map", file, "--deadline", 60), timeout=100)
    assert planned["status"] == "solved" and planned["pushes"] > 0
    again = result("map", "convert", file, tmp_path / "other.bt", "--resolution", 0.1)
    assert again["resolution_m"] == 0.1


def test_plans_on_a_floor_plan_itself(floor_plan, case_base):
    assert result(*plan(case_base, "--map", floor_plan))["success"]
    assert "overlap the map near" in refusal(*plan(case_base, "--map", floor_plan,
                                                   goal=(4.8, 0, 0)))


def bad_maps(folder, floor_plan):
    """(file, words of the message)."""
    bt = folder / "good.bt"
    result("map", "convert", floor_plan, bt)
    whole = bt.read_bytes()
    (folder / "cut.bt").write_bytes(whole[:len(whole) // 2])
    (folder / "cut.ot").write_bytes(b"# Octomap OcTree file\nid OcTree\nsize 9\nres 0.05\ndata\n\1")
    texts = {"zero.bt": HEAD + "size 1\nres 0\ndata\n", "nan.bt": HEAD + "size 1\nres nan\ndata\n",
             "empty.bt": HEAD + "size 0\nres 0.05\ndata\n", "void.bt": "", "text.bt": "a map",
             "bad.yaml": "image: none.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n",
             "zero.yaml": "image: none.pgm\nresolution: 0\norigin: [0, 0, 0]\n",
             "nan.yaml": "image: none.pgm\nresolution: 0.05\norigin: [0, .nan, 0]\n"}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [("cut.bt", "truncated"), ("cut.ot", "truncated"), ("zero.bt", "resolution is 0 m"),
            ("nan.bt", "resolution is"), ("empty.bt", "empty map"), ("void.bt", "is empty"),
            ("text.bt", "no OctoMap file"), ("bad.yaml", "none.pgm"), ("zero.yaml", "resolution"),
            ("nan.yaml", "origin"), ("absent.bt", "no such map file")]


def test_bad_maps_are_refused_by_name(tmp_path, floor_plan, case_base):
    for name, words in bad_maps(tmp_path, floor_plan):
        for arguments in (plan(case_base, "--map", tmp_path / name),
                          ["map", "info", tmp_path / name]):
            message = refusal(*arguments)
            assert name.replace("bad.yaml", "none.pgm") in message and words in message, message
    for option in (("--resolution", 0), ("--resolution", "nan"), ("--height", -1)):
        assert option[0] in refusal("map", "convert", floor_plan, tmp_path / "x.bt", *option)
    assert "cannot be written" in refusal("map", "convert", floor_plan, tmp_path / "no" / "x.bt")


def test_bad_requests_are_refused_with_a_reason(case_base):
    assert "start" in refusal(*plan(case_base)[:9], "--start", "nan", 0, 0, "--goal", 1, 1, 0)
    wall = plan(case_base)
    wall[wall.index("--start") + 1] = 4.8
    assert "overlaps the map near" in refusal(*wall)
    for option in (("--deadline", 0), ("--deadline", -1), ("--planner", "crystal_ball"),
                   ("--goal", 1, 1)):
        assert option[0].strip("-") in refusal(*plan(case_base, *option))


def test_returns_by_its_deadline(case_base, tmp_path):
    # A cupboard: every case leads out of it, and there is no way to the goal.
    world = tmp_path / "cupboard.yaml"
    walls = "\n".join(
        f"  - {{name: wall_{i}, size_m: {size}, xyz: {xyz}}}" for i, (size, xyz) in enumerate(
            [([2.4, 0.1, 1], [0, 1.25, 0.5]), ([2.4, 0.1, 1], [0, -1.25, 0.5]),
             ([0.1, 2.6, 1], [1.25, 0, 0.5]), ([0.1, 2.6, 1], [-1.25, 0, 0.5])]))
    world.write_text("bounds: {min: [-4, -4], max: [4, 4]}\nrobot: {model: cobot, xy: [-0.8, 0], "
                     "yaw_deg: 0}\nobjects:\n  - {id: chair_1, model: office_chair, xy: [0.3, 0], "
                     "yaw_deg: 0}\nboxes:\n" + walls + "\n", encoding="utf-8")
    for planner in ("exp_rrt", "exp_rrt_paper", "lattice", "ompl_rrt"):
        for deadline in (0.001, 0.5):
            start = time.monotonic()
            answer = result("plan", "--object", "office_chair", "--world", world, "--case-base",
                            case_base, "--goal", 3, 3, 0, "--planner", planner, "--deadline",
                            deadline, code=1)
            assert answer["status"] in ("unreachable", "deadline"), answer
            assert answer["explanation"]
            # Reading the world and starting take their time, too.
            assert answer["timing"]["planning_s"] < deadline + 1.0
            assert time.monotonic() - start < deadline + 20.0
