"""Reads a bag without a ROS master and without ever writing to it."""

import os
import sys

import rosbag

from casepush_analysis.builder import Builder
from casepush_analysis.errors import InputError
from casepush_analysis.salvage import SalvagedBag

PROGRESS_MESSAGES = 100000


class IntactBag:
    """A bag with its index."""

    def __init__(self, path):
        self._bag = rosbag.Bag(path, 'r')
        info = self._bag.get_type_and_topic_info().topics
        self.topics = {topic: (info[topic].msg_type, info[topic].message_count) for topic in info}
        self.start_s = self._bag.get_start_time() if self.topics else 0.0
        self.end_s = self._bag.get_end_time() if self.topics else 0.0

    def messages(self, wanted):
        """(topic, decode, stamp_s) of the wanted topics; decode() gives the message."""
        for topic, raw, stamp in self._bag.read_messages(wanted, raw=True):
            yield topic, lambda r=raw: _decode(r), stamp.to_sec()


def read_recording(path, log=sys.stderr):
    """Everything that this package understands of the bag at `path`.

    A bag without an index (its recorder died or is still running) is read as far as it goes.
    Raises InputError if there is nothing to read.
    """
    builder = Builder(os.path.basename(path))
    bag = _open(path, builder.recording, log)
    _read(bag, path, builder, log)
    return builder.finish()


def _open(path, recording, log):
    if os.path.isdir(path):
        raise InputError(f'{path}: is a folder, not a bag file')
    try:
        if os.path.getsize(path) == 0:
            raise InputError(f'{path}: the file is empty')
        return IntactBag(path)
    except OSError as error:
        raise InputError(f'{path}: {error.strerror}') from error
    except rosbag.ROSBagUnindexedException:
        log.write(f'analyze_bag: {path} has no index, reading it through\n')
    except InputError:
        raise
    except Exception as error:  # rosbag raises whatever its parsing trips over.
        raise InputError(f'{path}: not a bag file ({_first_line(error)})') from error
    bag = SalvagedBag(path)
    if not bag.topics:
        raise InputError(f'{path}: no message can be read; the bag was not closed properly and '
                         'broke off too early')
    recording.notes.append('The bag was not closed properly (its recorder was stopped or died, or '
                           'is still running); this report covers what could be read.')
    return bag


def _first_line(error):
    return (str(error).strip().splitlines() or [type(error).__name__])[0]


def _read(bag, path, builder, log):
    recording = builder.recording
    recording.topics = dict(sorted(bag.topics.items()))
    recording.message_count = sum(count for _, count in bag.topics.values())
    recording.start_s, recording.end_s = bag.start_s, bag.end_s
    if recording.message_count == 0:
        raise InputError(f'{path}: the bag holds no messages')
    handlers = {topic: builder.handler(topic, kind) for topic, (kind, _) in bag.topics.items()}
    wanted = sorted(topic for topic, handler in handlers.items() if handler)
    if not wanted:
        raise InputError(f'{path}: no topic of casepush in it (push_reports, plan, objects ... are '
                         'expected)')
    kinds = {topic: bag.topics[topic][0] for topic in wanted}
    thinners = {topic: builder.thinner(kind) for topic, kind in kinds.items()}
    total = sum(bag.topics[topic][1] for topic in wanted)
    newest = {}

    def feed():
        for count, (topic, decode, stamp_s) in enumerate(bag.messages(wanted), 1):
            if count % PROGRESS_MESSAGES == 0:
                log.write(f'analyze_bag: {100 * count // total} % of {total} messages\n')
            if builder.newest_counts(kinds[topic]):
                newest[topic] = decode, stamp_s
            elif thinners[topic] is None or thinners[topic].passes(stamp_s):
                builder.add(topic, handlers[topic], decode, stamp_s)

    try:
        feed()
    except Exception as error:  # A damaged chunk; rosbag raises whatever its parsing trips over.
        recording.notes.append(f'The bag is damaged ({_first_line(error)}); this report covers '
                               'what could be read before.')
    for topic, (decode, stamp_s) in sorted(newest.items()):
        builder.add(topic, handlers[topic], decode, stamp_s)


def _decode(raw):
    _, data, _, _, message_type = raw
    message = message_type()
    message.deserialize(data)
    return message
