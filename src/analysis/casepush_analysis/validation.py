"""The command line: `rosrun casepush validate_simulator`."""

import argparse
import json
import os
import subprocess
import sys

from casepush_analysis.errors import InputError
from casepush_analysis.figures import simulator

EXIT_DONE, EXIT_NOT_WRITTEN, EXIT_BAD_INPUT = 0, 1, 2
BENCH = ['rosrun', 'casepush', 'casepush', 'bench', 'sim', '--laws', '--fidelity', '--json']


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog='validate_simulator',
        description='Measures the simulator with `casepush bench sim --laws --fidelity --json` and '
        'draws what came out against its laws: laws.png and models.png, with bench_sim.json.',
        epilog='Exit codes: 0 done, 1 the results could not be written, 2 bad usage or bad input.')
    parser.add_argument('--input', metavar='FILE.json', help='output of an earlier '
                        '`casepush bench sim --laws --fidelity --json`, instead of measuring')
    parser.add_argument('--output', metavar='DIR', default='simulator_validation',
                        help='folder for the results, made if missing (default: %(default)s)')
    parser.add_argument('--object', default='office_chair', help='object that is pushed at random '
                        '(default: %(default)s)')
    parser.add_argument('--pushes', type=int, default=100, help='random pushes (default: '
                        '%(default)s)')
    parser.add_argument('--seed', type=int, default=1)
    return parser.parse_args(arguments)


def main(arguments, log=sys.stderr):
    """Returns the exit code."""
    options = parse(arguments)
    try:
        text = _read(options.input) if options.input else _measure(options)
        bench = _check(text, options.input or 'casepush bench sim')
    except InputError as error:
        log.write(f'validate_simulator: {error}\n')
        return EXIT_BAD_INPUT
    try:
        os.makedirs(options.output, exist_ok=True)
        with open(os.path.join(options.output, 'bench_sim.json'), 'w', encoding='utf-8') as stream:
            stream.write(text)
        simulator.draw_laws(bench, os.path.join(options.output, 'laws.png'))
        simulator.draw_models(bench, os.path.join(options.output, 'models.png'))
    except OSError as error:
        log.write(f'validate_simulator: {error.filename or options.output}: {error.strerror}\n')
        return EXIT_NOT_WRITTEN
    log.write(f'validate_simulator: wrote laws.png and models.png to {options.output}\n')
    return EXIT_DONE


def _read(path):
    try:
        with open(path, encoding='utf-8') as stream:
            return stream.read()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, 'strerror', None) or 'is not text'
        raise InputError(f'{path}: {reason}') from error


def _measure(options):
    command = BENCH + ['--object', options.object, '--pushes', str(options.pushes), '--seed',
                       str(options.seed)]
    try:
        process = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    except OSError as error:
        raise InputError(f'{command[0]}: {error.strerror}; source devel/setup.bash first') from error
    if process.returncode != 0:
        raise InputError(f'`{" ".join(command)}` failed')
    return process.stdout


def _check(text, where):
    try:
        bench = json.loads(text)
    except json.JSONDecodeError as error:
        raise InputError(f'{where}: is not JSON: {error}') from error
    for key, option in (('first_push', '--pushes'), ('fidelity', '--fidelity'), ('laws', '--laws')):
        if not isinstance(bench, dict) or not bench.get(key):
            raise InputError(f'{where}: lacks "{key}"; run casepush bench sim with {option}')
    return bench
