"""Reads a bag without a ROS master and without ever writing to it."""

import io
import os
import sys

import rosbag

from casepush_analysis.builder import Builder
from casepush_analysis.errors import InputError

PROGRESS_MESSAGES = 100000


class _ReadOnly(io.BufferedReader):
    """rosbag cuts a damaged tail off when it re-indexes; this file only pretends."""

    def truncate(self, size=None):
        return size


def read_recording(path, log=sys.stderr):
    """Everything that this package understands of the bag at `path`.

    A bag without an index (its recorder died) is indexed in memory and read as far as it goes.
    Raises InputError if there is nothing to read.
    """
    with _open(path) as stream:
        try:
            bag = rosbag.Bag(stream, 'r', allow_unindexed=True)
        except Exception as error:  # rosbag raises whatever its parsing trips over.
            raise InputError(f'{path}: not a bag file ({_first_line(error)})') from error
        builder = Builder(os.path.basename(path))
        _index(bag, path, builder.recording, log)
        _read(bag, path, builder, log)
    return builder.finish()


def _open(path):
    if os.path.isdir(path):
        raise InputError(f'{path}: is a folder, not a bag file')
    try:
        if os.path.getsize(path) == 0:
            raise InputError(f'{path}: the file is empty')
        return _ReadOnly(io.FileIO(path, 'r'))
    except OSError as error:
        raise InputError(f'{path}: {error.strerror}') from error


def _first_line(error):
    return (str(error).strip().splitlines() or [type(error).__name__])[0]


def _index(bag, path, recording, log):
    """Indexes the bag in memory if its own index is missing."""
    if bag._chunks or bag._connection_indexes:  # No public way to ask.
        return
    if os.path.getsize(path) > bag._file_header_pos:
        log.write(f'analyze_bag: {path} has no index, reading it through\n')
    try:
        for _ in bag.reindex():
            pass
    except Exception as error:
        raise InputError(f'{path}: damaged beyond reading ({_first_line(error)})') from error
    if bag.get_message_count():
        recording.notes.append('The bag was not closed properly (its recorder was stopped or '
                               'died); this report covers what could still be read.')


def _read(bag, path, builder, log):
    recording = builder.recording
    connections = {c.topic: c.datatype for c in bag._get_connections()}
    recording.message_count = bag.get_message_count()
    if recording.message_count == 0:
        raise InputError(f'{path}: the bag holds no messages')
    info = bag.get_type_and_topic_info().topics
    recording.topics = {topic: (info[topic].msg_type, info[topic].message_count)
                        for topic in sorted(info)}
    handlers = {topic: builder.handler(topic, datatype)
                for topic, datatype in connections.items()}
    wanted = sorted(topic for topic, handler in handlers.items() if handler)
    if not wanted:
        raise InputError(f'{path}: no topic of casepush in it (a bag of push_reports, plan, objects '
                         '... is expected)')
    recording.start_s, recording.end_s = bag.get_start_time(), bag.get_end_time()
    thinners = {topic: builder.thinner(connections[topic]) for topic in wanted}
    total = sum(recording.topics[topic][1] for topic in wanted)
    newest = {}
    try:
        for count, (topic, raw, stamp) in enumerate(bag.read_messages(wanted, raw=True), 1):
            if count % PROGRESS_MESSAGES == 0:
                log.write(f'analyze_bag: {100 * count // total} % of {total} messages\n')
            stamp_s = stamp.to_sec()
            if builder.newest_counts(connections[topic]):
                newest[topic] = raw, stamp_s
            elif thinners[topic] is None or thinners[topic].passes(stamp_s):
                builder.add(topic, handlers[topic], _decode(raw), stamp_s)
    except Exception as error:  # A damaged chunk; rosbag raises whatever its parsing trips over.
        recording.notes.append(f'The bag is damaged ({_first_line(error)}); this report covers '
                               'what could be read before.')
    for topic, (raw, stamp_s) in sorted(newest.items()):
        builder.add(topic, handlers[topic], _decode(raw), stamp_s)


def _decode(raw):
    _, data, _, _, message_type = raw
    message = message_type()
    message.deserialize(data)
    return message
