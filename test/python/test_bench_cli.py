"""The `casepush bench` commands as their users call them."""

from test_cli import case_base, casepush, result_of  # noqa: F401  case_base is a fixture


def test_bench_plans_each_problem_as_often_as_asked(tmp_path, case_base):
    log = tmp_path / "plan.log"
    process = casepush("bench", "plan", "--case-base", case_base, "--planners", "exp_rrt,lattice",
                       "--problems", 2, "--runs", 3, "--seed", 1, "--log", log, "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    assert (result["problems_per_world"], result["runs_per_problem"]) == (2, 3)
    for part in (result, result["first_runs"]):
        assert [row["planner"] for row in part["planners"]] == ["exp_rrt", "lattice"]
        assert all(row["success"] == 1.0 for row in part["by_world"]["office"])
        assert part["best_ompl"] is None
    assert result["first_runs"]["planners"] != result["planners"]
    assert "6 runs per planner" in log.read_text().splitlines()


def test_bench_compares_the_caster_models():
    process = casepush("bench", "sim", "--pushes", 2, "--swivels", 3, "--speed-time", 1, "--json")
    assert process.returncode == 0, process.stderr
    result = result_of(process)
    outcomes = result["planar_against_featherstone"]
    assert outcomes["mean_difference_m"]["median"] < outcomes["displacement_m"]["median"]
    assert result["timing"]["planar_over_featherstone"]["pushing_one"] > 1.0
