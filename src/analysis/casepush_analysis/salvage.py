"""Reads a bag without an index: its recorder still runs or was killed, or the file was cut.

rosbag's own re-indexing writes to the file and gives up the last piece. This reads the records of
the format (version 2.0) one after another, as far as they go.
"""

import bz2
import io
import struct

import genpy.dynamic
import roslz4

_MESSAGE, _CHUNK, _CONNECTION = b'\x02', b'\x05', b'\x07'
_VERSION_LINE = b'#ROSBAG V2.0\n'


class SalvagedBag:
    """What can be read of a damaged bag; like IntactBag."""

    def __init__(self, path):
        self._path = path
        self._connections = {}  # id: (topic, type, definition)
        self._types = {}
        self.topics = {}
        self.start_s = self.end_s = 0.0
        stamps = []
        for topic, datatype, _, _, stamp_s in self._messages():
            self.topics[topic] = (datatype, self.topics.get(topic, (None, 0))[1] + 1)
            stamps.append(stamp_s)
        if stamps:
            self.start_s, self.end_s = min(stamps), max(stamps)

    def messages(self, wanted):
        """(topic, decode, stamp_s) of the wanted topics; decode() gives the message."""
        for topic, datatype, definition, data, stamp_s in self._messages():
            if topic in wanted:
                yield topic, lambda d=data, t=datatype, m=definition: self._decode(t, m, d), stamp_s

    def _messages(self):
        with open(self._path, 'rb') as stream:
            if stream.readline() == _VERSION_LINE:
                yield from self._scan(stream)

    def _scan(self, stream):
        for fields, data in _records(stream):
            operation = fields['op']
            connection = self._connections.get(fields.get('conn'))
            if operation == _CHUNK:
                yield from self._scan(io.BytesIO(_unpack(fields.get('compression'), data)))
            elif operation == _CONNECTION:
                self._connect(fields, data)
            elif operation == _MESSAGE and connection and len(fields.get('time', b'')) == 8:
                seconds, nanoseconds = struct.unpack('<LL', fields['time'])
                yield (*connection, data, seconds + 1e-9 * nanoseconds)

    def _connect(self, fields, data):
        try:
            about = _fields(data)
            self._connections[fields['conn']] = (
                fields['topic'].decode(), about['type'].decode(),
                about['message_definition'].decode(errors='replace'))
        except (KeyError, struct.error, ValueError):
            pass  # Its messages cannot be told; other connections can.

    def _decode(self, datatype, definition, data):
        if datatype not in self._types:
            self._types[datatype] = genpy.dynamic.generate_dynamic(datatype, definition)[datatype]
        message = self._types[datatype]()
        message.deserialize(data)
        return message


def _records(stream):
    """Header fields and data of every record; ends quietly where the file breaks off."""
    while True:
        try:
            fields = _fields(_sized(stream))
            size, = struct.unpack('<L', stream.read(4))
            data = stream.read(size)
            # The beginning of a cut chunk still holds messages; that of a message does not.
            if 'op' not in fields or len(data) < size and fields['op'] != _CHUNK:
                return
        except (struct.error, ValueError):
            return
        yield fields, data


def _sized(stream):
    size, = struct.unpack('<L', stream.read(4))
    data = stream.read(size)
    if len(data) < size:
        raise ValueError('the file breaks off')
    return data


def _fields(data):
    """name=value pairs, each preceded by its length."""
    found, at = {}, 0
    while at < len(data):
        size, = struct.unpack_from('<L', data, at)
        name, separator, value = data[at + 4:at + 4 + size].partition(b'=')
        if not separator:
            raise ValueError('a header field without a value')
        found[name.decode()] = value
        at += 4 + size
    return found


def _unpack(compression, data):
    """The content of a chunk, or as much of it as there is."""
    try:
        if compression == b'bz2':
            return bz2.BZ2Decompressor().decompress(data)
        return roslz4.decompress(data) if compression == b'lz4' else data
    except (OSError, RuntimeError, ValueError):
        return b''
