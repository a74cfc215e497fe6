"""The whole way from a bag to tables and report, and from bad bags to clear errors."""

import csv
import hashlib
import io
import json
import math
import os
import struct
import types

import pytest
import rosbag
from casepush import msg
from casepush_analysis import conversions, report, room
from casepush_analysis.analysis import analyse
from casepush_analysis.bag import read_recording
from casepush_analysis.builder import Thinner
from casepush_analysis.command import main
from casepush_analysis.se2 import Pose2
from std_msgs.msg import String
from synthetic_bag import CHAIR, Story, room_points, write_demo

CASES, PRACTICES = 5, 4
GOAL = Pose2(6.0, 6.0, 0.0)


def run(*arguments):
    """Exit code, stderr and stdout of the command."""
    log, out = io.StringIO(), io.StringIO()
    code = main([str(a) for a in arguments], log, out)
    return code, log.getvalue(), out.getvalue()


def read_table(folder, name):
    with open(folder / (name + '.csv'), encoding='utf-8') as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope='module')
def demo(tmp_path_factory):
    """A demo's bag with its results."""
    folder = tmp_path_factory.mktemp('demo')
    bag, results = folder / 'demo.bag', folder / 'results'
    story = write_demo(bag, CASES, PRACTICES, goal=GOAL)
    code, log, out = run(bag, '--output', results, '--json')
    return types.SimpleNamespace(bag=bag, results=results, story=story, code=code, log=log, out=out,
                                 summary=json.loads(out))


def test_a_demo_is_analysed(demo):
    assert demo.code == 0
    assert 'report.html' in demo.log
    with open(demo.results / 'analysis.json', encoding='utf-8') as stream:
        assert stream.read() == demo.out


def test_the_summary_tells_the_task_by_ground_truth(demo):
    summary = demo.summary
    error = demo.story.chair.distance_m(GOAL)
    assert summary['success'] is True
    assert summary['position_error_m'] == pytest.approx(error, abs=1e-6)
    assert summary['collisions'] == 1
    assert summary['replans'] == summary['tasks'][0]['plans'] - 1 >= 1
    assert sum(summary['tasks'][0]['consecutive_pushes']) == summary['pushes']
    assert sum(summary['tasks'][0]['replan_causes'].values()) == summary['replans']
    assert len(summary['tasks'][0]['replan_reasons']) == summary['replans']
    assert summary['tasks'][0]['repairs'] == 2
    assert summary['tasks'][0]['tracking_rms_m'] == pytest.approx(0.01 * math.sqrt(2), rel=0.2)
    assert summary['missing'] == [] and summary['notes'] == []


def test_learning_is_kept_apart_from_the_task(demo):
    learning = demo.summary['learning']
    assert learning['pushes'] == CASES * PRACTICES
    assert learning['first_tries'] == CASES
    assert demo.summary['calibration']['learning']['tested'] == CASES * (PRACTICES - 1)
    assert demo.summary['calibration']['task']['tested'] == demo.summary['pushes']
    assert learning['phase_s']['push'] == pytest.approx(2.0 * CASES * PRACTICES)


def test_every_push_has_a_row(demo):
    rows = read_table(demo.results, 'pushes')
    assert len(rows) == CASES * PRACTICES + demo.summary['pushes']
    assert rows[0]['verdict'] == 'first try' and rows[0]['t_squared'] == ''
    assert rows[1]['sigma_x_m'] == '0.04' and rows[1]['approach_s'] == '4'
    rejected = [r for r in rows if r['verdict'] == 'rejected']
    assert any(r['part'] == 'task' for r in rejected)
    for row in rejected:
        assert float(row['p_value']) < 0.01
    for row in rows:
        if row['deviation_m']:
            distance = math.hypot(float(row['observed_x_m']) - float(row['expected_x_m']),
                                  float(row['observed_y_m']) - float(row['expected_y_m']))
            assert float(row['deviation_m']) == pytest.approx(distance, abs=1e-6)


