"""`ir.view(scene)`: the server of the page, one session a client."""

from __future__ import annotations

import contextlib
import io
import threading
import warnings
from html import escape
from typing import Any

from interreflect.live.page import Page
from interreflect.live.poses import Space
from interreflect.live.renderer import Client, Renderer
from interreflect.live.session import Session, Wish
from interreflect.live.shared import Shared
from interreflect.methods.method import Method
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.stages import camera_of

LINES = 270
HEIGHT = 640  # of the page in a notebook, pixels


def view(
    scene: Scene,
    method: Method | None = None,
    camera: Camera | str | None = None,
    *,
    lines: int = LINES,
    host: str = "127.0.0.1",
    port: int = 8080,
    threads: int | None = None,
    scene_code: str = "...  # the scene that was viewed",
) -> LiveView:
    """A page of the scene at `.address`, until `.close()`: fly, choose a method, turn its knobs, compare with a truth that refines.

    method: what it begins with; None: VoxelConeTracing. lines: height of the picture, pixels; its width follows the page's. host: the
    address that is listened on; only this machine reaches the default. port: the next free one from here on. scene_code: what makes the
    scene in the programs that the page exports. Each client has a camera and knobs of its own; one frame is rendered at a time.

    ImportError without the extra `view`, ValueError for a scene without triangles or camera, an unknown camera, or lines out of range.
    """
    return LiveView(scene, method, camera_of(scene, camera), lines, host, port, threads, scene_code)


class LiveView:
    """What `ir.view` returns. In a notebook it shows its page; as a context it closes at the end."""

    def __init__(
        self, scene: Scene, method: Method | None, camera: Camera, lines: int, host: str, port: int, threads: int | None, scene_code: str
    ) -> None:
        if scene.triangles == 0:
            raise ValueError(f"scene {scene.name!r} has no triangles to look at")
        if not 16 <= lines <= 4096:
            raise ValueError(f"lines must lie in [16, 4096], got {lines}")
        self._scene, self._method, self._camera, self._lines, self._code = scene, method or _first(), camera, lines, scene_code
        self._server = _serve(host, port, scene)
        self._shared, self._space = Shared(scene, threads), Space.of(scene)
        self._renderer = Renderer()
        self._closed = threading.Event()
        self._server.on_client_disconnect(lambda client: self._renderer.remove(client.client_id))
        self._server.on_client_connect(self._connect)
        shown = "127.0.0.1" if host in ("0.0.0.0", "::") else host
        self.address = f"http://{shown}:{self._server.get_port()}"

    def close(self) -> None:
        """Ends the page."""
        if not self._closed.is_set():
            self._closed.set()
            self._renderer.stop()
            with contextlib.redirect_stdout(io.StringIO()):  # it says so
                self._server.stop()

    def wait(self) -> None:
        """Returns when another thread closes the view, or with KeyboardInterrupt."""
        self._closed.wait()

    def _connect(self, client: Any) -> None:
        session = Session(self._shared, Wish(self._method, self._camera, self._camera.size))
        page = Page(client, session, self._space, self._lines, self._renderer.wake, self._code)
        self._renderer.add(client.client_id, Client(session, page.show, page.complain, page.begin))
        if client.client_id not in self._server.get_clients():  # it left while its page was built
            self._renderer.remove(client.client_id)

    def __enter__(self) -> LiveView:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<LiveView of {self._scene.name!r} at {self.address}>"

    def _repr_html_(self) -> str:
        address = escape(self.address)
        return f'<a href="{address}">{address}</a><iframe src="{address}" width="100%" height="{HEIGHT}" style="border: 0"></iframe>'


def _first() -> Method:
    from interreflect.methods import VoxelConeTracing

    return VoxelConeTracing()


def _serve(host: str, port: int, scene: Scene) -> Any:
    try:
        import viser
    except ImportError as missing:
        raise ImportError("the live view needs viser, which comes with the extra `view`: pip install 'interreflect[view]'") from missing
    # A client may leave while its picture is made.
    warnings.filterwarnings("ignore", "Queued a .* on a closed connection", UserWarning)
    with contextlib.redirect_stdout(io.StringIO()):  # it announces itself
        server = viser.ViserServer(host=host, port=port, label=scene.name or "interreflect", verbose=False)
    # A tunnel would open the page to the world, whoever asks for it.
    server.request_share_url = _no_tunnel  # type: ignore[method-assign]
    server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False, control_width="large")
    server.gui.main_panel.dock_right()
    server.scene.set_up_direction(scene.up)
    return server


def _no_tunnel(verbose: bool = True) -> None:
    """The page is shared by `host=`, on purpose, or not at all."""
