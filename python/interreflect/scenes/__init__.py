"""Scenes: the built-in ones by name, made when called; and the values that every scene is made of."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from interreflect.scenes.builtin.atrium import atrium as atrium
    from interreflect.scenes.builtin.ball_in_sky import ball_in_sky as ball_in_sky
    from interreflect.scenes.builtin.ball_on_floor import ball_on_floor as ball_on_floor
    from interreflect.scenes.builtin.blade import blade as blade
    from interreflect.scenes.builtin.blocked_sky import blocked_sky as blocked_sky
    from interreflect.scenes.builtin.closed_forms import closed_form as closed_form
    from interreflect.scenes.builtin.cornell_box import cornell_box as cornell_box
    from interreflect.scenes.builtin.corridors import corridors as corridors
    from interreflect.scenes.builtin.dark_room import dark_room as dark_room
    from interreflect.scenes.builtin.depth_edge import depth_edge as depth_edge
    from interreflect.scenes.builtin.disk_above_point import disk_above_point as disk_above_point
    from interreflect.scenes.builtin.foliage import foliage as foliage
    from interreflect.scenes.builtin.furnace import furnace as furnace
    from interreflect.scenes.builtin.glossy_plates import glossy_plates as glossy_plates
    from interreflect.scenes.builtin.glossy_receiver import glossy_receiver as glossy_receiver
    from interreflect.scenes.builtin.grille import grille as grille
    from interreflect.scenes.builtin.integrating_sphere import integrating_sphere as integrating_sphere
    from interreflect.scenes.builtin.lit_patch import lit_patch as lit_patch
    from interreflect.scenes.builtin.lone_ball import lone_ball as lone_ball
    from interreflect.scenes.builtin.opaque_layer import opaque_layer as opaque_layer
    from interreflect.scenes.builtin.opposed_lights import opposed_lights as opposed_lights
    from interreflect.scenes.builtin.penumbra import penumbra as penumbra
    from interreflect.scenes.builtin.squares import corner as corner
    from interreflect.scenes.builtin.squares import facing_squares as facing_squares
    from interreflect.scenes.builtin.sunk_box import sunk_box as sunk_box
    from interreflect.scenes.builtin.sunlit_floor import sunlit_floor as sunlit_floor
    from interreflect.scenes.builtin.textured_light_box import textured_light_box as textured_light_box
    from interreflect.scenes.builtin.thin_wall import thin_wall as thin_wall
    from interreflect.scenes.builtin.wires import wires as wires

_MODULES = {
    "atrium": "atrium",
    "ball_in_sky": "ball_in_sky",
    "ball_on_floor": "ball_on_floor",
    "blade": "blade",
    "blocked_sky": "blocked_sky",
    "closed_form": "closed_forms",
    "cornell_box": "cornell_box",
    "corner": "squares",
    "corridors": "corridors",
    "dark_room": "dark_room",
    "depth_edge": "depth_edge",
    "disk_above_point": "disk_above_point",
    "facing_squares": "squares",
    "foliage": "foliage",
    "furnace": "furnace",
    "glossy_plates": "glossy_plates",
    "glossy_receiver": "glossy_receiver",
    "grille": "grille",
    "integrating_sphere": "integrating_sphere",
    "lit_patch": "lit_patch",
    "lone_ball": "lone_ball",
    "opaque_layer": "opaque_layer",
    "opposed_lights": "opposed_lights",
    "penumbra": "penumbra",
    "sunk_box": "sunk_box",
    "sunlit_floor": "sunlit_floor",
    "textured_light_box": "textured_light_box",
    "thin_wall": "thin_wall",
    "wires": "wires",
}
__all__ = list(_MODULES)


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.builtin.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
