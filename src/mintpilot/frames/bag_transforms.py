"""Where a camera was, from the transforms and the odometry of a bag."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.frames.rotations import BODY_FROM_OPTICAL, pose_of

_ROOTS = ("map", "odom", "world")
"""Frames that are taken for the world, the first one that leads to the camera."""
_STALE_S = 0.2
"""A transform is used for pictures no further away in time."""
_LONGEST_CHAIN = 30


@dataclass(slots=True)
class _Link:
    """A frame in its parent over time."""

    parent: str
    times_s: list[float] = field(default_factory=list)
    poses: list[Floats] = field(default_factory=list)
    fixed: bool = False

    def at(self, time_s: float) -> Floats | None:
        if self.fixed:
            return self.poses[-1]
        after = bisect_left(self.times_s, time_s)
        near = [i for i in (after - 1, after) if 0 <= i < len(self.times_s)]
        best = min(near, key=lambda i: abs(self.times_s[i] - time_s), default=None)
        if best is None or abs(self.times_s[best] - time_s) > _STALE_S:
            return None
        if len(near) == 2 and self.times_s[near[0]] <= time_s <= self.times_s[near[1]]:
            return _between(self, near[0], near[1], time_s)
        return self.poses[best]


class Transforms:
    """All transforms of a bag, and its odometry where there are none."""

    def __init__(self) -> None:
        self._links: dict[str, _Link] = {}
        self._odometry: _Link | None = None
        self._odometry_child = ""

    def add(self, transforms: Iterable[Any], *, fixed: bool) -> None:
        """Takes the transforms of one message of ``/tf`` or, with ``fixed``, ``/tf_static``."""
        for transform in transforms:
            child, parent = transform.child_frame_id.lstrip("/"), transform.header.frame_id.lstrip("/")
            link = self._links.setdefault(child, _Link(parent=parent, fixed=fixed))
            t, r = transform.transform.translation, transform.transform.rotation
            stamp = transform.header.stamp
            link.times_s.append(float(stamp.sec) + 1e-9 * float(stamp.nanosec))
            link.poses.append(pose_of((t.x, t.y, t.z), (r.x, r.y, r.z, r.w)))

    def add_odometry(self, message: Any) -> None:
        """Takes one message of ``Odometry``."""
        if self._odometry is None:
            self._odometry = _Link(parent=message.header.frame_id.lstrip("/"))
            self._odometry_child = message.child_frame_id.lstrip("/")
        p, r = message.pose.pose.position, message.pose.pose.orientation
        stamp = message.header.stamp
        self._odometry.times_s.append(float(stamp.sec) + 1e-9 * float(stamp.nanosec))
        self._odometry.poses.append(pose_of((p.x, p.y, p.z), (r.x, r.y, r.z, r.w)))

    def pose(self, frame: str, time_s: float) -> Floats | None:
        """Pose (4, 4) of a camera's frame in the world at a time; None where the bag does not tell."""
        if self._odometry is not None and self._odometry_child not in self._links:
            self._links[self._odometry_child] = self._odometry
        pose, name = np.eye(4), frame.lstrip("/")
        for _ in range(_LONGEST_CHAIN):
            if name in _ROOTS and name not in self._links:
                return pose
            link = self._links.get(name)
            if link is None:
                # A chain that ends elsewhere counts when it moves at all: its end is the world.
                return pose if name != frame.lstrip("/") and self._moves(frame) else None
            step = link.at(time_s)
            if step is None:
                return None
            pose, name = step @ pose, link.parent
        return None

    def body_pose(self, time_s: float) -> Floats | None:
        """The odometry's pose with a camera that looks ahead from it, for bags without transforms."""
        step = self._odometry.at(time_s) if self._odometry is not None else None
        return None if step is None else np.asarray(step @ BODY_FROM_OPTICAL, float)

    def _moves(self, frame: str) -> bool:
        name = frame.lstrip("/")
        for _ in range(_LONGEST_CHAIN):
            link = self._links.get(name)
            if link is None:
                return False
            if not link.fixed:
                return True
            name = link.parent
        return False


def _between(link: _Link, a: int, b: int, time_s: float) -> Floats:
    """Between two poses: positions linearly, of the rotations the nearer one turned back to a rotation."""
    span = link.times_s[b] - link.times_s[a]
    share = (time_s - link.times_s[a]) / span if span > 0 else 0.0
    mixed = (1 - share) * link.poses[a] + share * link.poses[b]
    left, _, right = np.linalg.svd(mixed[:3, :3])
    mixed[:3, :3] = left @ right
    return np.asarray(mixed, float)
