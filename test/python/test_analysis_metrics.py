"""Metrics and calibration against closed forms and hand-made records."""

import math
import random

import numpy as np
import pytest
from casepush_analysis import calibration, metrics
from casepush_analysis.records import (ContactRecord, Part, PhaseSample, PushRecord, TaskRecord,
                                       Track)
from casepush_analysis.se2 import Pose2, PoseGaussian, interpolate, log_se2, wrap_angle


def push(number, plan=1, p_value=0.5, rejected=False, outcome='done', case_id=3, **changes):
    expected = PoseGaussian(Pose2(1.0, 0.0, 0.0), np.diag([0.01, 0.04, 0.09]))
    values = {'object_id': 'chair', 'case_id': case_id, 'outcome': outcome, 'explanation': '',
              'start_s': 10.0 * number, 'end_s': 10.0 * number + 4.0, 'map_start': Pose2(),
              'map_end': Pose2(1.3, 0.4, 0.2), 'map_expected': expected if case_id else None,
              't_squared': 1.0, 'p_value': p_value, 'rejected': rejected, 'push_s': 3.0,
              'plan_number': plan, 'push_index': number}
    values.update(changes)
    return PushRecord(**values)


def task(**changes):
    values = {'object_id': 'chair', 'map_goal': Pose2(2.0, 0.0, math.pi), 'start_s': 5.0,
              'position_tolerance_m': 0.2, 'yaw_tolerance_rad': 0.3, 'end_s': 100.0,
              'status': 'succeeded'}
    values.update(changes)
    return TaskRecord(**values)


@pytest.mark.parametrize('angle, wrapped', [
    (0.0, 0.0), (math.pi, math.pi), (-math.pi, math.pi), (3.5 * math.pi, -0.5 * math.pi)])
def test_angles_wrap_into_the_half_open_interval(angle, wrapped):
    assert wrap_angle(angle) == pytest.approx(wrapped)


def test_poses_compose_with_their_inverse_to_identity():
    pose = Pose2(1.0, -2.0, 2.5)
    identity = pose @ pose.inverse()
    assert (identity.x_m, identity.y_m, identity.yaw_rad) == pytest.approx((0.0, 0.0, 0.0))


def test_the_logarithm_of_a_quarter_circle_is_its_arc():
    # Radius 2, turned by 90 degrees: arc length pi in unit time.
    assert log_se2(Pose2(2.0, 2.0, math.pi / 2)) == pytest.approx([math.pi, 0.0, math.pi / 2])
    assert log_se2(Pose2(0.3, -0.4, 1e-9)) == pytest.approx([0.3, -0.4, 1e-9])


def test_an_ellipse_turns_with_its_mean():
    width, height, angle = PoseGaussian(
        Pose2(0, 0, math.pi / 2), np.diag([0.04, 0.01, 1.0])).ellipse(2.0)
    assert (width, height) == pytest.approx((0.8, 0.4))
    assert abs(math.sin(angle)) == pytest.approx(1.0)


def test_poses_are_interpolated_the_short_way_round():
    poses = [Pose2(0.0, 0.0, 3.0), Pose2(2.0, 4.0, -3.0)]
    middle = interpolate([1.0, 3.0], poses, 2.0)
    assert (middle.x_m, middle.y_m) == pytest.approx((1.0, 2.0))
    assert abs(middle.yaw_rad) == pytest.approx(math.pi)
    assert interpolate([1.0, 3.0], poses, 3.1) is None
    assert interpolate([], [], 0.0) is None


def test_the_deviation_is_measured_from_the_expected_mean():
    deviation = metrics.deviation(push(1))
    assert deviation.position_m == pytest.approx(0.5)
    assert deviation.yaw_rad == pytest.approx(0.2)


def test_first_tries_and_failed_pushes_have_no_deviation():
    assert metrics.deviation(push(1, case_id=0)) is None
    assert metrics.deviation(push(1, outcome='object_lost')) is None


def phase_segments():
    samples = [PhaseSample(0.0, 'idle'), PhaseSample(5.0, 'planning', Part.TASK),
               PhaseSample(6.0, 'approach', Part.TASK), PhaseSample(9.0, 'dock', Part.TASK),
               PhaseSample(10.0, 'push', Part.TASK), PhaseSample(13.0, 'rest', Part.TASK),
               PhaseSample(14.0, 'approach', Part.TASK), PhaseSample(20.0, 'push', Part.TASK)]
    return metrics.segments(samples, 23.0)


def test_phases_last_until_the_next_one():
    assert metrics.phase_totals(phase_segments(), Part.TASK) == {
        'planning': 1.0, 'approach': 9.0, 'dock': 1.0, 'push': 6.0, 'rest': 1.0}
    assert metrics.phase_totals(phase_segments(), Part.LEARNING) == {}


def test_time_before_a_push_belongs_to_it():
    first, second = metrics.push_times([push(1), push(2)], phase_segments())
    assert (first.plan_s, first.approach_s, first.push_s, first.rest_s) == (1.0, 4.0, 3.0, 1.0)
    assert (second.plan_s, second.approach_s) == (0.0, 6.0)


def test_without_phases_times_before_a_push_are_unknown():
    times = metrics.push_times([push(1)], [])[0]
    assert times.plan_s is None and times.approach_s is None and times.push_s == 3.0


def test_runs_end_where_the_plan_changes():
    pushes = [push(n, plan) for n, plan in enumerate((1, 1, 1, 2, 3, 3), 1)]
    found = metrics.runs(pushes)
    assert [r.pushes for r in found] == [3, 1, 2]
    assert [r.replanned for r in found] == [True, True, False]
    assert metrics.runs(pushes, ended_by_replan=True)[-1].replanned
    assert metrics.runs([]) == []


