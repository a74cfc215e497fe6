"""The room seen from above, from a point cloud or an OctoMap message."""

import numpy as np

from casepush_analysis.records import RoomMap

CELL_M = 0.05
FLOOR_M = 0.04  # Whatever lies lower is the floor.
MAX_VOXEL = 1024  # A pruned voxel larger than this, in smallest voxels, is no furniture.

_POINT_FORMATS = {1: 'i1', 2: 'u1', 3: 'i2', 4: 'u2', 5: 'i4', 6: 'u4', 7: 'f4', 8: 'f8'}


def from_points(message):
    """sensor_msgs/PointCloud2 in the map frame; None if nothing stands on the floor."""
    fields = {f.name: f for f in message.fields}
    if not all(axis in fields for axis in 'xyz'):
        return None
    order = '>' if message.is_bigendian else '<'
    layout = np.dtype({'names': list('xyz'),
                       'formats': [order + _POINT_FORMATS[fields[a].datatype] for a in 'xyz'],
                       'offsets': [fields[a].offset for a in 'xyz'],
                       'itemsize': message.point_step})
    rows = [np.frombuffer(message.data, layout, message.width, row * message.row_step)
            for row in range(message.height)]
    points = np.concatenate(rows) if rows else np.empty(0, layout)
    xyz = np.column_stack([points[axis].astype(float) for axis in 'xyz'])
    return _rasterise(xyz[np.all(np.isfinite(xyz), axis=1)], CELL_M)


def from_octomap(message):
    """casepush/Octomap (an OcTree, binary or full); None if nothing stands on the floor."""
    data = np.array(message.data, dtype=np.int8).tobytes()
    if data.startswith(b'# Octomap'):  # As a file has it.
        data = data.partition(b'\ndata\n')[2]
    voxels = _BinaryTree(data).occupied() if message.binary else _FullTree(data).occupied()
    cells = [_spread(key, size) for key, size in voxels if size <= MAX_VOXEL]
    if not cells:
        return None
    centres = (np.concatenate(cells) - 32768 + 0.5) * message.resolution
    return _rasterise(centres, message.resolution)


def _rasterise(xyz, cell_m):
    xyz = xyz[xyz[:, 2] > FLOOR_M]
    if len(xyz) == 0:
        return None
    # Points of single precision that lie on the border of two cells belong to the upper one.
    index = np.floor(xyz[:, :2] / cell_m + 1e-3).astype(int)
    low = index.min(axis=0)
    index -= low
    height = np.full((index[:, 1].max() + 1, index[:, 0].max() + 1), -np.inf)
    np.maximum.at(height, (index[:, 1], index[:, 0]), xyz[:, 2])
    height[np.isinf(height)] = np.nan
    return RoomMap(float(low[0] * cell_m), float(low[1] * cell_m), cell_m, height)


def _spread(key, size):
    """Keys of the top layer of smallest voxels that a pruned voxel stands for: the map is 2-D."""
    steps = np.arange(size)
    x, y = np.meshgrid(key[0] + steps, key[1] + steps)
    return np.column_stack([x.ravel(), y.ravel(), np.full(x.size, key[2] + size - 1)])


def _child_key(key, half, child):
    return (key[0] + (half if child & 1 else 0), key[1] + (half if child & 2 else 0),
            key[2] + (half if child & 4 else 0))


class _BinaryTree:
    """OctoMap's binary stream: two bits for each of eight children."""

    ROOT_SIZE = 1 << 16

    def __init__(self, data):
        self._data = data
        self._at = 0

    def occupied(self):
        """(key, size) of every occupied leaf, in smallest voxels."""
        found = []
        if self._data:
            self._read((0, 0, 0), self.ROOT_SIZE, found)
        return found

    def _read(self, key, size, found):
        bits = int.from_bytes(self._data[self._at:self._at + 2], 'little')
        self._at += 2
        half = size // 2
        inner = []
        for child in range(8):
            kind = bits >> (2 * child) & 3
            if kind == 2:  # Bit 1 set, bit 0 clear: an occupied leaf.
                found.append((_child_key(key, half, child), half))
            elif kind == 3:
                inner.append(child)
        for child in inner:
            self._read(_child_key(key, half, child), half, found)


class _FullTree(_BinaryTree):
    """OctoMap's full stream: each node a float log-odds and a byte telling its children."""

    def _read(self, key, size, found):
        log_odds = np.frombuffer(self._data, '<f4', 1, self._at)[0]
        children = self._data[self._at + 4]
        self._at += 5
        if children == 0 and log_odds > 0.0:
            found.append((key, size))
        for child in range(8):
            if children >> child & 1:
                self._read(_child_key(key, size // 2, child), size // 2, found)