def test_the_other_tables_agree_with_the_summary(demo):
    task, = read_table(demo.results, 'tasks')
    assert (task['object'], task['status'], task['success']) == (CHAIR, 'succeeded', 'true')
    assert int(task['replans']) == demo.summary['replans']
    assert int(task['repairs']) == 2
    replans = read_table(demo.results, 'replans')
    assert len(replans) == demo.summary['replans']
    for row in replans:
        assert row['cause'].replace('_', ' ') in task['replan_causes'] and row['reason']
    assert len(read_table(demo.results, 'plans')) == demo.summary['tasks'][0]['plans']
    assert len(read_table(demo.results, 'cases')) == CASES
    collision, = read_table(demo.results, 'collisions')
    assert (collision['body'], collision['obstacle']) == ('robot', 'wall_north')
    assert [int(r['pushes']) for r in read_table(demo.results, 'runs')] == \
        demo.summary['tasks'][0]['consecutive_pushes']
    shares = sum(float(r['share_percent']) for r in read_table(demo.results, 'phases')
                 if r['part'] == 'task')
    assert shares == pytest.approx(100.0)


def test_the_report_stands_alone_and_shows_every_picture(demo):
    html = (demo.results / 'report.html').read_text(encoding='utf-8')
    pictures = sorted(p for p in os.listdir(demo.results) if p.endswith('.png'))
    assert pictures == ['cases.png', 'learning_calibration.png', 'learning_deviations.png',
                        'learning_timeline.png', 'task_1_calibration.png', 'task_1_deviations.png',
                        'task_1_map.png', 'task_1_timeline.png', 'task_1_way.png']
    assert html.count('<img src="data:image/png;base64,') == len(pictures)
    assert 'http://' not in html and 'https://' not in html
    for text in ('Task 1: chair_1', 'success', 'wall_north', 'rejected', 'Consecutive pushes'):
        assert text in html


def test_the_same_bag_gives_the_same_bytes(demo, tmp_path):
    assert run(demo.bag, '--output', tmp_path)[0] == 0
    for name in sorted(os.listdir(demo.results)):
        assert (tmp_path / name).read_bytes() == (demo.results / name).read_bytes(), name


def test_a_recording_of_learning_only_is_reported(tmp_path):
    bag = tmp_path / 'learning.bag'
    write_demo(bag, 2, 3, task=False)
    code, _, out = run(bag, '--output', tmp_path / 'out', '--json')
    summary = json.loads(out)
    assert code == 0
    assert summary['success'] is None and summary['tasks'] == []
    assert [line.split(':')[0] for line in summary['missing']] == ['contacts']
    assert ', no task' in (tmp_path / 'out' / 'report.html').read_text(encoding='utf-8')


def test_a_cut_off_bag_is_read_as_far_as_it_goes_and_left_alone(demo, tmp_path):
    bag = tmp_path / 'cut.bag'
    content = demo.bag.read_bytes()
    bag.write_bytes(content[:int(0.8 * len(content))])
    before = hashlib.sha256(bag.read_bytes()).digest()
    code, log, out = run(bag, '--output', tmp_path / 'out', '--json')
    whole, cut = read_recording(str(demo.bag)).pushes, read_recording(str(bag)).pushes
    assert code == 0
    assert 'not closed properly' in log
    assert 0 < len(cut) < len(whole)
    assert [p.end_s for p in cut] == [p.end_s for p in whole[:len(cut)]]
    assert json.loads(out)['learning']['pushes'] <= len(cut)
    assert 'not closed properly' in (tmp_path / 'out' / 'report.html').read_text(encoding='utf-8')
    assert hashlib.sha256(bag.read_bytes()).digest() == before


def without(bag, folder, prefix):
    """A copy of a bag without the topics that begin with `prefix` (or one of them), analysed."""
    part = folder / 'part.bag'
    with rosbag.Bag(str(bag)) as source, rosbag.Bag(str(part), 'w') as target:
        for topic, message, stamp in source.read_messages(raw=True):
            if not topic.startswith(prefix):
                target.write(topic, message, stamp, raw=True)
    return analyse(read_recording(str(part), io.StringIO()))