def test_failed_pushes_do_not_lengthen_a_run():
    assert metrics.runs([push(1), push(2, outcome='approach_failed')])[0].pushes == 1


def contact(stamp_s, a='robot', b='wall', impulse_ns=1.0):
    return ContactRecord(stamp_s, a, 'base', b, 'box', impulse_ns)


def test_contacts_in_a_row_are_one_collision():
    found = metrics.collisions([contact(t) for t in (1.0, 1.05, 1.1, 2.0, 2.05)], ['chair'])
    assert [(c.start_s, c.end_s) for c in found] == [(1.0, 1.1), (2.0, 2.05)]
    assert found[0].impulse_ns == pytest.approx(3.0)
    assert (found[0].body, found[0].obstacle) == ('robot', 'wall')


def test_only_contacts_of_something_moving_with_the_building_are_collisions():
    contacts = [contact(1.0, 'robot', 'chair'), contact(1.0, 'chair', 'floor'),
                contact(1.0, 'wall', 'desk'), contact(1.0, 'desk', 'chair')]
    found = metrics.collisions(contacts, ['chair'])
    assert [(c.body, c.part, c.obstacle) for c in found] == [('chair', 'box', 'desk')]


def test_the_final_error_is_taken_at_the_end_of_the_task():
    track = Track([4.0, 50.0, 100.0, 200.0],
                  [Pose2(), Pose2(1, 0, 0), Pose2(2.1, 0.0, -math.pi + 0.1), Pose2(9, 9, 0)])
    error = metrics.final_error(task(), track)
    assert error.position_m == pytest.approx(0.1)
    assert error.yaw_rad == pytest.approx(0.1)
    assert error.within_tolerance
    assert not metrics.final_error(task(end_s=60.0), track).within_tolerance
    assert metrics.final_error(task(), None) is None
    assert metrics.final_error(task(start_s=300.0, end_s=None), track) is None


def test_pushes_and_plans_belong_to_the_task_of_their_time():
    pushes = [push(1), push(2, plan=0), push(3, object_id='cart'), push(20)]
    assert metrics.pushes_of(task(), pushes) == [pushes[0]]
    assert metrics.pushes_of(task(end_s=None), pushes) == [pushes[0], pushes[3]]


def test_the_tracking_error_is_the_rms_over_common_times():
    truth = Track([0.0, 10.0], [Pose2(0, 0, 0), Pose2(10, 0, 0)])
    tracked = Track([2.0, 4.0, 11.0], [Pose2(2.0, 0.3, 0), Pose2(4.0, -0.4, 0), Pose2(99, 0, 0)])
    rms = metrics.tracking_rms_m(tracked, truth, 0.0, 20.0)
    assert rms == pytest.approx(math.sqrt((0.09 + 0.16) / 2))
    assert metrics.tracking_rms_m(tracked, truth, 50.0, 60.0) is None


def test_means_and_medians_of_nothing_are_unknown():
    assert metrics.mean([]) is None and metrics.median([]) is None
    assert metrics.mean([1, 2, 6]) == 3 and metrics.median([1, 2, 6]) == 2
    assert metrics.median([1, 2, 6, 8]) == 4


def test_the_binomial_tail_matches_its_closed_form():
    assert calibration.binomial_tail(0, 10, 0.01) == pytest.approx(1.0)
    assert calibration.binomial_tail(1, 10, 0.01) == pytest.approx(1 - 0.99**10)
    assert calibration.binomial_tail(10, 10, 0.5) == pytest.approx(0.5**10)


def test_the_wilson_interval_solves_its_equation():
    for bound in calibration.wilson_interval(3, 20):
        deviation = abs(3 / 20 - bound) / math.sqrt(bound * (1 - bound) / 20)
        assert deviation == pytest.approx(calibration.NORMAL_QUANTILE)
    assert calibration.wilson_interval(0, 5)[0] == 0.0


def test_evenly_spread_values_are_half_a_step_from_uniform():
    assert calibration.uniform_distance([(i + 0.5) / 10 for i in range(10)]) == pytest.approx(0.05)
    assert calibration.uniform_distance([0.2]) == pytest.approx(0.8)


def test_uniform_p_values_pass_and_overconfident_ones_fail():
    generator = random.Random(4)
    uniform = [generator.random() for _ in range(300)]
    right = calibration.calibrate([push(i, p_value=p, rejected=p < 0.01)
                                   for i, p in enumerate(uniform)])
    assert right.ks_distance < right.ks_critical and right.excess_p > 0.05
    wrong = calibration.calibrate([push(i, p_value=p**3, rejected=p**3 < 0.01)
                                   for i, p in enumerate(uniform)])
    assert wrong.ks_distance > wrong.ks_critical and wrong.excess_p < 1e-6
    assert wrong.fraction_low < wrong.rejected_fraction < wrong.fraction_high


def test_untested_predictions_do_not_count():
    untested = push(1, p_value=1.0, t_squared=0.0)
    result = calibration.calibrate([untested, push(2, case_id=0)])
    assert result.tested == 0 and result.rejected_fraction is None


@pytest.mark.parametrize('pushes, alpha', [
    ([], 0.01),
    ([push(1, p_value=0.005, rejected=True), push(2, p_value=0.02)], 0.01),
    ([push(1, p_value=0.04, rejected=True), push(2, p_value=0.06)], 0.05)])
def test_the_level_is_inferred_from_the_verdicts(pushes, alpha):
    assert calibration.infer_alpha(pushes) == pytest.approx(alpha)
