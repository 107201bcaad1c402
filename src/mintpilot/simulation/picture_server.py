"""Pictures of a running MuJoCo world over a local socket: a client asks, and gets the present view."""

from __future__ import annotations

import json
import socket
import struct
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from mintpilot.core.errors import DeviceError, MapError
from mintpilot.core.observation import CameraModel, Frame, RawFrame
from mintpilot.core.ports import FrameSource, SourceOptions
from mintpilot.simulation.render import SceneRenderer
from mintpilot.simulation.scene import Scene

SIZE: Final = (320, 240)
LENGTH: Final = struct.Struct("!I")
MOST_BYTES: Final = 64_000_000
TIMEOUT_S: Final = 10.0
"""A client that does not read, or a server that does not answer, is given up after this, seconds."""


class PictureServer:
    """Sends one picture for each connection: a header in JSON, colours (uint8), depth (float32, metres).

    Args:
        model: the compiled world, with the camera ``rgbd``.
        scene: its clouds and flames.
        host: address to listen at.
        port: TCP; 0: any free one.
    """

    def __init__(self, model: Any, scene: Scene, host: str, port: int) -> None:
        self._model, self._scene = model, scene
        self.listener = socket.create_server((host, port))
        self.port = int(self.listener.getsockname()[1])
        self._renderer: SceneRenderer | None = None

    def serve_one(self, data: Any) -> None:
        """Takes one client and sends the picture of now; a client that goes away costs nothing."""
        client, _ = self.listener.accept()
        with client:
            client.settimeout(TIMEOUT_S)
            frame = self.draw(data)
            lens = frame.camera
            head = json.dumps(
                {
                    "time_s": frame.time_s,
                    "camera": {n: getattr(lens, n) for n in ("width", "height", "fx", "fy", "cx", "cy")},
                    "world_from_camera": frame.world_from_camera.tolist(),
                }
            ).encode()
            depth = np.nan_to_num(frame.depth_m).astype("<f4").tobytes()
            try:
                client.sendall(LENGTH.pack(len(head)) + head + frame.rgb.tobytes() + depth)
            except OSError:
                return

    def draw(self, data: Any) -> Frame:
        """The picture of now. The first one takes seconds: whoever may not wait draws one before."""
        if self._renderer is None:
            width, height = SIZE
            self._renderer = SceneRenderer(self._model, self._scene, seed=0, width=width, height=height)
        return self._renderer.capture(data, float(data.time))

    def close(self) -> None:
        """Frees the port. Safe to call again."""
        self.listener.close()

    def stop_drawing(self) -> None:
        """Frees what is drawn with, in the thread that drew. Safe to call again."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None


class RemotePictures(FrameSource):
    """Pictures of ``mintpilot sim serve``: each is the view at the moment when it is asked for.

    Args:
        where: ``//HOST:PORT``.
        options: ``longest`` bounds the number of frames.

    Raises:
        MapError: that is no address.
    """

    def __init__(self, where: str, options: SourceOptions) -> None:
        host, _, port = where.removeprefix("//").partition(":")
        if not host or not port.isdigit():
            raise MapError(f"'sim:{where}' is no address of a simulator: write sim://127.0.0.1:PORT")
        self._address = (host, int(port))
        self._longest = options.longest

    @property
    def z_is_up(self) -> bool:
        """True."""
        return True

    def remarks(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    def frames(self) -> Iterator[RawFrame]:
        """The view of now, again and again. Raises `DeviceError` when the simulator does not answer."""
        for _ in range(self._longest):
            yield self.picture()

    def picture(self) -> RawFrame:
        """One picture. Raises `DeviceError` when the simulator does not answer, or sends something else."""
        try:
            with socket.create_connection(self._address, timeout=TIMEOUT_S) as connection:
                data = bytearray()
                while chunk := connection.recv(1 << 16):
                    data += chunk
                    if len(data) > MOST_BYTES:
                        raise DeviceError(f"the simulator at {self._address} sent more than {MOST_BYTES} bytes")
        except OSError as error:
            raise DeviceError(
                f"no pictures from the simulator at {self._address[0]}:{self._address[1]} ({error}); is "
                "'mintpilot sim serve … --camera PORT' running?"
            ) from error
        try:
            return _read(bytes(data))
        except (ValueError, KeyError, TypeError, struct.error) as error:
            raise DeviceError(f"the simulator at {self._address} sent no picture ({error})") from error


def _read(data: bytes) -> RawFrame:
    (length,) = LENGTH.unpack_from(data)
    head = json.loads(data[LENGTH.size : LENGTH.size + length])
    lens = CameraModel(**head["camera"])
    count, begin = lens.width * lens.height, LENGTH.size + length
    rgb = np.frombuffer(data, np.uint8, 3 * count, begin).reshape(lens.height, lens.width, 3)
    depth = np.frombuffer(data, "<f4", count, begin + 3 * count).reshape(lens.height, lens.width)
    return RawFrame(
        time_s=float(head["time_s"]),
        rgb=rgb.copy(),
        depth_m=depth.astype(np.float32),
        camera=lens,
        source_from_camera=np.asarray(head["world_from_camera"], float),
    )


def simulated(where: str, options: SourceOptions) -> FrameSource:
    """Pictures of a built-in scenario by name, or of a running simulator at ``//HOST:PORT``."""
    if where.startswith("//"):
        return RemotePictures(where, options)
    from mintpilot.simulation.frame_source import SimulatedPictures

    return SimulatedPictures(where, options)