def test_an_unfinished_task_is_called_that(demo, tmp_path):
    entry, = without(demo.bag, tmp_path, ('/push_object/result', '/task_summaries')).tasks
    assert entry.task.status == 'unfinished' and entry.success is False
    assert len(entry.pushes) == demo.summary['pushes']


@pytest.mark.parametrize('dropped, missing', [
    ('/ground_truth/objects', 'ground_truth/objects: success and final error are unknown'),
    ('/executor/state', 'executor/state: times for planning and approach are unknown'),
    (('/push_object', '/task_summaries'), 'push_object/goal: goal and times'),
    ('/pl', 'plan: plans are not drawn'),
    ('/task_summaries', 'task_summaries: why plans were given up is unknown'),
    ('/survey', 'survey: the room is not drawn'),
    ('/tf', "tf: the robot's path is not drawn"),
    ('/objects', 'objects: the tracked path is not drawn'),
    ('/push_reports', 'push_reports: no push is known'),
    ('/cases', 'cases: the cases are not drawn')])
def test_what_is_missing_is_said(demo, tmp_path, dropped, missing):
    analysis = without(demo.bag, tmp_path, dropped)
    assert [line for line in analysis.missing if line.startswith(missing)]
    assert 'Not recorded – ' + missing.replace("'", '&#39;') in report.render(analysis, {})


def test_a_summary_makes_up_for_the_action(demo, tmp_path):
    entry, = without(demo.bag, tmp_path, '/push_object').tasks
    assert entry.task.status == 'succeeded' and entry.success is True
    assert entry.task.position_tolerance_m == 0.5
    assert len(entry.pushes) == demo.summary['pushes']


def test_pushes_alone_are_enough_for_a_report(demo, tmp_path):
    bag = tmp_path / 'pushes.bag'
    with rosbag.Bag(str(demo.bag)) as source, rosbag.Bag(str(bag), 'w') as target:
        for topic, message, stamp in source.read_messages(['/push_reports', '/plan']):
            target.write(topic, message, stamp)
    code, _, out = run(bag, '--output', tmp_path / 'out', '--json')
    summary = json.loads(out)
    assert code == 0
    assert summary['success'] is None and summary['position_error_m'] is None
    assert summary['pushes'] == demo.summary['pushes']
    assert (tmp_path / 'out' / 'task_1_map.png').exists()


def test_messages_with_numbers_that_are_not_finite_are_left_out(tmp_path):
    bag = tmp_path / 'nan.bag'
    with rosbag.Bag(str(bag), 'w') as target:
        story = Story(target, 1)
        story.learn(1, 3)
        report = msg.ExecutedPush(object_id=CHAIR)
        report.observed.x = math.nan
        story.write('/push_reports', report)
    recording = read_recording(str(bag))
    assert len(recording.pushes) == 3
    assert recording.notes == [
        '/push_reports: 1 message with numbers that are not finite, left out.']


def bad_bag(kind, folder):
    path = folder / 'bad.bag'
    if kind == 'text':
        path.write_text('this is no bag\n')
    elif kind == 'empty file':
        path.write_text('')
    elif kind == 'binary':
        path.write_bytes(bytes(range(256)) * 10)
    elif kind == 'header only':
        path.write_bytes(b'#ROSBAG V2.0\n')
    elif kind == 'folder':
        path.mkdir()
    elif kind in ('no messages', 'foreign'):
        with rosbag.Bag(str(path), 'w') as bag:
            if kind == 'foreign':
                bag.write('/chatter', String('hello'))
    return path


def test_a_bag_cut_off_in_its_index_is_read_completely(demo, tmp_path):
    bag = tmp_path / 'cut.bag'
    bag.write_bytes(demo.bag.read_bytes()[:-100])
    cut, whole = read_recording(str(bag), io.StringIO()), read_recording(str(demo.bag))
    assert cut.message_count == whole.message_count and len(cut.pushes) == len(whole.pushes)


