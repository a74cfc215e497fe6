"""The command line: `rosrun casepush analyze_bag FILE.bag`."""

import argparse
import os
import sys

from casepush_analysis import pictures, report, summary, tables
from casepush_analysis.analysis import analyse
from casepush_analysis.bag import read_recording
from casepush_analysis.errors import InputError

EXIT_DONE, EXIT_NOT_WRITTEN, EXIT_BAD_INPUT = 0, 1, 2


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog='analyze_bag', description='Analyses a recording of casepush without a ROS master: '
        'tables (CSV), analysis.json, pictures (PNG) and report.html.',
        epilog='Exit codes: 0 done, 1 the results could not be written, 2 bad usage or bad input.')
    parser.add_argument('bag', metavar='FILE.bag', help='recording; it is only read')
    parser.add_argument('--output', metavar='DIR', help='folder for the results, made if missing '
                        '(default: FILE_analysis in the current folder)')
    parser.add_argument('--json', action='store_true', help='also print analysis.json on stdout')
    return parser.parse_args(arguments)


def main(arguments, log=sys.stderr, out=sys.stdout):
    """Returns the exit code."""
    options = parse(arguments)
    stem = os.path.splitext(os.path.basename(options.bag))[0]
    folder = options.output or stem + '_analysis'
    is_new = not os.path.isdir(folder)
    try:
        os.makedirs(folder, exist_ok=True)  # Before reading, which may take long.
        analysis = analyse(read_recording(options.bag, log))
        for note in analysis.recording.notes:
            log.write(f'analyze_bag: {note}\n')
        text = write(analysis, folder, log)
    except InputError as error:
        log.write(f'analyze_bag: {error}\n')
        if is_new:
            os.rmdir(folder)
        return EXIT_BAD_INPUT
    except OSError as error:
        log.write(f'analyze_bag: {error.filename or folder}: {error.strerror}\n')
        return EXIT_NOT_WRITTEN
    if options.json:
        out.write(text)
    log.write(f'analyze_bag: wrote {os.path.join(folder, "report.html")}\n')
    return EXIT_DONE


def write(analysis, folder, log):
    """Writes everything into the folder. Returns analysis.json's text."""
    for table in tables.all_tables(analysis):
        table.write(folder)
    text = summary.to_json(summary.summarise(analysis))
    _write(os.path.join(folder, 'analysis.json'), text)
    log.write('analyze_bag: drawing\n')
    files = pictures.draw_all(analysis, folder)
    _write(os.path.join(folder, 'report.html'), report.render(analysis, files))
    return text


def _write(path, text):
    with open(path, 'w', encoding='utf-8') as stream:
        stream.write(text)
