"""The command line: `rosrun casepush plot_cases FILE.db --out DIR`."""

import argparse
import os
import re
import sys

from casepush_analysis.case_base import read_case_base
from casepush_analysis.errors import InputError
from casepush_analysis.figures import cases, outcomes, prediction, style

EXIT_DONE, EXIT_NOT_WRITTEN, EXIT_BAD_INPUT = 0, 1, 2


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog='plot_cases', description='Draws what a case base holds, for each object: the cases '
        '(the paper\'s Fig. 3b), the observed outcomes with their ellipses, the trajectories with '
        'their tubes, and how well observations are predicted by the others of their case.',
        epilog='Exit codes: 0 done, 1 the pictures could not be written, 2 bad usage or bad input.')
    parser.add_argument('case_base', metavar='FILE.db', help='case base; it is only read')
    parser.add_argument('--out', metavar='DIR', default='.',
                        help='folder for the PNG files, made if missing (default: this folder)')
    parser.add_argument('--object', default='', help='only this object')
    return parser.parse_args(arguments)


def main(arguments, log=sys.stderr, read=read_case_base):
    """Returns the exit code."""
    options = parse(arguments)
    try:
        stored = read(options.case_base, options.object)
        if not stored:
            raise InputError(f'{options.case_base}: holds no case'
                             + (f' of {options.object}' if options.object else ''))
    except InputError as error:
        log.write(f'plot_cases: {error}\n')
        return EXIT_BAD_INPUT
    try:
        os.makedirs(options.out, exist_ok=True)
        with style.look():
            for name in sorted({c.record.object for c in stored}):
                _draw([c for c in stored if c.record.object == name],
                      os.path.join(options.out, re.sub(r'[^\w.-]', '_', name)), log)
    except OSError as error:
        log.write(f'plot_cases: {error.filename or options.out}: {error.strerror}\n')
        return EXIT_NOT_WRITTEN
    return EXIT_DONE


def _draw(stored, stem, log):
    def save(kind, figure):
        path = f'{stem}_{kind}.png'
        style.save(figure, path)
        log.write(f'plot_cases: wrote {path}\n')

    save('cases', cases.draw([c.record for c in stored]))
    save('outcomes', outcomes.draw(stored))
    save('tubes', outcomes.draw_tubes(stored))
    if any(o.p_value is not None for c in stored for o in c.observations):
        save('calibration', prediction.draw(stored))
    else:
        log.write(f'plot_cases: {stored[0].record.object}: too few observations of each case for '
                  'a calibration plot; practise at least 6 times\n')