@pytest.mark.parametrize('compression', ['lz4', 'bz2'])
def test_compressed_chunks_are_salvaged(tmp_path, compression):
    bag = tmp_path / 'compressed.bag'
    with rosbag.Bag(str(bag), 'w', compression=compression, chunk_threshold=50000) as target:
        Story(target, 1).learn(2, 3)
    whole = read_recording(str(bag), io.StringIO())
    bag.write_bytes(bag.read_bytes()[:int(0.6 * bag.stat().st_size)])
    cut = read_recording(str(bag), io.StringIO())
    assert (len(whole.pushes), whole.notes) == (6, [])
    assert 0 < len(cut.pushes) < 6 and len(cut.notes) == 1


@pytest.mark.parametrize('kind, text', [
    ('missing', 'No such file or directory'), ('folder', 'is a folder, not a bag file'),
    ('empty file', 'the file is empty'), ('text', 'not a bag file'), ('binary', 'not a bag file'),
    ('header only', 'not closed properly'), ('no messages', 'the bag holds no messages'),
    ('foreign', 'no topic of casepush in it')])
def test_a_bad_bag_gives_one_line_and_exit_code_2(kind, text, tmp_path):
    path = bad_bag(kind, tmp_path)
    code, log, out = run(path, '--output', tmp_path / 'out', '--json')
    assert code == 2
    lines = log.strip().splitlines()
    assert lines[-1].startswith(f'analyze_bag: {path}: ') and text in lines[-1]
    assert 'Traceback' not in log and out == ''
    assert not (tmp_path / 'out').exists()


def test_results_that_cannot_be_written_give_exit_code_1(demo, tmp_path):
    blocked = tmp_path / 'file'
    blocked.write_text('')
    code, log, _ = run(demo.bag, '--output', blocked)
    assert code == 1 and str(blocked) in log


def test_bad_usage_gives_exit_code_2(capsys):
    with pytest.raises(SystemExit) as stop:
        main(['--nonsense'])
    assert stop.value.code == 2
    assert 'usage: analyze_bag' in capsys.readouterr().err


def test_points_become_the_highest_point_of_each_cell():
    found = room.from_points(room_points(15.0))
    left, _, bottom, _ = found.extent_m
    assert (left, bottom) == (0.0, 0.0)
    assert found.height_m[60, 130] == pytest.approx(0.7)
    assert found.height_m[0, 60] == pytest.approx(1.25)
    assert math.isnan(found.height_m[100, 100])


def binary_octree(key, depth=16):
    """A tree in OctoMap's binary format with one occupied leaf at `depth`."""
    stream = b''
    for level in range(depth):
        bit = 15 - level
        child = sum(((k >> bit) & 1) << axis for axis, k in enumerate(key))
        kind = 3 if level < depth - 1 else 2
        stream += struct.pack('<H', kind << (2 * child))
    return stream


@pytest.mark.parametrize('depth, size', [(16, 1), (14, 4)])
def test_an_octree_leaf_covers_its_cells(depth, size):
    message = types.SimpleNamespace(binary=True, resolution=0.1, data=list(
        struct.unpack(f'{2 * depth}b', binary_octree((32768 + 8, 32768 - 4, 32768 + 4), depth))))
    found = room.from_octomap(message)
    assert found.height_m.shape == (size, size)
    assert (found.min_x_m, found.min_y_m) == pytest.approx((0.8, -0.4))
    assert found.height_m.max() == pytest.approx(0.4 + 0.1 * size - 0.05)


def test_constants_are_named_by_the_message_itself():
    report = msg.ExecutedPush(outcome=msg.ExecutedPush.NOT_MOVED)
    assert conversions.constant_name(report, report.outcome) == 'not_moved'
    assert conversions.constant_name(report, 99) == 'unknown (99)'


def test_tracks_are_thinned_but_transforms_come_in_bursts():
    plain, bursts = Thinner(0.1), Thinner(0.1, 0.03)
    times = [0.0, 0.02, 0.05, 0.1, 0.12, 0.15]
    assert [t for t in times if plain.passes(t)] == [0.0, 0.1]
    assert [t for t in times if bursts.passes(t)] == [0.0, 0.02, 0.1, 0.12]
