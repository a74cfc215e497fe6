"""Pictures of the simulator: drawn from what the bench prints, and clear errors for anything else."""

import io
import json
import math

import pytest
from casepush_analysis.validation import main


def run(*arguments):
    log = io.StringIO()
    code = main([str(a) for a in arguments], log)
    return code, log.getvalue()


def laws():
    forces = [{'rolling_lever_arm_m': f, 'wheel_radius_m': r, 'weight_n': w, 'force_n': f * w / r,
               'law_n': f * w / r}
              for f in (0.0022, 0.0024, 0.0033, 0.0045) for r in (0.05, 0.08) for w in (200, 900)]
    curve = {'moved_m': [0.0, 0.1], 'force_n': [20.0, 19.0]}
    coast = [{'rolling_lever_arm_m': f, 'time_s': [0.0, 1.0], 'moved_m': [0.0, 0.1],
              'speed_mps': [0.3, 0.0], 'law_m': 0.1} for f in (0.0022, 0.0024, 0.0033, 0.0045)]
    return {'push_force': forces,
            'start': {'mass_kg': 40, 'law_n': 18.8, 'aligned': curve, 'across': curve},
            'coast': coast,
            'trailing': {'moved_m': [0.0, 0.8], 'swivel_rad': [[1.0, -2.0], [0.001, 0.0]]}}


def bench():
    outcomes = [[math.cos(i), math.sin(i), 0.0] for i in range(5)]
    spread = {'median': 0.002, 'p90': 0.01}
    fidelity = [{'caster_model': model, 'step_s': 1.0 / rate, 'reference_step_s': 1.0 / 2400.0,
                 'difference_m': spread, 'difference_rad': spread}
                for model in ('featherstone', 'planar') for rate in (120, 240)]
    return {'success': True, 'object': 'office_chair',
            'first_push': {'featherstone': outcomes, 'planar': outcomes},
            'fidelity': fidelity, 'laws': {'featherstone': laws(), 'planar': laws()}}


def test_draws_both_pictures(tmp_path):
    source = tmp_path / 'bench.json'
    source.write_text(json.dumps(bench()), encoding='utf-8')
    code, log = run('--input', source, '--output', tmp_path / 'out')
    assert code == 0, log
    for name in ('laws.png', 'models.png'):
        picture = (tmp_path / 'out' / name).read_bytes()
        assert picture.startswith(b'\x89PNG') and len(picture) < 150000
    assert json.loads((tmp_path / 'out' / 'bench_sim.json').read_text(encoding='utf-8')) == bench()


@pytest.mark.parametrize('text, reason', [
    ('{', 'is not JSON'),
    ('[]', 'lacks "first_push"; run casepush bench sim with --pushes'),
    (json.dumps({'first_push': {'planar': []}}),
     'lacks "fidelity"; run casepush bench sim with --fidelity')])
def test_says_what_is_wrong_with_its_input(tmp_path, text, reason):
    source = tmp_path / 'bench.json'
    source.write_text(text, encoding='utf-8')
    code, log = run('--input', source, '--output', tmp_path / 'out')
    assert code == 2
    assert reason in log and str(source) in log
    assert not (tmp_path / 'out').exists()


def test_says_that_its_input_is_missing(tmp_path):
    code, log = run('--input', tmp_path / 'none.json')
    assert code == 2
    assert 'none.json: No such file or directory' in log


def test_says_that_results_cannot_be_written(tmp_path):
    source = tmp_path / 'bench.json'
    source.write_text(json.dumps(bench()), encoding='utf-8')
    (tmp_path / 'file').write_text('', encoding='utf-8')
    code, log = run('--input', source, '--output', tmp_path / 'file')
    assert code == 1
    assert 'File exists' in log
