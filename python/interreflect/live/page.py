"""The page of one client: what it can set, and what it is shown."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from interreflect import methods
from interreflect.live import tables
from interreflect.live.comparison import COMPARISONS, Bytes
from interreflect.live.export import program
from interreflect.live.layers import LAYERS
from interreflect.live.poses import Space
from interreflect.live.seen import Seen
from interreflect.live.session import Picture, Session
from interreflect.live.widgets import KnobPanel
from interreflect.methods.method import Method
from interreflect.scenes.camera import Camera

LINES = ("90", "135", "180", "270", "360", "540", "720", "1080")
DEFAULTS = "defaults"
JPEG_QUALITY = 90
WORDS = (
    "Drag turns, drag with the right button shifts, the wheel goes nearer. W A S D fly, Q and E go down and up, arrows turn; click the "
    "picture first."
)


class Page:
    """wake: called when the session wishes for something else. scene_code: the expression that makes the scene in an exported program."""

    def __init__(self, client: Any, session: Session, space: Space, lines: int, wake: Callable[[], None], scene_code: str) -> None:
        self._client, self._session, self._space, self._wake = client, session, space, wake
        self._lines, self._scene_code = lines, scene_code
        self._lock = threading.Lock()  # the page reports from several threads
        self._preset: str | None = None
        self._wrong = ""  # with the knobs as they stand
        self._sent: Bytes | None = None
        self._seen: Seen | None = None
        self._times = ""  # of that frame, in words
        self._build()
        self._fly_to(session.wish.camera)
        client.camera.on_update(lambda _: self._moved())

    def show(self, picture: Picture) -> None:
        sending = self._send(picture.pixels)
        if picture.seen is not self._seen:
            self._seen = picture.seen
            self._times = tables.times(picture, sending)
            self._stages.content = tables.stages(picture.seen.frame.profile)
            self._code.content = tables.code(self._program())
        self._status.content = tables.status(self._times, picture.errors)
        self.complain("")
        self._errors.content = tables.errors(picture.errors)

    def complain(self, words: str) -> None:
        """What is wrong with the picture that was wished for, beside what is wrong with the knobs."""
        self._problem.content = "".join(tables.problem(text) for text in (self._wrong, words) if text)

    def begin(self) -> None:
        method = self._session.wish.method
        if not self._session.shared.is_ready(method):
            self._status.content = tables.waiting(method.name)

    def _send(self, pixels: Bytes) -> float:
        """Milliseconds that it took to encode the picture and hand it to the network; none where it is there already."""
        if pixels is self._sent:
            return 0.0
        start = time.perf_counter()
        self._client.scene.set_background_image(pixels, format="jpeg", jpeg_quality=JPEG_QUALITY)
        self._client.flush()
        self._sent = pixels
        return 1e3 * (time.perf_counter() - start)

    def _build(self) -> None:
        gui = self._client.gui
        self._status = gui.add_html("")
        self._problem = gui.add_html("")
        tabs = gui.add_tab_group()
        with tabs.add_tab("Picture"):
            self._build_picture(gui)
        with tabs.add_tab("Method"):
            self._build_method(gui)
        with tabs.add_tab("Truth"):
            self._build_truth(gui)
        with tabs.add_tab("Python"):
            save = gui.add_button("Save as view.py")
            save.on_click(lambda _: self._client.send_file_download("view.py", self._program().encode()))
            self._code = gui.add_html("")

    def _build_picture(self, gui: Any) -> None:
        wish = self._session.wish
        self._bind(gui.add_dropdown("layer", tuple(LAYERS), initial_value=wish.layer), "layer")
        exposure = gui.add_slider("exposure (stops)", -8.0, 8.0, 0.25, 0.0, hint="0: the mean of the first picture is middle grey")
        self._bind(exposure, "exposure")
        lines = gui.add_dropdown("lines", tuple(sorted({*LINES, str(self._lines)}, key=int)), initial_value=str(self._lines))
        lines.on_update(lambda event: self._set_lines(event))
        cameras = {"as it began": wish.camera, **self._session.shared.scene.cameras}
        camera = gui.add_dropdown("camera", tuple(cameras), initial_value=self._camera_name(), hint="fly to a camera of the scene")
        camera.on_update(lambda event: None if event.client is None else self._fly_to(cameras[event.target.value]))
        again = gui.add_button("Back to the camera")
        again.on_click(lambda _: self._fly_to(cameras[camera.value]))
        self._bind(gui.add_checkbox("play", False, hint="frame after frame also at rest, each on the history of the one before"), "plays")
        self._stages = gui.add_html("")
        gui.add_html(f'<div style="{tables.SMALL}; opacity: 0.7">{WORDS}</div>')

    def _camera_name(self) -> str:
        """Of the camera that the page begins with."""
        known = self._session.shared.scene.cameras.items()
        return next((name for name, camera in known if camera == self._session.wish.camera), "as it began")

    def _build_method(self, gui: Any) -> None:
        method = self._session.wish.method
        names = {getattr(methods, name)().name: getattr(methods, name) for name in dir(methods)}
        self._method = gui.add_dropdown("method", tuple(names), initial_value=method.name)
        self._method.on_update(lambda event: None if event.client is None else self._choose_method(names[event.target.value]))
        self._paper = gui.add_dropdown("paper", (DEFAULTS, *method.presets), hint="sets every knob as a paper has it")
        self._paper.on_update(lambda event: None if event.client is None else self._choose_preset(event.target.value))
        self._panel = KnobPanel(gui, gui.add_folder(None), method, self._turned)

    def _build_truth(self, gui: Any) -> None:
        self._refines = gui.add_checkbox("refine the truth", False, hint="by path tracing, while the camera rests")
        self._bind(self._refines, "refines")
        self._comparison = gui.add_dropdown("show", COMPARISONS)
        self._comparison.on_update(lambda event: self._compare(event.target.value))
        flip = gui.add_button("Flip between method and truth")
        flip.on_click(lambda _: self._flip())
        bounces = gui.add_dropdown("truth's bounces", ("method", "all"), hint="of the truth: as many as the method aims at, or all")
        self._bind(bounces, "truth_bounces")
        self._errors = gui.add_html(tables.errors(None))

    def _bind(self, widget: Any, wish: str) -> None:
        """The widget's value is the wish of that name."""

        def turned(event: Any) -> None:
            with self._lock:
                self._change(**{wish: event.target.value})

        widget.on_update(turned)

    def _change(self, **changes: Any) -> None:
        self._session.change(**changes)
        self._wake()

    def _flip(self) -> None:
        self._comparison.value = "method" if self._comparison.value == "truth" else "truth"

    def _compare(self, comparison: str) -> None:
        """There is nothing to compare with before a truth refines."""
        self._change(comparison=comparison)
        if comparison != "method":
            self._refines.value = True

    def _choose_method(self, cls: type[Method]) -> None:
        self._paper.options = (DEFAULTS, *cls.presets)
        self._paper.value = DEFAULTS
        self._choose(cls(), None)

    def _choose_preset(self, name: str) -> None:
        cls = self._panel.cls
        self._choose(cls() if name == DEFAULTS else cls.preset(name), None if name == DEFAULTS else name)

    def _choose(self, method: Method, preset: str | None) -> None:
        self._preset, self._wrong = preset, ""
        self._panel.show(method)
        self._change(method=method)

    def _turned(self) -> None:
        try:
            method = self._panel.method()
        except (ValueError, TypeError) as error:
            self._wrong = f"{type(error).__name__}: {error}"
            self.complain("")
            return
        self._wrong = ""
        self.complain("")
        self._change(method=method)

    def _set_lines(self, event: Any) -> None:
        self._lines = int(event.target.value)
        self._moved()

    def _moved(self) -> None:
        """The camera as the page has it."""
        with self._lock:
            seen = self._client.camera
            aspect = max(seen.aspect, 1e-2)
            size = (max(16, min(4096, round(self._lines * aspect))), self._lines)
            # The picture fills the page, so its own aspect counts and not that of its rounded size.
            self._change(camera=self._space.camera(seen.position, seen.look_at, seen.wxyz, seen.fov, aspect, size), size=size)

    def _fly_to(self, camera: Camera) -> None:
        seen = self._client.camera
        pose = self._space.pose(camera, seen.aspect)
        with self._client.atomic():
            seen.up_direction, seen.position, seen.look_at, seen.fov = pose.up, pose.position, pose.look_at, pose.fov
        self._moved()

    def _program(self) -> str:
        wish = self._session.wish
        preset = self._preset if isinstance(wish.method, self._panel.cls) else None
        return program(self._scene_code, wish.method, preset, wish.camera, wish.size)
